//! The guard: a plugin object whose panics become errors.
//!
//! A panic cannot cross from one Rust binary into another (the process is aborted), so a plugin library
//! compiles the guard *into itself*; the host puts the same guard round the built-in plugins. Calls that
//! return a `Result` give [`CallError::Panicked`]. Those that return plain values give a harmless one (a cone
//! without friction, a contact on a sharp edge, infinitely far away) and report the panic as the thread's
//! fault ([`regrasp_api::report_fault`]): [`regrasp_api::Context::proceed`] then ends the call, and the
//! planner takes the fault in place of the call's result.

use regrasp_api::{BuildError, Built, CallError, SettingsError};
use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// A plugin object and its id, or an object of a service and the service's name.
pub(crate) struct Guard<T: ?Sized> {
    pub plugin: &'static str,
    /// Always there, until the guard is dropped.
    object: Option<Box<T>>,
}

/// A role's trait object that can be put behind a guard.
#[doc(hidden)]
pub trait Guardable {
    /// The same object behind a guard.
    fn guarded(object: Box<Self>, plugin: &'static str) -> Box<Self>;
}

impl<T: ?Sized> Guard<T> {
    pub fn new(plugin: &'static str, object: Box<T>) -> Self {
        Self { plugin, object: Some(object) }
    }

    fn object(&self) -> &T {
        self.object.as_deref().expect("it is taken only when the guard is dropped")
    }

    /// A call that can fail.
    pub fn call<'a, R>(&'a self, call: impl FnOnce(&'a T) -> Result<R, CallError>) -> Result<R, CallError> {
        caught(self.plugin, || call(self.object())).and_then(|answer| answer)
    }

    /// A call that returns a plain value; `harmless` takes its place after a panic.
    pub fn value<'a, R>(&'a self, call: impl FnOnce(&'a T) -> R, harmless: impl FnOnce() -> R) -> R {
        caught(self.plugin, || call(self.object())).unwrap_or_else(|fault| {
            regrasp_api::report_fault(fault);
            harmless()
        })
    }
}

impl<T: ?Sized> Drop for Guard<T> {
    fn drop(&mut self) {
        let object = self.object.take();
        // Nothing is computed with the object any more: a panic here spoils no result, and must not be taken
        // for a fault of the thread's next call. The panic's message has been printed already.
        let _ = caught(self.plugin, || drop(object));
    }
}

/// Runs `call`; a panic becomes [`CallError::Panicked`].
pub(crate) fn caught<R>(plugin: &str, call: impl FnOnce() -> R) -> Result<R, CallError> {
    // What a panic may have left half changed (random stream, counts, path) is thrown away with the failed
    // call.
    catch_unwind(AssertUnwindSafe(call)).map_err(|payload| {
        let message = message(payload.as_ref());
        // The payload may be any type of the plugin's, whose own end may panic.
        if let Err(worse) = catch_unwind(AssertUnwindSafe(|| drop(payload))) {
            std::mem::forget(worse);
        }
        CallError::Panicked { plugin: plugin.into(), message }
    })
}

fn message(payload: &(dyn Any + Send)) -> String {
    let text = payload.downcast_ref::<&str>().copied();
    text.or_else(|| payload.downcast_ref::<String>().map(String::as_str)).unwrap_or("(no message)").to_owned()
}

/// Builds a plugin and puts it behind a guard; a panic while it is built becomes an error too.
pub fn guarded<T: Guardable + ?Sized>(plugin: &'static str, build: impl FnOnce() -> Built<T>) -> Built<T> {
    let built = caught(plugin, build).map_err(|fault| BuildError::Panicked(fault.to_string()))?;
    built.map(|object| T::guarded(object, plugin))
}

/// A plugin's check of settings; a panic becomes a refusal.
pub(crate) fn guarded_check(
    plugin: &'static str,
    check: impl FnOnce() -> Result<(), SettingsError>,
) -> Result<(), SettingsError> {
    caught(plugin, check).map_err(|fault| SettingsError::Panicked(fault.to_string()))?
}
