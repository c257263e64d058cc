//! Distance to the nearest sharp edge.

use crate::bvh::{Hierarchy, Thing};
use crate::polyhedron::Polyhedron;
use regrasp_api::{Mesh, Vec3};

/// The edges whose facets meet at more than an angle.
#[derive(Clone, Debug)]
pub(crate) struct SharpEdges {
    ends: Vec<(Vec3, Vec3)>,
    hierarchy: Hierarchy,
    /// For each facet the edge nearest to its middle: the first bound of a search.
    nearest: Vec<u32>,
}

/// What lies at most this far (fingertip radii) from an edge tells whether the surface bends there, beside
/// its two facets: a scanner's noise bends nearly every edge.
const SCALE: f64 = 0.3;

impl SharpEdges {
    /// Collects the edges that bend by more than `angle` (rad), by themselves and at the scale of a fingertip
    /// of a radius (m).
    pub fn new(polyhedron: &Polyhedron, angle: f64, radius: f64) -> Self {
        let mesh = &polyhedron.mesh;
        let mut around = Around::new(mesh, SCALE * radius);
        let mut is_sharp = |index: usize| {
            let (facet, side) = (index as u32 / 3, index % 3);
            mesh.neighbors(facet)[side].bend.abs() > angle
                && index < polyhedron.half_edges[index].twin as usize
                && around.bend(facet, side) > angle
        };
        let ends: Vec<_> = (0..polyhedron.half_edges.len())
            .filter(|&index| is_sharp(index))
            .map(|index| {
                let edge = &polyhedron.half_edges[index];
                (edge.p_OE, edge.at(edge.length))
            })
            .collect();
        let things: Vec<_> =
            ends.iter().map(|&(a, b)| Thing { corners: [a, b, b], thin: Vec3::zeros() }).collect();
        let mut edges = Self { ends, hierarchy: Hierarchy::new(&things), nearest: Vec::new() };
        if !edges.ends.is_empty() {
            let middle = |facet| mesh.corners(facet).iter().sum::<Vec3>() / 3.0;
            edges.nearest =
                (0..mesh.facets().len() as u32).map(|facet| edges.search(&middle(facet), 0).1).collect();
        }
        edges
    }

    /// The straight distance (m) to the nearest sharp edge, infinite if there is none.
    pub fn distance(&self, facet: u32, p_OC: &Vec3) -> f64 {
        if self.ends.is_empty() {
            return f64::INFINITY;
        }
        let first = self.nearest.get(facet as usize).copied().unwrap_or(0);
        self.search(p_OC, first).0.sqrt()
    }

    /// Squared distance and number of the nearest edge.
    fn search(&self, p_OC: &Vec3, first: u32) -> (f64, u32) {
        let mut best = (self.squared_distance(first, p_OC), first);
        let mut bound = best.0;
        self.hierarchy.closest(p_OC, &mut bound, |edge, bound| {
            let squared = self.squared_distance(edge, p_OC);
            if squared < best.0 {
                best = (squared, edge);
                *bound = squared;
            }
        });
        best
    }

    fn squared_distance(&self, edge: u32, p: &Vec3) -> f64 {
        let (a, b) = &self.ends[edge as usize];
        let ab = b - a;
        let t = ((p - a).dot(&ab) / ab.norm_squared()).clamp(0.0, 1.0);
        (a + ab * t - p).norm_squared()
    }
}

/// The surface on both sides of an edge.
struct Around<'m> {
    mesh: &'m Mesh,
    /// How far (m) it is looked at.
    scale: f64,
    /// For each facet the last look that saw it.
    seen: Vec<u32>,
    looks: u32,
    open: Vec<u32>,
}

impl<'m> Around<'m> {
    fn new(mesh: &'m Mesh, scale: f64) -> Self {
        Self { mesh, scale, seen: vec![0; mesh.facets().len()], looks: 0, open: Vec::new() }
    }

