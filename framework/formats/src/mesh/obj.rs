//! Wavefront OBJ: vertices and polygons; everything else is ignored.

use super::{Raw, polygon::triangulate, text};

/// Vertices and triangulated faces.
pub(super) fn parse(bytes: &[u8]) -> Result<Raw, String> {
    let (mut vertices, mut facets) = (Vec::new(), Vec::new());
    let mut joined = String::new();
    for (line, content) in text::lines(bytes) {
        // A backslash at a line's end continues it on the next.
        let content = content.split('#').next().unwrap_or_default().trim_end();
        if let Some(part) = content.strip_suffix('\\') {
            joined.push_str(part);
            joined.push(' ');
            continue;
        }
        joined.push_str(content);
        let mut words = joined.split_ascii_whitespace();
        match words.next() {
            Some("v") => vertices.push(text::point(&mut words, line)?),
            Some("f") => {
                let corners: Vec<u32> =
                    words.map(|word| corner(word, vertices.len(), line)).collect::<Result<_, _>>()?;
                if corners.len() < 3 {
                    return Err(format!("line {line}: a face has fewer than 3 corners"));
                }
                triangulate(&corners, &vertices, &mut facets);
                super::check_count(facets.len())?;
            }
            _ => (),
        }
        joined.clear();
    }
    Ok((vertices, facets))
}

/// The vertex, from 0, of a corner like `7`, `7/1/2`, `7//2` or `-1` (the last vertex so far).
fn corner(word: &str, count: usize, line: usize) -> Result<u32, String> {
    let refuse = || format!("line {line}: `{word}` names no vertex of the {count} before it");
    let index: i64 = word.split('/').next().and_then(|i| i.parse().ok()).ok_or_else(refuse)?;
    let from_zero = if index < 0 { count as i64 + index } else { index - 1 };
    u32::try_from(from_zero).ok().filter(|&i| (i as usize) < count).ok_or_else(refuse)
}
