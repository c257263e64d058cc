//! Standard output is this program's alone: what a plugin prints goes to standard error, so that it spoils no
//! JSON and no plan.

use std::fs::File;
use std::io::{self, IsTerminal, Write};
use std::sync::OnceLock;

/// Standard output as the program got it, once its number stands for standard error.
static KEPT: OnceLock<File> = OnceLock::new();

/// From here on whoever prints to standard output reaches standard error, but for [`standard`].
///
/// Where that cannot be done, and on other systems than Unix, everything stays as it is.
pub fn keep() {
    #[cfg(unix)]
    {
        use std::os::fd::AsFd;
        let Ok(out) = io::stdout().as_fd().try_clone_to_owned() else { return };
        if KEPT.set(out.into()).is_ok() {
            let _ = rustix::stdio::dup2_stdout(io::stderr());
        }
    }
}

/// Whether standard output is a terminal.
pub fn is_terminal() -> bool {
    KEPT.get().map_or_else(|| io::stdout().is_terminal(), IsTerminal::is_terminal)
}

/// The program's standard output.
pub fn standard() -> Box<dyn Write> {
    match KEPT.get() {
        Some(file) => Box::new(file),
        None => Box::new(io::stdout().lock()),
    }
}
