//! Work on threads, taken in its order.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread;

/// Does the pieces of work 0 to `count` - 1 on so many threads, and takes what comes of each in that order,
/// as one thread would: the number of threads changes the time alone.
///
/// What comes early waits; no more does than threads run ahead.
pub(crate) fn in_order<T: Send>(
    count: usize,
    threads: usize,
    work: impl Fn(usize) -> T + Sync,
    mut take: impl FnMut(usize, T) + Send,
) {
    let threads = threads.min(count);
    if threads <= 1 {
        return (0..count).for_each(|piece| take(piece, work(piece)));
    }
    let next = AtomicUsize::new(0);
    let row = Mutex::new(Row { take, next: 0, waiting: BTreeMap::new() });
    let worker = || {
        loop {
            let piece = next.fetch_add(1, Ordering::Relaxed);
            if piece >= count {
                break;
            }
            let done = work(piece);
            // Where another thread has panicked all ends in that panic.
            row.lock().unwrap_or_else(PoisonError::into_inner).put(piece, done);
        }
    };
    thread::scope(|scope| {
        for _ in 1..threads {
            scope.spawn(worker);
        }
        worker();
    });
}

/// What is done, as it is taken.
struct Row<T, F> {
    take: F,
    next: usize,
    waiting: BTreeMap<usize, T>,
}

impl<T, F: FnMut(usize, T)> Row<T, F> {
    fn put(&mut self, piece: usize, done: T) {
        self.waiting.insert(piece, done);
        while let Some(done) = self.waiting.remove(&self.next) {
            (self.take)(self.next, done);
            self.next += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_is_taken_in_order_whatever_comes_first() {
        for (count, threads) in [(0, 4), (1, 4), (50, 1), (50, 2), (50, 7), (3, 0)] {
            let mut taken = Vec::new();
            let work = |piece: usize| {
                if piece.is_multiple_of(3) {
                    thread::yield_now();
                }
                piece * piece
            };
            in_order(count, threads, work, |piece, done| taken.push((piece, done)));
            assert_eq!(taken, (0..count).map(|piece| (piece, piece * piece)).collect::<Vec<_>>());
        }
    }
}
