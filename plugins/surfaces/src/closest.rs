//! The closest point of a polyhedron: exact, with its sign, and quick where a facet nearby is known.

use crate::bvh::{Hierarchy, Thing};
use crate::polyhedron::{HalfEdge, Polyhedron};
use regrasp_api::{Contact, Projection, Vec3};

/// Steps of the local walk before it gives up for the global search.
const WALK_STEPS: usize = 24;

/// The part of a facet that holds the closest point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Feature {
    /// The facet's inside.
    Inside,
    /// Its edge k.
    Edge(u8),
    /// Its corner k.
    Corner(u8),
}

/// A facet's closest point.
#[derive(Clone, Copy, Debug)]
struct Nearest {
    squared: f64,
    facet: u32,
    p_OC: Vec3,
    feature: Feature,
}

impl Nearest {
    /// The order that settles ties: smaller distance, then smaller facet. It makes the answer independent of
    /// the search.
    fn is_before(&self, other: &Self) -> bool {
        self.squared < other.squared || (self.squared == other.squared && self.facet < other.facet)
    }
}

/// Closest points of a polyhedron.
#[derive(Clone, Debug)]
pub(crate) struct ClosestPoints {
    facets: Hierarchy,
    /// Sum of the facets' normals around each vertex, weighted by their angles.
    vertex_normals: Vec<Vec3>,
}

impl ClosestPoints {
    /// Prepares the hierarchy, in O(n log n).
    pub fn new(polyhedron: &Polyhedron) -> Self {
        let mesh = &polyhedron.mesh;
        let things: Vec<_> = (0..mesh.facets().len() as u32)
            .map(|facet| Thing { corners: mesh.corners(facet), thin: mesh.normal(facet) })
            .collect();
        let mut vertex_normals = vec![Vec3::zeros(); mesh.vertices().len()];
        for (index, edge) in polyhedron.half_edges.iter().enumerate() {
            let angle = edge.apex[1].atan2(edge.apex[0]);
            vertex_normals[edge.vertex as usize] += mesh.normal(index as u32 / 3) * angle;
        }
        Self { facets: Hierarchy::new(&things), vertex_normals }
    }

    /// The closest contact and the signed distance (m).
    pub fn project(&self, polyhedron: &Polyhedron, p_OF: &Vec3, hint: Option<u32>) -> Projection {
        let start = hint.filter(|&facet| (facet as usize) < polyhedron.mesh.facets().len());
        let local = start.map(|facet| walk(polyhedron, p_OF, facet));
        let nearest = match local {
            Some((nearest, true)) if is_certain(polyhedron, p_OF, &nearest) => nearest,
            _ => self.search(polyhedron, p_OF, local.map(|(nearest, _)| nearest)),
        };
        self.signed(polyhedron, p_OF, &nearest)
    }

    /// Whether every facet is at least `distance` (m) away.
    pub fn is_clear(&self, polyhedron: &Polyhedron, p_OF: &Vec3, distance: f64) -> bool {
        let squared = distance.max(0.0).powi(2);
        !self.facets.any_closer(p_OF, squared, |facet| on_facet(polyhedron, p_OF, facet).squared < squared)
    }

    /// Whether `is_it` holds for a facet whose box comes as close as `distance` (m); it is asked about others
    /// too.
    pub fn any_box(&self, p_OF: &Vec3, distance: f64, is_it: impl FnMut(u32) -> bool) -> bool {
        self.facets.any_closer(p_OF, distance.max(0.0).powi(2), is_it)
    }

    /// Searches all facets; what is known already only gives the first bound.
    fn search(&self, polyhedron: &Polyhedron, p_OF: &Vec3, known: Option<Nearest>) -> Nearest {
        let mut best = known.unwrap_or_else(|| on_facet(polyhedron, p_OF, 0));
        let mut bound = best.squared;
        self.facets.closest(p_OF, &mut bound, |facet, bound| {
            let candidate = on_facet(polyhedron, p_OF, facet);
            if candidate.is_before(&best) {
                best = candidate;
                *bound = best.squared;
            }
        });
        best
    }

    /// The contact and the signed distance; inside the solid the distance is negative, the normal still
    /// outward.
    ///
    /// On edges and at vertices the side is that of the angle-weighted normal (Bærentzen & Aanæs, "Signed
    /// distance computation using the angle weighted pseudonormal", IEEE TVCG 2005).
    fn signed(&self, polyhedron: &Polyhedron, p_OF: &Vec3, nearest: &Nearest) -> Projection {
        let (facet, p_OC) = (nearest.facet, nearest.p_OC);
        let normal = polyhedron.mesh.normal(facet);
        let out = p_OF - p_OC;
        let pseudo = match nearest.feature {
            Feature::Inside => {
                // The facet's own normal has less rounding than the quotient.
                let distance = normal.dot(&out);
                return Projection { contact: Contact { facet, p_OC, n_O: normal }, distance };
            }
            Feature::Edge(k) => {
                normal + polyhedron.mesh.normal(polyhedron.mesh.neighbors(facet)[usize::from(k)].facet)
            }
            Feature::Corner(k) => {
                self.vertex_normals[polyhedron.mesh.facets()[facet as usize][usize::from(k)] as usize]
            }
        };
        let size = nearest.squared.sqrt();
        let distance = if pseudo.dot(&out) < 0.0 { -size } else { size };
        let n_O = if size > polyhedron.snap { out / distance } else { normal };
        Projection { contact: Contact { facet, p_OC, n_O }, distance }
    }
}

