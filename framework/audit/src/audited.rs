//! A plugin with an auditor in front of it.

use crate::auditor::{Auditor, Key, is_resting, resting};
use crate::laws::{Broken, Kept, broken, ensure};
use regrasp_api::{CallError, Context, Slot, Tally, pending_fault, report_fault};
use serde_json::Value;
use std::fmt::Debug;

/// A plugin whose every call is held against its role's laws.
pub struct Audited<'a, T: ?Sized> {
    pub(crate) inner: &'a T,
    pub(crate) auditor: &'a Auditor<'a>,
    pub(crate) slot: Slot,
}

impl<'a, T: ?Sized> Audited<'a, T> {
    /// `inner`, which fills `slot`, under audit.
    pub fn new(inner: &'a T, slot: Slot, auditor: &'a Auditor<'a>) -> Self {
        Self { inner, auditor, slot }
    }

    /// A call that returns a plain value: a breach becomes the thread's fault.
    pub(crate) fn value<R>(
        &self,
        (call, key): (&'static str, Key),
        act: impl FnOnce(&'a T) -> R,
        input: impl FnOnce() -> Value,
        check: impl FnOnce(&'a T, &R) -> Kept,
    ) -> R {
        if is_resting() || !self.auditor.looks_at(key) {
            return act(self.inner);
        }
        let answer = act(self.inner);
        // What a panic left behind is no answer of the plugin's.
        if pending_fault().is_none()
            && let Err(fault) = resting(|| check(self.inner, &answer))
            // Nor is a call that panicked while the laws were tried.
            && pending_fault().is_none()
        {
            report_fault(self.auditor.keep(self.slot, call, fault, input()));
        }
        answer
    }

    /// A call that returns a `Result` and counts itself, made twice; see [`Self::value_of`].
    pub(crate) fn call<R: Debug + PartialEq>(
        &self,
        (call, key): (&'static str, Key),
        context: &mut Context<'_>,
        act: impl Fn(&'a T, &mut Context<'_>) -> Result<R, CallError>,
        input: impl FnOnce(&Context<'_>) -> Value,
        check: impl FnOnce(&'a T, &R, &Context<'_>) -> Kept,
    ) -> Result<R, CallError> {
        self.value_of((call, key), context, act, input, |inner, answer, context| {
            let slot = self.slot.name();
            let calls = context.tally.calls(self.slot);
            ensure("counted", calls == 1, || {
                format!("it is counted {calls} times in `{slot}` (`context.count_call`)")
            })?;
            check(inner, answer, context)
        })
    }

    /// A call that returns a `Result`, made twice: `act` answers, `check` knows the laws.
    ///
    /// The second answer comes with the same random stream, and must be the same and count the same.
    pub(crate) fn value_of<R: Debug + PartialEq>(
        &self,
        (call, key): (&'static str, Key),
        context: &mut Context<'_>,
        act: impl Fn(&'a T, &mut Context<'_>) -> Result<R, CallError>,
        input: impl FnOnce(&Context<'_>) -> Value,
        check: impl FnOnce(&'a T, &R, &Context<'_>) -> Kept,
    ) -> Result<R, CallError> {
        if is_resting() || !self.auditor.looks_at(key) {
            return act(self.inner, context);
        }
        let mut twin = context.twin();
        let before = context.tally.clone();
        let answer = act(self.inner, context)?;
        if pending_fault().is_some() {
            return Ok(answer);
        }
        let fresh = twin.twin();
        let kept = resting(|| {
            let again = match act(self.inner, &mut twin) {
                Err(CallError::Interrupted) => return Ok(()),
                again => again,
            };
            same_answer(&Ok(&answer), &again.as_ref().map_err(Clone::clone))?;
            if twin.random != context.random {
                return broken("pure", "the same call again draws other random numbers");
            }
            // Without notes and messages, which `since` leaves out.
            if twin.tally.since(&Tally::default()) != context.tally.since(&before) {
                return broken("pure", "the same call again counts other calls or refusals");
            }
            check(self.inner, &answer, &twin)
        });
        if pending_fault().is_some() {
            return Ok(answer);
        }
        kept.map_err(|fault: Broken| self.auditor.keep(self.slot, call, fault, input(&fresh)))?;
        Ok(answer)
    }
}

/// Breaks the law unless both answers are alike; NaN is like NaN.
fn same_answer<R: Debug + PartialEq>(first: &Result<&R, CallError>, again: &Result<&R, CallError>) -> Kept {
    if first == again {
        return Ok(());
    }
    let (first, again) = (format!("{first:?}"), format!("{again:?}"));
    if first == again {
        return Ok(());
    }
    broken("pure", format!("the same call again answers otherwise: {}", first_difference(&first, &again)))
}

/// What two texts say where they first differ.
fn first_difference(a: &str, b: &str) -> String {
    let same = a.chars().zip(b.chars()).take_while(|(x, y)| x == y).count();
    let part = |text: &str| text.chars().skip(same.saturating_sub(24)).take(64).collect::<String>();
    format!("…{}… then …{}…", part(a), part(b))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_are_shown_where_they_differ() {
        let text = first_difference("Contact { facet: 3 }", "Contact { facet: 4 }");
        assert!(text.contains("facet: 3") && text.contains("facet: 4"), "{text}");
    }
}
