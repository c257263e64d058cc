//! The facets cut into smaller ones: the heat method is as exact as its mesh is fine.

use crate::polyhedron::{Place, Polyhedron};
use crate::rolling::Spot;
use regrasp_api::{Mesh, MeshError, Vec3};
use std::collections::BTreeMap;

/// A mesh whose every facet was cut into 4^levels similar ones.
#[derive(Clone, Debug)]
pub(super) struct Fine {
    pub polyhedron: Polyhedron,
    levels: u32,
    /// The connected part that each facet belongs to.
    parts: Vec<u32>,
}

/// A point of a fine facet.
#[derive(Clone, Copy, Debug)]
pub(super) struct FinePoint {
    pub facet: u32,
    /// Barycentric coordinates.
    pub weights: [f64; 3],
}

impl Fine {
    /// Cuts the facets until there are at least `fewest`.
    pub fn new(mesh: &Mesh, fewest: usize) -> Result<Self, MeshError> {
        let (mut vertices, mut facets) = (mesh.vertices().to_vec(), mesh.facets().to_vec());
        let mut levels = 0;
        while facets.len() < fewest {
            facets = cut(&mut vertices, &facets);
            levels += 1;
        }
        let polyhedron = Polyhedron::new(&Mesh::new(vertices, facets)?);
        Ok(Self { parts: parts(&polyhedron), polyhedron, levels })
    }

    /// The facet that a fine facet was cut from.
    pub fn parent(&self, facet: u32) -> u32 {
        facet >> (2 * self.levels)
    }

    /// Whether two fine facets belong to one connected part.
    pub fn connected(&self, a: u32, b: u32) -> bool {
        self.parts[a as usize] == self.parts[b as usize]
    }

    /// Where a place of the coarse mesh lies on the fine one.
    pub fn locate(&self, coarse: &Polyhedron, spot: &Spot) -> FinePoint {
        let mut facet = match spot.place {
            Place::Facet(facet) => facet,
            Place::Edge(edge) => edge / 3,
            Place::Vertex(vertex) => coarse.outgoing[vertex as usize] / 3,
        };
        let mut weights = barycentric(coarse, facet, &spot.contact.p_OC);
        for _ in 0..self.levels {
            let corner = weights.iter().position(|&weight| weight >= 0.5);
            facet = 4 * facet + corner.unwrap_or(3) as u32;
            let [a, b, c] = weights;
            weights = match corner {
                Some(0) => [a - b - c, 2.0 * b, 2.0 * c],
                Some(1) => [b - c - a, 2.0 * c, 2.0 * a],
                Some(_) => [c - a - b, 2.0 * a, 2.0 * b],
                None => [1.0 - 2.0 * c, 1.0 - 2.0 * a, 1.0 - 2.0 * b],
            };
        }
        FinePoint { facet, weights }
    }
}

/// Barycentric coordinates of a point of a facet.
fn barycentric(polyhedron: &Polyhedron, facet: u32, p_OP: &Vec3) -> [f64; 3] {
    let weight = |k: u32| {
        let opposite = &polyhedron.half_edges[(3 * facet + (k + 1) % 3) as usize];
        let up = polyhedron.mesh.normal(facet).cross(&opposite.along_O);
        (up.dot(&(p_OP - opposite.p_OE)) / opposite.apex[1]).clamp(0.0, 1.0)
    };
    let weights = [0, 1, 2].map(weight);
    let sum: f64 = weights.iter().sum();
    weights.map(|weight| weight / sum)
}

/// Every facet in four: three at its corners, then the middle one.
fn cut(vertices: &mut Vec<Vec3>, facets: &[[u32; 3]]) -> Vec<[u32; 3]> {
    let mut middles = BTreeMap::new();
    let mut middle = |a: u32, b: u32| {
        *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
            vertices.push((vertices[a as usize] + vertices[b as usize]) / 2.0);
            vertices.len() as u32 - 1
        })
    };
    let pieces = facets.iter().flat_map(|&[a, b, c]| {
        let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
        [[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]
    });
    pieces.collect()
}

/// Numbers the connected parts of a mesh.
fn parts(polyhedron: &Polyhedron) -> Vec<u32> {
    let count = polyhedron.mesh.facets().len();
    let mut parts = vec![u32::MAX; count];
    let mut waiting = Vec::new();
    for first in 0..count as u32 {
        waiting.push(first);
        while let Some(facet) = waiting.pop() {
            if parts[facet as usize] == u32::MAX {
                parts[facet as usize] = first;
                let across =
                    (3 * facet..3 * facet + 3).map(|edge| polyhedron.half_edges[edge as usize].twin / 3);
                waiting.extend(across.filter(|&facet| parts[facet as usize] == u32::MAX));
            }
        }
    }
    parts
}
