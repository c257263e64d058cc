//! Who keeps the first breach of a run.

use crate::laws::Broken;
use regrasp_api::{CallError, ObjectModel, Slot};
use serde_json::Value;
use std::cell::Cell;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};

/// How much of a run is looked at.
///
/// Single calls are chosen by the bits of what they are given, so that every run looks at the same ones, on
/// any number of threads. A law that a plugin breaks now and then is found by the share of calls that are
/// looked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Depth {
    /// Every call of planners, samplers, strategies and assessments; of the calls that take less than a
    /// microsecond and come by the hundred thousand, one in eight.
    Full,
    /// One call in 16 of those, and in 64 of these: what a debug build does unasked.
    Sparse,
}

impl Depth {
    /// Of how many short, and of how many long calls one is looked at.
    fn periods(self) -> (u64, u64) {
        match self {
            Self::Full => (8, 1),
            Self::Sparse => (64, 16),
        }
    }
}

thread_local! {
    // Whether this thread repeats a call or checks a law: what is called then was audited before, or is not
    // the plugin's doing.
    static RESTING: Cell<bool> = const { Cell::new(false) };
}

/// A law that a plugin broke in a real call.
#[derive(Clone, Debug, PartialEq)]
pub struct Breach {
    /// The plugin's id.
    pub plugin: String,
    /// The slot that it fills.
    pub slot: Slot,
    /// The method that was called.
    pub call: &'static str,
    /// The law and how it was broken.
    pub broken: Broken,
    /// What the plugin was called with.
    pub input: Value,
}

impl Breach {
    /// As the error that ends the call.
    pub fn error(&self) -> CallError {
        let Broken { law, what } = &self.broken;
        CallError::Contract {
            plugin: self.plugin.clone(),
            reason: format!("`{}` breaks `{law}`: {what}", self.call),
        }
    }

    /// As a JSON object: `plugin`, `slot`, `call`, `law`, `what`, `input`.
    pub fn json(&self) -> Value {
        serde_json::json!({
            "plugin": self.plugin,
            "slot": self.slot.name(),
            "call": self.call,
            "law": self.broken.law,
            "what": self.broken.what,
            "input": self.input,
        })
    }
}

/// What a call is known by when it is decided whether to look at it.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Key {
    /// Calls that are rare.
    Always,
    /// Calls that are short and many, by the bits of their input.
    Short(u64),
    /// Calls that take long, by the bits of their input.
    Long(u64),
}

/// The bits of numbers, mixed.
pub(crate) fn bits<'x>(numbers: impl IntoIterator<Item = &'x f64>) -> u64 {
    numbers.into_iter().fold(0, |sum, x| (sum ^ x.to_bits()).wrapping_mul(0x9e37_79b9_7f4a_7c15))
}

/// Judges the calls of one run.
pub struct Auditor<'a> {
    /// The object whose mesh is the truth.
    pub(crate) object: &'a ObjectModel,
    /// Radius of the fingertips (m).
    pub(crate) radius: f64,
    plugins: Vec<(Slot, String)>,
    breach: Mutex<Option<Breach>>,
    depth: Depth,
    looks: AtomicU64,
}

impl<'a> Auditor<'a> {
    /// An auditor of the plugins that fill the slots, for an object and a fingertip radius (m).
    pub fn new(
        object: &'a ObjectModel,
        radius: f64,
        plugins: impl IntoIterator<Item = (Slot, String)>,
    ) -> Self {
        Self {
            object,
            radius,
            plugins: plugins.into_iter().collect(),
            breach: Mutex::new(None),
            depth: Depth::Full,
            looks: AtomicU64::new(0),
        }
    }

    /// The same, looking at this share of the calls.
    #[must_use]
    pub fn at(self, depth: Depth) -> Self {
        Self { depth, ..self }
    }

    /// Whether a call is looked at, by what it is given.
    pub(crate) fn looks_at(&self, call: Key) -> bool {
        let (short, long) = self.depth.periods();
        let looks = match call {
            Key::Always => true,
            Key::Short(bits) => (bits >> 40).is_multiple_of(short),
            Key::Long(bits) => (bits >> 40).is_multiple_of(long),
        };
        if looks {
            self.looks.fetch_add(1, Ordering::Relaxed);
        }
        looks
    }

    /// How many calls were looked at.
    pub fn looks(&self) -> u64 {
        self.looks.load(Ordering::Relaxed)
    }

    /// The first breach, if there was one.
    pub fn breach(&self) -> Option<Breach> {
        self.breach.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Keeps a breach, and gives the error that it is.
    pub(crate) fn keep(&self, slot: Slot, call: &'static str, broken: Broken, input: Value) -> CallError {
        let plugin = self.plugins.iter().find(|(place, _)| *place == slot);
        let plugin = plugin.map_or_else(|| slot.name().to_owned(), |(_, id)| id.clone());
        let breach = Breach { plugin, slot, call, broken, input };
        let error = breach.error();
        self.breach.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(breach);
        error
    }
}

/// Whether this thread is not to audit now.
pub(crate) fn is_resting() -> bool {
    RESTING.get()
}

/// Does `work` without auditing what it calls.
pub(crate) fn resting<R>(work: impl FnOnce() -> R) -> R {
    struct Restore(bool);
    impl Drop for Restore {
        fn drop(&mut self) {
            RESTING.set(self.0);
        }
    }
    let _restore = Restore(RESTING.replace(true));
    work()
}
