//! STL, binary and ASCII (3D Systems, "StereoLithography Interface Specification", 1988).

use super::{Raw, polygon::triangulate, text};
use regrasp_api::Vec3;

const HEADER: usize = 84;
/// How many bytes tell an ASCII file.
const HEAD: usize = 1024;
const RECORD: usize = 50;

/// The corners of every facet, not merged. Normals in the file are ignored: the order of the corners counts.
pub(super) fn parse(bytes: &[u8]) -> Result<Raw, String> {
    let announced = announced(bytes);
    let exact = announced.is_some_and(|count| bytes.len() == HEADER + RECORD * count);
    // Binary headers may begin with "solid" too: a fitting length decides first, then zeros, which no text
    // has.
    let has_zeros = text::trimmed(bytes).iter().take(512).any(|&byte| byte == 0);
    if !exact && !has_zeros && is_text(bytes) {
        return ascii(text::trimmed(bytes));
    }
    let count = announced.ok_or("too short for an STL file; is it truncated?")?;
    let held = (bytes.len() - HEADER) / RECORD;
    if count > held {
        return Err(format!("the header announces {count} facets, the file holds {held}; is it truncated?"));
    }
    if count < held && (bytes.len() - HEADER).is_multiple_of(RECORD) {
        return Err(format!("the header announces {count} facets, the file holds {held}; export it again"));
    }
    super::check_count(count)?;
    binary(&bytes[HEADER..HEADER + RECORD * count])
}

/// Whether a file that may be a binary one begins as an ASCII one does, remarks before it or not.
fn is_text(bytes: &[u8]) -> bool {
    let head = bytes[..bytes.len().min(HEAD)].to_ascii_lowercase();
    let start = head.trim_ascii_start();
    let begins = [&b"solid"[..], b"facet"].iter().any(|word| start.starts_with(word));
    begins || head.windows(5).any(|word| word == b"facet") && head.windows(6).any(|word| word == b"vertex")
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

/// What an ASCII file has said so far.
#[derive(Default)]
struct Reader {
    vertices: Vec<Vec3>,
    facets: Vec<[u32; 3]>,
    /// Those of the loop that is not yet ended.
    corners: Vec<u32>,
    /// Whether a facet has begun and not ended.
    is_open: bool,
}

fn ascii(bytes: &[u8]) -> Result<Raw, String> {
    let mut reader = Reader::default();
    for (line, content) in text::lines(bytes) {
        reader.line(line, &content)?;
        super::check_count(reader.facets.len())?;
    }
    // The closing `endsolid` may be missing: whether something else is, too, the surface tells.
    if reader.is_open {
        return Err("it ends within a facet; is it truncated?".into());
    }
    Ok((reader.vertices, reader.facets))
}

impl Reader {
    fn line(&mut self, line: usize, content: &str) -> Result<(), String> {
        let mut words = content.split_ascii_whitespace().peekable();
        while let Some(word) = words.next() {
            let mut word = word.to_ascii_lowercase();
            // Some programs write the closing words apart, or the opening ones together.
            if word == "end" {
                word += &words.next().unwrap_or_default().to_ascii_lowercase();
            }
            match word.as_str() {
                "vertex" => {
                    self.corners.push(self.vertices.len() as u32);
                    self.vertices.push(text::point(&mut words, line)?);
                }
                "endloop" if self.corners.len() < 3 => {
                    return Err(format!("line {line}: a facet has fewer than 3 corners"));
                }
                "endloop" => {
                    let corners = std::mem::take(&mut self.corners);
                    triangulate(&corners, &self.vertices, &mut self.facets);
                }
                "solid" | "endsolid" if is_whole_file(content) => {
                    // All on one line: the name ends where the next facet begins.
                    while words.next_if(|next| !next.eq_ignore_ascii_case("facet")).is_some() {}
                }
                "facet" | "facetnormal" => {
                    self.is_open = true;
                    while words.next_if(|next| !is_word(next)).is_some() {}
                }
                "endfacet" => self.is_open = false,
                "outer" | "outerloop" | "loop" => {}
                // Names, colours and remarks go on to the end of the line.
                "solid" | "endsolid" | "color" => return Ok(()),
                remark if remark.starts_with(['#', ';']) || remark.starts_with("//") => return Ok(()),
                _ => {
                    return Err(format!(
                        "line {line}: `{word}` is no word of an ASCII STL file; is it damaged?"
                    ));
                }
            }
        }
        Ok(())
    }
}

/// Whether a line that begins a solid holds facets, too.
fn is_whole_file(line: &str) -> bool {
    let line = line.to_ascii_lowercase();
    line.contains("vertex") && line.contains("endloop")
}

/// Whether a word begins a loop, so that what stands before it is the normal.
fn is_word(word: &str) -> bool {
    ["outer", "outerloop", "loop", "vertex"].iter().any(|known| word.eq_ignore_ascii_case(known))
}
