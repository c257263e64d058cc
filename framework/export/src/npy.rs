//! The motion as NumPy arrays in one uncompressed archive.
//!
//! The array format is version 1.0 of NumPy's own specification (numpy.lib.format): a magic number, a header
//! in Python's syntax, the values in row-major order.

use crate::table::{Row, Touch};
use crate::{ExportError, File, Scene};
use regrasp_api::Vec3;
use std::io::{Cursor, Write};
use zip::write::SimpleFileOptions;

/// One archive. Let T, F and J be the numbers of states, fingers and joints; what does not exist is NaN, or
/// -1 among whole numbers.
pub(crate) fn files(scene: &Scene<'_>, stem: &str) -> Result<Vec<File>, ExportError> {
    let mut archive = Archive::new();
    motion(scene, &mut archive)?;
    contacts(scene, &mut archive)?;
    Ok(vec![File { name: format!("{stem}.npz"), bytes: archive.finish()? }])
}

/// Times, segments, joints and the object's pose.
fn motion(scene: &Scene<'_>, archive: &mut Archive) -> Result<(), ExportError> {
    let rows: Vec<Row<'_>> = scene.rows().collect();
    let t = rows.len();
    let joints: Vec<&str> = scene.names.joints.iter().flatten().map(String::as_str).collect();
    let fingers: Vec<&str> = scene.description().finger.iter().map(|finger| finger.name.as_str()).collect();
    let segments: Vec<i64> = rows.iter().map(|row| row.segment as i64).collect();
    let moving: Vec<i64> =
        rows.iter().map(|row| row.moving().map_or(-1, |finger| i64::from(finger.0))).collect();
    let postures = rows.iter().flat_map(|row| row.q.joints.iter().flat_map(|(_, q)| q.to_vec()));
    archive.floats("time", &[t], rows.iter().map(|row| row.time))?;
    archive.whole("segment", &[t], &segments)?;
    archive.whole("moving_finger", &[t], &moving)?;
    archive.floats("joints", &[t, joints.len()], postures)?;
    let rates = rows.iter().flat_map(|row| row.velocities().unwrap_or(vec![f64::NAN; joints.len()]));
    archive.floats("velocities", &[t, joints.len()], rates)?;
    archive.texts("joint_names", &joints)?;
    archive.texts("finger_names", &fingers)?;
    archive.floats("object_position", &[t, 3], rows.iter().flat_map(|row| row.object().0))?;
    archive.floats("object_orientation", &[t, 4], rows.iter().flat_map(|row| row.object().1))
}

/// One vector of a touch, where there is one.
type Pick = fn(&Touch) -> Option<Vec3>;

/// Fingertips, contacts and forces.
fn contacts(scene: &Scene<'_>, archive: &mut Archive) -> Result<(), ExportError> {
    let rows: Vec<Row<'_>> = scene.rows().collect();
    let touches: Vec<Option<Touch>> =
        rows.iter().flat_map(|row| scene.fingers().map(|finger| scene.touch(row, finger))).collect();
    let (t, f) = (rows.len(), scene.origins.len());
    let tips = rows.iter().flat_map(|row| scene.fingers().map(|finger| scene.tip(row, finger)));
    archive.floats("tip_H", &[t, f, 3], tips.flat_map(|tip| three(Some(tip))))?;
    let vectors: [(&str, Pick); 5] = [
        ("contact_point_O", |touch| Some(touch.point_O)),
        ("contact_normal_O", |touch| Some(touch.normal_O)),
        ("contact_point_H", |touch| Some(touch.point_H)),
        ("contact_normal_H", |touch| Some(touch.normal_H)),
        ("force_H", |touch| Some(touch.exerted?.force)),
    ];
    for (name, pick) in vectors {
        archive.floats(
            name,
            &[t, f, 3],
            touches.iter().flat_map(|touch| three(touch.as_ref().and_then(pick))),
        )?;
    }
    let spin =
        |touch: &Option<Touch>| touch.as_ref().and_then(|touch| touch.exerted).map_or(f64::NAN, |e| e.spin);
    archive.floats("torque_about_normal", &[t, f], touches.iter().map(spin))?;
    archive.floats("force_margin", &[t], (0..t).map(|state| scene.forces.margin(state).unwrap_or(f64::NAN)))
}

/// Coordinates, NaN where there are none.
pub(crate) fn three(vector: Option<Vec3>) -> [f64; 3] {
    vector.map_or([f64::NAN; 3], Into::into)
}

/// An archive of arrays in memory.
pub(crate) struct Archive(zip::ZipWriter<Cursor<Vec<u8>>>);

impl Archive {
    pub fn new() -> Self {
        Self(zip::ZipWriter::new(Cursor::new(Vec::new())))
    }

    /// 64-bit floating-point numbers.
    pub fn floats(
        &mut self,
        name: &str,
        shape: &[usize],
        values: impl IntoIterator<Item = f64>,
    ) -> Result<(), ExportError> {
        let bytes: Vec<u8> = values.into_iter().flat_map(f64::to_le_bytes).collect();
        self.array(name, "<f8", shape, &bytes)
    }

    /// 64-bit whole numbers.
    pub fn whole(&mut self, name: &str, shape: &[usize], values: &[i64]) -> Result<(), ExportError> {
        let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
        self.array(name, "<i8", shape, &bytes)
    }

    /// Texts, each padded to the longest, four bytes a character.
    pub fn texts(&mut self, name: &str, texts: &[&str]) -> Result<(), ExportError> {
        let longest = texts.iter().map(|text| text.chars().count()).max().unwrap_or(0).max(1);
        let padded = texts.iter().flat_map(|text| text.chars().chain(std::iter::repeat('\0')).take(longest));
        let bytes: Vec<u8> = padded.flat_map(|c| u32::from(c).to_le_bytes()).collect();
        self.array(name, &format!("<U{longest}"), &[texts.len()], &bytes)
    }

    fn array(&mut self, name: &str, kind: &str, shape: &[usize], values: &[u8]) -> Result<(), ExportError> {
        // No time of writing: the same plan gives the same bytes.
        let options = SimpleFileOptions::default()
            .compression_method(zip::CompressionMethod::Stored)
            .last_modified_time(zip::DateTime::default());
        self.0.start_file(format!("{name}.npy"), options)?;
        self.0.write_all(&npy_header(kind, shape))?;
        self.0.write_all(values)?;
        Ok(())
    }

    pub fn finish(self) -> Result<Vec<u8>, ExportError> {
        Ok(self.0.finish()?.into_inner())
    }
}

/// Everything before the values of an array of `kind`, NumPy's word for its type: magic number, version 1.0,
/// length, description; padded so that the values begin at a multiple of 64 bytes.
pub fn npy_header(kind: &str, shape: &[usize]) -> Vec<u8> {
    let shape: String = shape.iter().map(|length| format!("{length}, ")).collect();
    let text = format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': ({}), }}", shape.trim_end());
    let before = 10;
    let padded = (before + text.len() + 1).next_multiple_of(64);
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend(((padded - before) as u16).to_le_bytes());
    bytes.extend(text.as_bytes());
    bytes.resize(padded - 1, b' ');
    bytes.push(b'\n');
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn headers_end_at_multiples_of_64_bytes() {
        for shape in [&[][..], &[7], &[2000, 4, 3]] {
            let header = npy_header("<f8", shape);
            assert_eq!(header.len() % 64, 0);
            assert_eq!(header.last(), Some(&b'\n'));
        }
        assert!(String::from_utf8_lossy(&npy_header("<f8", &[7])).contains("'shape': (7,), }"));
    }
}
