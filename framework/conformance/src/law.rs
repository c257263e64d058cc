//! Laws, and how they are tried: panics caught.

pub(crate) use crate::calls::*;
use crate::report::{Check, Fault, Finding};
use crate::roles::Journey;
use regrasp_api::{Entry, Slot};
use std::panic::{AssertUnwindSafe, catch_unwind};
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
