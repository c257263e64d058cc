//! The intrinsic Delaunay triangulation: other straight edges over the same facets, between the same
//! vertices.
//!
//! The Laplacian of a mesh with obtuse or thin facets is a bad one. Edges are flipped inside the surface,
//! which changes no distance, until the angles opposite to each edge add up to π at most; then all its
//! weights are positive (Bobenko & Springborn, "A discrete Laplace-Beltrami operator for simplicial
//! surfaces", Discrete Comput. Geom. 38, 2007).

use crate::polyhedron::{Planar, Polyhedron, next, previous};

/// Cotangents that add up to more than this count as no reason for a flip.
const FLAT: f64 = -1e-9;

/// Triangles given by the lengths of their edges; edge 3 t + k leads from corner k of triangle t to the next.
#[derive(Clone, Debug)]
pub(super) struct Triangles {
    pub corners: Vec<[u32; 3]>,
    /// Length (m) of each edge.
    lengths: Vec<f64>,
    twins: Vec<u32>,
}

impl Triangles {
    /// The Delaunay triangulation of a mesh's vertices.
    pub fn delaunay(polyhedron: &Polyhedron) -> Self {
        let mut triangles = Self {
            corners: polyhedron.mesh.facets().to_vec(),
            lengths: polyhedron.half_edges.iter().map(|edge| edge.length).collect(),
            twins: polyhedron.half_edges.iter().map(|edge| edge.twin).collect(),
        };
        let mut waiting: Vec<u32> = (0..triangles.twins.len() as u32).collect();
        while let Some(edge) = waiting.pop() {
            let twin = triangles.twins[edge as usize];
            // An edge with one triangle on both sides cannot be flipped.
            if edge / 3 != twin / 3 && triangles.cotangent(edge) + triangles.cotangent(twin) < FLAT {
                let outer = triangles.flip(edge);
                waiting.extend(outer);
            }
        }
        triangles
    }

    /// A triangle's corners in the plane: the first at the origin, the second on the x axis (m).
    pub fn flat(&self, triangle: usize) -> [Planar; 3] {
        [[0.0, 0.0], [self.lengths[3 * triangle], 0.0], self.apex(3 * triangle as u32)]
    }

    /// The corner opposite to an edge, in the edge's frame (m).
    fn apex(&self, edge: u32) -> Planar {
        let [l, m, n] = [edge, next(edge), previous(edge)].map(|e| self.lengths[e as usize]);
        let x = (l * l + n * n - m * m) / (2.0 * l);
        [x, (n * n - x * x).max(0.0).sqrt()]
    }

    /// The cotangent of the angle opposite to an edge.
    fn cotangent(&self, edge: u32) -> f64 {
        let [l, m, n] = [edge, next(edge), previous(edge)].map(|e| self.lengths[e as usize]);
        let [_, height] = self.apex(edge);
        (m * m + n * n - l * l) / (2.0 * l * height.max(f64::MIN_POSITIVE))
    }

    /// Replaces an edge by the other diagonal of its two triangles; the four edges around them.
    fn flip(&mut self, edge: u32) -> [u32; 4] {
        let twin = self.twins[edge as usize];
        let (f, g) = (edge / 3, twin / 3);
        let (up, down) = (self.apex(edge), self.apex(twin));
        let across = (self.lengths[edge as usize] - down[0] - up[0]).hypot(up[1] + down[1]);
        let corner = |e: u32| self.corners[(e / 3) as usize][(e % 3) as usize];
        let (a, b, c, d) = (corner(edge), corner(twin), corner(previous(edge)), corner(previous(twin)));
        // Old edge, new place.
        let moved = [
            (previous(twin), 3 * f),
            (next(edge), 3 * f + 1),
            (previous(edge), 3 * g),
            (next(twin), 3 * g + 1),
        ];
        let place = |old: u32| moved.iter().find(|(from, _)| *from == old).map_or(old, |&(_, to)| to);
        let kept =
            moved.map(|(from, to)| (to, self.lengths[from as usize], place(self.twins[from as usize])));
        for (to, length, twin) in kept {
            self.lengths[to as usize] = length;
            self.twins[to as usize] = twin;
            self.twins[twin as usize] = to;
        }
        for (here, there) in [(3 * f + 2, 3 * g + 2), (3 * g + 2, 3 * f + 2)] {
            self.lengths[here as usize] = across;
            self.twins[here as usize] = there;
        }
        self.corners[f as usize] = [d, b, c];
        self.corners[g as usize] = [c, a, d];
        moved.map(|(_, to)| to)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use regrasp_api::{Mesh, Vec3};

    /// A box of 40 × 2 × 30 mm whose facets are long and thin.
    fn plate() -> Polyhedron {
        let corner = |i: u32| {
            let at = |bit: u32, size: f64| if i >> bit & 1 == 1 { size } else { 0.0 };
            Vec3::new(at(0, 0.04), at(1, 0.002), at(2, 0.03))
        };
        let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let facets = quads.iter().flat_map(|q| [[q[0], q[1], q[2]], [q[0], q[2], q[3]]]).collect();
        Polyhedron::new(&Mesh::new((0..8).map(corner).collect(), facets).expect("a box is sound"))
    }

    #[test]
    fn flips_keep_area_and_angles_and_leave_positive_weights() {
        let polyhedron = plate();
        let triangles = Triangles::delaunay(&polyhedron);
        let area = |t: usize| {
            let [_, b, c] = triangles.flat(t);
            b[0] * c[1] / 2.0
        };
        let total: f64 = (0..triangles.corners.len()).map(area).sum();
        let truth: f64 = (0..12).map(|facet| polyhedron.mesh.area(facet)).sum();
        assert!((total - truth).abs() < 1e-12 * truth, "{total} instead of {truth}");
        let mut angles = [0.0; 8];
        for edge in 0..36_u32 {
            let twin = triangles.twins[edge as usize];
            assert_eq!(triangles.twins[twin as usize], edge);
            assert!((triangles.lengths[edge as usize] - triangles.lengths[twin as usize]).abs() < 1e-15);
            assert!(triangles.cotangent(edge) + triangles.cotangent(twin) > -1e-6);
            let [x, y] = triangles.apex(edge);
            angles[triangles.corners[edge as usize / 3][edge as usize % 3] as usize] += y.atan2(x);
        }
        assert!(angles.iter().all(|angle| (angle - 1.5 * std::f64::consts::PI).abs() < 1e-12), "{angles:?}");
    }
}
