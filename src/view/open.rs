//! Opening a page in the user's browser.

use std::ffi::OsStr;
use std::io;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::thread;
use std::time::Duration;

/// How long a program that opens pages may take to say that it cannot.
const PATIENCE: Duration = Duration::from_millis(1500);

/// Opens a page in the browser; whether that seems to have worked.
pub fn in_browser(page: &Path) -> bool {
    opened(page.as_os_str())
}

/// Opens an address in the browser; whether that seems to have worked.
pub fn address_in_browser(address: &str) -> bool {
    opened(address.as_ref())
}

fn opened(what: &OsStr) -> bool {
    let Some(mut command) = opener() else { return false };
    command.arg(what).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    let Ok(mut child) = command.spawn() else { return false };
    // Some openers stay until the browser is closed: who still runs after a while has not failed.
    for _ in 0..15 {
        match child.try_wait() {
            Ok(Some(status)) => return status.success(),
            Ok(None) => thread::sleep(PATIENCE / 15),
            Err(_) => return false,
        }
    }
    true
}

/// The system's program that opens files; `None` where nobody could see a window.
pub fn opener() -> Option<Command> {
    if cfg!(target_os = "macos") {
        return Some(Command::new("open"));
    }
    if cfg!(windows) {
        // `start` is a word of the shell, and takes a first argument in quotes for a title.
        let mut command = Command::new("cmd");
        command.args(["/C", "start", ""]);
        return Some(command);
    }
    let set = |name| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    (set("DISPLAY") || set("WAYLAND_DISPLAY")).then(|| Command::new("xdg-open"))
}

/// A new folder of our own among the system's temporary files.
pub fn temporary_folder() -> Result<PathBuf, String> {
    let place = std::env::temp_dir();
    for number in 0..10_000 {
        let folder = place.join(format!("regrasp-view-{}-{number}", std::process::id()));
        // To create it is to own it: what is there already, even as a link, is somebody else's.
        match std::fs::create_dir(&folder) {
            Ok(()) => return Ok(folder),
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
            Err(error) => {
                return Err(format!(
                    "cannot write to `{}`: {}; name a file with `-o`",
                    place.display(),
                    error.kind()
                ));
            }
        }
    }
    Err(format!(
        "`{}` holds too many pages of earlier runs; delete them, or name a file with `-o`",
        place.display()
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_temporary_folder_is_new() {
        let (first, second) = (temporary_folder().unwrap(), temporary_folder().unwrap());
        assert!(first.is_dir() && second.is_dir() && first != second);
        [first, second].iter().for_each(|folder| std::fs::remove_dir(folder).unwrap());
    }
}