    /// By how much (rad) the mean normals of both sides of a facet's edge differ.
    fn bend(&mut self, facet: u32, side: usize) -> f64 {
        let neighbor = self.mesh.neighbors(facet)[side].facet;
        let corners = self.mesh.corners(facet);
        let (from, to) = (corners[side], corners[(side + 1) % 3]);
        let middle = (from + to) / 2.0;
        let up = self.mesh.normal(facet) + self.mesh.normal(neighbor);
        // Facets are counted to the left of their sides.
        let aside = up.cross(&(to - from));
        let (a, b) = (self.mean(facet, &middle, &aside), self.mean(neighbor, &middle, &-aside));
        a.cross(&b).norm().atan2(a.dot(&b))
    }

    /// The sum of the normals, each as long as its facet's area, of what is connected with `first` and whose
    /// middles lie near the edge's on the side of `aside`.
    fn mean(&mut self, first: u32, middle: &Vec3, aside: &Vec3) -> Vec3 {
        self.looks += 1;
        self.open.push(first);
        self.seen[first as usize] = self.looks;
        let mut sum = Vec3::zeros();
        while let Some(facet) = self.open.pop() {
            // What is larger than all that is looked at counts as much as that.
            sum += self.mesh.normal(facet) * self.mesh.area(facet).min(self.scale * self.scale);
            for neighbor in self.mesh.neighbors(facet).iter().map(|neighbor| neighbor.facet) {
                let off = self.mesh.corners(neighbor).iter().sum::<Vec3>() / 3.0 - middle;
                let is_near = off.norm() <= self.scale && off.dot(aside) > 0.0;
                if is_near && self.seen[neighbor as usize] != self.looks {
                    self.seen[neighbor as usize] = self.looks;
                    self.open.push(neighbor);
                }
            }
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use regrasp_api::Random;

    /// A cube of 45 mm with 20 × 20 squares a side, its vertices moved along the rays from its middle.
    fn cube(noise: f64) -> Mesh {
        const N: usize = 20;
        let mut random = Random::from_key(3, 0, 0, 0);
        let mut vertices: Vec<Vec3> = Vec::new();
        let mut facets = Vec::new();
        let mut places = std::collections::BTreeMap::new();
        for face in 0..6 {
            let mut at = |i: usize, j: usize| {
                let (u, v) = (2 * i as i32 - N as i32, 2 * j as i32 - N as i32);
                let w = N as i32;
                let key = match face {
                    0 => [u, v, w],
                    1 => [v, u, -w],
                    2 => [w, u, v],
                    3 => [-w, v, u],
                    4 => [v, w, u],
                    _ => [u, -w, v],
                };
                *places.entry(key).or_insert_with(|| {
                    let p = Vec3::from(key.map(f64::from)) * (0.0225 / N as f64);
                    vertices.push(p * (1.0 + random.range(-1.0, 1.0) * noise / p.norm()));
                    vertices.len() as u32 - 1
                })
            };
            for (i, j) in (0..N).flat_map(|i| (0..N).map(move |j| (i, j))) {
                let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
                facets.extend([[a, b, c], [a, c, d]]);
            }
        }
        Mesh::new(vertices, facets).expect("a closed cube")
    }

    fn distance_from_the_edges(p: &Vec3) -> f64 {
        let mut sides = p.abs().map(|x| 0.0225 - x);
        sides.as_mut_slice().sort_by(f64::total_cmp);
        sides[1]
    }

    #[test]
    fn noise_makes_no_edge_sharp_and_hides_none() {
        for noise in [0.0, 4e-4] {
            let mesh = cube(noise);
            let sharp = SharpEdges::new(&Polyhedron::new(&mesh), 30_f64.to_radians(), 0.01);
            let stray = sharp.ends.iter().filter(|(a, _)| distance_from_the_edges(a) > 1.5e-3).count();
            assert_eq!(stray, 0, "in the middle of a side, noise {noise}");
            assert!(sharp.ends.len() >= 12 * 18, "{} of 240 edges", sharp.ends.len());
        }
    }

    #[test]
    fn large_facets_are_sharp_by_themselves() {
        let mesh = regrasp_world::primitive_mesh(
            &regrasp_api::Primitive::Cuboid { half_size: Vec3::repeat(0.02) },
            12,
        );
        let sharp = SharpEdges::new(&Polyhedron::new(&mesh.expect("a cube")), 30_f64.to_radians(), 0.01);
        assert_eq!(sharp.ends.len(), 12);
    }
}
