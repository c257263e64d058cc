//! Wavefront OBJ: vertices and polygons; everything else is ignored.

use super::{Raw, polygon::triangulate, text};
use std::borrow::Cow;

/// A face before it is known how many vertices there are: its line, and how many stood before it.
struct Face {
    line: usize,
    before: usize,
    corners: Vec<i64>,
}

/// Vertices and triangulated faces; faces may stand before their vertices.
pub(super) fn parse(bytes: &[u8]) -> Result<Raw, String> {
    let (mut vertices, mut faces) = (Vec::new(), Vec::new());
    let mut joined = String::new();
    for (line, content) in text::lines(text::trimmed(bytes)) {
        // A backslash at a line's end continues it on the next.
        let content = content.split('#').next().unwrap_or_default().trim_end();
        if let Some(part) = content.strip_suffix('\\') {
            joined.push_str(part);
            joined.push(' ');
            continue;
        }
        let whole = match joined.is_empty() {
            true => Cow::Borrowed(content),
            false => Cow::Owned(std::mem::take(&mut joined) + content),
        };
        let mut words = whole.split_ascii_whitespace();
        match words.next() {
            Some("v" | "V") => vertices.push(text::point(&mut words, line)?),
            // `fo` is what the oldest files have.
            Some("f" | "F" | "fo") => {
                let corners = words.map(|word| index(word, line)).collect::<Result<_, _>>()?;
                faces.push(Face { line, before: vertices.len(), corners });
                super::check_count(faces.len())?;
            }
            _ => (),
        }
    }
    if faces.is_empty() {
        return Err(match vertices.len() {
            0 => "it has no facets and no vertices".into(),
            _ => "it has vertices and no facets; export it as a triangle mesh".into(),
        });
    }
    let mut facets = Vec::with_capacity(faces.len());
    let mut corners = Vec::new();
    for face in &faces {
        corners.clear();
        for &index in &face.corners {
            corners.push(vertex(index, face, vertices.len())?);
        }
        triangulate(&corners, &vertices, &mut facets);
        super::check_count(facets.len())?;
    }
    Ok((vertices, facets))
}

/// The vertex that a corner like `7`, `7/1/2`, `7//2` or `-1` names, as it is written.
fn index(word: &str, line: usize) -> Result<i64, String> {
    let index = word.split('/').next().and_then(|index| index.parse().ok());
    index.ok_or_else(|| format!("line {line}: `{word}` names no vertex"))
}

/// The vertex from 0: of all there are, or with a minus of those before the face, -1 being the last.
fn vertex(index: i64, face: &Face, count: usize) -> Result<u32, String> {
    let from_zero = if index < 0 { face.before as i64 + index } else { index - 1 };
    let known = u32::try_from(from_zero).ok().filter(|&vertex| (vertex as usize) < count);
    known
        .ok_or_else(|| format!("line {}: `{index}` names no vertex of the {count} that there are", face.line))
}
