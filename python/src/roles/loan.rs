//! What Python is handed for the time of one call: it borrows from the search, and Python knows no borrowing.
#![allow(unsafe_code)]

use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use regrasp::api;
use std::cell::Cell;

/// A borrowed value that is taken back when the call that lent it returns.
///
/// It is neither `Send` nor `Sync`: classes that hold one are `unsendable`, so that all uses and the taking
/// back happen on one thread,
/// in the order of its stack.
pub struct Loan<T: Copy>(Cell<Option<T>>);

impl<T: Copy> Loan<T> {
    /// The value, while its call lasts.
    pub fn value(&self) -> PyResult<T> {
        let over = "it was lent for one call of a plugin, which is over; keep what you need of it instead";
        self.0.get().ok_or_else(|| PyRuntimeError::new_err(over))
    }

    fn take_back(&self) {
        self.0.set(None);
    }
}

/// Takes a loan back when it goes out of scope, panics and exceptions included.
struct Return<'a, T: Copy>(&'a Loan<T>);

impl<T: Copy> Drop for Return<'_, T> {
    fn drop(&mut self) {
        self.0.take_back();
    }
}

/// Lends a task to Python for the time of `call`.
pub fn lend_task<R>(
    py: Python<'_>,
    task: &api::Task<'_>,
    call: impl FnOnce(&Bound<'_, super::task::Task>) -> PyResult<R>,
) -> PyResult<R> {
    // SAFETY: the loan is emptied before this function returns, while `task` is still borrowed. Until then
    // it is read on this thread only (its
    // class is `unsendable`), by frames above this one, and what they read they do not keep: the methods of
    // `Task` hand out copies.
    let forever = unsafe { std::mem::transmute::<api::Task<'_>, api::Task<'static>>(*task) };
    let lent = Bound::new(py, super::task::Task(Loan(Cell::new(Some(forever)))))?;
    let borrowed = lent.borrow();
    let _return = Return(&borrowed.0);
    call(&lent)
}

/// Lends a view of the graph to Python for the time of `call`.
pub fn lend_graph<R>(
    py: Python<'_>,
    graph: &dyn api::GraphView,
    call: impl FnOnce(&Bound<'_, super::graph_strategy::Graph>) -> PyResult<R>,
) -> PyResult<R> {
    // SAFETY: as in `lend_task`.
    let forever = unsafe { std::mem::transmute::<&dyn api::GraphView, &'static dyn api::GraphView>(graph) };
    let lent = Bound::new(py, super::graph_strategy::Graph(Loan(Cell::new(Some(forever)))))?;
    let borrowed = lent.borrow();
    let _return = Return(&borrowed.0);
    call(&lent)
}
