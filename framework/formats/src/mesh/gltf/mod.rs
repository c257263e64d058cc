//! glTF and GLB: the triangles of the scene that the file shows, in metres.
//!
//! Format: "glTF 2.0 Specification", Khronos Group, ISO/IEC 12113:2022. Read are meshes of triangles, strips
//! and fans with their positions, the nodes of the scene with their transforms, and buffers in the file, in
//! `data:` addresses and in files beside it. Coordinates stay as they are: the file's y-axis points up.
//! Materials, skins and animations are ignored; compressed meshes are refused.

mod buffers;
mod document;

use super::Raw;
use super::gather::Gathered;
use buffers::Buffers;
use document::{Document, Node, Primitive};
use nalgebra::{Matrix4, Quaternion, UnitQuaternion};
use regrasp_api::Vec3;
use std::collections::BTreeMap;
use std::path::Path;

/// Extensions without which a mesh is still what it is.
const HARMLESS: [&str; 3] = ["KHR_materials_", "KHR_texture_transform", "KHR_mesh_quantization"];

/// The scene's triangles; `folder` is where further files are looked for.
pub(super) fn parse(bytes: &[u8], folder: &Path) -> Result<Raw, String> {
    let (text, binary) = if bytes.starts_with(b"glTF") { chunks(bytes)? } else { (bytes, None) };
    let document: Document =
        serde_json::from_slice(text).map_err(|error| format!("no glTF that can be read: {error}"))?;
    let harmless = |name: &&String| !HARMLESS.iter().any(|known| name.starts_with(known));
    if let Some(name) = document.extensions_required.iter().find(harmless) {
        return Err(format!(
            "it needs the extension `{name}`, which is not read; export it without compression"
        ));
    }
    if !document.asset.version.starts_with("2.") {
        return Err(format!("it is glTF {}, and 2.0 is read", document.asset.version));
    }
    let buffers = Buffers::new(&document, binary, folder)?;
    let mut reader =
        Reader { document: &document, buffers, known: BTreeMap::new(), all: Gathered::default() };
    for &node in reader.roots()? {
        reader.node(node, &Matrix4::identity(), 0)?;
    }
    Ok(reader.all.raw)
}

/// The chunks of a GLB: its JSON, and its buffer where it has one.
fn chunks(bytes: &[u8]) -> Result<(&[u8], Option<&[u8]>), String> {
    let word = |at: usize| {
        let bytes: [u8; 4] = bytes.get(at..at + 4)?.try_into().ok()?;
        Some(u32::from_le_bytes(bytes) as usize)
    };
    let chunk = |at: usize, kind: &[u8; 4]| {
        let length = word(at)?;
        (bytes.get(at + 4..at + 8)? == kind).then_some(())?;
        bytes.get(at + 8..(at + 8).checked_add(length)?)
    };
    if word(4) != Some(2) {
        return Err("it is a GLB of another version than 2".into());
    }
    let text = chunk(12, b"JSON").ok_or("its first part is no JSON, or the file is truncated")?;
    let binary = chunk(20 + text.len(), b"BIN\0");
    Ok((text, binary))
}

struct Reader<'d> {
    document: &'d Document,
    buffers: Buffers<'d>,
    /// Meshes that were read.
    known: BTreeMap<usize, Raw>,
    all: Gathered,
}

impl<'d> Reader<'d> {
    /// The nodes of the scene that is shown.
    fn roots(&self) -> Result<&'d [usize], String> {
        let number = self.document.scene.unwrap_or(0);
        let scene = self.document.scenes.get(number);
        scene.map(|scene| &scene.nodes[..]).ok_or_else(|| format!("there is no scene {number}"))
    }

    fn node(&mut self, index: usize, above: &Matrix4<f64>, depth: usize) -> Result<(), String> {
        self.all.enter(depth)?;
        let document = self.document;
        let node = document.nodes.get(index).ok_or_else(|| format!("there is no node {index}"))?;
        let transform = above * transform(node);
        if let Some(mesh) = node.mesh {
            if !self.known.contains_key(&mesh) {
                let read = self.mesh(mesh)?;
                self.known.insert(mesh, read);
            }
            self.all.add(&self.known[&mesh], &transform)?;
        }
        node.children.iter().try_for_each(|&child| self.node(child, &transform, depth + 1))
    }

    /// The triangles of a mesh.
    fn mesh(&self, index: usize) -> Result<Raw, String> {
        let mesh = self.document.meshes.get(index).ok_or_else(|| format!("there is no mesh {index}"))?;
        let (mut vertices, mut facets) = (Vec::new(), Vec::new());
        for primitive in &mesh.primitives {
            let first = vertices.len() as u32;
            let Some(position) = primitive.attributes.get("POSITION") else { continue };
            let points = self.buffers.points(*position)?;
            let count = points.len() as u32;
            vertices.extend(points);
            let corners = match primitive.indices {
                Some(accessor) => self.buffers.indices(accessor)?,
                None => (0..count).collect(),
            };
            if let Some(bad) = corners.iter().find(|&&corner| corner >= count) {
                return Err(format!("mesh {index}: corner {bad} of only {count}"));
            }
            facets.extend(triangles(primitive, &corners).into_iter().map(|f| f.map(|v| first + v)));
            super::check_count(facets.len())?;
        }
        Ok((vertices, facets))
    }
}

/// The triangles that corners form; none where they form points or lines.
fn triangles(primitive: &Primitive, corners: &[u32]) -> Vec<[u32; 3]> {
    match primitive.mode {
        4 => corners.chunks_exact(3).map(|w| [w[0], w[1], w[2]]).collect(),
        5 => {
            let turned =
                |(i, w): (usize, &[u32])| if i % 2 == 0 { [w[0], w[1], w[2]] } else { [w[1], w[0], w[2]] };
            corners.windows(3).enumerate().map(turned).collect()
        }
        6 if corners.len() > 2 => corners[1..].windows(2).map(|w| [corners[0], w[0], w[1]]).collect(),
        _ => Vec::new(),
    }
}

/// A node's own transform.
fn transform(node: &Node) -> Matrix4<f64> {
    if let Some(columns) = node.matrix {
        let mut matrix = Matrix4::from_column_slice(&columns);
        // Whatever stands in the last row: nodes are affine.
        matrix.set_row(3, &nalgebra::RowVector4::new(0.0, 0.0, 0.0, 1.0));
        return matrix;
    }
    let [x, y, z, w] = node.rotation.unwrap_or([0.0, 0.0, 0.0, 1.0]);
    let turn = UnitQuaternion::try_new(Quaternion::new(w, x, y, z), 1e-12).unwrap_or_default();
    let shift = Vec3::from(node.translation.unwrap_or_default());
    let scale = Vec3::from(node.scale.unwrap_or([1.0; 3]));
    Matrix4::new_translation(&shift) * turn.to_homogeneous() * Matrix4::new_nonuniform_scaling(&scale)
}
