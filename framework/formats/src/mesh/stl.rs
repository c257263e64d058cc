//! STL, binary and ASCII (3D Systems, "StereoLithography Interface Specification", 1988).

use super::{Raw, polygon::triangulate, text};
use regrasp_api::{MAX_FACETS, Vec3};

const HEADER: usize = 84;
const RECORD: usize = 50;

/// The corners of every facet, not merged. Normals in the file are ignored: the order of the corners counts.
pub(super) fn parse(bytes: &[u8]) -> Result<Raw, String> {
    let announced = announced(bytes);
    let exact = announced.is_some_and(|count| bytes.len() == HEADER + RECORD * count);
    // Binary headers may begin with "solid" too: a fitting length decides first, then zeros, which no text
    // has.
    let has_zeros = bytes.iter().take(512).any(|&byte| byte == 0);
    if !exact && !has_zeros && begins_as_text(bytes) {
        return ascii(bytes);
    }
    let count = announced.ok_or("too short for an STL file; is it truncated?")?;
    if count > MAX_FACETS {
        return Err(format!(
            "{count} facets are more than the largest allowed {MAX_FACETS}; simplify the mesh"
        ));
    }
    if bytes.len() < HEADER + RECORD * count {
        let held = (bytes.len() - HEADER) / RECORD;
        return Err(format!("the header announces {count} facets, the file holds {held}; is it truncated?"));
    }
    binary(&bytes[HEADER..HEADER + RECORD * count])
}

fn begins_as_text(bytes: &[u8]) -> bool {
    let start = bytes.trim_ascii_start();
    [&b"solid"[..], b"facet"].iter().any(|word| start.get(..5).is_some_and(|s| s.eq_ignore_ascii_case(word)))
}

fn announced(bytes: &[u8]) -> Option<usize> {
    let count = bytes.get(80..HEADER)?.try_into().expect("four bytes");
    Some(u32::from_le_bytes(count) as usize)
}

fn binary(records: &[u8]) -> Result<Raw, String> {
    let mut vertices = Vec::with_capacity(3 * records.len() / RECORD);
    for (facet, record) in records.chunks_exact(RECORD).enumerate() {
        for corner in record[12..48].chunks_exact(12) {
            let float = |k: usize| {
                let bytes = corner[4 * k..4 * k + 4].try_into().expect("four bytes");
                f64::from(f32::from_le_bytes(bytes))
            };
            let vertex = Vec3::new(float(0), float(1), float(2));
            if !vertex.iter().all(|x| x.is_finite()) {
                return Err(format!("facet {facet} has a coordinate that is not finite"));
            }
            vertices.push(vertex);
        }
    }
    let facets = (0..vertices.len() as u32 / 3).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    Ok((vertices, facets))
}

fn ascii(bytes: &[u8]) -> Result<Raw, String> {
    let (mut vertices, mut facets, mut corners) = (Vec::new(), Vec::new(), Vec::new());
    let mut ended = false;
    for (line, content) in text::lines(bytes) {
        let mut words = content.split_ascii_whitespace();
        let Some(word) = words.next() else { continue };
        let mut word = word.to_ascii_lowercase();
        // Some programs write the closing words apart, or the opening ones together.
        if word == "end" {
            word += &words.next().unwrap_or_default().to_ascii_lowercase();
        }
        match word.as_str() {
            "vertex" => {
                corners.push(vertices.len() as u32);
                vertices.push(text::point(&mut words, line)?);
            }
            "endloop" if corners.len() < 3 => {
                return Err(format!("line {line}: a facet has fewer than 3 corners"));
            }
            "endloop" => triangulate(&std::mem::take(&mut corners), &vertices, &mut facets),
            "solid" | "endsolid" => ended = word == "endsolid",
            "facet" | "facetnormal" | "outer" | "outerloop" | "loop" | "endfacet" | "color" => (),
            _ => {
                return Err(format!("line {line}: `{word}` is no word of an ASCII STL file; is it damaged?"));
            }
        }
        super::check_count(facets.len())?;
    }
    if ended {
        Ok((vertices, facets))
    } else {
        Err("the last `endsolid` is missing; is it truncated?".into())
    }
}