/// Walks downhill from `facet`; true once it has come to a local minimum of the distance.
fn walk(polyhedron: &Polyhedron, p_OF: &Vec3, facet: u32) -> (Nearest, bool) {
    let mut best = on_facet(polyhedron, p_OF, facet);
    for _ in 0..WALK_STEPS {
        let before = best.facet;
        compare_neighbors(polyhedron, p_OF, &mut best);
        if best.facet == before {
            return (best, true);
        }
    }
    (best, false)
}

/// Whether a local minimum is certainly the closest point: outside of a convex solid.
///
/// A convex solid lies in the half-space that the outward direction at the minimum bounds. The direction at a
/// minimum inside a facet may be inward (the far side of a flat object): then the global search decides.
fn is_certain(polyhedron: &Polyhedron, p_OF: &Vec3, nearest: &Nearest) -> bool {
    polyhedron.convex && (p_OF - nearest.p_OC).dot(&polyhedron.mesh.normal(nearest.facet)) > 0.0
}

/// Lets the facets that meet at (or within rounding of) the closest point's corner or edge compete with it.
fn compare_neighbors(polyhedron: &Polyhedron, p_OF: &Vec3, best: &mut Nearest) {
    let facet = best.facet;
    let p_OC = best.p_OC;
    let tolerance = 10.0 * (polyhedron.snap + 1e-8 * best.squared.sqrt());
    let mut compete = |other: u32| {
        let candidate = on_facet(polyhedron, p_OF, other);
        if candidate.is_before(best) {
            *best = candidate;
        }
    };
    let edges = &polyhedron.half_edges[3 * facet as usize..3 * facet as usize + 3];
    if let Some(edge) = edges.iter().find(|edge| (p_OC - edge.p_OE).norm_squared() < tolerance * tolerance) {
        return polyhedron.star(edge.vertex).for_each(|outgoing| compete(outgoing / 3));
    }
    let n = polyhedron.mesh.normal(facet);
    let near = |edge: &&HalfEdge| n.cross(&edge.along_O).dot(&(p_OC - edge.p_OE)) < tolerance;
    edges.iter().filter(near).for_each(|edge| compete(edge.twin / 3));
}

/// The contact with one facet alone, whatever else is closer; the distance (m) has no sign.
pub(crate) fn closest_of_facet(polyhedron: &Polyhedron, p_OF: &Vec3, facet: u32) -> Projection {
    let Nearest { p_OC, squared, .. } = on_facet(polyhedron, p_OF, facet);
    let distance = squared.sqrt();
    let n_O =
        if distance > polyhedron.snap { (p_OF - p_OC) / distance } else { polyhedron.mesh.normal(facet) };
    Projection { contact: Contact { facet, p_OC, n_O }, distance }
}

/// The closest point of one facet (Ericson, "Real-Time Collision Detection", 2005, section 5.1.5).
fn on_facet(polyhedron: &Polyhedron, p: &Vec3, facet: u32) -> Nearest {
    let [a, b, c] = &polyhedron.corners[facet as usize];
    let (p_OC, feature) = closest_on_triangle(p, a, b, c);
    Nearest { squared: (p - p_OC).norm_squared(), facet, p_OC, feature }
}

fn closest_on_triangle(p: &Vec3, a: &Vec3, b: &Vec3, c: &Vec3) -> (Vec3, Feature) {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let (d1, d2) = (ab.dot(&ap), ac.dot(&ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return (*a, Feature::Corner(0));
    }
    let bp = p - b;
    let (d3, d4) = (ab.dot(&bp), ac.dot(&bp));
    if d3 >= 0.0 && d4 <= d3 {
        return (*b, Feature::Corner(1));
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return (a + ab * (d1 / (d1 - d3)), Feature::Edge(0));
    }
    let cp = p - c;
    let (d5, d6) = (ab.dot(&cp), ac.dot(&cp));
    if d6 >= 0.0 && d5 <= d6 {
        return (*c, Feature::Corner(2));
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return (a + ac * (d2 / (d2 - d6)), Feature::Edge(2));
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 {
        return (b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6))), Feature::Edge(1));
    }
    let scale = 1.0 / (va + vb + vc);
    (a + ab * (vb * scale) + ac * (vc * scale), Feature::Inside)
}
