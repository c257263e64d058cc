//! Meshes as the page draws them: no more facets than a page can bear.

use crate::ViewError;
use crate::number::nano;
use regrasp_api::{Mesh, Shape, Vec3};
use regrasp_world::shape_mesh;
use serde::Serialize;

/// The most facets of one page (some 1.5 MB). Scenes with more are drawn with fewer.
const MOST_FACETS: usize = 40_000;
/// No mesh is drawn with fewer facets than this only because others have many.
const FEWEST_FACETS: usize = 500;
/// The finest grid that is tried, in cells along the longest edge of a mesh's box.
const FINEST_GRID: f64 = 1024.0;

/// A mesh, flattened.
#[derive(Serialize)]
pub(crate) struct MeshData {
    vertices: Vec<f64>,
    facets: Vec<u32>,
    /// How many facets the mesh has in truth.
    count: usize,
}

impl MeshData {
    pub(crate) fn new(mesh: &Mesh) -> Self {
        let vertices = mesh.vertices().iter().flat_map(|v| [nano(v.x), nano(v.y), nano(v.z)]).collect();
        Self { vertices, facets: mesh.facets().concat(), count: mesh.facets().len() }
    }

    /// The vertices that are drawn.
    pub(crate) fn points(&self) -> Vec<Vec3> {
        self.vertices.chunks_exact(3).map(Vec3::from_column_slice).collect()
    }

    /// What is drawn of a shape by its facets.
    pub(crate) fn of_shape(shape: &Shape, key: &str) -> Result<Self, ViewError> {
        // A plan stands alone: its meshes are inside, and no folder is looked into.
        Ok(Self::new(&shape_mesh(shape, key)?))
    }

    /// Draws with at most `most` facets, on the finest grid that does it: the vertices of one cell become one
    /// (J. Rossignac, P. Borrel, "Multi-resolution 3D approximations for rendering complex scenes", in
    /// Modeling in Computer Graphics, 1993).
    fn thin(&mut self, most: usize) {
        if self.count <= most {
            return;
        }
        // A closed surface that crosses the grid has some 6 to 12 facets for each square of cells.
        let mut cells = (most as f64).sqrt().min(FINEST_GRID);
        loop {
            let (vertices, facets) = self.clustered(cells);
            if facets.len() <= 3 * most || cells < 2.0 {
                (self.vertices, self.facets) = (vertices, facets);
                return;
            }
            cells *= 0.85;
        }
    }

    /// The mean vertex of each cell, and the facets between different cells.
    fn clustered(&self, cells: f64) -> (Vec<f64>, Vec<u32>) {
        let points = || self.vertices.chunks_exact(3);
        let end = |start: f64, pick: fn(f64, f64) -> f64| {
            [0, 1, 2].map(|k| points().map(|p| p[k]).fold(start, pick))
        };
        let (low, high) = (end(f64::INFINITY, f64::min), end(f64::NEG_INFINITY, f64::max));
        let edge = (0..3).map(|k| high[k] - low[k]).fold(1e-9, f64::max) / cells;
        let cell = |p: &[f64]| [0, 1, 2].map(|k| ((p[k] - low[k]) / edge) as u32);
        let keys: Vec<[u32; 3]> = points().map(cell).collect();
        let mut known = keys.clone();
        known.sort_unstable();
        known.dedup();
        let index = |key: &[u32; 3]| known.binary_search(key).expect("every vertex's cell is among them");
        let places: Vec<usize> = keys.iter().map(index).collect();
        let mut sums = vec![[0.0; 4]; known.len()];
        for (p, &place) in points().zip(&places) {
            let sum = &mut sums[place];
            (0..3).for_each(|k| sum[k] += p[k]);
            sum[3] += 1.0;
        }
        let vertices = sums.iter().flat_map(|s| [0, 1, 2].map(|k| nano(s[k] / s[3]))).collect();
        let facets = self.facets.chunks_exact(3).map(|f| [0, 1, 2].map(|k| places[f[k] as usize] as u32));
        let facets = facets.filter(|[a, b, c]| a != b && b != c && c != a);
        (vertices, facets.flatten().collect())
    }
}

/// Draws the meshes of a scene with at most as many facets as a page can bear, each with its share of them.
pub(crate) fn thin<'m>(meshes: impl Iterator<Item = &'m mut MeshData>) {
    let mut meshes: Vec<&mut MeshData> = meshes.collect();
    let total: usize = meshes.iter().map(|mesh| mesh.count).sum();
    if total > MOST_FACETS {
        for mesh in &mut meshes {
            let share = MOST_FACETS as f64 * mesh.count as f64 / total as f64;
            mesh.thin((share as usize).max(FEWEST_FACETS));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use regrasp_api::Primitive;

    fn ball(facets: usize) -> MeshData {
        MeshData::new(&regrasp_world::primitive_mesh(&Primitive::Sphere { radius: 0.03 }, facets).unwrap())
    }

    #[test]
    fn large_meshes_are_drawn_with_fewer_facets_that_stay_near_and_closed() {
        let mut meshes = [ball(80_000), ball(320)];
        thin(meshes.iter_mut());
        let [large, small] = &meshes;
        assert!(
            large.count >= 80_000
                && large.facets.len() / 3 <= MOST_FACETS
                && large.facets.len() / 3 > MOST_FACETS / 4
        );
        assert_eq!(small.facets.len(), 3 * small.count, "a small one keeps its own");
        for p in large.vertices.chunks_exact(3) {
            let radius = p.iter().map(|x| x * x).sum::<f64>().sqrt();
            assert!((radius - 0.03).abs() < 2e-4, "{radius}");
        }
        // Every edge is used as often in one direction as in the other.
        let mut balance = std::collections::BTreeMap::new();
        for f in large.facets.chunks_exact(3) {
            for (a, b) in [(f[0], f[1]), (f[1], f[2]), (f[2], f[0])] {
                *balance.entry((a.min(b), a.max(b))).or_insert(0) += if a < b { 1 } else { -1 };
            }
        }
        assert!(balance.values().all(|&sum| sum == 0));
    }

    #[test]
    fn meshes_within_the_budget_stay_as_they_are() {
        let mut meshes = [ball(1280), ball(320)];
        let before = meshes.iter().map(|mesh| mesh.vertices.clone()).collect::<Vec<_>>();
        thin(meshes.iter_mut());
        assert!(meshes.iter().zip(before).all(|(mesh, before)| mesh.vertices == before));
    }
}
