//! The nodes of the visual scene, and what hangs on them where.

use super::super::Raw;
use super::super::gather::{Gathered, MOST_TURNS};
use super::{Element, File, child, children, geometry, numbers, place};
use nalgebra::{Matrix4, Rotation3, Unit};
use regrasp_api::Vec3;
use std::collections::BTreeMap;

/// Everything in the scene that the file shows, in the file's unit.
pub(super) fn read(file: &File<'_>) -> Result<Raw, String> {
    let mut reader = Reader { file, known: BTreeMap::new(), all: Gathered::default() };
    match shown(file)? {
        Some(scene) => {
            for node in children(scene, "node") {
                reader.node(node, &Matrix4::identity(), 0)?;
            }
        }
        None => {
            let libraries = children(file.root, "library_geometries");
            for geometry in libraries.flat_map(|library| children(library, "geometry")) {
                reader.add(geometry, &Matrix4::identity())?;
            }
        }
    }
    Ok(reader.all.raw)
}

/// The visual scene that `<scene>` names, or else the first one.
fn shown<'a>(file: &File<'a>) -> Result<Option<Element<'a>>, String> {
    let named = child(file.root, "scene").and_then(|scene| child(scene, "instance_visual_scene"));
    match named {
        Some(instance) => file.target(instance, "url").map(Some),
        None => {
            let library = child(file.root, "library_visual_scenes");
            Ok(library.and_then(|library| child(library, "visual_scene")))
        }
    }
}

struct Reader<'f, 'a> {
    file: &'f File<'a>,
    /// Geometries that were read, by where they stand in the file.
    known: BTreeMap<usize, Raw>,
    all: Gathered,
}

impl<'a> Reader<'_, 'a> {
    fn node(&mut self, node: Element<'a>, above: &Matrix4<f64>, depth: usize) -> Result<(), String> {
        self.all.enter(depth).map_err(|reason| format!("{}: {reason}", place(node)))?;
        let transform = above * transform(node)?;
        for element in node.children().filter(|child| child.is_element()) {
            match element.tag_name().name() {
                "node" => self.node(element, &transform, depth + 1)?,
                "instance_node" => self.node(self.file.target(element, "url")?, &transform, depth + 1)?,
                "instance_geometry" => self.add(self.file.target(element, "url")?, &transform)?,
                "instance_controller" => {
                    return Err(format!(
                        "{}: a skinned mesh; export it without its skeleton",
                        place(element)
                    ));
                }
                _ => {}
            }
        }
        Ok(())
    }

    /// Adds a geometry with a transform.
    fn add(&mut self, geometry: Element<'a>, transform: &Matrix4<f64>) -> Result<(), String> {
        let key = geometry.range().start;
        if !self.known.contains_key(&key) {
            let read = geometry::read(self.file, geometry)?;
            self.known.insert(key, read);
        }
        self.all.add(&self.known[&key], transform).map_err(|reason| format!("{}: {reason}", place(geometry)))
    }
}

/// The product of a node's transforms, in the order in which they stand.
fn transform(node: Element<'_>) -> Result<Matrix4<f64>, String> {
    let mut product = Matrix4::identity();
    for element in node.children().filter(|child| child.is_element()) {
        let read = |count: usize| -> Result<Vec<f64>, String> {
            let values = numbers::<f64>(element)?;
            if values.len() == count && values.iter().all(|x| x.is_finite()) {
                return Ok(values);
            }
            Err(format!("{} needs {count} finite numbers", place(element)))
        };
        product *= match element.tag_name().name() {
            "matrix" => affine(element, Matrix4::from_row_slice(&read(16)?))?,
            "translate" => Matrix4::new_translation(&Vec3::from_row_slice(&read(3)?)),
            "scale" => Matrix4::new_nonuniform_scaling(&Vec3::from_row_slice(&read(3)?)),
            "rotate" => {
                let values = read(4)?;
                if values[3].abs() > MOST_TURNS * 360.0 {
                    return Err(format!(
                        "{}: {}° is outside ±{}°",
                        place(element),
                        values[3],
                        MOST_TURNS * 360.0
                    ));
                }
                let axis = Unit::try_new(Vec3::from_row_slice(&values[..3]), 1e-12);
                let turn = |axis| Rotation3::from_axis_angle(&axis, values[3].to_radians()).to_homogeneous();
                axis.map_or_else(Matrix4::identity, turn)
            }
            "lookat" | "skew" => {
                return Err(format!("{} is not understood; convert the file to STL", place(element)));
            }
            _ => continue,
        };
    }
    Ok(product)
}

/// A matrix whose last row is 0 0 0 1.
fn affine(element: Element<'_>, matrix: Matrix4<f64>) -> Result<Matrix4<f64>, String> {
    let last = matrix.row(3) - nalgebra::RowVector4::new(0.0, 0.0, 0.0, 1.0);
    if last.amax() < 1e-9 {
        return Ok(matrix);
    }
    Err(format!("{}: its last row must be 0 0 0 1", place(element)))
}
