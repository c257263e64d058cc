//! The numbers of a glTF: accessors over views of buffers.

use super::super::MAX_BYTES;
use super::document::{Accessor, Document};
use crate::packages::decoded;
use regrasp_api::{MAX_FACETS, Vec3};
use std::borrow::Cow;
use std::path::Path;

/// More numbers than the corners of the largest mesh are no accessor of one.
const MOST: usize = 3 * MAX_FACETS;

/// The buffers of a file.
pub(super) struct Buffers<'d> {
    document: &'d Document,
    bytes: Vec<Cow<'d, [u8]>>,
}

impl<'d> Buffers<'d> {
    pub(super) fn new(
        document: &'d Document,
        binary: Option<&'d [u8]>,
        folder: &Path,
    ) -> Result<Self, String> {
        let read = |(i, buffer): (usize, &super::document::Buffer)| match &buffer.uri {
            None if i == 0 => Ok(Cow::Borrowed(binary.ok_or("its buffer is missing; is it truncated?")?)),
            None => Err(format!("buffer {i} names no file")),
            Some(address) => named(address, folder).map(Cow::Owned),
        };
        let bytes = document.buffers.iter().enumerate().map(read).collect::<Result<_, _>>()?;
        Ok(Self { document, bytes })
    }

    /// The points of an accessor.
    pub(super) fn points(&self, accessor: usize) -> Result<Vec<Vec3>, String> {
        let all = self.numbers(accessor, "VEC3", 3)?;
        if !all.iter().all(|x| x.is_finite()) {
            return Err(format!("accessor {accessor} holds a number that is not finite"));
        }
        Ok(all.chunks_exact(3).map(Vec3::from_column_slice).collect())
    }

    /// The indices of an accessor.
    pub(super) fn indices(&self, accessor: usize) -> Result<Vec<u32>, String> {
        Ok(self.numbers(accessor, "SCALAR", 1)?.into_iter().map(|index| index as u32).collect())
    }

    fn numbers(&self, index: usize, form: &str, width: usize) -> Result<Vec<f64>, String> {
        let accessor =
            self.document.accessors.get(index).ok_or_else(|| format!("there is no accessor {index}"))?;
        if accessor.form != form || accessor.count > MOST || accessor.sparse.is_some() {
            return Err(format!(
                "accessor {index} must be a plain {form} of at most {MOST} elements; export it again"
            ));
        }
        let short = || format!("accessor {index} reaches beyond its buffer; is the file truncated?");
        let (size, read) =
            component(accessor).ok_or_else(|| format!("accessor {index} has no known numbers"))?;
        let Some(view) = accessor.buffer_view else { return Ok(vec![0.0; width * accessor.count]) };
        let view = self.document.buffer_views.get(view).ok_or_else(|| format!("there is no view {view}"))?;
        let buffer =
            self.bytes.get(view.buffer).ok_or_else(|| format!("there is no buffer {}", view.buffer))?;
        let end = view.byte_offset.checked_add(view.byte_length).ok_or_else(short)?;
        let bytes = buffer.get(view.byte_offset..end).ok_or_else(short)?;
        let stride = view.byte_stride.unwrap_or(size * width);
        let mut all = Vec::with_capacity(width * accessor.count);
        for element in 0..accessor.count {
            let start = stride.checked_mul(element).and_then(|at| at.checked_add(accessor.byte_offset));
            let start = start.ok_or_else(short)?;
            let end = start.checked_add(size * width).ok_or_else(short)?;
            all.extend(bytes.get(start..end).ok_or_else(short)?.chunks_exact(size).map(&read));
        }
        Ok(all)
    }
}

/// The size of a component (bytes), and how it is read.
fn component(accessor: &Accessor) -> Option<(usize, impl Fn(&[u8]) -> f64 + use<>)> {
    let (size, most) = match accessor.component_type {
        5120 => (1, f64::from(i8::MAX)),
        5121 => (1, f64::from(u8::MAX)),
        5122 => (2, f64::from(i16::MAX)),
        5123 => (2, f64::from(u16::MAX)),
        5125 | 5126 => (4, 1.0),
        _ => return None,
    };
    let (kind, share) = (accessor.component_type, if accessor.normalized { 1.0 / most } else { 1.0 });
    let read = move |b: &[u8]| match kind {
        5120 => (f64::from(b[0] as i8) * share).max(if share < 1.0 { -1.0 } else { f64::MIN }),
        5121 => f64::from(b[0]) * share,
        5122 => (f64::from(i16::from_le_bytes([b[0], b[1]])) * share).max(if share < 1.0 {
            -1.0
        } else {
            f64::MIN
        }),
        5123 => f64::from(u16::from_le_bytes([b[0], b[1]])) * share,
        5125 => f64::from(u32::from_le_bytes([b[0], b[1], b[2], b[3]])),
        _ => f64::from(f32::from_le_bytes([b[0], b[1], b[2], b[3]])),
    };
    Some((size, read))
}

/// The bytes of an address: in itself, or in a file beside.
fn named(address: &str, folder: &Path) -> Result<Vec<u8>, String> {
    if let Some(data) = address.strip_prefix("data:") {
        let (kind, text) = data.split_once(',').ok_or("a buffer's `data:` has no comma")?;
        return if kind.ends_with(";base64") {
            base64(text).ok_or_else(|| "a buffer's `data:` is no base64".into())
        } else {
            Err("a buffer's `data:` is not base64".into())
        };
    }
    if address.contains("://") {
        return Err(format!(
            "its buffer is `{address}`, and nothing is fetched; download it beside the file"
        ));
    }
    let paths = [folder.join(address), folder.join(decoded(address))];
    let path = paths.iter().find(|path| path.is_file()).unwrap_or(&paths[0]);
    regrasp_api::read_at_most(path, MAX_BYTES)
        .map_err(|error| format!("its buffer `{}` cannot be read: {error}", path.display()))
}

/// RFC 4648, section 4.
fn base64(text: &str) -> Option<Vec<u8>> {
    let value = |byte: u8| match byte {
        b'A'..=b'Z' => Some(byte - b'A'),
        b'a'..=b'z' => Some(byte - b'a' + 26),
        b'0'..=b'9' => Some(byte - b'0' + 52),
        b'+' => Some(62),
        b'/' => Some(63),
        _ => None,
    };
    let digits = text.trim_end_matches('=').bytes().filter(|byte| !byte.is_ascii_whitespace());
    let (mut out, mut held, mut bits) = (Vec::with_capacity(text.len() / 4 * 3), 0_u32, 0);
    for digit in digits {
        held = held << 6 | u32::from(value(digit)?);
        bits += 6;
        if bits >= 8 {
            bits -= 8;
            out.push((held >> bits) as u8);
            held &= (1 << bits) - 1;
        }
    }
    Some(out)
}
