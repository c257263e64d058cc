//! The errors of the contract: what a call, a setting or the building of a plugin can fail with.

use crate::Departure;
use thiserror::Error;

/// A call has no answer. "No" (unstable, no path, no sample) is not an error but an answer with its
/// [`crate::Reason`].
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[non_exhaustive]
pub enum CallError {
    /// The run was asked to stop (deadline, Ctrl-C).
    #[error("interrupted")]
    Interrupted,
    /// The plugin cannot answer for this input, and says what to use instead.
    #[error("`{plugin}` does not support this: {reason}")]
    Unsupported {
        /// The plugin's id.
        plugin: String,
        /// What is not supported, and what to use.
        reason: String,
    },
    /// A plugin broke its role's contract.
    #[error("`{plugin}` broke the contract of its role: {reason}")]
    Contract {
        /// The plugin's id.
        plugin: String,
        /// What it did.
        reason: String,
    },
    /// A plugin panicked.
    #[error("`{plugin}` panicked: {message}")]
    Panicked {
        /// The plugin's id.
        plugin: String,
        /// The panic's message.
        message: String,
    },
}

/// A plugin's settings are refused.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum SettingsError {
    /// Not JSON, or not of a form that serde reads.
    #[error("{0}")]
    Form(String),
    /// A key, a type or a value that the schema refuses.
    #[error(transparent)]
    Departs(Box<Departure>),
    /// A value that makes no sense beside the others.
    #[error("`{key}` = {value} {reason}; {remedy}")]
    Value {
        /// The setting's key.
        key: &'static str,
        /// The value that was given.
        value: String,
        /// What is wrong with it.
        reason: &'static str,
        /// What to do.
        remedy: &'static str,
    },
    /// The plugin panicked while it looked at them.
    #[error("{0}")]
    Panicked(String),
}

impl From<Departure> for SettingsError {
    fn from(departure: Departure) -> Self {
        Self::Departs(Box::new(departure))
    }
}

/// A plugin cannot be built from these settings and parts.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum BuildError {
    /// The settings are refused.
    #[error(transparent)]
    Settings(#[from] SettingsError),
    /// The plugin does not work for this hand or object; the text says why and what to use.
    #[error("{0}")]
    Unsupported(String),
    /// It panicked while it was built.
    #[error("{0}")]
    Panicked(String),
}
