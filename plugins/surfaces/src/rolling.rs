//! The fingertip's way above any path over the facets, shared by the surfaces whose paths are not windows.
//!
//! How a ball rolls over facets and slides over hollows is the same for every path: `lift` and `follow` are the sources of
//! `surface/geodesic`, and points, projections and walks are its answers.

// Their home is the default surface: the same source, so that both roll alike; not all of it is of use here.
#[allow(clippy::duplicate_mod, dead_code)]
#[path = "geodesic/follow.rs"]
mod follow;
#[allow(clippy::duplicate_mod)]
#[path = "geodesic/lift.rs"]
mod lift;
pub(crate) mod trace {
    //! What a path over the facets is made of.

    use regrasp_api::Vec3;

    /// A point of a path and the facet in which the path leaves it.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub(crate) struct Leg {
        pub p_OP: Vec3,
        pub facet: u32,
    }
}

use crate::closest::ClosestPoints;
use crate::geodesic::{Geodesic, GeodesicSettings};
use crate::polyhedron::{Place, Polyhedron};
use follow::Follower;
use regrasp_api::{BuildError, Contact, Mesh, SurfaceParam, SurfacePath, Waypoint};
use trace::Leg;

/// A contact's place on the facets.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Spot {
    pub contact: Contact,
    pub place: Place,
}

/// A polyhedron with a fingertip of one radius that rolls over it.
#[derive(Clone, Debug)]
pub(crate) struct Rolling {
    pub polyhedron: Polyhedron,
    /// Answers what does not depend on how paths are found: points, projections, walks.
    pub points: Geodesic,
    closest: ClosestPoints,
    radius: f64,
    step: f64,
}

impl Rolling {
    /// Prepares `mesh` for fingertips of the given radius (m); the settings mean what they mean for `surface/geodesic`.
    pub fn new(mesh: &Mesh, radius: f64, sharp_angle_deg: f64, step: f64) -> Result<Self, BuildError> {
        let settings = GeodesicSettings { sharp_angle_deg, step, ..GeodesicSettings::default() };
        let polyhedron = Polyhedron::new(mesh);
        Ok(Self {
            points: Geodesic::new(&settings, mesh, radius)?,
            closest: ClosestPoints::new(&polyhedron),
            polyhedron,
            radius,
            step: step.min((radius / 5.0).max(1e-4)),
        })
    }

    /// Where a contact lies; its facet is looked up where it does not hold the point.
    pub fn spot(&self, contact: &Contact) -> Spot {
        let mut facet = contact.facet;
        if !self.polyhedron.holds(facet, &contact.p_OC) {
            facet = self.points.project(&contact.p_OC, Some(facet)).contact.facet;
        }
        Spot { contact: *contact, place: self.polyhedron.place(facet, &contact.p_OC) }
    }

    /// Fills `path` with the fingertip's way over `legs`, the last of which leads to the end; `false` where it cannot go.
    pub fn roll(
        &self,
        (start, end): (&Spot, &Spot),
        legs: &[Leg],
        path: &mut SurfacePath,
        rolled: &mut Vec<Waypoint>,
    ) -> bool {
        let ends = ((&start.contact, start.place), (&end.contact, end.place));
        lift::lift(&self.polyhedron, self.radius, ends.0, ends.1, legs, path);
        path.length = length(legs, &end.contact);
        let follower = Follower {
            polyhedron: &self.polyhedron,
            closest: &self.closest,
            radius: self.radius,
            step: self.step,
        };
        self.polyhedron.convex || self.radius == 0.0 || follower.follow(path, rolled)
    }
}

/// Length (m) of a path over the facets.
fn length(legs: &[Leg], end: &Contact) -> f64 {
    let ends = legs.iter().skip(1).map(|leg| leg.p_OP).chain([end.p_OC]);
    legs.iter().zip(ends).map(|(leg, to)| (to - leg.p_OP).norm()).sum()
}
