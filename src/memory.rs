//! How much memory a thread has in use: the system's allocator, counted.

use regrasp::study::compare::Memory;
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

/// The bytes of a thread. What it frees for another thread is taken off its own.
#[derive(Clone, Copy)]
struct Bytes {
    in_use: i64,
    most: i64,
}

thread_local! {
    // Made by the compiler and never dropped: the allocator may use it at any time of a thread's life.
    static BYTES: Cell<Bytes> = const { Cell::new(Bytes { in_use: 0, most: 0 }) };
}

fn count(change: i64) {
    let _ = BYTES.try_with(|bytes| {
        let in_use = bytes.get().in_use + change;
        bytes.set(Bytes { in_use, most: bytes.get().most.max(in_use) });
    });
}

/// The system's allocator, counted for each thread.
///
/// Every call is passed on as it is: what a library of plugins allocates, by the system's allocator itself,
/// may be freed here and the other way round. What a library allocates is not counted.
///
/// Cost: two numbers of the thread's own for each; a plan of `cubic` has 100,000 allocations among 608
/// million instructions.
struct Counting;

fn size(layout: Layout) -> i64 {
    // A layout is never larger than that.
    layout.size() as i64
}

#[expect(unsafe_code, reason = "an allocator is unsafe by its contract; all of it is the system's")]
// SAFETY: every method passes its arguments on to the system's allocator, and gives its answer.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count(size(layout));
        // SAFETY: the caller's promise is the one that the system's allocator wants.
        unsafe { System.alloc(layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        count(size(layout));
        // SAFETY: the same.
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn dealloc(&self, place: *mut u8, layout: Layout) {
        count(-size(layout));
        // SAFETY: the same.
        unsafe { System.dealloc(place, layout) }
    }

    unsafe fn realloc(&self, place: *mut u8, layout: Layout, new_size: usize) -> *mut u8 {
        count(new_size as i64 - size(layout));
        // SAFETY: the same.
        unsafe { System.realloc(place, layout, new_size) }
    }
}

#[global_allocator]
static COUNTING: Counting = Counting;

/// What this program's threads have in use.
pub struct Counted;

impl Memory for Counted {
    fn begin(&self) {
        BYTES.with(|bytes| {
            bytes.set(Bytes { in_use: 0, most: 0 });
        });
    }

    fn most(&self) -> u64 {
        BYTES.with(|bytes| bytes.get().most.unsigned_abs())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_most_is_what_was_in_use_at_once() {
        let before = vec![0_u8; 1000];
        Counted.begin();
        let first = vec![1_u8; 40_000];
        drop(first);
        let mut second: Vec<u8> = Vec::with_capacity(10_000);
        second.resize(10_000, 2);
        second.reserve_exact(20_000);
        drop((second, before));
        assert_eq!(Counted.most(), 40_000);
        // 40 MB on another thread are another thread's.
        std::thread::spawn(|| drop(vec![3_u8; 40_000_000])).join().unwrap();
        assert!(Counted.most() < 60_000, "{}", Counted.most());
    }
}
