//! Text files in whatever encoding they name.

use crate::error::RobotFault as Fault;
use encoding_rs::{Encoding, UTF_8, UTF_16BE, UTF_16LE};
use std::path::Path;

/// The largest description of a robot that is read (bytes).
const MAX_BYTES: u64 = 64 << 20;

/// Reads the text of an XML file.
///
/// A byte order mark decides, then the declaration (`encoding="ISO-8859-1"`), else it is UTF-8.
pub fn read_xml(path: &Path) -> Result<String, Fault> {
    let unreadable = |error: std::io::Error| Fault::of_file(format!("cannot read the file: {error}"));
    let size = std::fs::metadata(path).map_err(unreadable)?.len();
    if size > MAX_BYTES {
        let message = format!("{size} bytes are more than the largest allowed {MAX_BYTES}");
        return Err(Fault::of_file(message));
    }
    decode(&std::fs::read(path).map_err(unreadable)?)
}

/// The text of an XML file.
pub(crate) fn decode(bytes: &[u8]) -> Result<String, Fault> {
    let encoding = match Encoding::for_bom(bytes) {
        Some((encoding, _)) => encoding,
        None => declared(bytes)?,
    };
    let (text, _, broken) = encoding.decode(bytes);
    if broken {
        let message = format!(
            "the file is not {0} text, which it should be{1}; save it as UTF-8, or name its encoding in the \
             first line: \
             <?xml version=\"1.0\" encoding=\"ISO-8859-1\"?>",
            encoding.name(),
            if encoding == UTF_8 { " where it names no other encoding" } else { ", as its first line says" }
        );
        return Err(Fault::of_file(message));
    }
    Ok(text.into_owned())
}

/// The encoding that the declaration names.
fn declared(bytes: &[u8]) -> Result<&'static Encoding, Fault> {
    match bytes {
        [b'<', 0, ..] => return Ok(UTF_16LE),
        [0, b'<', ..] => return Ok(UTF_16BE),
        _ => {}
    }
    let head = String::from_utf8_lossy(&bytes[..bytes.len().min(200)]);
    let declaration = head.trim_start().strip_prefix("<?xml").and_then(|rest| rest.split("?>").next());
    let Some(name) = declaration.and_then(encoding_name) else { return Ok(UTF_8) };
    Encoding::for_label(name.as_bytes())
        .ok_or_else(|| Fault::at(1, format!("the encoding \"{name}\" is not known; save the file as UTF-8")))
}

fn encoding_name(declaration: &str) -> Option<&str> {
    let rest = declaration.split_once("encoding")?.1.trim_start().strip_prefix('=')?.trim_start();
    let quote = rest.chars().next().filter(|c| ['"', '\''].contains(c))?;
    rest[1..].split(quote).next()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_text_is_read_in_the_encoding_that_it_names() {
        let latin = b"<?xml version='1.0' encoding='ISO-8859-1'?><robot name=\"f\xfcnf\"/>";
        assert!(decode(latin).unwrap().contains("fünf"));
        assert!(decode("\u{feff}<robot name=\"fünf\"/>".as_bytes()).unwrap().starts_with("<robot"));
        let wide: Vec<u8> = "<robot name=\"fünf\"/>".encode_utf16().flat_map(u16::to_le_bytes).collect();
        assert!(decode(&wide).unwrap().contains("fünf"));
        let marked: Vec<u8> = "\u{feff}<robot/>".encode_utf16().flat_map(u16::to_be_bytes).collect();
        assert_eq!(decode(&marked).unwrap(), "<robot/>");
    }

    #[test]
    fn bytes_that_are_no_text_and_unknown_encodings_are_refused() {
        let message = decode(b"<robot name=\"f\xfcnf\"/>").unwrap_err().message;
        assert!(message.contains("UTF-8") && message.contains("ISO-8859-1"), "{message}");
        let unknown = decode(b"<?xml version=\"1.0\" encoding=\"klingon\"?><robot/>").unwrap_err();
        assert!(unknown.message.contains("klingon") && unknown.line == Some(1));
    }
}
