//! `surface/geodesic`: exact shortest paths on the object's facets, and the fingertip's path above them.
//!
//! The facets are the true surface. Contacts live on the offset surface (object ⊕ fingertip ball): on a facet the normal
//! is the facet's, on a convex edge it is any direction between those of its two facets.
//!
//! - *Geodesic*: exact windows led towards the target (`search`), for any closed mesh, to the relative `tolerance`. The
//!   fingertip rolls over the path's facets (`lift`); on solids that are not convex it slides over the hollows that it
//!   cannot enter (`follow`). `false` where the mesh's parts are not connected, where an end cannot be touched, or where
//!   the fingertip would have to leap.
//! - *Projection*: a walk from the hint, certain outside of convex solids; else a hierarchy of boxes.
//! - *Walk*: straightest geodesic; on solids that are not convex the end is pushed out to where the fingertip touches.
//! - *Edge distance*: straight, which is never longer than along the surface.

mod bound;
mod follow;
mod lift;
mod plane;
mod queue;
mod search;
mod trace;
mod walk;
mod windows;

use crate::closest::ClosestPoints;
use crate::polyhedron::Polyhedron;
use crate::sharp::SharpEdges;
use bound::{Ball, LowerBound};
use follow::Follower;
use regrasp_api::{
    Build, BuildError, Built, CallError, Contact, Context, Entry, Mesh, Parts, Projection, Random, Settings,
    SettingsError, Slot, SurfaceParam, SurfacePath, Vec3, Waypoint, check_range, check_settings, inventory,
};
use schemars::JsonSchema;
use search::Search;
use serde::{Deserialize, Serialize};
use std::cell::RefCell;
use trace::Leg;
use windows::{Scratch, Site};

inventory::submit! {
    Entry {
        id: "surface/geodesic",
        slots: &[Slot::Surface],
        summary: "Exact shortest paths on the object's facets, followed by the fingertip",
        references: &[
            "Mitchell, Mount & Papadimitriou, The discrete geodesic problem, SIAM J. Comput. 16, 1987",
            "Xin & Wang, Improving Chen and Han's algorithm on the discrete geodesic problem, ACM TOG 28, 2009",
            "Polthier & Schmies, Straightest geodesics on polyhedral surfaces, 1998",
            "Bærentzen & Aanæs, Signed distance computation using the angle weighted pseudonormal, IEEE TVCG 11, 2005",
        ],
        schema: GeodesicSettings::schema,
        check: check_settings::<GeodesicSettings>,
        build: Build::Surface(build),
    }
}

fn build(json: &str, parts: &Parts<'_>) -> Built<dyn SurfaceParam> {
    let settings = GeodesicSettings::from_json(json)?;
    Ok(Box::new(Geodesic::new(&settings, &parts.object.mesh, parts.hand.fingertip_radius())?))
}

/// Samples before an object counts as having (almost) no area that a fingertip can touch.
const MOST_SAMPLES: usize = 1000;

/// Settings of [`Geodesic`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct GeodesicSettings {
    /// An edge is sharp where its facets' normals differ by more than this angle, in 1..=180 degrees. Default 30, a neutral choice.
    pub sharp_angle_deg: f64,
    /// On solids that are not convex, the largest distance (m) between two places where the fingertip is checked, in
    /// 1e-5..=1e-2; at most a fifth of its radius r. A spike between two places sinks in by step²/(8 r) at most. Default
    /// 0.001, the step of a transfer: 13 µm for a radius of 10 mm, less than a plan's tolerance of closure.
    pub step: f64,
    /// By how much a path may be longer than the shortest one, relative, in 1e-9..=1e-3. Default 2e-4, a neutral choice.
    pub tolerance: f64,
}

impl Default for GeodesicSettings {
    fn default() -> Self {
        Self { sharp_angle_deg: 30.0, step: 1e-3, tolerance: 2e-4 }
    }
}

impl Settings for GeodesicSettings {
    fn validate(&self) -> Result<(), SettingsError> {
        check_range("sharp_angle_deg", self.sharp_angle_deg, 1.0, 180.0)?;
        check_range("step", self.step, 1e-5, 1e-2)?;
        check_range("tolerance", self.tolerance, 1e-9, 1e-3)
    }
}

/// The surface of a polyhedron under a fingertip of one radius.
#[derive(Clone, Debug)]
pub struct Geodesic {
    settings: GeodesicSettings,
    radius: f64,
    polyhedron: Polyhedron,
    closest: ClosestPoints,
    sharp: SharpEdges,
    balls: Vec<Ball>,
    /// Largest distance (m) between two places of the fingertip that are looked at on solids that are not convex.
    step: f64,
    /// Sum of the facets' areas up to and with each facet (m²).
    areas: Vec<f64>,
}

