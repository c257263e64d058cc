//! What is shown now: the newest page, and the error where the newest input has none.

use regrasp::api::Interrupt;
use serde_json::{Value, json};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// A question for a change is answered after this long even where there is none.
const LONGEST: Duration = Duration::from_secs(20);
/// Between two looks for the end of the program.
const STEP: Duration = Duration::from_millis(100);

/// The state that the page asks for.
#[derive(Default)]
struct State {
    /// Grows with every change.
    version: u64,
    /// Grows with every new page.
    page_version: u64,
    page: Arc<str>,
    /// What is being done.
    doing: String,
    /// The error of the newest input, as `--json` prints it.
    error: Option<Value>,
}

/// The state, shared by who makes pages and who hands them out.
#[derive(Default)]
pub struct Live {
    state: Mutex<State>,
    changed: Condvar,
}

impl Live {
    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn change(&self, change: impl FnOnce(&mut State)) {
        let mut state = self.lock();
        change(&mut state);
        state.version += 1;
        self.changed.notify_all();
    }

    /// Says what is being done now; nothing where it is done.
    pub fn doing(&self, what: &str) {
        self.change(|state| state.doing = what.to_owned());
    }

    /// Shows a new page: what was wrong is right now.
    pub fn show(&self, page: String) {
        self.change(|state| {
            (state.page, state.error) = (page.into(), None);
            state.page_version += 1;
            state.doing.clear();
        });
    }

    /// Shows an error over the last page.
    pub fn fail(&self, error: Value) {
        self.change(|state| {
            state.error = Some(error);
            state.doing.clear();
        });
    }

    /// The newest page; empty before the first.
    pub fn page(&self) -> Arc<str> {
        self.lock().page.clone()
    }

    /// The state as JSON as soon as it is another than version `after`, or after a while.
    pub fn state_after(&self, after: u64, stop: &dyn Interrupt) -> Value {
        let begin = Instant::now();
        let mut state = self.lock();
        while state.version == after && begin.elapsed() < LONGEST && !stop.interrupted() {
            let waited = self.changed.wait_timeout(state, STEP);
            state = waited.unwrap_or_else(PoisonError::into_inner).0;
        }
        json!({
            "version": state.version,
            "page": state.page_version,
            "doing": state.doing,
            "error": state.error,
        })
    }
}
