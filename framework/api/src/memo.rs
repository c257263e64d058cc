//! A plugin's memory of what it worked out before.

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

/// Results by key, shared by the threads of a search: for roadmaps, factorisations, cones.
///
/// It changes what a call costs and never what it answers, if the result is a pure function of the key. That
/// is the plugin's duty; the laws
/// of purity and an audit hold it to it. Once `most` results are kept no more are: which ones are depends on
/// the threads, so the answers may not.
#[derive(Debug)]
pub struct Memo<K, V> {
    most: usize,
    known: Mutex<BTreeMap<K, V>>,
}

impl<K: Ord, V: Clone> Memo<K, V> {
    /// An empty memory of at most `most` results.
    pub fn new(most: usize) -> Self {
        Self { most, known: Mutex::new(BTreeMap::new()) }
    }

    /// The result for `key`, worked out by `make` where it is not known; a `make` that fails is tried again
    /// the next time.
    ///
    /// Two threads that miss at a time both work it out, alike.
    pub fn get<E>(&self, key: K, make: impl FnOnce() -> Result<V, E>) -> Result<V, E> {
        let known = || self.known.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(value) = known().get(&key) {
            return Ok(value.clone());
        }
        // Not while the others wait: it may take long, and it may ask this memory.
        let value = make()?;
        let mut known = known();
        if known.len() < self.most {
            known.insert(key, value.clone());
        }
        Ok(value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::Cell;

    #[test]
    fn what_is_known_is_not_worked_out_again() {
        let (memo, made) = (Memo::new(2), Cell::new(0));
        let square = |k: u32| {
            memo.get(k, || {
                made.set(made.get() + 1);
                if k == 9 { Err("too large") } else { Ok(k * k) }
            })
        };
        assert_eq!([square(2), square(3), square(2), square(3)], [Ok(4), Ok(9), Ok(4), Ok(9)]);
        assert_eq!(made.get(), 2);
        // Full: right all the same.
        assert_eq!([square(4), square(4), square(9)], [Ok(16), Ok(16), Err("too large")]);
        assert_eq!(made.get(), 5);
    }
}
