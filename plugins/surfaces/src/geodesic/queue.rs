//! A queue of windows in the order of their lengths, nearly.

/// Bits of a positive f64 that are dropped: 13 bits of the fraction stay, 8,192 steps for each doubling.
const DROPPED: u32 = 52 - 13;
/// Steps that have a bucket each: the first doubling, where the keys of most searches lie.
const FINE: u64 = 1 << 13;
/// Bits dropped beyond: 32 steps share a bucket, 256 buckets for each doubling.
const COARSE: u32 = 5;
/// Sixteen doublings beyond; what is longer still shares the last bucket.
const BUCKETS: usize = FINE as usize + 16 * 256;
/// No item.
const NONE: u32 = u32::MAX;

#[derive(Clone, Copy, Debug)]
struct Item {
    key: f64,
    index: u32,
    below: u32,
}

/// Buckets of similar keys, each a stack. A search is right in any order, and quick in nearly the right one:
/// buckets cost a tenth of a heap.
#[derive(Debug, Default)]
pub(super) struct Queue {
    items: Vec<Item>,
    /// The last item of each bucket.
    tops: Vec<u32>,
    /// A bit for each bucket that holds an item.
    occupied: Vec<u64>,
    /// The first word that may have a bit.
    lowest: usize,
    /// Buckets above are not asked for any more.
    last: usize,
    /// Number of the first bucket's keys.
    base: u64,
}

impl Queue {
    /// Empties the queue for keys of at least `least` > 0; smaller ones share the first bucket.
    pub fn restart(&mut self, least: f64) {
        self.items.clear();
        if self.tops.is_empty() {
            self.tops.resize(BUCKETS, NONE);
            self.occupied.resize(BUCKETS / 64, 0);
        }
        for (word, bits) in self.occupied.iter_mut().enumerate() {
            while *bits != 0 {
                self.tops[64 * word + bits.trailing_zeros() as usize] = NONE;
                *bits &= *bits - 1;
            }
        }
        (self.lowest, self.last) = (0, BUCKETS - 1);
        self.base = least.to_bits() >> DROPPED;
    }

    /// Adds a positive key with an index.
    pub fn push(&mut self, key: f64, index: u32) {
        let bucket = self.bucket(key);
        self.items.push(Item { key, index, below: self.tops[bucket] });
        self.tops[bucket] = (self.items.len() - 1) as u32;
        self.occupied[bucket / 64] |= 1 << (bucket % 64);
        self.lowest = self.lowest.min(bucket / 64);
    }

    /// From now on keys of at least `limit` may be left out.
    pub fn cut(&mut self, limit: f64) {
        self.last = self.bucket(limit);
    }

    /// Takes one of the smallest keys with its index.
    pub fn pop(&mut self) -> Option<(f64, u32)> {
        while self.lowest <= self.last / 64 {
            let bits = self.occupied[self.lowest];
            if bits == 0 {
                self.lowest += 1;
                continue;
            }
            let bucket = 64 * self.lowest + bits.trailing_zeros() as usize;
            let Item { key, index, below } = self.items[self.tops[bucket] as usize];
            self.tops[bucket] = below;
            if below == NONE {
                self.occupied[self.lowest] = bits & (bits - 1);
            }
            return (bucket <= self.last).then_some((key, index));
        }
        None
    }

    fn bucket(&self, key: f64) -> usize {
        let step = (key.to_bits() >> DROPPED).saturating_sub(self.base);
        if step < FINE {
            return step as usize;
        }
        let coarse = FINE + ((step - FINE) >> COARSE);
        (coarse as usize).min(BUCKETS - 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use regrasp_api::Random;

    #[test]
    fn keys_come_out_once_each_and_nearly_in_order() {
        let mut random = Random::from_key(3, 0, 0, 0);
        let mut queue = Queue::default();
        for round in 0..3 {
            queue.restart(0.01);
            let keys: Vec<f64> = (0..500).map(|_| random.range(0.01, 2.0)).collect();
            keys.iter().enumerate().for_each(|(index, &key)| queue.push(key, index as u32));
            let (mut last, mut seen) = (0.0, vec![false; keys.len()]);
            while let Some((key, index)) = queue.pop() {
                assert_eq!(keys[index as usize], key);
                assert!(!std::mem::replace(&mut seen[index as usize], true));
                assert!(key > last * (1.0 - 4e-3), "round {round}: {key} after {last}");
                last = key;
            }
            assert!(seen.iter().all(|&seen| seen));
        }
        queue.restart(0.01);
        [0.05, 0.5, 0.02].iter().for_each(|&key| queue.push(key, 0));
        queue.cut(0.1);
        assert_eq!([queue.pop(), queue.pop(), queue.pop()], [Some((0.02, 0)), Some((0.05, 0)), None]);
        // Keys out of range are kept too.
        queue.restart(1.0);
        queue.push(1e-9, 1);
        queue.push(1e9, 2);
        assert_eq!([queue.pop(), queue.pop(), queue.pop()], [Some((1e-9, 1)), Some((1e9, 2)), None]);
    }
}
