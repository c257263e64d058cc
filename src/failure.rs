//! How the program ends when it does not succeed.

use crate::terminal::printable;
use std::io::{self, Write};
use std::process::ExitCode;

/// A failure with its exit code and message.
#[derive(Debug)]
pub struct Failure {
    code: u8,
    message: String,
}

impl Failure {
    /// Something about the input is wrong (exit code 2).
    pub fn bad_input(message: impl ToString) -> Self {
        Self { code: 2, message: message.to_string() }
    }

    /// No plan within the budget (exit code 3).
    pub fn no_plan(message: String) -> Self {
        Self { code: 3, message }
    }

    /// A plan that does not verify (exit code 4).
    pub fn not_verified(message: String) -> Self {
        Self { code: 4, message }
    }

    /// An object that does not arrive (exit code 4).
    pub fn not_arrived(message: String) -> Self {
        Self { code: 4, message }
    }

    /// Interrupted (exit code 130, as shells expect after Ctrl-C).
    pub fn interrupted(message: String) -> Self {
        Self { code: 130, message }
    }

    /// Prints the message to standard error and gives the exit code.
    pub fn exit(self) -> ExitCode {
        let label = if self.code == 2 { "error: " } else { "" };
        // A reader of standard error that has gone away changes no exit code.
        let _ = writeln!(io::stderr(), "{label}{}", printable(self.message.trim_end()));
        ExitCode::from(self.code)
    }
}
