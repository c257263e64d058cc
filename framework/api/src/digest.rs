//! Fingerprints of meshes.

use crate::Mesh;

/// Fingerprint of a mesh: FNV-1a over the bits of its vertices and facets (Fowler, Noll, Vo; 128 bits), in
/// hexadecimal digits.
///
/// It tells meshes apart that were mixed up; against somebody who forges one it is no protection.
pub fn mesh_digest(mesh: &Mesh) -> String {
    let mut hash = Fnv(0x6c62_272e_07bb_0142_62b8_2175_6295_c58d);
    mesh.vertices().iter().flatten().for_each(|x| hash.take(x.to_bits().to_le_bytes()));
    mesh.facets().iter().flatten().for_each(|index| hash.take(index.to_le_bytes()));
    format!("{:032x}", hash.0)
}

struct Fnv(u128);

impl Fnv {
    fn take<const N: usize>(&mut self, bytes: [u8; N]) {
        for byte in bytes {
            self.0 = (self.0 ^ u128::from(byte)).wrapping_mul(0x0000_0000_0100_0000_0000_0000_0000_013b);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The published test vector of the letter "a".
    #[test]
    fn it_is_the_published_function() {
        let mut hash = Fnv(0x6c62_272e_07bb_0142_62b8_2175_6295_c58d);
        hash.take([b'a']);
        assert_eq!(format!("{:032x}", hash.0), "d228cb696f1a8caf78912b704e4a8964");
    }
}
