//! Loading a library that was inspected. The only code of the framework that is `unsafe`, besides the export macro's expansion.
#![allow(unsafe_code)]

use super::{Inspected, LoadError};
use regrasp_abi::{EXPORT_NAME, ExportFunction};
use regrasp_api::{Entry, own_faults};

/// Loads the library for good and hands out its plugins.
pub(crate) fn open(inspected: &Inspected) -> Result<Vec<&'static Entry>, LoadError> {
    let path = &inspected.path;
    let failed = |error: libloading::Error| LoadError::Open { path: path.clone(), cause: cause(&error) };
    // SAFETY: loading runs the library's initialisers. The file carries the section that the export macro writes, so it is a Rust library
    // that the user named to be loaded; what its author put into initialisers is the author's responsibility.
    let library = unsafe { libloading::Library::new(path) }.map_err(failed)?;
    // Never unloaded: entries, objects and errors point into it.
    let library: &'static libloading::Library = Box::leak(Box::new(library));
    // SAFETY: the export macro defines this name with this type, and the types are laid out alike, since the fingerprints are equal.
    let export = unsafe { library.get::<ExportFunction>(EXPORT_NAME.as_bytes()) }.map_err(failed)?;
    // SAFETY: as above; the function stores a pointer and returns another.
    let exported = unsafe { export(&own_faults()) };
    if exported.section != inspected.section {
        return Err(LoadError::Changed { path: path.clone() });
    }
    Ok(exported.entries.iter().collect())
}

fn cause(error: &libloading::Error) -> String {
    let inner = std::error::Error::source(error).map(|source| format!(" ({source})"));
    format!("{error}{}", inner.unwrap_or_default())
}
