//! How the program ends when it does not succeed.

use crate::terminal::{Paint, tell};
use regrasp::api::{Refusal, Refuse};
use serde_json::{Value, json};
use std::process::ExitCode;

/// A failure with its exit code and message.
#[derive(Debug)]
pub struct Failure {
    code: u8,
    message: String,
    refusal: Box<Refusal>,
}

impl Failure {
    /// Something about the input is wrong (exit code 2).
    pub fn bad_input(message: impl ToString) -> Self {
        Self::new(2, "bad-input", message.to_string())
    }

    /// The same, of an error that says in fields what is wrong.
    pub fn refused<E: Refuse + ToString>(error: E) -> Self {
        Self { code: 2, message: error.to_string(), refusal: Box::new(error.refusal()) }
    }

    /// No plan within the budget (exit code 3).
    pub fn no_plan(message: String) -> Self {
        Self::new(3, "no-plan", message)
    }

    /// A plan that does not verify (exit code 4).
    pub fn not_verified(message: String) -> Self {
        Self::new(4, "not-verified", message)
    }

    /// An object that does not arrive (exit code 4).
    pub fn not_arrived(message: String) -> Self {
        Self::new(4, "not-arrived", message)
    }

    /// Interrupted (exit code 130, as shells expect after Ctrl-C).
    pub fn interrupted(message: String) -> Self {
        Self::new(130, "interrupted", message)
    }

    fn new(code: u8, kind: &'static str, message: String) -> Self {
        Self { code, refusal: Box::new(Refusal::new(kind, &message)), message }
    }

    /// The same within a longer sentence.
    pub fn told(self, message: String) -> Self {
        Self { refusal: Box::new(self.refusal.told(&message)), message, ..self }
    }

    /// What went wrong, in words.
    pub fn message(&self) -> &str {
        &self.message
    }

    /// The failure as JSON: `{"error": {"code": …, "message": …, "file": …, "line": …, "key": …, …}}`.
    pub fn json(&self) -> Value {
        json!({ "error": self.refusal })
    }

    /// Prints the message to standard error and gives the exit code.
    pub fn exit(self) -> ExitCode {
        let label = if self.code == 2 { "error:" } else { "" };
        tell(label, Paint::Bad, self.message.trim_end());
        ExitCode::from(self.code)
    }
}
