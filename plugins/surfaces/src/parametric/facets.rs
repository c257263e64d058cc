//! From a closed form to the facets of a mesh that stands for it, and back.
//!
//! Both lie apart by the faceting's depth. A point of the one and its partner on the other lie on one ray
//! from the form's core, so that going there and back leads to the same point: through the centre of balls
//! and ellipsoids, at right angles from the axis of capsules and the ring of a torus. A cylinder's section is
//! shrunk to the mesh's polygon. Boxes are their mesh.

use super::curve::Curve;
use super::form::ClosedForm;
use super::rim::Rim;
use crate::lift::Leg;
use crate::polyhedron::Place;
use crate::rolling::{Rolling, Spot};
use crate::strip::Strip;
use regrasp_api::{Contact, Mesh, Primitive, Vec3};

/// How far a vertex may lie off the closed form, relative to the object's size.
const OFF: f64 = 1e-6;
/// Facets looked at for the one that a ray meets.
const MOST_FACETS: usize = 32;

/// How points of the closed form and of the mesh belong together.
#[derive(Clone, Debug)]
enum Partner {
    /// They are the same.
    Same,
    /// Along rays from the form's core.
    Ray,
    /// By the ratio of the mesh's section to the circle.
    Section(Rim),
}

/// The mapping between a closed form and its mesh.
#[derive(Clone, Debug)]
pub(super) struct Facets(Partner);

/// Memory for following curves; nothing of one call shows in the next.
#[derive(Default)]
pub(super) struct Corridor {
    strip: Strip,
    piece: Vec<Leg>,
    /// Facets in the order in which they are reached, each with the half-edge through which, and from which
    /// entry.
    reached: Vec<(u32, u32, u32)>,
}

impl Facets {
    /// Prepares the mapping; `None` where a vertex of the mesh does not lie on the primitive.
    pub fn new(primitive: &Primitive, form: &ClosedForm, mesh: &Mesh) -> Option<Self> {
        let slack = OFF * mesh.radius();
        if mesh.vertices().iter().any(|v| (form.outward(v) - v).norm() > slack) {
            return None;
        }
        Some(Self(match primitive {
            Primitive::Cuboid { .. } => Partner::Same,
            Primitive::Cylinder { radius, half_height } => {
                Partner::Section(Rim::new(*radius, *half_height, slack, mesh)?)
            }
            _ => Partner::Ray,
        }))
    }

    /// The partner of a point of the mesh (m, in O) on the closed form.
    pub fn out(&self, form: &ClosedForm, p: &Vec3) -> Vec3 {
        match &self.0 {
            Partner::Section(rim) => form.outward(&rim.scaled(p, |share| 1.0 / share)),
            _ => form.outward(p),
        }
    }

    /// The partner of a point of the closed form (m, in O) on the mesh, found from a facet nearby.
    pub fn back(&self, form: &ClosedForm, rolling: &Rolling, p: &Vec3, hint: u32) -> Contact {
        let project = |p: &Vec3, hint: u32| rolling.project(p, Some(hint)).contact;
        match &self.0 {
            Partner::Same => project(p, hint),
            Partner::Section(rim) => project(&rim.scaled(p, |share| share), hint),
            Partner::Ray => {
                let core = form.core(p);
                let mut near = project(p, hint);
                for _ in 0..MOST_FACETS {
                    let n = rolling.polyhedron.mesh.normal(near.facet);
                    let t = n.dot(&(near.p_OC - core)) / n.dot(&(p - core));
                    let met = core + (p - core) * t;
                    if rolling.polyhedron.holds(near.facet, &met) {
                        return Contact { p_OC: met, n_O: n, ..near };
                    }
                    near = project(&met, near.facet);
                }
                near
            }
        }
    }
}

impl Corridor {
    /// Appends the way over the facets between the partners of a curve's points; the ends are given.
    ///
    /// Between two neighbouring points it is shortest, so it strays from the curve by the square of their
    /// distance only.
    pub fn follow(
        &mut self,
        (rolling, facets, form): (&Rolling, &Facets, &ClosedForm),
        (start, end): (&Spot, Option<&Spot>),
        curve: &Curve,
        legs: &mut Vec<Leg>,
    ) -> Spot {
        let mut at = *start;
        let inner = curve.points.len() - usize::from(end.is_some());
        for p in &curve.points[1..inner.max(1)] {
            let next = facets.back(form, rolling, p, facet_of(rolling, at.place));
            let next = Spot { place: rolling.polyhedron.place(next.facet, &next.p_OC), contact: next };
            self.step(rolling, &at, &next, legs);
            at = next;
        }
        if let Some(end) = end {
            self.step(rolling, &at, end, legs);
            at = *end;
        }
        at
    }

    /// Appends the legs from one place to one nearby.
    fn step(&mut self, rolling: &Rolling, from: &Spot, to: &Spot, legs: &mut Vec<Leg>) {
        let first = self.search(rolling, from.place, to.place);
        self.strip.straighten(&rolling.polyhedron, (from, to), first, &mut self.piece);
        legs.append(&mut self.piece);
    }

    /// Finds a way over few facets; the facet in which it begins.
    fn search(&mut self, rolling: &Rolling, from: Place, to: Place) -> u32 {
        let polyhedron = &rolling.polyhedron;
        let reached = &mut self.reached;
        reached.clear();
        self.strip.crossings.clear();
        polyhedron.facets_at(from, |facet| reached.push((facet, u32::MAX, u32::MAX)));
        let mut at = 0;
        while at < reached.len() && !holds(rolling, to, reached[at].0) {
            let facet = reached[at].0;
            for edge in 3 * facet..3 * facet + 3 {
                let entered = polyhedron.half_edges[edge as usize].twin;
                if reached.iter().all(|known| known.0 != entered / 3) {
                    reached.push((entered / 3, entered, at as u32));
                }
            }
            at += 1;
        }
        // A mesh of one part: the search has ended at the target.
        while let Some(&(_, entered, before)) = reached.get(at).filter(|entry| entry.1 != u32::MAX) {
            self.strip.crossings.push(entered);
            at = before as usize;
        }
        self.strip.crossings.reverse();
        self.reached.get(at).map_or(0, |entry| entry.0)
    }
}

/// A facet that holds a place.
fn facet_of(rolling: &Rolling, place: Place) -> u32 {
    match place {
        Place::Facet(facet) => facet,
        Place::Edge(edge) => edge / 3,
        Place::Vertex(vertex) => rolling.polyhedron.outgoing[vertex as usize] / 3,
    }
}

fn holds(rolling: &Rolling, place: Place, facet: u32) -> bool {
    let mut found = false;
    rolling.polyhedron.facets_at(place, |other| found |= other == facet);
    found
}
