//! What a fingertip's ball that touches a twin feels of the true mesh.

use crate::clearance::{Field, MeshSolid};
use regrasp_api::{Mesh, Vec3};
use std::sync::Arc;

/// Places of the ball that are looked at are at most this far apart, in radii ...
const SPACING: f64 = 0.08;
/// ... or as many as this over the whole surface.
const MOST_PLACES: f64 = 60_000.0;
/// How deep (m) the ball may sink into the twin itself at a place that counts as one where it can be.
const SINK: f64 = 1e-6;
/// What may lie between the places (m), added to the bound that was found.
const BETWEEN: f64 = 5e-6;

/// The true mesh, and a ball.
pub(super) struct Touch {
    solid: Arc<MeshSolid>,
    pub radius: f64,
}

impl Touch {
    pub fn new(mesh: &Mesh, radius: f64) -> Self {
        Self { solid: Arc::new(MeshSolid::new(mesh)), radius }
    }

    /// How far (m) the ball is from the mesh that touches a twin at `p` with the outward normal `n`; negative
    /// where it enters the mesh.
    pub fn gap(&self, p: &Vec3, n: &Vec3) -> f64 {
        let center = p + n * self.radius;
        self.solid.signed_distance_within(&center, 1.05 * self.radius) - self.radius
    }

    /// Bounds of the distance from the mesh wherever the centre of a ball that touches it can be.
    pub fn field(&self) -> Field {
        Field::new(self.solid.clone(), 1.5 * self.radius)
    }

    /// The signed distance (m) of a point from the mesh, which is likely to be small.
    pub fn height(&self, p: &Vec3) -> f64 {
        self.solid.signed_distance_within(p, 0.1 * self.radius)
    }

    /// The largest gap, or depth, of the ball over all places where it touches `twin` and enters it nowhere
    /// (m); `None` where it is more than `most`.
    pub fn bound(&self, twin: &Mesh, most: f64) -> Option<f64> {
        let (above, below) = self.range(twin, most)?;
        let bound = above.max(below) + BETWEEN;
        (bound <= most).then_some(bound)
    }

    /// How far (m) the ball is from the mesh at most, and how deep it enters it, over all places where it
    /// touches `twin` and enters it nowhere; `None` where either is more than `most`.
    pub fn range(&self, twin: &Mesh, most: f64) -> Option<(f64, f64)> {
        let own = (!twin.is_locally_convex()).then(|| MeshSolid::new(twin));
        let area: f64 = (0..twin.facets().len() as u32).map(|facet| twin.area(facet)).sum();
        let spacing = (SPACING * self.radius).max((area / MOST_PLACES).sqrt());
        let (mut above, mut below) = (0.0, 0.0);
        let mut visit = |p: &Vec3, n: &Vec3| {
            if f64::max(above, below) > most {
                return;
            }
            let gap = self.gap(p, n);
            let counts = gap > above || -gap > below;
            if counts && own.as_ref().is_none_or(|own| self.is_free(own, p, n)) {
                above = f64::max(above, gap);
                below = f64::max(below, -gap);
            }
        };
        places(twin, spacing, &mut visit);
        (f64::max(above, below) <= most).then_some((above, below))
    }

    fn is_free(&self, own: &MeshSolid, p: &Vec3, n: &Vec3) -> bool {
        own.signed_distance_within(&(p + n * self.radius), 1.01 * self.radius) >= self.radius - SINK
    }
}

/// Calls `visit` with points and normals all over a surface, no farther apart than `spacing` (m): on facets,
/// and turning about convex edges and vertices.
pub(super) fn places(mesh: &Mesh, spacing: f64, visit: &mut dyn FnMut(&Vec3, &Vec3)) {
    // The mean normals at vertices; none where a concave edge ends: there the ball touches elsewhere.
    let mut around = vec![Some(Vec3::zeros()); mesh.vertices().len()];
    for facet in 0..mesh.facets().len() as u32 {
        let corners = mesh.corners(facet);
        let n = mesh.normal(facet);
        on_facet(corners, spacing, |p| visit(p, &n));
        for (k, neighbor) in mesh.neighbors(facet).iter().enumerate() {
            let vertex = mesh.facets()[facet as usize][k] as usize;
            let end = mesh.facets()[facet as usize][(k + 1) % 3] as usize;
            if neighbor.bend < 0.0 {
                (around[vertex], around[end]) = (None, None);
            }
            around[vertex] = around[vertex].map(|sum| sum + n * corner_angle(corners, k));
            if neighbor.bend > 0.0 && neighbor.facet > facet {
                let middle = (n + mesh.normal(neighbor.facet)).normalize();
                let (from, to) = (corners[k], corners[(k + 1) % 3]);
                let pieces = ((to - from).norm() / spacing).ceil().max(1.0) as usize;
                for piece in 0..pieces {
                    let p = from.lerp(&to, (piece as f64 + 0.5) / pieces as f64);
                    visit(&p, &middle);
                }
            }
        }
    }
    for (p, n) in mesh.vertices().iter().zip(&around) {
        if let Some(n) = n.and_then(|sum| sum.try_normalize(1e-9)) {
            visit(p, &n);
        }
    }
}

/// Points all over a triangle: the middles of the triangles into which it falls.
pub(super) fn on_facet([a, b, c]: [Vec3; 3], spacing: f64, mut visit: impl FnMut(&Vec3)) {
    let longest = (b - a).norm().max((c - b).norm()).max((a - c).norm());
    let n = (longest / spacing).ceil().clamp(1.0, 1000.0) as usize;
    let at = |i: f64, j: f64| a + (b - a) * (i / n as f64) + (c - a) * (j / n as f64);
    for i in 0..n {
        for j in 0..n - i {
            let (x, y) = (i as f64, j as f64);
            visit(&at(x + 1.0 / 3.0, y + 1.0 / 3.0));
            if j + 1 < n - i {
                visit(&at(x + 2.0 / 3.0, y + 2.0 / 3.0));
            }
        }
    }
}

fn corner_angle(corners: [Vec3; 3], k: usize) -> f64 {
    let (u, v) = (corners[(k + 1) % 3] - corners[k], corners[(k + 2) % 3] - corners[k]);
    u.cross(&v).norm().atan2(u.dot(&v))
}
