//! A fingertip on an object's facets: whatever a surface answers besides how its paths are found.

use crate::closest::ClosestPoints;
use crate::hollows::{Above, Follower, Room};
use crate::lift::{Leg, lift};
use crate::polyhedron::{Place, Polyhedron};
use crate::sharp::SharpEdges;
use crate::walk::walk;
use regrasp_api::{Contact, Mesh, Projection, Random, SurfacePath, Vec3};

/// The answers of a surface that are its rolling's alone.
macro_rules! rolling_answers {
    () => {
        fn sample(&self, random: &mut Random) -> Contact {
            self.rolling.sample(random)
        }

        fn project(&self, p_OF: &Vec3, hint: Option<u32>) -> Projection {
            self.rolling.project(p_OF, hint)
        }

        fn edge_distance(&self, contact: &Contact) -> f64 {
            self.rolling.edge_distance(contact)
        }
    };
}
pub(crate) use rolling_answers;

/// Samples before an object counts as having (almost) no area that a fingertip can touch.
const MOST_SAMPLES: usize = 1000;

/// A contact with its place on the facets.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Spot {
    pub contact: Contact,
    pub place: Place,
}

/// A polyhedron with a fingertip of one radius that rolls over it.
#[derive(Clone, Debug)]
pub(crate) struct Rolling {
    pub polyhedron: Polyhedron,
    pub closest: ClosestPoints,
    sharp: SharpEdges,
    /// What the fingertip may sink into; empty where it can nowhere.
    above: Above,
    /// The fingertip's radius (m).
    radius: f64,
    /// Largest distance (m) between two places of the fingertip that are looked at on solids that are not
    /// convex.
    step: f64,
    /// Sum of the facets' areas up to and with each facet (m²).
    areas: Vec<f64>,
}

impl Rolling {
    /// Prepares `mesh` for fingertips of the given radius (m). Edges are sharp beyond `sharp_angle_deg`;
    /// `step` (m) is at most a fifth of the radius.
    pub fn new(mesh: &Mesh, radius: f64, sharp_angle_deg: f64, step: f64) -> Self {
        let polyhedron = Polyhedron::new(mesh);
        let mut sum = 0.0;
        let areas = (0..mesh.facets().len() as u32).map(|facet| {
            sum += mesh.area(facet);
            sum
        });
        let closest = ClosestPoints::new(&polyhedron);
        let can_sink = !polyhedron.convex && radius > 0.0;
        Self {
            areas: areas.collect(),
            above: if can_sink { Above::new(&polyhedron, &closest, radius) } else { Above::default() },
            closest,
            sharp: SharpEdges::new(&polyhedron, sharp_angle_deg.to_radians(), radius),
            polyhedron,
            radius,
            step: step.min((radius / 5.0).max(1e-4)),
        }
    }

    /// Where a contact lies; its facet is looked up where it does not hold the point.
    pub fn spot(&self, contact: &Contact) -> Spot {
        let mut facet = contact.facet;
        if !self.polyhedron.holds(facet, &contact.p_OC) {
            facet = self.project(&contact.p_OC, Some(facet)).contact.facet;
        }
        Spot { contact: *contact, place: self.polyhedron.place(facet, &contact.p_OC) }
    }

    /// Fills `path` with the fingertip's way over `legs`, the last of which leads to the end; `false` where
    /// it cannot go.
    pub fn roll(
        &self,
        (start, end): (&Spot, &Spot),
        legs: &[Leg],
        path: &mut SurfacePath,
        room: &mut Room,
    ) -> bool {
        let ends = ((&start.contact, start.place), (&end.contact, end.place));
        lift(&self.polyhedron, self.radius, ends.0, ends.1, legs, path);
        path.length = length(legs, &end.contact);
        self.polyhedron.convex || self.radius == 0.0 || self.follower().follow(path, room)
    }

    /// A contact that the fingertip can have, uniform over the facets' area.
    pub fn sample(&self, random: &mut Random) -> Contact {
        for _ in 0..MOST_SAMPLES {
            let contact = self.on_facets(random);
            if self.polyhedron.convex || self.follower().is_free(&contact, 1e-10) {
                return contact;
            }
        }
        self.outermost(&random.direction())
    }

    /// The contact closest to a fingertip's centre `p_OF` (m).
    pub fn project(&self, p_OF: &Vec3, hint: Option<u32>) -> Projection {
        self.closest.project(&self.polyhedron, p_OF, hint)
    }

    /// The contact a `distance` (m) straight ahead; where the fingertip would sink in there, pushed out to
    /// where it touches.
    pub fn walk(&self, from: &Contact, direction_O: &Vec3, distance: f64) -> Contact {
        self.settled(walk(&self.polyhedron, from, self.spot(from).place, direction_O, distance))
    }

    /// The contact, or where the fingertip touches if it is pushed out from one at which it would sink in.
    pub fn settled(&self, contact: Contact) -> Contact {
        if self.polyhedron.convex { contact } else { self.follower().settled(contact) }
    }

    /// The straight distance (m) to the nearest sharp edge.
    pub fn edge_distance(&self, contact: &Contact) -> f64 {
        self.sharp.distance(contact.facet, &contact.p_OC)
    }

    fn follower(&self) -> Follower<'_> {
        let Self { polyhedron, closest, above, radius, step, .. } = self;
        Follower { polyhedron, closest, above, radius: *radius, step: *step }
    }

    /// The vertex farthest along a direction, with that direction as its normal: a contact that every
    /// fingertip reaches.
    fn outermost(&self, n_O: &Vec3) -> Contact {
        let vertices = self.polyhedron.mesh.vertices();
        let along = |&vertex: &u32| vertices[vertex as usize].dot(n_O);
        let farthest = (0..vertices.len() as u32).max_by(|a, b| along(a).total_cmp(&along(b))).unwrap_or(0);
        let facet = self.polyhedron.outgoing[farthest as usize] / 3;
        Contact { facet, p_OC: vertices[farthest as usize], n_O: *n_O }
    }

    /// A point uniform over the facets' area, with its facet's normal.
    fn on_facets(&self, random: &mut Random) -> Contact {
        let wanted = random.unit() * self.areas[self.areas.len() - 1];
        let facet = self.areas.partition_point(|&sum| sum <= wanted).min(self.areas.len() - 1) as u32;
        let [a, b, c] = self.polyhedron.mesh.corners(facet);
        // Turk, "Generating random points in triangles", Graphics Gems, 1990.
        let (s, t) = (random.unit().sqrt(), random.unit());
        let p_OC = a * (1.0 - s) + b * (s * (1.0 - t)) + c * (s * t);
        Contact { facet, p_OC, n_O: self.polyhedron.mesh.normal(facet) }
    }
}

/// Length (m) of a path over the facets.
pub(crate) fn length(legs: &[Leg], end: &Contact) -> f64 {
    let ends = legs.iter().skip(1).map(|leg| leg.p_OP).chain([end.p_OC]);
    legs.iter().zip(ends).map(|(leg, to)| (to - leg.p_OP).norm()).sum()
}