/// What a path needs beside the answer; one a thread, overwritten by every call.
#[derive(Default)]
struct Workspace {
    search: Scratch,
    legs: Vec<Leg>,
    rolled: Vec<Waypoint>,
}

thread_local! {
    static WORKSPACE: RefCell<Workspace> = RefCell::new(Workspace::default());
}

impl Geodesic {
    /// Prepares the surface of `mesh` for fingertips of the given radius (m).
    pub fn new(settings: &GeodesicSettings, mesh: &Mesh, radius: f64) -> Result<Self, BuildError> {
        settings.validate()?;
        let polyhedron = Polyhedron::new(mesh);
        let closest = ClosestPoints::new(&polyhedron);
        let mut sum = 0.0;
        let areas = (0..mesh.facets().len() as u32).map(|facet| {
            sum += mesh.area(facet);
            sum
        });
        Ok(Self {
            settings: *settings,
            radius,
            step: settings.step.min((radius / 5.0).max(1e-4)),
            areas: areas.collect(),
            balls: bound::inscribed_balls(&polyhedron, &closest),
            closest,
            sharp: SharpEdges::new(&polyhedron, settings.sharp_angle_deg.to_radians()),
            polyhedron,
        })
    }

    /// The vertex farthest along a direction, with that direction as its normal: a contact that every fingertip reaches.
    fn outermost(&self, n_O: &Vec3) -> Contact {
        let vertices = self.polyhedron.mesh.vertices();
        let along = |&vertex: &u32| vertices[vertex as usize].dot(n_O);
        let farthest = (0..vertices.len() as u32).max_by(|a, b| along(a).total_cmp(&along(b))).unwrap_or(0);
        let facet = self.polyhedron.outgoing[farthest as usize] / 3;
        Contact { facet, p_OC: vertices[farthest as usize], n_O: *n_O }
    }

    /// Where a contact lies; its facet is looked up where it does not hold the point.
    fn site(&self, contact: &Contact) -> Site {
        let p_OP = contact.p_OC;
        let facet = if self.polyhedron.holds(contact.facet, &p_OP) {
            contact.facet
        } else {
            self.project(&p_OP, Some(contact.facet)).contact.facet
        };
        Site { p_OP, place: self.polyhedron.place(facet, &p_OP) }
    }

    fn follower(&self) -> Follower<'_> {
        let (polyhedron, closest) = (&self.polyhedron, &self.closest);
        Follower { polyhedron, closest, radius: self.radius, step: self.step }
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

impl SurfaceParam for Geodesic {
    fn sample(&self, random: &mut Random) -> Contact {
        for _ in 0..MOST_SAMPLES {
            let contact = self.on_facets(random);
            if self.polyhedron.convex || self.follower().is_free(&contact, 1e-10) {
                return contact;
            }
        }
        self.outermost(&random.direction())
    }

    fn geodesic(
        &self,
        from: &Contact,
        to: &Contact,
        path: &mut SurfacePath,
        context: &mut Context<'_>,
    ) -> Result<bool, CallError> {
        context.count_call(Slot::Surface);
        WORKSPACE.with_borrow_mut(|workspace| {
            let Workspace { search, legs, rolled } = workspace;
            let bound = LowerBound::new(&self.balls, &from.p_OC, &to.p_OC);
            let (start, target) = (self.site(from), self.site(to));
            let job =
                Search::new(&self.polyhedron, search, bound, &target, self.settings.tolerance, f64::INFINITY);
            let Some(found) = job.run(&start, context)? else {
                path.restart(*from);
                return Ok(false);
            };
            trace::trace(&self.polyhedron, search, &found, &to.p_OC, legs);
            lift::lift(&self.polyhedron, self.radius, (from, start.place), (to, target.place), legs, path);
            path.length = found.length;
            Ok(self.polyhedron.convex || self.radius == 0.0 || self.follower().follow(path, rolled))
        })
    }

    fn project(&self, p_OF: &Vec3, hint: Option<u32>) -> Projection {
        self.closest.project(&self.polyhedron, p_OF, hint)
    }

    fn walk(&self, from: &Contact, direction_O: &Vec3, distance: f64) -> Contact {
        let reached = walk::walk(&self.polyhedron, from, self.site(from).place, direction_O, distance);
        if self.polyhedron.convex { reached } else { self.follower().settled(reached) }
    }

    fn edge_distance(&self, contact: &Contact) -> f64 {
        self.sharp.distance(contact.facet, &contact.p_OC)
    }
}
