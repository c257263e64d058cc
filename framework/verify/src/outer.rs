//! Closest points on facets that bound a mesh as planes bound a convex solid: found without a search.
//!
//! Where all of the mesh lies below a facet's plane, a point above it that projects onto the facet has its
//! closest point there: nothing of the mesh is above the plane. Beyond the edge of two such facets the
//! closest point lies on the edge, if the point is behind neither: the direction to it is then a sum of the
//! two normals, and no vertex lies farther that way than the edge. A corner is closest where all vertices
//! are behind the plane across the way to it.

use regrasp_api::{Mesh, Neighbor, Vec3};
use std::sync::atomic::{AtomicU8, Ordering};

/// How far above a facet's plane a vertex may be by rounding (m).
const ROUNDING: f64 = 1e-13;
/// How many facets are looked at, one beside the other.
const STEPS: usize = 64;
/// With more facets than this a tree finds the closest one sooner than going through all, or through all
/// vertices to see whether a facet bounds the mesh.
const MOST_FACING: usize = 4000;
/// A point no higher above a facet (m) may be inside.
const ABOVE: f64 = 1e-9;

/// The facets of a mesh, with what is known of them.
#[derive(Debug)]
pub(crate) struct Outer {
    facets: Vec<Facet>,
}

#[derive(Debug)]
struct Facet {
    corners: [Vec3; 3],
    n: Vec3,
    /// Along its plane inward of each edge; edge `k` runs from corner `k` to the next.
    inward: [Vec3; 3],
    /// What lies across its edges.
    across: [Neighbor; 3],
    /// Whether all vertices are below its plane: found out when it is first asked.
    is_outer: AtomicU8,
}

const UNKNOWN: u8 = 0;
const YES: u8 = 1;
const NO: u8 = 2;

impl Facet {
    /// The edge beyond which a point lies whose foot is not on the facet; the first of two.
    fn beyond(&self, p: &Vec3) -> Option<usize> {
        (0..3).find(|&edge| self.is_beyond(edge, p))
    }

    fn is_beyond(&self, edge: usize, p: &Vec3) -> bool {
        self.inward[edge].dot(&(p - self.corners[edge])) < 0.0
    }

    /// The foot of a point on the line of an edge, if it lies within the edge.
    fn on_edge(&self, edge: usize, p: &Vec3) -> Option<Vec3> {
        let a = &self.corners[edge];
        let along = self.corners[(edge + 1) % 3] - a;
        let t = along.dot(&(p - a)) / along.norm_squared();
        (0.0..=1.0).contains(&t).then(|| a + along * t)
    }

    /// The corner closest to a point, if all vertices lie behind the plane across the way from one to the
    /// other: then nothing of the mesh is closer.
    fn corner_below(&self, p: &Vec3, vertices: &[Vec3]) -> Option<Vec3> {
        let [a, b, c] = self.corners.map(|corner| (p - corner).norm_squared());
        let corner = self.corners[if a <= b && a <= c {
            0
        } else if b <= c {
            1
        } else {
            2
        }];
        let away = p - corner;
        let most = ROUNDING * away.norm();
        vertices.iter().all(|v| away.dot(&(v - corner)) <= most).then_some(corner)
    }

    fn height(&self, p: &Vec3) -> f64 {
        self.n.dot(&(p - self.corners[0]))
    }
}

impl Outer {
    pub(crate) fn new(mesh: &Mesh) -> Self {
        let facet = |f: u32| {
            let (corners, n) = (mesh.corners(f), mesh.normal(f));
            let inward = std::array::from_fn(|k| n.cross(&(corners[(k + 1) % 3] - corners[k])));
            Facet { corners, n, inward, across: *mesh.neighbors(f), is_outer: AtomicU8::new(UNKNOWN) }
        };
        Self { facets: (0..mesh.facets().len() as u32).map(facet).collect() }
    }

    /// The facet whose plane a point is farthest above: on a convex solid it is close to the closest one.
    pub(crate) fn facing(&self, p: &Vec3) -> u32 {
        if self.facets.len() > MOST_FACING {
            return 0;
        }
        let mut best = (0, f64::NEG_INFINITY);
        for (f, facet) in self.facets.iter().enumerate() {
            let height = facet.height(p);
            if height > best.1 {
                best = (f as u32, height);
            }
        }
        best.0
    }

    /// The facets that share an edge with this one.
    pub(crate) fn beside(&self, facet: u32) -> [u32; 3] {
        self.facets[facet as usize].across.map(|neighbor| neighbor.facet)
    }

