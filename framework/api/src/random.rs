//! The random stream that a call is handed: seeded, portable, cheap to fork.

/// xoshiro256++ (Blackman & Vigna, "Scrambled linear pseudorandom number generators", ACM TOMS 2021), seeded
/// by SplitMix64.
///
/// A stream is a pure function of its key, so that an expensive call gives the same answer on whichever
/// thread it runs.
#[derive(Clone, Debug, PartialEq)]
pub struct Random {
    state: [u64; 4],
}

impl Random {
    /// The stream of the key `(seed, kind, a, b)`: unequal keys give unrelated streams.
    pub fn from_key(seed: u64, kind: u64, a: u64, b: u64) -> Self {
        let mut mixer = 0x9e37_79b9_7f4a_7c15_u64;
        for part in [seed, kind, a, b] {
            mixer = split_mix(&mut (mixer ^ part));
        }
        Self { state: std::array::from_fn(|_| split_mix(&mut mixer)) }
    }

    /// The stream in a state that [`Random::state`] gave.
    pub fn from_state(state: [u64; 4]) -> Self {
        Self { state }
    }

    /// Where the stream is: what comes next follows from these words alone.
    pub fn state(&self) -> [u64; 4] {
        self.state
    }

    /// Uniform over all 64-bit words.
    pub fn word(&mut self) -> u64 {
        let s = &mut self.state;
        let result = s[0].wrapping_add(s[3]).rotate_left(23).wrapping_add(s[0]);
        let t = s[1] << 17;
        s[2] ^= s[0];
        s[3] ^= s[1];
        s[1] ^= s[2];
        s[0] ^= s[3];
        s[2] ^= t;
        s[3] = s[3].rotate_left(45);
        result
    }

    /// Uniform in [0, 1), 53 bits.
    pub fn unit(&mut self) -> f64 {
        (self.word() >> 11) as f64 * (1.0 / (1u64 << 53) as f64)
    }

    /// Uniform in [low, high).
    pub fn range(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Uniform in 0..count; `count` must be positive.
    pub fn index(&mut self, count: usize) -> usize {
        // Multiply-shift: the bias is below count / 2^64.
        ((u128::from(self.word()) * count as u128) >> 64) as usize
    }

    /// Standard normal (Box-Muller).
    pub fn normal(&mut self) -> f64 {
        let radius = (-2.0 * (1.0 - self.unit()).ln()).sqrt();
        radius * (std::f64::consts::TAU * self.unit()).cos()
    }

    /// Uniform on the unit sphere.
    pub fn direction(&mut self) -> crate::Vec3 {
        let z = self.range(-1.0, 1.0);
        let (sin, cos) = self.range(0.0, std::f64::consts::TAU).sin_cos();
        let radius = (1.0 - z * z).max(0.0).sqrt();
        crate::Vec3::new(radius * cos, radius * sin, z)
    }

    /// Uniform over all orientations (Shoemake, "Uniform random rotations", Graphics Gems III, 1992).
    pub fn rotation(&mut self) -> crate::Rotation {
        let u = self.unit();
        let (s1, c1) = self.range(0.0, std::f64::consts::TAU).sin_cos();
        let (s2, c2) = self.range(0.0, std::f64::consts::TAU).sin_cos();
        let (a, b) = ((1.0 - u).sqrt(), u.sqrt());
        crate::Rotation::new_normalize(nalgebra::Quaternion::new(b * c2, a * s1, a * c1, b * s2))
    }
}

fn split_mix(state: &mut u64) -> u64 {
    *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let mut z = *state;
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// The generator behind `rand`'s traits: `rand_core::Rng` comes with this one.
#[cfg(any(feature = "rand_core", test))]
impl rand_core::TryRng for Random {
    type Error = std::convert::Infallible;

    fn try_next_u32(&mut self) -> Result<u32, Self::Error> {
        // The upper half is the better one.
        Ok((self.word() >> 32) as u32)
    }

    fn try_next_u64(&mut self) -> Result<u64, Self::Error> {
        Ok(self.word())
    }

    fn try_fill_bytes(&mut self, bytes: &mut [u8]) -> Result<(), Self::Error> {
        for part in bytes.chunks_mut(8) {
            part.copy_from_slice(&self.word().to_le_bytes()[..part.len()]);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_give_repeatable_and_distinct_streams() {
        let first = |a, b| Random::from_key(7, 1, a, b).word();
        assert_eq!(first(2, 3), first(2, 3));
        assert_ne!(first(2, 3), first(3, 2));
        assert_ne!(first(0, 0), first(0, 1));
    }

    #[test]
    fn moments_are_those_of_the_distributions() {
        let mut random = Random::from_key(1, 0, 0, 0);
        let n = 40_000;
        let mean = (0..n).map(|_| random.unit()).sum::<f64>() / f64::from(n);
        assert!((mean - 0.5).abs() < 0.01, "{mean}");
        let square = (0..n).map(|_| random.normal().powi(2)).sum::<f64>() / f64::from(n);
        assert!((square - 1.0).abs() < 0.04, "{square}");
        let direction = (0..n).map(|_| random.direction()).sum::<crate::Vec3>() / f64::from(n);
        assert!(direction.norm() < 0.02);
        // A uniform rotation takes any vector to a uniform direction.
        let turned = (0..n).map(|_| random.rotation() * crate::Vec3::x()).sum::<crate::Vec3>() / f64::from(n);
        assert!(turned.norm() < 0.02);
    }

    #[test]
    fn index_covers_its_range() {
        let mut random = Random::from_key(1, 2, 3, 4);
        let mut seen = [0; 5];
        (0..5000).for_each(|_| seen[random.index(5)] += 1);
        assert!(seen.iter().all(|&count| (850..1150).contains(&count)), "{seen:?}");
    }

    #[test]
    fn rands_traits_draw_the_same_words() {
        use rand_core::Rng;
        let (mut own, mut theirs) = (Random::from_key(1, 2, 3, 4), Random::from_key(1, 2, 3, 4));
        let word = own.word();
        assert_eq!(theirs.next_u64(), word);
        let mut bytes = [0; 11];
        theirs.fill_bytes(&mut bytes);
        assert_eq!(bytes[..8], own.word().to_le_bytes());
        assert_eq!(bytes[8..], own.word().to_le_bytes()[..3]);
        assert_eq!(theirs, own);
    }
}
