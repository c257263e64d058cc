//! NumPy arrays in one uncompressed archive, written as a stream: one pass over the grasps for each array.

use super::Set;
use super::columns::{Column, columns};
use crate::grasp::BulkGrasp;
use regrasp_export::{joint_names, npy_header};
use std::io::{self, Write};
use zip::CompressionMethod;
use zip::write::{SimpleFileOptions, StreamWriter, ZipWriter};

/// Archives from this size on (bytes) need the wide form of the format.
const WIDE: u64 = u32::MAX as u64;

/// Writes the set; let G, F, J and E be the numbers of grasps, fingers, joints and regrasps. What does not
/// exist is NaN, or -1 among whole numbers.
///
/// | array | shape | what it holds |
/// |---|---|---|
/// | `grasps_info` | () | JSON text: scenario, object, hand, plugins, seed, spread, versions |
/// | `grasps_problem` | () | JSON text: the whole problem, as a plan file without motion |
/// | `finger_names`, `joint_names` | (F), (J) | texts |
/// | `pose` | (G) | number of the pose that was drawn |
/// | `object_position`, `object_orientation` | (G, 3), (G, 4) | in the hand's frame: m; w, x, y, z |
/// | `joints` | (G, J) | rad; m where prismatic |
/// | `holding`, `liftable` | (G, F) | which fingers hold; which of these may be lifted |
/// | `facet` | (G, F) | the facet that a finger touches |
/// | `contact_point_O`, `contact_normal_O` | (G, F, 3) | in the object's frame: m; outward |
/// | `force_O`, `efforts` | (G, F, 3), (G, J) | what holds the weight: N on the object, in O; N·m |
/// | `margin` | (G) | the verifier's certified margin |
/// | `clearance` | (G) | smallest distance of bodies that may not touch (m) |
/// | `friction`, `effort_share` | (G) | friction that the forces need; largest share of an effort limit |
/// | `edges`, `edge_finger` | (E, 2), (E) | regrasps: two grasps of one pose, and the finger that moves |
///
/// Grasps of one pose differ in fingers and contacts alone; `edges` are there where they were asked for.
pub fn npz(set: &Set<'_>, out: &mut dyn Write) -> io::Result<()> {
    let mut archive = Archive::stream(out);
    archive.texts("grasps_info", None, &[set.info])?;
    archive.texts("grasps_problem", None, &[set.problem])?;
    let fingers: Vec<&str> = set.hand.finger.iter().map(|finger| finger.name.as_str()).collect();
    archive.texts("finger_names", Some(fingers.len()), &fingers)?;
    let names = joint_names(set.hand);
    let joints: Vec<&str> = names.iter().map(String::as_str).collect();
    archive.texts("joint_names", Some(joints.len()), &joints)?;
    for column in columns(set.layout) {
        archive.column(set, &column)?;
    }
    if let Some(edges) = set.edges {
        archive.edges(set, edges as usize)?;
    }
    archive.finish()
}

/// An archive that is written as a stream.
pub(super) struct Archive<'w>(ZipWriter<StreamWriter<&'w mut dyn Write>>);

impl<'w> Archive<'w> {
    pub fn stream(out: &'w mut dyn Write) -> Self {
        Self(ZipWriter::new_stream(out))
    }

    pub fn finish(self) -> io::Result<()> {
        self.0.finish()?;
        Ok(())
    }

    /// Begins an array; its values follow.
    pub fn begin(&mut self, name: &str, kind: &str, shape: &[usize], width: usize) -> io::Result<()> {
        let size = shape.iter().product::<usize>() as u64 * width as u64;
        // No time of writing: the same grasps give the same bytes.
        let options = SimpleFileOptions::default()
            .compression_method(CompressionMethod::Stored)
            .last_modified_time(zip::DateTime::default())
            .large_file(size >= WIDE);
        self.0.start_file(format!("{name}.npy"), options)?;
        self.0.write_all(&npy_header(kind, shape))
    }

    /// Texts, each padded to the longest, four bytes a character; one text alone where there is no `count`.
    pub fn texts(&mut self, name: &str, count: Option<usize>, texts: &[&str]) -> io::Result<()> {
        let longest = texts.iter().map(|text| text.chars().count()).max().unwrap_or(0).max(1);
        let shape: Vec<usize> = count.into_iter().collect();
        self.begin(name, &format!("<U{longest}"), &shape, 4 * longest)?;
        let padded = texts.iter().flat_map(|text| text.chars().chain(std::iter::repeat('\0')).take(longest));
        let bytes: Vec<u8> = padded.flat_map(|c| u32::from(c).to_le_bytes()).collect();
        self.0.write_all(&bytes)
    }

    fn column(&mut self, set: &Set<'_>, column: &Column) -> io::Result<()> {
        let shape = [&[set.grasps as usize], &column.shape[..]].concat();
        self.begin(column.name, column.kind, &shape, 8)?;
        self.fill(set, column.put)
    }

    /// One pass over the grasps.
    pub fn fill(&mut self, set: &Set<'_>, put: fn(&BulkGrasp, &mut Vec<u8>)) -> io::Result<()> {
        let mut bytes = Vec::new();
        set.rows.each(&mut |grasp| {
            put(grasp, &mut bytes);
            if bytes.len() < 1 << 16 {
                return Ok(());
            }
            self.0.write_all(&bytes)?;
            bytes.clear();
            Ok(())
        })?;
        self.0.write_all(&bytes)
    }

    fn edges(&mut self, set: &Set<'_>, count: usize) -> io::Result<()> {
        self.begin("edges", "<i8", &[count, 2], 8)?;
        set.rows.each_edge(&mut |edge| {
            self.0.write_all(&edge.from.to_le_bytes())?;
            self.0.write_all(&edge.to.to_le_bytes())
        })?;
        self.begin("edge_finger", "<i8", &[count], 8)?;
        set.rows.each_edge(&mut |edge| self.0.write_all(&i64::from(edge.finger.0).to_le_bytes()))
    }
}
