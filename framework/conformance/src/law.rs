//! Laws, and how they are tried: panics caught, calls repeated in other orders and on other threads.

use crate::report::{Check, Fault, Finding, ensure};
use crate::roles::Journey;
use regrasp_api::{Context, Entry, Interrupt, Random, Slot, Uninterrupted};
use std::fmt::Debug;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::rc::Rc;

/// What a law is tried on: an entry, and what is demanded of it.
pub(crate) struct Subject<'a> {
    pub entry: &'a Entry,
    pub demands: &'a crate::Demands,
    /// What the plugin did as a local planner: made once, looked at by many laws.
    pub journeys: std::cell::RefCell<Vec<(Slot, Rc<Vec<Journey>>)>>,
}

/// One law of a role, with the check that tries it.
pub(crate) struct Law {
    pub name: &'static str,
    pub why: &'static str,
    pub check: fn(&Subject<'_>) -> Finding,
}

/// Tries every law; a panic breaks the law during whose check it happens.
pub(crate) fn try_laws(laws: &[Law], subject: &Subject<'_>) -> Vec<Check> {
    let tried = laws.iter().map(|law| {
        let finding = catch_unwind(AssertUnwindSafe(|| (law.check)(subject)));
        let finding = finding.unwrap_or_else(|payload| Err(Fault::Broken(panic_text(payload.as_ref()))));
        Check { name: law.name, why: law.why, outcome: finding.into() }
    });
    tried.collect()
}

fn panic_text(payload: &(dyn std::any::Any + Send)) -> String {
    let text = payload.downcast_ref::<&str>().copied();
    let text = text.or_else(|| payload.downcast_ref::<String>().map(String::as_str));
    format!("it panicked: {}", text.unwrap_or("(no message)"))
}

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
