//! One plugin object: an instance of a Python class, and how it is called.

use super::{data::Context, stash::Stash};
use pyo3::prelude::*;
use regrasp::api::{self, CallError, Slot};
use std::sync::Arc;

/// An instance of a Python class that plays a role.
pub struct Plugin {
    pub id: &'static str,
    pub object: Py<PyAny>,
    pub stash: Arc<Stash>,
}

impl Plugin {
    /// A call that can say that it has no answer.
    pub fn call<R>(
        &self,
        call: impl for<'py> FnOnce(Python<'py>, &Bound<'py, PyAny>) -> PyResult<R>,
    ) -> Result<R, CallError> {
        if self.stash.cancelled() {
            return Err(CallError::Interrupted);
        }
        Python::attach(|py| call(py, self.object.bind(py)).map_err(|e| self.stash.fault(py, self.id, e)))
    }

    /// A call that cannot: its fault is remembered until somebody asks, and `harmless` stands for the answer.
    pub fn value<R>(
        &self,
        call: impl for<'py> FnOnce(Python<'py>, &Bound<'py, PyAny>) -> PyResult<R>,
        harmless: impl FnOnce() -> R,
    ) -> R {
        if self.stash.cancelled() {
            api::report_fault(CallError::Interrupted);
            return harmless();
        }
        let answer =
            Python::attach(|py| call(py, self.object.bind(py)).map_err(|e| self.stash.fault(py, self.id, e)));
        answer.unwrap_or_else(|fault| {
            api::report_fault(fault);
            harmless()
        })
    }

    /// A call of the plugin in `slot` that draws random numbers and counts: its context is handed over and
    /// taken back.
    pub fn with_context<R>(
        &self,
        slot: Slot,
        context: &mut api::Context<'_>,
        call: impl for<'py> FnOnce(Python<'py>, &Bound<'py, PyAny>, &Bound<'py, Context>) -> PyResult<R>,
    ) -> Result<R, CallError> {
        context.count_call(slot);
        context.proceed()?;
        let answer = self.call(|py, object| {
            let ours = Bound::new(py, Context::new(slot, context.random.clone(), Arc::clone(&self.stash)))?;
            let answer = call(py, object, &ours);
            let (random, tally) = ours.borrow().take();
            context.random = random;
            context.tally.add(&tally);
            answer
        })?;
        context.proceed()?;
        Ok(answer)
    }
}
