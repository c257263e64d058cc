//! Files without a name while they are written: a process that is killed leaves nothing behind.

use crate::TEMPORARY;
use rustix::fs::{AtFlags, CWD, Mode, OFlags};
use std::fs::File;
use std::io;
use std::os::fd::AsRawFd;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

/// A file in this folder that has no name yet; `None` where the file system knows no such files.
pub fn open(folder: &Path) -> Option<File> {
    let flags = OFlags::TMPFILE | OFlags::WRONLY | OFlags::CLOEXEC;
    rustix::fs::openat(CWD, folder, flags, Mode::from_raw_mode(0o666)).ok().map(File::from)
}

/// Gives a complete file its name, in the place of what bears it already.
///
/// Only a file that is replaced has another name for the moment before it is renamed: no call does both at
/// once.
pub fn put_in_place(file: &File, path: &Path, folder: &Path) -> io::Result<()> {
    match name(file, path) {
        Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
        other => return other,
    }
    let meanwhile = unused(folder);
    name(file, &meanwhile)?;
    std::fs::rename(&meanwhile, path).inspect_err(|_| {
        // What could not be renamed is of no use to anybody.
        let _ = std::fs::remove_file(&meanwhile);
    })
}

fn name(file: &File, path: &Path) -> io::Result<()> {
    let open = format!("/proc/self/fd/{}", file.as_raw_fd());
    Ok(rustix::fs::linkat(CWD, open, CWD, path, AtFlags::SYMLINK_FOLLOW)?)
}

fn unused(folder: &Path) -> PathBuf {
    static COUNT: AtomicU64 = AtomicU64::new(0);
    let number = COUNT.fetch_add(1, Ordering::Relaxed);
    folder.join(format!("{}{}-{number}{}", TEMPORARY.0, std::process::id(), TEMPORARY.1))
}
