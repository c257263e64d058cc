//! PLY, ASCII and binary of either byte order (G. Turk, "The PLY Polygon File Format", 1994).

use super::{Raw, polygon::triangulate, text};
use regrasp_api::Vec3;

/// Coordinates of the element `vertex`, and the triangulated `vertex_indices` of the elements `face` and
/// `tristrips`, in whatever order they come; the rest is skipped.
pub(super) fn parse(bytes: &[u8]) -> Result<Raw, String> {
    let (header, mut body) = Header::parse(bytes)?;
    let count =
        header.elements.iter().find(|element| element.name == "vertex").map_or(0, |element| element.count);
    let (mut vertices, mut polygons, mut facets) = (Vec::new(), Vec::new(), Vec::new());
    for element in &header.elements {
        if element.properties.is_empty() {
            continue;
        }
        for row in 0..element.count {
            let truncated =
                || format!("ends in `{}` {row} of {}; is it truncated?", element.name, element.count);
            let values = Row::read(element, header.encoding, &mut body).ok_or_else(truncated)?;
            match element.name.as_str() {
                "vertex" => vertices.push(values.vertex(row)?),
                "face" => polygons.push(values.corners(row, count)?),
                "tristrips" => values.strips(row, count, &mut facets)?,
                _ => (),
            }
            super::check_count(facets.len().max(polygons.len()))?;
        }
    }
    if polygons.is_empty() && facets.is_empty() {
        return Err(without_faces(&header));
    }
    for corners in polygons {
        triangulate(&corners, &vertices, &mut facets);
        super::check_count(facets.len())?;
    }
    Ok((vertices, facets))
}

fn without_faces(header: &Header) -> String {
    let others: Vec<&str> = header.elements.iter().map(|element| element.name.as_str()).collect();
    if others.contains(&"range_grid") {
        return "it holds a range grid and no faces; export it as a triangle mesh".into();
    }
    "it holds points and no faces, a cloud; make a closed surface of it first, as by Poisson reconstruction"
        .into()
}

#[derive(Clone, Copy)]
enum Encoding {
    Ascii,
    Little,
    Big,
}

#[derive(Clone, Copy)]
enum Kind {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

/// A property: its name, its kind and, for a list, the kind of the list's length.
struct Property {
    name: String,
    kind: Kind,
    length: Option<Kind>,
}

struct Element {
    name: String,
    count: usize,
    properties: Vec<Property>,
}

struct Header {
    encoding: Encoding,
    elements: Vec<Element>,
}

impl Header {
    /// The header, and what follows it.
    fn parse(bytes: &[u8]) -> Result<(Self, &[u8]), String> {
        let (mut encoding, mut elements, mut rest) = (None, Vec::<Element>::new(), bytes);
        let mut number = 0;
        let line_end = line_end(bytes);
        loop {
            let end = rest
                .iter()
                .position(|&b| b == line_end)
                .ok_or("the header has no `end_header`; is it truncated?")?;
            let line = String::from_utf8_lossy(&rest[..end]);
            rest = &rest[end + 1..];
            number += 1;
            let words: Vec<&str> = line.split_ascii_whitespace().collect();
            let refuse = || format!("line {number}: `{}` is not a PLY header line", line.trim());
            match words.as_slice() {
                ["ply"] if number == 1 => (),
                _ if number == 1 => return Err("the file does not begin with `ply`".into()),
                ["format", name, "1.0"] => encoding = Some(Encoding::named(name).ok_or_else(refuse)?),
                ["element", name, count] => elements.push(Element {
                    name: (*name).into(),
                    count: count.parse().map_err(|_| refuse())?,
                    properties: Vec::new(),
                }),
                ["property", of @ ..] => {
                    let element = elements.last_mut().ok_or_else(refuse)?;
                    element.properties.push(Property::parse(of).ok_or_else(refuse)?);
                }
                ["end_header"] => break,
                [] | ["comment" | "obj_info", ..] => (),
                _ => return Err(refuse()),
            }
        }
        let encoding = encoding.ok_or("the header has no `format` line")?;
        Ok((Self { encoding, elements }, rest))
    }
}

/// What ends the lines of the header: a CR alone where no LF follows the first one.
fn line_end(bytes: &[u8]) -> u8 {
    match bytes.iter().position(|&byte| byte == b'\r' || byte == b'\n') {
        Some(end) if bytes[end] == b'\r' && bytes.get(end + 1) != Some(&b'\n') => b'\r',
        _ => b'\n',
    }
}

impl Encoding {
    fn named(name: &str) -> Option<Self> {
        Some(match name {
            "ascii" => Self::Ascii,
            "binary_little_endian" => Self::Little,
            "binary_big_endian" => Self::Big,
            _ => return None,
        })
    }
}

impl Property {
    fn parse(words: &[&str]) -> Option<Self> {
        let (name, kind, length) = match words {
            ["list", length, kind, name] => (name, kind, Some(Kind::named(length)?)),
            [kind, name] => (name, kind, None),
            _ => return None,
        };
        Some(Self { name: (*name).into(), kind: Kind::named(kind)?, length })
    }
}

impl Kind {
    fn named(name: &str) -> Option<Self> {
        Some(match name {
            "char" | "int8" => Self::I8,
            "uchar" | "uint8" => Self::U8,
            "short" | "int16" => Self::I16,
            "ushort" | "uint16" => Self::U16,
            "int" | "int32" => Self::I32,
            "uint" | "uint32" => Self::U32,
            "float" | "float32" => Self::F32,
            "double" | "float64" => Self::F64,
            _ => return None,
        })
    }

