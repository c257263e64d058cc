//! Convex meshes by their corners: what is farthest in a direction is found by climbing along edges.

use super::border::to_glam;
use parry3d_f64::math::Vector;
use parry3d_f64::shape::SupportMap;
use regrasp_api::Mesh;

/// Hulls of at most as many corners are looked through; climbing is not faster there.
const FEW: usize = 24;
/// One for each octant.
const OCTANTS: usize = 8;

/// The corners of a convex mesh, and the edges between them.
pub(crate) struct Hull {
    corners: Vec<Vector>,
    /// The corners next to each, one after the other ...
    neighbors: Vec<u32>,
    /// ... and where those of each begin; one more than there are corners.
    begins: Vec<u32>,
    /// The farthest corner in the middle of each octant: where climbing begins.
    starts: [u32; OCTANTS],
}

impl Hull {
    /// `None` for a mesh that is not convex, or not of one piece.
    pub fn of(mesh: &Mesh, pieces: usize) -> Option<Self> {
        if pieces != 1 || !mesh.is_locally_convex() {
            return None;
        }
        let corners: Vec<Vector> = mesh.vertices().iter().map(to_glam).collect();
        let mut edges: Vec<(u32, u32)> =
            mesh.facets().iter().flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)]).collect();
        edges.sort_unstable();
        let mut begins = vec![0; corners.len() + 1];
        edges.iter().for_each(|&(from, _)| begins[from as usize + 1] += 1);
        for i in 1..begins.len() {
            begins[i] += begins[i - 1];
        }
        let neighbors = edges.into_iter().map(|(_, to)| to).collect();
        let mut hull = Self { corners, neighbors, begins, starts: [0; OCTANTS] };
        hull.starts = std::array::from_fn(|octant| hull.farthest(&middle_of(octant)));
        Some(hull)
    }

    /// The farthest corner, looked for among all.
    fn farthest(&self, direction: &Vector) -> u32 {
        let mut best = (f64::NEG_INFINITY, 0);
        for (i, corner) in self.corners.iter().enumerate() {
            let height = corner.dot(*direction);
            if height > best.0 {
                best = (height, i as u32);
            }
        }
        best.1
    }

    /// The farthest corner, by going up along edges: on a convex mesh there is but one top.
    fn climb(&self, direction: &Vector) -> u32 {
        let bit = |x: f64, axis: u32| usize::from(x < 0.0) << axis;
        let octant = bit(direction.x, 0) | bit(direction.y, 1) | bit(direction.z, 2);
        let mut top = self.starts[octant];
        let mut height = self.corners[top as usize].dot(*direction);
        loop {
            let around = self.begins[top as usize] as usize..self.begins[top as usize + 1] as usize;
            let before = top;
            for &next in &self.neighbors[around] {
                let higher = self.corners[next as usize].dot(*direction);
                if higher > height {
                    (top, height) = (next, higher);
                }
            }
            if top == before {
                return top;
            }
        }
    }
}

impl SupportMap for Hull {
    fn local_support_point(&self, direction: Vector) -> Vector {
        let corner =
            if self.corners.len() <= FEW { self.farthest(&direction) } else { self.climb(&direction) };
        self.corners[corner as usize]
    }
}

/// The middle of an octant, whose bits say which coordinates are negative.
fn middle_of(octant: usize) -> Vector {
    let sign = |axis: usize| if octant >> axis & 1 == 0 { 1.0 } else { -1.0 };
    Vector::new(sign(0), sign(1), sign(2))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::object::primitive_mesh;
    use regrasp_api::{Primitive, Random, Vec3};

    #[test]
    fn climbing_finds_what_looking_through_all_finds() {
        for form in [
            Primitive::Ellipsoid { semi_axes: Vec3::new(0.04, 0.02, 0.01) },
            Primitive::Cylinder { radius: 0.02, half_height: 0.03 },
            Primitive::Cuboid { half_size: Vec3::new(0.02, 0.03, 0.01) },
        ] {
            let hull = Hull::of(&primitive_mesh(&form, 1280).unwrap(), 1).unwrap();
            let mut random = Random::from_key(3, 0, 0, 0);
            for _ in 0..2000 {
                let direction = to_glam(&random.direction());
                let height = |corner: u32| hull.corners[corner as usize].dot(direction);
                let (found, best) = (height(hull.climb(&direction)), height(hull.farthest(&direction)));
                assert!((found - best).abs() < 1e-12, "{form:?}: {found} of {best}");
            }
        }
    }

    #[test]
    fn a_ring_is_no_hull() {
        let form = Primitive::Torus { ring_radius: 0.03, tube_radius: 0.01 };
        assert!(Hull::of(&primitive_mesh(&form, 1280).unwrap(), 1).is_none());
    }
}
