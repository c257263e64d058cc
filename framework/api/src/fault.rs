//! Panics in calls that return no `Result`: remembered until somebody who can return an error asks.

use crate::CallError;
use std::cell::RefCell;
use std::sync::OnceLock;

thread_local! {
    // One a thread, because an expensive call runs on one thread from begin to end: the fault belongs to that
    // call, and a result that was computed ahead and thrown away takes its fault with it.
    static FAULT: RefCell<Option<CallError>> = const { RefCell::new(None) };
}

/// The host's memory of faults, as a plugin library is given it when it is loaded: the library's own copy is
/// another one.
#[derive(Clone, Copy)]
#[doc(hidden)]
pub struct Faults {
    report: fn(CallError),
    pending: fn() -> Option<CallError>,
}

static HOST: OnceLock<Faults> = OnceLock::new();

/// The memory of this binary, to be handed to the libraries that it loads.
#[doc(hidden)]
pub fn own_faults() -> Faults {
    Faults { report: remember, pending: remembered }
}

/// Makes this binary's faults known to the host that loads it.
#[doc(hidden)]
pub fn report_faults_to(host: Faults) {
    // Loaded twice into one process it is the same host.
    let _ = HOST.set(host);
}

/// Remembers that a call on this thread failed, although it returned a value; the first fault stays.
pub fn report_fault(fault: CallError) {
    HOST.get().map_or(remember as fn(CallError), |host| host.report)(fault);
}

/// The fault that was reported on this thread and not yet taken.
pub fn pending_fault() -> Option<CallError> {
    HOST.get().map_or(remembered as fn() -> Option<CallError>, |host| host.pending)()
}

/// Takes the fault that was reported on this thread. Whoever runs a whole call asks once at its end.
pub fn take_fault() -> Option<CallError> {
    FAULT.with_borrow_mut(Option::take)
}

/// The result of a call that ran to its end on this thread, or the fault that made it worthless.
pub fn unless_fault<T>(result: Result<T, CallError>) -> Result<T, CallError> {
    match take_fault() {
        Some(fault) => Err(fault),
        None => result,
    }
}

fn remember(fault: CallError) {
    FAULT.with_borrow_mut(|first| {
        first.get_or_insert(fault);
    });
}

fn remembered() -> Option<CallError> {
    FAULT.with_borrow(Option::clone)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn panicked(message: &str) -> CallError {
        CallError::Panicked { plugin: "surface/test".into(), message: message.into() }
    }

    #[test]
    fn the_first_fault_of_a_thread_stays_until_it_is_taken() {
        assert_eq!(pending_fault(), None);
        report_fault(panicked("one"));
        report_fault(panicked("two"));
        assert_eq!(pending_fault(), Some(panicked("one")));
        std::thread::scope(|scope| {
            scope.spawn(|| assert_eq!(pending_fault(), None, "another thread has its own"));
        });
        assert_eq!(unless_fault(Ok(1)), Err(panicked("one")));
        assert_eq!(unless_fault(Ok(1)), Ok(1));
    }
}
