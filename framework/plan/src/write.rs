//! Writing plan files, so that a failure never costs what was there before.

use crate::{ContactSurface, Plan, StateRecord, TEMPORARY, WriteError, write_json};
use std::fs::{File, OpenOptions};
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};

/// Writes a plan file: first under another name in the same folder, then, once all is on the disk, under its
/// own.
///
/// What is no regular file, such as a pipe or `/dev/stdout`, is written in place; a symbolic link keeps
/// pointing to its file.
pub fn write(path: &Path, plan: &Plan) -> Result<(), WriteError> {
    if let Some(place) = not_finite(plan) {
        return Err(WriteError::NotFinite { place });
    }
    write_file(path, |writer| write_json(plan, writer))
}

/// Writes any file as [`write()`] writes plans: `put` gives its content.
pub fn write_file(path: &Path, put: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<(), WriteError> {
    let done = match target(path)? {
        Target::Special => OpenOptions::new().write(true).open(path).and_then(|file| buffered(&file, put)),
        Target::File { path, folder } => replace(&path, &folder, put),
    };
    done.map_err(|error| write_error(error, path))
}

/// Whether a plan file could be written here, found out before there is one; leaves everything as it is.
pub fn check_place(path: &Path) -> Result<(), WriteError> {
    match target(path)? {
        Target::Special => Ok(()),
        Target::File { folder, .. } => {
            // The temporary file is named in the system's own message, which would not help: its kind says
            // enough.
            let refused = |error: io::Error| write_error(io::Error::from(error.kind()), path);
            temporary(&folder).map(drop).map_err(refused)
        }
    }
}

/// What a path stands for.
enum Target {
    /// A device or a pipe: it cannot be replaced.
    Special,
    /// A regular file, there or not, behind any symbolic links.
    File { path: PathBuf, folder: PathBuf },
}

fn target(path: &Path) -> Result<Target, WriteError> {
    let owned = || path.to_owned();
    let real = std::fs::canonicalize(path).unwrap_or_else(|_| owned());
    match std::fs::metadata(&real) {
        Ok(found) if found.is_dir() => return Err(WriteError::IsFolder { path: owned() }),
        Ok(found) if !found.is_file() => return Ok(Target::Special),
        Ok(found) if found.permissions().readonly() => {
            return Err(WriteError::Failed { path: owned(), source: ErrorKind::PermissionDenied.into() });
        }
        _ => {}
    }
    let folder = match real.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder.to_owned(),
        _ => PathBuf::from("."),
    };
    if folder.is_dir() {
        Ok(Target::File { path: real, folder })
    } else {
        Err(WriteError::NoFolder { path: owned() })
    }
}

fn write_error(error: io::Error, path: &Path) -> WriteError {
    let path = path.to_owned();
    match error.kind() {
        ErrorKind::StorageFull | ErrorKind::QuotaExceeded => WriteError::DiskFull { path },
        _ => WriteError::Failed { path, source: error },
    }
}

fn replace(path: &Path, folder: &Path, put: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
    #[cfg(target_os = "linux")]
    if let Some(file) = crate::nameless::open(folder) {
        buffered(&file, put)?;
        keep_mode(&file, path)?;
        file.sync_all()?;
        return crate::nameless::put_in_place(&file, path, folder);
    }
    let file = temporary(folder)?;
    buffered(file.as_file(), put)?;
    keep_mode(file.as_file(), path)?;
    file.as_file().sync_all()?;
    file.persist(path).map_err(|error| error.error)?;
    Ok(())
}

/// A file that replaces another may be used as that could be.
fn keep_mode(file: &File, replaced: &Path) -> io::Result<()> {
    match std::fs::metadata(replaced) {
        Ok(found) => file.set_permissions(found.permissions()),
        Err(_) => Ok(()),
    }
}

fn temporary(folder: &Path) -> io::Result<tempfile::NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(TEMPORARY.0).suffix(TEMPORARY.1);
    #[cfg(unix)]
    {
        // As any new file, less what the user's mask takes away; the default of temporary files is for their
        // owner alone.
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    builder.tempfile_in(folder)
}

fn buffered(file: &File, put: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
    let mut buffer = io::BufWriter::new(file);
    put(&mut buffer)?;
    buffer.flush()
}

