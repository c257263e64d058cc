//! Loading a library that was inspected. The only code of the framework that is `unsafe`, besides the export
//! macro's expansion.
#![allow(unsafe_code)]

use super::{Inspected, LoadError};
use regrasp_abi::{EXPORT_NAME, ExportFunction};
use regrasp_api::{Entry, own_faults};
use std::path::{Path, PathBuf};

/// Loads the library for good and hands out its plugins.
pub(crate) fn open(inspected: &Inspected) -> Result<Vec<&'static Entry>, LoadError> {
    let path = &inspected.path;
    let image = Image::of(inspected)
        .map_err(|error| LoadError::Open { path: path.clone(), cause: error.to_string() })?;
    let failed = |error: libloading::Error| {
        let cause = cause(&error).replace(&*image.path().to_string_lossy(), &path.to_string_lossy());
        LoadError::Open { path: path.clone(), cause }
    };
    // SAFETY: loading runs the library's initialisers. The file carries the section that the export macro
    // writes, so it is a Rust library that the user named to be loaded; what its author put into initialisers
    // is the author's responsibility.
    let library = unsafe { libloading::Library::new(image.path()) }.map_err(failed)?;
    // Never unloaded: entries, objects and errors point into it.
    let library: &'static libloading::Library = Box::leak(Box::new(library));
    // SAFETY: the export macro defines this name with this type, and the types are laid out alike, since the
    // fingerprints are equal.
    let export = unsafe { library.get::<ExportFunction>(EXPORT_NAME.as_bytes()) }.map_err(failed)?;
    // SAFETY: as above; the function stores a pointer and returns another.
    let exported = unsafe { export(&own_faults()) };
    if exported.section != inspected.section {
        return Err(LoadError::Changed { path: path.clone() });
    }
    Ok(exported.entries.iter().collect())
}

/// What is handed to the system's loader: the bytes that were inspected, in memory, so that a file which is
/// swapped or changed in between is not run. Where the system has no files in memory it is the file itself.
struct Image {
    path: PathBuf,
    #[cfg(target_os = "linux")]
    _open: std::fs::File,
}

impl Image {
    #[cfg(target_os = "linux")]
    fn of(inspected: &Inspected) -> std::io::Result<Self> {
        use std::io::Write;
        use std::os::fd::AsRawFd;
        let memory = rustix::fs::memfd_create("regrasp-plugin", rustix::fs::MemfdFlags::CLOEXEC)?;
        let mut open = std::fs::File::from(memory);
        open.write_all(&inspected.bytes)?;
        Ok(Self { path: format!("/proc/self/fd/{}", open.as_raw_fd()).into(), _open: open })
    }

    #[cfg(not(target_os = "linux"))]
    fn of(inspected: &Inspected) -> std::io::Result<Self> {
        Ok(Self { path: inspected.path.clone() })
    }

    fn path(&self) -> &Path {
        &self.path
    }
}

fn cause(error: &libloading::Error) -> String {
    let inner = std::error::Error::source(error).map(|source| format!(" ({source})"));
    format!("{error}{}", inner.unwrap_or_default())
}