    /// The closest point to `p` of a mesh with these vertices, and its facet, where `p` is outside and it is
    /// on the facet `near` or beside it, and such that no search is needed.
    pub(crate) fn closest(&self, vertices: &[Vec3], p: &Vec3, near: u32) -> Option<(Vec3, u32)> {
        if self.facets.len() > MOST_FACING {
            return None;
        }
        let mut f = near;
        for _ in 0..STEPS {
            let facet = self.facets.get(f as usize)?;
            let height = facet.height(p);
            if height <= ABOVE || !self.is_outer(f, vertices) {
                return None;
            }
            let Some(edge) = facet.beyond(p) else { return Some((p - facet.n * height, f)) };
            let Neighbor { facet: other, edge: back, .. } = facet.across[edge];
            if self.facets.get(other as usize)?.is_beyond(usize::from(back), p) {
                return match facet.on_edge(edge, p) {
                    Some(point) => self.is_outer(other, vertices).then_some((point, f)),
                    None => facet.corner_below(p, vertices).map(|corner| (corner, f)),
                };
            }
            f = other;
        }
        None
    }

    /// Whether all of the mesh is below a facet's plane.
    fn is_outer(&self, facet: u32, vertices: &[Vec3]) -> bool {
        let facet = &self.facets[facet as usize];
        match facet.is_outer.load(Ordering::Relaxed) {
            UNKNOWN => {
                let is_outer = vertices.iter().all(|v| facet.height(v) <= ROUNDING);
                // Whoever finds it out finds the same.
                facet.is_outer.store(if is_outer { YES } else { NO }, Ordering::Relaxed);
                is_outer
            }
            known => known == YES,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solid::Solid;
    use regrasp_api::Random;

    /// A ball of 30 mm, and a block with a notch.
    fn meshes() -> [Mesh; 2] {
        let notch = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [2.0, 1.0], [0.0, 4.0]];
        let mut vertices: Vec<Vec3> = Vec::new();
        for z in [0.0, 2.0] {
            vertices.extend(notch.map(|[x, y]| Vec3::new(x, y, z) * 0.01));
        }
        let mut facets: Vec<[u32; 3]> = Vec::new();
        for [a, b, c] in [[0, 1, 3], [1, 2, 3], [0, 3, 4]] {
            facets.extend([[c, b, a], [a + 5, b + 5, c + 5]]);
        }
        for k in 0..5u32 {
            let next = (k + 1) % 5;
            facets.extend([[k, next, next + 5], [k, next + 5, k + 5]]);
        }
        let block = Mesh::new(vertices, facets).unwrap();
        let shape = serde_json::json!({ "kind": "sphere", "radius": 0.03 });
        let description = serde_json::json!({ "shape": shape, "mass": 0.1, "friction": 0.5 });
        let ball = regrasp_world::load_object(&serde_json::from_value(description).unwrap()).unwrap();
        [ball.mesh, block]
    }

    #[test]
    fn what_is_found_beside_a_facet_is_what_the_search_finds() {
        let mut random = Random::from_key(11, 0, 0, 0);
        for mesh in meshes() {
            let (solid, outer) = (Solid::new(&mesh), Outer::new(&mesh));
            let (mut found, mut all) = (0, 0);
            for _ in 0..4000 {
                let on = mesh.corners(random.index(mesh.facets().len()) as u32);
                let p = on[0] + random.direction() * random.range(0.0, 0.03);
                let exact = solid.search(&p, 0);
                let beside = mesh.neighbors(exact.facet.min(mesh.facets().len() as u32 - 1))[0].facet;
                for near in [exact.facet, beside] {
                    all += 1;
                    if let Some((point, _)) = outer.closest(mesh.vertices(), &p, near) {
                        found += 1;
                        let (a, b) = ((point - p).norm(), (exact.point - p).norm());
                        assert!((a - b).abs() < 1e-12 && !exact.inside, "{a} {b}");
                        assert!((point - exact.point).norm() < 1e-9);
                    }
                }
                let q = p + random.direction() * 0.02;
                let exact = solid.search_segment(&p, &q, 0);
                for near in [0, exact.facet, beside] {
                    let gap = solid.gap_to_segment(&p, &q, near);
                    assert!((gap.distance - exact.distance).abs() < 1e-12, "{gap:?} {exact:?}");
                }
            }
            assert!(found > all / 10, "{found} of {all}");
        }
    }
}
