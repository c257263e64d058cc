//! Reading and writing plan files.

use crate::{Plan, ReadError, SegmentRecord, VERSION, WriteError, write_json};
use serde::Deserialize;
use serde_json::{Value, error::Category};
use std::io::{self, ErrorKind, Write};
use std::path::Path;

/// What tells a plan file of any version.
#[derive(Deserialize)]
struct Header {
    format: Option<Value>,
    version: Option<Value>,
}

/// Reads a plan file. Whatever the file holds, the answer is a plan or an error that names it.
pub fn read(path: &Path) -> Result<Plan, ReadError> {
    let owned = || path.to_owned();
    match std::fs::read(path) {
        Ok(bytes) => from_json(&bytes, path),
        Err(error) if error.kind() == ErrorKind::NotFound => Err(ReadError::Missing { path: owned() }),
        Err(source) => Err(ReadError::Unreadable { path: owned(), source }),
    }
}

/// Reads a plan from JSON text; `path` is what errors call it.
pub fn from_json(bytes: &[u8], path: &Path) -> Result<Plan, ReadError> {
    let header: Header = serde_json::from_slice(bytes).map_err(|error| header_error(&error, path))?;
    let found = |value: Option<Value>| value.map_or("missing".into(), |value| short(&value));
    if header.format.as_ref().and_then(Value::as_str) != Some("regrasp-plan") {
        return Err(ReadError::Format { path: path.to_owned(), found: found(header.format) });
    }
    if header.version.as_ref().and_then(Value::as_u64) != Some(VERSION.into()) {
        let found = found(header.version);
        return Err(ReadError::Version { path: path.to_owned(), found, known: VERSION });
    }
    serde_json::from_slice(bytes)
        .map_err(|error| ReadError::Content { path: path.to_owned(), message: error.to_string() })
}

fn header_error(error: &serde_json::Error, path: &Path) -> ReadError {
    let path = path.to_owned();
    match error.classify() {
        Category::Eof => ReadError::Truncated { path, line: error.line() },
        Category::Data => ReadError::Format { path, found: "missing".into() },
        _ => ReadError::Syntax { path, message: error.to_string() },
    }
}

/// At most 40 characters of a value, for a message.
fn short(value: &Value) -> String {
    let text = value.to_string();
    if text.chars().count() <= 40 { text } else { text.chars().take(40).chain(['…']).collect() }
}

/// Writes a plan file: first under another name in the same folder, then, once all is on the disk, under its own.
pub fn write(path: &Path, plan: &Plan) -> Result<(), WriteError> {
    if let Some(place) = not_finite(&plan.segments) {
        return Err(WriteError::NotFinite { place });
    }
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    if !folder.is_dir() {
        return Err(WriteError::NoFolder { path: path.to_owned() });
    }
    replace(path, folder, plan).map_err(|error| write_error(error, path))
}

fn write_error(error: io::Error, path: &Path) -> WriteError {
    let path = path.to_owned();
    match error.kind() {
        ErrorKind::StorageFull | ErrorKind::QuotaExceeded => WriteError::DiskFull { path },
        _ => WriteError::Failed { path, source: error },
    }
}

fn replace(path: &Path, folder: &Path, plan: &Plan) -> io::Result<()> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".regrasp-plan-").suffix(".tmp");
    #[cfg(unix)]
    {
        // As any new file, less what the user's mask takes away; the default of temporary files is for their owner alone.
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    let mut file = builder.tempfile_in(folder)?;
    let mut buffer = io::BufWriter::new(&mut file);
    write_json(plan, &mut buffer)?;
    buffer.flush()?;
    drop(buffer);
    file.as_file().sync_all()?;
    file.persist(path).map_err(|error| error.error)?;
    Ok(())
}

/// Names the first number of the motion that is not finite.
fn not_finite(segments: &[SegmentRecord]) -> Option<String> {
    let finite = |values: &[f64]| values.iter().all(|x| x.is_finite());
    for (s, segment) in segments.iter().enumerate() {
        for (k, state) in segment.states.iter().enumerate() {
            let pose = finite(&state.object.position) && finite(&state.object.orientation);
            let joints = state.joints.iter().all(|joints| finite(joints));
            let contacts = state.contacts.iter().flatten();
            let contacts = contacts.flat_map(|c| [c.point_O, c.normal_O, c.point_F]).all(|v| finite(&v));
            if !(state.time.is_finite() && pose && joints && contacts) {
                return Some(format!("a value in segment {s}, state {k},"));
            }
        }
    }
    None
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
}