/// Names the first number of a plan that is not finite.
fn not_finite(plan: &Plan) -> Option<String> {
    let twin = plan.object.as_ref().and_then(|object| object.contact_surface.as_ref());
    let twin_is_finite = |twin: &ContactSurface| {
        twin.bound.is_finite() && twin.vertices.iter().flatten().all(|x| x.is_finite())
    };
    if !twin.is_none_or(twin_is_finite) {
        return Some("a value in the object's contact surface".into());
    }
    let facets = plan.object.as_ref().and_then(|object| object.surface.as_ref());
    if !facets.is_none_or(|facets| facets.vertices.iter().flatten().all(|x| x.is_finite())) {
        return Some("a value in the object's facets".into());
    }
    for (s, segment) in plan.segments.iter().enumerate() {
        if let Some(k) = segment.states.iter().position(|state| !is_finite(state)) {
            return Some(format!("a value in segment {}, state {},", s + 1, k + 1));
        }
    }
    None
}

fn is_finite(state: &StateRecord) -> bool {
    let finite = |values: &[f64]| values.iter().all(|x| x.is_finite());
    let rows = |rows: &[Vec<f64>]| rows.iter().all(|row| finite(row));
    let mut contacts = state.contacts.iter().flatten().flat_map(|c| [c.point_O, c.normal_O, c.point_F]);
    let mut forces = state.forces.iter().flatten().flatten();
    state.time.is_finite()
        && finite(&state.object.position)
        && finite(&state.object.orientation)
        && rows(&state.joints)
        && state.velocities.as_ref().is_none_or(|velocities| rows(velocities))
        && contacts.all(|v| finite(&v))
        && forces.all(|f| finite(f))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_full_disk_is_said_to_be_full() {
        let error = write_error(io::Error::from(ErrorKind::StorageFull), Path::new("plan.json"));
        assert!(matches!(error, WriteError::DiskFull { .. }));
        assert!(error.to_string().contains("no space"), "{error}");
    }

    #[test]
    fn places_are_told_apart_before_anything_is_written() {
        let folder = tempfile::tempdir().unwrap();
        let inside = |name: &str| folder.path().join(name);
        assert!(check_place(&inside("plan.json")).is_ok());
        assert!(matches!(check_place(folder.path()), Err(WriteError::IsFolder { .. })));
        assert!(matches!(check_place(&inside("none/plan.json")), Err(WriteError::NoFolder { .. })));
        std::fs::write(inside("kept.json"), "kept").unwrap();
        let mut rights = std::fs::metadata(inside("kept.json")).unwrap().permissions();
        rights.set_readonly(true);
        std::fs::set_permissions(inside("kept.json"), rights).unwrap();
        let refused = check_place(&inside("kept.json")).unwrap_err().to_string();
        assert!(refused.contains("kept.json") && refused.contains("permission denied"), "{refused}");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    #[cfg(unix)]
    fn a_file_that_is_replaced_keeps_its_mode_and_leaves_nothing_behind() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("plan.json");
        std::fs::write(&path, "old").unwrap();
        std::fs::set_permissions(&path, std::fs::Permissions::from_mode(0o640)).unwrap();
        write_file(&path, |out| out.write_all(b"new")).unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), b"new");
        assert_eq!(std::fs::metadata(&path).unwrap().permissions().mode() & 0o777, 0o640);
        write_file(&path, |_| Err(io::Error::from(ErrorKind::StorageFull))).unwrap_err();
        assert_eq!(std::fs::read(&path).unwrap(), b"new");
        write_file(&folder.path().join("other.json"), |out| out.write_all(b"other")).unwrap();
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 2);
    }

    #[test]
    #[cfg(unix)]
    fn devices_and_links_stay_what_they_are() {
        assert!(matches!(target(Path::new("/dev/null")), Ok(Target::Special)));
        let folder = tempfile::tempdir().unwrap();
        let (file, link) = (folder.path().join("plan.json"), folder.path().join("latest.json"));
        std::fs::write(&file, "old").unwrap();
        std::os::unix::fs::symlink(&file, &link).unwrap();
        let Ok(Target::File { path, .. }) = target(&link) else { panic!("a link to a file is a file") };
        assert_eq!(path, std::fs::canonicalize(&file).unwrap());
    }
}
