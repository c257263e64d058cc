//! Meshes of a scene put together, each with its transform: bounded, however often a file uses them again.

use super::{Raw, check_count};
use nalgebra::{Matrix4, Point3};
use regrasp_api::{MAX_FACETS, Vec3};

/// How deep nodes may lie in nodes: deeper ones hold each other in a circle.
const DEEPEST: usize = 64;
/// How many nodes are looked at, those that are used again counted again.
const MOST_NODES: usize = 100_000;
/// How many meshes may be added, those that are used again counted again.
const MOST_MESHES: usize = 100_000;
/// How many vertices may be gathered: as many as facets that share none.
const MOST_VERTICES: usize = 3 * MAX_FACETS;
/// Angles are within so many turns.
pub(super) const MOST_TURNS: f64 = 100.0;

/// What was gathered so far.
#[derive(Default)]
pub(super) struct Gathered {
    pub raw: Raw,
    nodes: usize,
    meshes: usize,
}

impl Gathered {
    /// Counts a node that lies so deep in others.
    pub(super) fn enter(&mut self, depth: usize) -> Result<(), String> {
        self.nodes += 1;
        if depth > DEEPEST {
            return Err(format!("nodes lie more than {DEEPEST} deep in each other"));
        }
        if self.nodes > MOST_NODES {
            return Err(format!("the scene has more than {MOST_NODES} nodes"));
        }
        Ok(())
    }

    /// Adds a mesh with a transform; one that mirrors turns the facets round.
    pub(super) fn add(&mut self, (vertices, facets): &Raw, transform: &Matrix4<f64>) -> Result<(), String> {
        let (all_vertices, all_facets) = &mut self.raw;
        check_count(all_facets.len() + facets.len())?;
        self.meshes += 1;
        if self.meshes > MOST_MESHES || all_vertices.len() + vertices.len() > MOST_VERTICES {
            return Err(format!(
                "the scene uses meshes more than {MOST_MESHES} times, or gathers more than {MOST_VERTICES} \
                 vertices; simplify it"
            ));
        }
        if facets.is_empty() {
            return Ok(());
        }
        let first = all_vertices.len() as u32;
        let moved = |v: &Vec3| transform.transform_point(&Point3::from(*v)).coords;
        all_vertices.extend(vertices.iter().map(moved));
        let mirrors = transform.fixed_view::<3, 3>(0, 0).determinant() < 0.0;
        let placed = |f: &[u32; 3]| if mirrors { [f[0], f[2], f[1]] } else { *f }.map(|v| first + v);
        all_facets.extend(facets.iter().map(placed));
        Ok(())
    }
}
