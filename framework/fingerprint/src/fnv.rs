//! FNV-1a with 128 bits (Fowler, Noll, Vo): enough to tell versions apart, no defence against malice.

pub struct Fnv(u128);

impl Default for Fnv {
    fn default() -> Self {
        Self(0x6c62_272e_07bb_0142_62b8_2175_6295_c58d)
    }
}

impl Fnv {
    /// Adds a word; lengths keep apart what would otherwise run together.
    pub fn word(&mut self, word: &str) {
        self.bytes(&(word.len() as u64).to_le_bytes());
        self.bytes(word.as_bytes());
    }

    fn bytes(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.0 = (self.0 ^ u128::from(byte)).wrapping_mul(0x0000_0000_0100_0000_0000_0000_0000_013b);
        }
    }

    /// The hash in hexadecimal.
    pub fn text(&self) -> String {
        format!("{:032x}", self.0)
    }
}
