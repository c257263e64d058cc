//! Lines and numbers of text formats.

use regrasp_api::Vec3;

/// The lines of a text in any encoding that agrees with ASCII, with their numbers from 1; a line ends with
/// LF, CR LF or CR.
pub(super) fn lines(bytes: &[u8]) -> impl Iterator<Item = (usize, std::borrow::Cow<'_, str>)> {
    let mut before = 0;
    let lines = bytes.split_inclusive(|&byte| byte == b'\n' || byte == b'\r').filter_map(move |line| {
        let ended_by = std::mem::replace(&mut before, line[line.len() - 1]);
        // The LF of CR LF is no line of its own.
        (!(ended_by == b'\r' && line == b"\n")).then(|| line.trim_ascii_end())
    });
    lines.enumerate().map(|(i, line)| (i + 1, String::from_utf8_lossy(line)))
}

/// The text as one that agrees with ASCII: without a byte order mark, and UTF-16 (which has one) turned into
/// UTF-8.
pub(super) fn plain(bytes: Vec<u8>) -> Vec<u8> {
    let wide = |units: fn([u8; 2]) -> u16| {
        let units = bytes[2..].chunks_exact(2).map(|pair| units([pair[0], pair[1]]));
        char::decode_utf16(units)
            .map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER))
            .collect::<String>()
            .into_bytes()
    };
    match bytes.as_slice() {
        [0xef, 0xbb, 0xbf, rest @ ..] => rest.to_vec(),
        [0xff, 0xfe, ..] if bytes.len() != binary_length(&bytes) => wide(u16::from_le_bytes),
        [0xfe, 0xff, ..] if bytes.len() != binary_length(&bytes) => wide(u16::from_be_bytes),
        _ => bytes,
    }
}

/// The length that a binary STL file with this beginning has: its header may begin with anything.
fn binary_length(bytes: &[u8]) -> usize {
    let count = bytes.get(80..84).map_or(0, |b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]) as usize);
    count.saturating_mul(50).saturating_add(84)
}

/// Three finite coordinates from the next three words.
pub(super) fn point<'a>(words: &mut impl Iterator<Item = &'a str>, line: usize) -> Result<Vec3, String> {
    let mut point = Vec3::zeros();
    for coordinate in point.iter_mut() {
        let word = words.next().ok_or_else(|| format!("line {line}: a vertex needs three coordinates"))?;
        *coordinate = finite(word).ok_or_else(|| format!("line {line}: `{word}` is not a finite number"))?;
    }
    Ok(point)
}

fn finite(word: &str) -> Option<f64> {
    let number = word.parse().ok().or_else(|| {
        // Programs in Fortran write the exponent with a D.
        word.contains(['d', 'D']).then(|| word.replace(['d', 'D'], "e").parse().ok()).flatten()
    });
    number.filter(|x: &f64| x.is_finite())
}
