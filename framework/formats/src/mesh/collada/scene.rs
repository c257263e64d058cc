//! The nodes of the visual scene, and what hangs on them where.

use super::super::{Raw, check_count};
use super::{Element, File, child, children, geometry, numbers, place};
use nalgebra::{Matrix4, Point3, Rotation3, Unit};
use regrasp_api::{MAX_FACETS, Vec3};
use std::collections::BTreeMap;

/// How deep nodes may lie in nodes: deeper ones instance each other in a circle.
const DEEPEST: usize = 64;
/// How many nodes are looked at, those that are instanced again counted again.
const MOST_NODES: usize = 100_000;
/// How many geometries may be added, those that are instanced again counted again.
const MOST_INSTANCES: usize = 100_000;
/// How many vertices may be gathered: as many as facets that share none.
const MOST_VERTICES: usize = 3 * MAX_FACETS;

/// Everything in the scene that the file shows, in the file's unit.
pub(super) fn read(file: &File<'_>) -> Result<Raw, String> {
    let mut reader =
        Reader { file, nodes: 0, instances: 0, known: BTreeMap::new(), all: (Vec::new(), Vec::new()) };
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
    Ok(reader.all)
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
    /// Nodes looked at so far.
    nodes: usize,
    /// Geometries added so far, those that come again counted again.
    instances: usize,
    /// Geometries that were read, by where they stand in the file.
    known: BTreeMap<usize, Raw>,
    all: Raw,
}

impl<'a> Reader<'_, 'a> {
    fn node(&mut self, node: Element<'a>, above: &Matrix4<f64>, depth: usize) -> Result<(), String> {
        if depth > DEEPEST {
            return Err(format!("{}: nodes lie more than {DEEPEST} deep in each other", place(node)));
        }
        self.nodes += 1;
        if self.nodes > MOST_NODES {
            return Err(format!("the scene has more than {MOST_NODES} nodes"));
        }
        let transform = above * transform(node)?;
        for element in node.children().filter(|child| child.is_element()) {
            match element.tag_name().name() {
                "node" => self.node(element, &transform, depth + 1)?,
                "instance_node" => self.node(self.file.target(element, "url")?, &transform, depth + 1)?,
                "instance_geometry" => self.add(self.file.target(element, "url")?, &transform)?,
                _ => {}
            }
        }
        Ok(())
    }

    /// Adds a geometry with a transform; one that mirrors turns the facets round.
    fn add(&mut self, geometry: Element<'a>, transform: &Matrix4<f64>) -> Result<(), String> {
        let key = geometry.range().start;
        if !self.known.contains_key(&key) {
            let read = geometry::read(self.file, geometry)?;
            self.known.insert(key, read);
        }
        let (vertices, facets) = &self.known[&key];
        check_count(self.all.1.len() + facets.len())?;
        self.instances += 1;
        if self.instances > MOST_INSTANCES || self.all.0.len() + vertices.len() > MOST_VERTICES {
            return Err(format!(
                "the scene instances geometries more than {MOST_INSTANCES} times, or gathers more than \
                 {MOST_VERTICES} vertices; \
                 simplify it"
            ));
        }
        if facets.is_empty() {
            return Ok(());
        }
        let first = self.all.0.len() as u32;
        let moved = |v: &Vec3| transform.transform_point(&Point3::from(*v)).coords;
        self.all.0.extend(vertices.iter().map(moved));
        let mirrors = transform.fixed_view::<3, 3>(0, 0).determinant() < 0.0;
        let placed = |f: &[u32; 3]| if mirrors { [f[0], f[2], f[1]] } else { *f }.map(|v| first + v);
        self.all.1.extend(facets.iter().map(placed));
        Ok(())
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
            "matrix" => Matrix4::from_row_slice(&read(16)?),
            "translate" => Matrix4::new_translation(&Vec3::from_row_slice(&read(3)?)),
            "scale" => Matrix4::new_nonuniform_scaling(&Vec3::from_row_slice(&read(3)?)),
            "rotate" => {
                let values = read(4)?;
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
