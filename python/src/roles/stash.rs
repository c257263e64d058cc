//! The exceptions of one run's plugins, kept until the run has ended and one of them is raised.

use crate::watch::Watch;
use pyo3::prelude::*;
use regrasp::api::{CallError, Interrupt};
use std::cell::RefCell;
use std::sync::{Arc, Mutex, PoisonError};

/// How the number of a kept exception stands in a fault's message: threads compute ahead, and only the fault
/// that is consumed counts.
const MARK: &str = " [exception ";

thread_local! {
    static CURRENT: RefCell<Option<Arc<Stash>>> = const { RefCell::new(None) };
}

/// The exceptions of one run.
#[derive(Default)]
pub struct Stash {
    kept: Mutex<Vec<PyErr>>,
    watch: Option<Arc<Watch>>,
}

impl Stash {
    /// A stash for the run that `watch` stops.
    pub fn new(watch: &Arc<Watch>) -> Arc<Self> {
        Arc::new(Self { kept: Mutex::default(), watch: Some(Arc::clone(watch)) })
    }

    /// The stash of the run that builds its plugins on this thread; one of its own for a plugin that is
    /// built outside of any.
    pub fn current() -> Arc<Self> {
        CURRENT.with_borrow(|current| current.clone()).unwrap_or_default()
    }

    /// Whether the run is to stop.
    pub fn interrupted(&self) -> bool {
        self.watch.as_ref().is_some_and(|watch| watch.interrupted())
    }

    /// Whether the caller of the run is gone: then Python may be, too, and no plugin is called any more.
    pub fn cancelled(&self) -> bool {
        self.watch.as_ref().is_some_and(|watch| watch.cancelled())
    }

    /// Keeps an exception, and gives the text that leads back to it.
    pub fn keep(&self, py: Python<'_>, exception: PyErr) -> String {
        let text = exception.value(py).to_string();
        let name = exception.get_type(py).name().map_or_else(|_| "exception".into(), |name| name.to_string());
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        kept.push(exception);
        format!("{name}: {text}{MARK}{}]", kept.len() - 1)
    }

    /// Keeps an exception, as the fault of a call of `plugin`.
    pub fn fault(&self, py: Python<'_>, plugin: &str, exception: PyErr) -> CallError {
        CallError::Panicked { plugin: plugin.into(), message: self.keep(py, exception) }
    }

    /// The exception that a message leads to.
    pub fn find(&self, py: Python<'_>, message: &str) -> Option<PyErr> {
        let (_, rest) = message.rsplit_once(MARK)?;
        let number: usize = rest.split(']').next()?.parse().ok()?;
        let kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        kept.get(number).map(|exception| exception.clone_ref(py))
    }
}

/// Runs `job`, which builds plugins, with this stash as theirs.
pub fn with_stash<R>(stash: &Arc<Stash>, job: impl FnOnce() -> R) -> R {
    struct Restore(Option<Arc<Stash>>);
    impl Drop for Restore {
        fn drop(&mut self) {
            CURRENT.set(self.0.take());
        }
    }
    let _restore = Restore(CURRENT.replace(Some(Arc::clone(stash))));
    job()
}
