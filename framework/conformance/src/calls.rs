//! Calls of a plugin: what they are handed, and whether they are pure and counted.

use crate::report::{Finding, ensure};
use regrasp_api::{Context, Interrupt, Random, Slot, Uninterrupted};
use std::fmt::Debug;
use std::panic::resume_unwind;

/// A context with the random stream of the key.
pub(crate) fn context(key: u64) -> Context<'static> {
    Context::new(random(key), &Uninterrupted)
}

/// The random stream of the key.
pub(crate) fn random(key: u64) -> Random {
    Random::from_key(0xc0f0, 0, 0, key)
}

/// Interrupts at once.
pub(crate) struct Always;

impl Interrupt for Always {
    fn interrupted(&self) -> bool {
        true
    }
}

/// Whether `call(0..count)` gives the same answers in another order, again, and on several threads at a time.
///
/// Answers are compared as their `Debug` text, which tells all numbers apart.
pub(crate) fn pure<T: Debug>(count: usize, call: impl Fn(usize) -> Finding<T> + Sync) -> Finding {
    let text = |i: usize| call(i).map(|answer| format!("{answer:?}"));
    let first: Vec<String> = (0..count).map(text).collect::<Finding<_>>()?;
    for i in (0..count).rev() {
        let again = text(i)?;
        ensure(again == first[i], || {
            format!("the same call again gives another answer: {} then {again}", first[i])
        })?;
    }
    let (text, first) = (&text, &first);
    std::thread::scope(|scope| {
        let run = |start: usize| {
            move || {
                for k in 0..count {
                    let i = (start + 2 * k * (count / 2) + k) % count;
                    let there = text(i)?;
                    ensure(there == first[i], || {
                        format!("on another thread the same call gives {there} in place of {}", first[i])
                    })?;
                }
                Ok(())
            }
        };
        let threads: Vec<_> = (0..3).map(|thread| scope.spawn(run(thread * count / 3))).collect();
        threads
            .into_iter()
            .try_for_each(|thread| thread.join().unwrap_or_else(|payload| resume_unwind(payload)))
    })
}

/// Breaks the law unless one call of the plugin in `slot` was counted.
pub(crate) fn counted_once(context: &Context<'_>, slot: Slot) -> Finding {
    let calls = context.tally.calls(slot);
    ensure(calls == 1, || format!("one call is counted {calls} times in `{}`", slot.name()))
}
