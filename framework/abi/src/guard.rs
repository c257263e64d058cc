//! The guard: a plugin object whose panics become errors.
//!
//! A panic cannot cross from one Rust binary into another (the process is aborted), so a plugin library
//! compiles the guard *into itself*; the host puts the same guard round the built-in plugins. Calls that
//! return a `Result` give [`CallError::Panicked`]. Those that return plain values give a harmless one (a cone
//! without friction, a contact on a sharp edge, infinitely far away) and report the panic as the thread's
//! fault ([`regrasp_api::report_fault`]): [`regrasp_api::Context::proceed`] then ends the call, and the
//! planner takes the fault in place of the call's result.

use crate::wrapped::{Around, Wrapped};
use regrasp_api::{BuildError, Built, CallError, LoneFinger, SettingsError};
use std::any::Any;
use std::ops::Deref;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Catches what panics around a call, and names the plugin or the service that it was.
#[derive(Clone, Copy, Debug)]
pub struct Caught(pub(crate) &'static str);

impl Around for Caught {
    fn call<R>(&self, call: impl FnOnce() -> Result<R, CallError>) -> Result<R, CallError> {
        caught(self.0, call).and_then(|answer| answer)
    }

    fn value<R>(&self, call: impl FnOnce() -> R, harmless: impl FnOnce() -> R) -> R {
        caught(self.0, call).unwrap_or_else(|fault| {
            regrasp_api::report_fault(fault);
            harmless()
        })
    }

    /// A plugin owns the object that it is handed: its end, too, runs inside the plugin's library.
    fn lone_finger<'a>(&'a self, finger: Box<dyn LoneFinger + 'a>) -> Box<dyn LoneFinger + 'a> {
        Box::new(owned(self.0, finger))
    }
}

/// An object that is owned, and whose end may panic.
pub(crate) struct Owned<T: ?Sized> {
    name: &'static str,
    /// Always there, until it is dropped.
    object: Option<Box<T>>,
}

impl<T: ?Sized> Deref for Owned<T> {
    type Target = T;

    fn deref(&self) -> &T {
        self.object.as_deref().expect("it is taken only when it is dropped")
    }
}

impl<T: ?Sized> Drop for Owned<T> {
    fn drop(&mut self) {
        let object = self.object.take();
        // Nothing is computed with the object any more: a panic here spoils no result, and must not be taken
        // for a fault of the thread's next call. The panic's message has been printed already.
        let _ = caught(self.name, || drop(object));
    }
}

/// An object behind a guard to its end.
pub(crate) fn owned<T: ?Sized>(name: &'static str, object: Box<T>) -> Wrapped<Caught, Owned<T>> {
    Wrapped::new(Caught(name), Owned { name, object: Some(object) })
}

/// A role's trait object that can be put behind a guard.
#[doc(hidden)]
pub trait Guardable {
    /// The same object behind a guard.
    fn guarded(object: Box<Self>, plugin: &'static str) -> Box<Self>;
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
