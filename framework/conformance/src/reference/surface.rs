//! The reference surface: the object's facets, everything by brute force.

use super::geometry::{closest_on_mesh, closest_on_segment, facets_at};
use super::graph_path::SteinerGraph;
use super::walk;
use regrasp_api::{
    CallError, Contact, Context, Mesh, Projection, Random, Slot, SurfaceParam, SurfacePath, Vec3,
};

/// Edges that bend by more are sharp (rad): 30°.
const SHARP: f64 = std::f64::consts::PI / 6.0;

/// The facets of a mesh under a fingertip.
///
/// Shortest paths run over points on the edges (Lanthier, Maheshwari, Sack, "Approximating weighted shortest
/// paths on polyhedral surfaces", SoCG 1997) and are up to 1 % too long.
pub struct FacetSurface {
    mesh: Mesh,
    radius: f64,
    graph: SteinerGraph,
    areas: Vec<f64>,
}

impl FacetSurface {
    /// The surface of `mesh` for fingertips of the given radius (m).
    pub fn new(mesh: &Mesh, radius: f64) -> Self {
        let areas: Vec<f64> = (0..mesh.facets().len() as u32).map(|facet| mesh.area(facet)).collect();
        let spacing = areas.iter().sum::<f64>().sqrt() / 45.0;
        Self { graph: SteinerGraph::new(mesh, spacing), mesh: mesh.clone(), radius, areas }
    }
}

impl SurfaceParam for FacetSurface {
    fn sample(&self, random: &mut Random) -> Contact {
        let mut wanted = random.unit() * self.areas.iter().sum::<f64>();
        let mut facet = 0;
        while facet + 1 < self.areas.len() && wanted > self.areas[facet] {
            wanted -= self.areas[facet];
            facet += 1;
        }
        let [a, b, c] = self.mesh.corners(facet as u32);
        let (mut s, mut t) = (random.unit(), random.unit());
        if s + t > 1.0 {
            (s, t) = (1.0 - s, 1.0 - t);
        }
        let p_OC = a + (b - a) * s + (c - a) * t;
        Contact { facet: facet as u32, p_OC, n_O: self.mesh.normal(facet as u32) }
    }

    fn geodesic(
        &self,
        from: &Contact,
        to: &Contact,
        path: &mut SurfacePath,
        context: &mut Context<'_>,
    ) -> Result<bool, CallError> {
        context.count_call(Slot::Surface);
        path.restart(*from);
        if from == to {
            return Ok(true);
        }
        let ends = [from, to].map(|end| (end.p_OC, facets_at(&self.mesh, &end.p_OC)));
        let Some((length, legs)) = self.graph.shortest(&ends[0], &ends[1]) else { return Ok(false) };
        let mut last = *from;
        let mut advance = |contact: Contact| {
            let turn = last.n_O.cross(&contact.n_O).norm().atan2(last.n_O.dot(&contact.n_O));
            let travelled = (contact.p_OC - last.p_OC).norm() + self.radius * turn;
            if travelled > 1e-12 {
                path.push(contact, travelled);
                last = contact;
            }
        };
        for (facet, a, b) in legs {
            let n_O = self.mesh.normal(facet);
            advance(Contact { facet, p_OC: a, n_O });
            advance(Contact { facet, p_OC: b, n_O });
        }
        advance(*to);
        if let Some(end) = path.waypoints.last_mut() {
            end.contact = *to;
        }
        path.length = length;
        Ok(true)
    }

    fn project(&self, p_OF: &Vec3, _hint: Option<u32>) -> Projection {
        let closest = closest_on_mesh(&self.mesh, p_OF);
        let out = p_OF - closest.point;
        let n_O = if closest.distance > 1e-9 { out.normalize() } else { self.mesh.normal(closest.facet) };
        let contact = Contact { facet: closest.facet, p_OC: closest.point, n_O };
        Projection { contact, distance: closest.distance }
    }

    fn walk(&self, from: &Contact, direction_O: &Vec3, distance: f64) -> Contact {
        walk::walk(&self.mesh, from, direction_O, distance)
    }

    fn edge_distance(&self, contact: &Contact) -> f64 {
        let mut least = f64::INFINITY;
        for facet in 0..self.mesh.facets().len() as u32 {
            let corners = self.mesh.corners(facet);
            for (k, neighbor) in self.mesh.neighbors(facet).iter().enumerate() {
                if neighbor.bend.abs() > SHARP {
                    let on = closest_on_segment(&corners[k], &corners[(k + 1) % 3], &contact.p_OC);
                    least = least.min((on - contact.p_OC).norm());
                }
            }
        }
        least
    }
}
