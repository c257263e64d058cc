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
        *coordinate = finite(word).ok_or_else(|| not_finite(word, line))?;
    }
    Ok(point)
}

fn not_finite(word: &str, line: usize) -> String {
    let hint = if word.contains(',') { "; numbers need blanks between them" } else { "" };
    format!("line {line}: `{word}` is not a finite number{hint}")
}

fn finite(word: &str) -> Option<f64> {
    number(word).filter(|x| x.is_finite())
}

/// A number as programs write it: with a D before the exponent (Fortran), a comma for the decimal point
/// (some languages) or after it (lists).
pub(super) fn number(word: &str) -> Option<f64> {
    let read = |word: &str| word.parse::<f64>().ok();
    let odd = || {
        let word = word.trim_end_matches([',', ';']).replace(['d', 'D'], "e");
        let is_decimal = word.matches(',').count() == 1 && !word.contains('.');
        read(&if is_decimal { word.replace(',', ".") } else { word })
    };
    // The words that are no figures ("infinity") hold a D or none that matters.
    read(word).or_else(|| if word.starts_with(char::is_alphabetic) { None } else { odd() })
}

/// The text without what some programs write behind its end: blanks, zeros, the end-of-file mark of DOS.
pub(super) fn trimmed(bytes: &[u8]) -> &[u8] {
    let is_end = |byte: &u8| byte.is_ascii_whitespace() || *byte == 0 || *byte == 0x1a;
    let length = bytes.iter().rposition(|byte| !is_end(byte)).map_or(0, |last| last + 1);
    &bytes[..length]
}
