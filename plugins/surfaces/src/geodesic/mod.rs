//! `surface/geodesic`: exact shortest paths on the object's facets, and the fingertip's path above them.
//!
//! The facets are the true surface. Contacts live on the offset surface (object ⊕ fingertip ball): on a facet
//! the normal is the facet's, on a convex edge it is any direction between those of its two facets.
//!
//! - *Geodesic*: exact windows led towards the target (`search`), for any closed mesh, to the relative
//!   `tolerance`. The fingertip rolls over the path's facets (`lift`); on solids that are not convex it
//!   slides over the hollows that it cannot enter (`hollows`). `false` where the mesh's parts are not
//!   connected, where an end cannot be touched, or where the fingertip would have to leap.
//! - *Projection*: a walk from the hint, certain outside of convex solids; else a hierarchy of boxes.
//! - *Walk*: straightest geodesic; on solids that are not convex the end is pushed out to where the fingertip
//!   touches.
//! - *Edge distance*: straight, which is never longer than along the surface.

mod bound;
mod plane;
mod queue;
mod search;
mod trace;
mod windows;

use crate::hollows::Room;
use crate::lift::Leg;
use crate::rolling::{Rolling, rolling_answers};
use bound::{Ball, LowerBound};
use regrasp_api::{
    Build, BuildError, Built, CallError, Contact, Context, Entry, Mesh, Parts, Projection, Random, Settings,
    Slot, SurfaceParam, SurfacePath, Vec3, check_settings, inventory,
};
use schemars::JsonSchema;
use search::Search;
use serde::{Deserialize, Serialize};
use std::cell::RefCell;
use std::sync::OnceLock;
use windows::Scratch;

inventory::submit! {
    Entry {
        id: "surface/geodesic",
        slots: &[Slot::Surface],
        summary: "Exact shortest paths on the object's facets, followed by the fingertip",
        references: &[
            "Mitchell, Mount & Papadimitriou, The discrete geodesic problem, SIAM J. Comput. 16, 1987",
            "Xin & Wang, Improving Chen and Han's algorithm on the discrete geodesic problem, ACM TOG 28, \
             2009",
            "Polthier & Schmies, Straightest geodesics on polyhedral surfaces, 1998",
            "Bærentzen & Aanæs, Signed distance computation using the angle weighted pseudonormal, IEEE \
             TVCG 11, 2005",
        ],
        schema: GeodesicSettings::schema,
        check: check_settings::<GeodesicSettings>,
        build: Build::Surface(build),
    }
}

fn build(json: &str, parts: &Parts<'_>) -> Built<dyn SurfaceParam> {
    let settings = GeodesicSettings::from_json(json)?;
    Ok(Box::new(Geodesic::new(&settings, parts.object.contact_mesh(), parts.hand.fingertip_radius())?))
}

/// Settings of [`Geodesic`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct GeodesicSettings {
    /// An edge is sharp where its facets' normals differ by more than this angle (degrees). Default 30, a
    /// neutral choice.
    #[schemars(range(min = 1.0, max = 180.0), extend("x-unit" = "degrees"))]
    pub sharp_angle_deg: f64,
    /// On solids that are not convex, the largest distance (m) between two places where the fingertip is
    /// checked; at most a fifth of its radius r. A spike between two places sinks in by step²/(8 r) at most.
    /// Default 0.001, the step of a transfer: 13 µm for a radius of 10 mm, less than a plan's tolerance of
    /// closure.
    #[schemars(range(min = 1e-5, max = 1e-2), extend("x-unit" = "m"))]
    pub step: f64,
    /// By how much a path may be longer than the shortest one, relative. Default 2e-4, a neutral choice.
    #[schemars(range(min = 1e-9, max = 1e-3), extend("x-unit" = "1"))]
    pub tolerance: f64,
}

impl Default for GeodesicSettings {
    fn default() -> Self {
        Self { sharp_angle_deg: 30.0, step: 1e-3, tolerance: 2e-4 }
    }
}

impl Settings for GeodesicSettings {}

/// The surface of a polyhedron under a fingertip of one radius.
#[derive(Clone, Debug)]
pub struct Geodesic {
    tolerance: f64,
    rolling: Rolling,
    /// Found when the first path is asked for: many plans ask for none.
    balls: OnceLock<Vec<Ball>>,
}

/// What a path needs beside the answer; one a thread, overwritten by every call.
#[derive(Default)]
struct Workspace {
    search: Scratch,
    legs: Vec<Leg>,
    room: Room,
}

thread_local! {
    static WORKSPACE: RefCell<Workspace> = RefCell::new(Workspace::default());
}

impl Geodesic {
    /// Prepares the surface of `mesh` for fingertips of the given radius (m).
    pub fn new(settings: &GeodesicSettings, mesh: &Mesh, radius: f64) -> Result<Self, BuildError> {
        settings.validate()?;
        let rolling = Rolling::new(mesh, radius, settings.sharp_angle_deg, settings.step);
        Ok(Self { tolerance: settings.tolerance, rolling, balls: OnceLock::new() })
    }

    fn balls(&self) -> &[Ball] {
        self.balls.get_or_init(|| bound::inscribed_balls(&self.rolling.polyhedron, &self.rolling.closest))
    }
}

impl SurfaceParam for Geodesic {
    rolling_answers!();

    fn geodesic(
        &self,
        from: &Contact,
        to: &Contact,
        path: &mut SurfacePath,
        context: &mut Context<'_>,
    ) -> Result<bool, CallError> {
        context.count_call(Slot::Surface);
        WORKSPACE.with_borrow_mut(|workspace| {
            let Workspace { search, legs, room } = workspace;
            let polyhedron = &self.rolling.polyhedron;
            let bound = LowerBound::new(self.balls(), &from.p_OC, &to.p_OC);
            let (start, target) = (self.rolling.spot(from), self.rolling.spot(to));
            let job = Search::new(polyhedron, search, bound, &target, self.tolerance, f64::INFINITY);
            let Some(last) = job.run(&start, context)? else {
                path.restart(*from);
                return Ok(false);
            };
            trace::trace(polyhedron, search, last, &to.p_OC, legs);
            Ok(self.rolling.roll((&start, &target), legs, path, room))
        })
    }

    fn walk(&self, from: &Contact, direction_O: &Vec3, distance: f64) -> Contact {
        self.rolling.walk(from, direction_O, distance)
    }
}
