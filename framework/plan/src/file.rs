//! Reading plan files.

use crate::{OLDEST_VERSION, Plan, ReadError, VERSION};
use serde::Deserialize;
use serde_json::{Value, error::Category};
use std::io::ErrorKind;
use std::path::Path;

/// What tells a plan file of any version.
#[derive(Deserialize)]
struct Header {
    format: Option<Value>,
    version: Option<Value>,
}

/// The largest plan file that is read (bytes).
const MAX_BYTES: u64 = 512 << 20;

/// Reads a plan file. Whatever the file holds, the answer is a plan or an error that names it.
pub fn read(path: &Path) -> Result<Plan, ReadError> {
    let owned = || path.to_owned();
    match regrasp_api::read_at_most(path, MAX_BYTES) {
        Ok(bytes) => from_json(&bytes, path),
        Err(error) if error.kind() == ErrorKind::NotFound => Err(ReadError::Missing { path: owned() }),
        Err(error) if error.kind() == ErrorKind::IsADirectory => Err(ReadError::IsFolder { path: owned() }),
        Err(source) => Err(ReadError::Unreadable { path: owned(), source }),
    }
}

/// Reads a plan from JSON text; `path` is what errors call it.
pub fn from_json(bytes: &[u8], path: &Path) -> Result<Plan, ReadError> {
    if bytes.trim_ascii().is_empty() {
        return Err(ReadError::Empty { path: path.to_owned() });
    }
    // serde would read a list as the fields in their order.
    if bytes.trim_ascii_start().starts_with(b"[") {
        return Err(ReadError::Format { path: path.to_owned(), found: "missing".into() });
    }
    let header: Header = serde_json::from_slice(bytes).map_err(|error| header_error(&error, bytes, path))?;
    let found = |value: Option<Value>| value.map_or("missing".into(), |value| short(&value));
    if header.format.as_ref().and_then(Value::as_str) != Some("regrasp-plan") {
        return Err(ReadError::Format { path: path.to_owned(), found: found(header.format) });
    }
    let known = u64::from(OLDEST_VERSION)..=u64::from(VERSION);
    if !header.version.as_ref().and_then(Value::as_u64).is_some_and(|version| known.contains(&version)) {
        let found = found(header.version);
        return Err(ReadError::Version { path: path.to_owned(), found, known: VERSION });
    }
    serde_json::from_slice(bytes)
        .map_err(|error| ReadError::Content { path: path.to_owned(), message: error.to_string() })
}

fn header_error(error: &serde_json::Error, bytes: &[u8], path: &Path) -> ReadError {
    let path = path.to_owned();
    match error.classify() {
        Category::Eof => ReadError::Truncated { path, line: error.line() },
        Category::Syntax if at_the_end(error, bytes) => ReadError::Truncated { path, line: error.line() },
        Category::Data => ReadError::Format { path, found: "missing".into() },
        _ => ReadError::Syntax { path, message: error.to_string() },
    }
}

/// Whether the last character is to blame: a number that is cut at its point or exponent is bad syntax to
/// serde.
fn at_the_end(error: &serde_json::Error, bytes: &[u8]) -> bool {
    let lines = bytes.split(|&byte| byte == b'\n');
    let (count, last) = lines.fold((0, 0), |(count, _), line| (count + 1, line.len()));
    count > 1 && error.line() == count && error.column() + 1 >= last
}

/// At most 40 characters of a value, for a message.
fn short(value: &Value) -> String {
    let text = value.to_string();
    if text.chars().count() <= 40 { text } else { text.chars().take(40).chain(['…']).collect() }
}
