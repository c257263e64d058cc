//! A digest of bytes: tells apart what was mixed up, cut short or changed; no defence against a forger.

/// Odd, and without pattern: the golden ratio.
const FACTOR: u64 = 0x9e37_79b9_7f4a_7c15;
/// Sums that run side by side, so that a processor need not wait for one multiplication to begin the next.
const LANES: usize = 4;

/// The digest of bytes, taken as words of eight, the lowest byte first; what is missing counts as zeros.
pub(crate) fn digest(bytes: &[u8]) -> u64 {
    let mut lanes: [u64; LANES] = std::array::from_fn(|lane| lane as u64 + 1);
    let mut blocks = bytes.chunks_exact(8 * LANES);
    for block in &mut blocks {
        for (lane, word) in lanes.iter_mut().zip(block.chunks_exact(8)) {
            *lane = mixed(*lane, u64::from_le_bytes(word.try_into().expect("eight bytes")));
        }
    }
    for (i, rest) in blocks.remainder().chunks(8).enumerate() {
        let mut word = [0; 8];
        word[..rest.len()].copy_from_slice(rest);
        lanes[i] = mixed(lanes[i], u64::from_le_bytes(word));
    }
    lanes.into_iter().fold(bytes.len() as u64, mixed)
}

fn mixed(sum: u64, word: u64) -> u64 {
    (sum.rotate_left(23) ^ word).wrapping_mul(FACTOR)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_byte_and_the_length_count() {
        let bytes: Vec<u8> = (0..100).collect();
        let whole = digest(&bytes);
        assert_eq!(whole, digest(&bytes));
        for i in 0..bytes.len() {
            let mut changed = bytes.clone();
            changed[i] ^= 1;
            assert_ne!(digest(&changed), whole, "byte {i}");
            assert_ne!(digest(&bytes[..i]), whole, "the first {i} bytes");
        }
        assert_ne!(digest(&[0; 7]), digest(&[0; 8]));
    }
}
