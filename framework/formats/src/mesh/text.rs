//! Lines and numbers of text formats.

use regrasp_api::Vec3;

/// The lines of a text in any encoding that agrees with ASCII, with their numbers from 1.
pub(super) fn lines(bytes: &[u8]) -> impl Iterator<Item = (usize, std::borrow::Cow<'_, str>)> {
    bytes
        .split(|&byte| byte == b'\n')
        .enumerate()
        .map(|(i, line)| (i + 1, String::from_utf8_lossy(line.strip_suffix(b"\r").unwrap_or(line))))
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
    word.parse().ok().filter(|x: &f64| x.is_finite())
}