    /// The next value of the body, which moves on; `None` at its end or where it is no number.
    fn read(self, encoding: Encoding, body: &mut &[u8]) -> Option<f64> {
        match encoding {
            Encoding::Ascii => {
                *body = body.trim_ascii_start();
                let end = body.iter().position(u8::is_ascii_whitespace).unwrap_or(body.len());
                let (word, rest) = body.split_at(end);
                *body = rest;
                text::number(str::from_utf8(word).ok()?)
            }
            Encoding::Little => self.read_binary(body, false),
            Encoding::Big => self.read_binary(body, true),
        }
    }

    fn read_binary(self, body: &mut &[u8], big: bool) -> Option<f64> {
        Some(match self {
            Self::I8 => f64::from(i8::from_le_bytes(take(body, big)?)),
            Self::U8 => f64::from(u8::from_le_bytes(take(body, big)?)),
            Self::I16 => f64::from(i16::from_le_bytes(take(body, big)?)),
            Self::U16 => f64::from(u16::from_le_bytes(take(body, big)?)),
            Self::I32 => f64::from(i32::from_le_bytes(take(body, big)?)),
            Self::U32 => f64::from(u32::from_le_bytes(take(body, big)?)),
            Self::F32 => f64::from(f32::from_le_bytes(take(body, big)?)),
            Self::F64 => f64::from_le_bytes(take(body, big)?),
        })
    }
}

/// The next bytes in little-endian order.
fn take<const N: usize>(body: &mut &[u8], big: bool) -> Option<[u8; N]> {
    let (bytes, rest) = body.split_first_chunk::<N>()?;
    *body = rest;
    let mut bytes = *bytes;
    if big {
        bytes.reverse();
    }
    Some(bytes)
}

/// What of one row matters.
#[derive(Default)]
struct Row {
    point: [Option<f64>; 3],
    corners: Vec<f64>,
}

impl Row {
    fn read(element: &Element, encoding: Encoding, body: &mut &[u8]) -> Option<Self> {
        let mut row = Self::default();
        for property in &element.properties {
            let length = property.length.map_or(Some(1.0), |kind| kind.read(encoding, body))?;
            let indices =
                property.length.is_some() && ["vertex_indices", "vertex_index"].contains(&&*property.name);
            let axis = ["x", "y", "z"].iter().position(|name| property.name == *name);
            // A negative or NaN length casts to 0; a mistaken large one runs into the end of the body.
            for _ in 0..length as usize {
                let value = property.kind.read(encoding, body)?;
                match axis {
                    Some(axis) => row.point[axis] = Some(value),
                    None if indices => row.corners.push(value),
                    None => (),
                }
            }
        }
        Some(row)
    }

    fn vertex(&self, row: usize) -> Result<Vec3, String> {
        match self.point {
            [Some(x), Some(y), Some(z)] if x.is_finite() && y.is_finite() && z.is_finite() => {
                Ok(Vec3::new(x, y, z))
            }
            [Some(_), Some(_), Some(_)] => Err(format!("vertex {row} has a coordinate that is not finite")),
            _ => Err("the element `vertex` has no properties x, y, z".into()),
        }
    }

    fn corners(&self, row: usize, count: usize) -> Result<Vec<u32>, String> {
        let corner = |&index: &f64| {
            let known = (0.0..count as f64).contains(&index);
            known.then_some(index as u32).ok_or_else(|| format!("face {row} names vertex {index} of {count}"))
        };
        self.corners.iter().map(corner).collect()
    }

    /// The triangles of strips, which end at an index of -1.
    fn strips(&self, row: usize, count: usize, facets: &mut Vec<[u32; 3]>) -> Result<(), String> {
        for strip in self.corners.split(|&index| index == -1.0) {
            let known = |&index: &f64| (0.0..count as f64).contains(&index);
            if let Some(bad) = strip.iter().find(|index| !known(index)) {
                return Err(format!("strip {row} names vertex {bad} of {count}"));
            }
            let turned = |(i, w): (usize, &[f64])| {
                let [a, b, c] = [w[0] as u32, w[1] as u32, w[2] as u32];
                if i % 2 == 0 { [a, b, c] } else { [b, a, c] }
            };
            facets.extend(strip.windows(3).enumerate().map(turned));
        }
        Ok(())
    }
}
