//! `surface/heat`: shortest paths by the heat method, straightened.
//!
//! Crane, Weischedel & Wardetzky find the distances of all points from one by two sparse linear systems: heat
//! flows from the point for a short time, and the function whose gradients point along its flow with unit
//! length is the distance. Both matrices depend on the object alone and are factorised once, when the surface
//! is built; a path costs two solutions for each of its ends.
//!
//! # How exact
//! The field is as exact as its mesh is fine: facets are cut into four until there are at least
//! `fewest_facets`, and both systems are set up on the intrinsic Delaunay triangulation of the vertices
//! (`delaunay`), so that thin facets do no harm. By itself the field is off by some per cent, so it only says
//! which ways a path may take: down the field from either end, and through the places between where the sum
//! of both fields is lowest (`sides`), once for each side of an obstacle; the best of them is then tried on
//! the other side of each sharp corner that it passes. Each way's strip of facets is unfolded and pulled
//! tight in it and in the strips around its bends (Xin & Wang 2007), and the shortest is taken. It is locally
//! shortest on the facets as they are, the same length both ways, and within 2 % of the shortest in the
//! tests, nearly always the shortest.
//!
//! # Cost
//! Two solutions of each system for a path: about a millisecond with the default 3000 facets, 8 ms with
//! 20,480 facets. Where single paths are asked for, `surface/geodesic` is tens to hundreds of times faster;
//! what the heat method shows is the cost of all distances at once. Preparation: 25 ms and 3 MB for 1,280
//! facets (cut to 5,120), 0.15 s and 40 MB for 20,480.
//!
//! # Beside paths
//! The fingertip's way above a path, samples, projections and walks are those of `surface/geodesic`. `false`
//! in the same cases: parts that are not connected, ends that cannot be touched, a fingertip that would have
//! to leap.
//!
//! # Where it fails
//! A field may have false minima where facets are extremely thin: the descent then ends there, and the rest
//! of the strip crosses as few facets as possible, which may be far from shortest before it is pulled tight.

mod delaunay;
mod descent;
mod field;
mod fine;
mod sides;

use crate::hollows::Room;
use crate::lift::Leg;
use crate::rolling::{Rolling, Spot, length, rolling_answers};
use crate::strip::Strip;
use descent::Descent;
use field::Field;
use fine::{Fine, FinePoint};
use regrasp_api::{
    Build, BuildError, Built, CallError, Contact, Context, Entry, Mesh, Parts, Projection, Random, Settings,
    Slot, SurfaceParam, SurfacePath, Vec3, check_settings, inventory,
};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use sides::Sides;
use std::cell::RefCell;

inventory::submit! {
    Entry {
        id: "surface/heat",
        slots: &[Slot::Surface],
        summary: "Paths down the distances of the heat method, straightened",
        references: &[
            "Crane, Weischedel & Wardetzky, Geodesics in heat: a new approach to computing distance based \
             on heat flow, ACM TOG 32, 2013",
            "Bobenko & Springborn, A discrete Laplace-Beltrami operator for simplicial surfaces, Discrete \
             Comput. Geom. 38, 2007",
            "Xin & Wang, Efficiently determining a locally exact shortest path on polyhedral surfaces, \
             Computer-Aided Design 39, 2007",
        ],
        schema: HeatSettings::schema,
        check: check_settings::<HeatSettings>,
        build: Build::Surface(build),
    }
}

fn build(json: &str, parts: &Parts<'_>) -> Built<dyn SurfaceParam> {
    let settings = HeatSettings::from_json(json)?;
    Ok(Box::new(Heat::new(&settings, parts.object.contact_mesh(), parts.hand.fingertip_radius())?))
}

/// A vertex is a corner where its facets' angles differ from a full turn by more (rad): locally shortest
/// paths on both sides of it can differ by per cents.
const CORNER: f64 = 0.3;
/// Times that a path is led around the other side of a corner.
const MOST_CORNERS: usize = 8;

/// Settings of [`Heat`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct HeatSettings {
    /// Facets are cut into four until there are this many. Default 3000, a neutral choice.
    #[schemars(range(min = 1, max = 100_000))]
    pub fewest_facets: u32,
    /// Time of the heat flow over the mean edge's length squared (no unit). Default 1, the paper's value.
    #[schemars(range(min = 0.1, max = 1000.0), extend("x-unit" = "1"))]
    pub smoothing: f64,
    /// An edge is sharp where its facets' normals differ by more than this angle (degrees). Default 30, a
    /// neutral choice.
    #[schemars(range(min = 1.0, max = 180.0), extend("x-unit" = "degrees"))]
    pub sharp_angle_deg: f64,
    /// On solids that are not convex, the largest distance (m) between two places where the fingertip is
    /// checked; at most a fifth of its radius. Default 0.001, as for `surface/geodesic`.
    #[schemars(range(min = 1e-5, max = 1e-2), extend("x-unit" = "m"))]
    pub step: f64,
}

impl Default for HeatSettings {
    fn default() -> Self {
        Self { fewest_facets: 3000, smoothing: 1.0, sharp_angle_deg: 30.0, step: 1e-3 }
    }
}

impl Settings for HeatSettings {}

/// The surface of a polyhedron with the factors of its heat and Laplace systems.
#[derive(Clone)]
pub struct Heat {
    rolling: Rolling,
    fine: Fine,
    field: Field,
}

/// A strip of facets, and the path that was pulled tight in it.
#[derive(Default)]
struct Way {
    strip: Strip,
    legs: Vec<Leg>,
}

/// What a path needs beside the answer; one a thread, overwritten by every call.
#[derive(Default)]
struct Workspace {
    /// Distances (m) of the fine mesh's vertices from the path's start and from its end.
    phi: [Vec<f64>; 2],
    divergence: Vec<f64>,
    sides: Sides,
    half: Strip,
    best: Way,
    tried: Way,
    room: Room,
}

thread_local! {
    static WORKSPACE: RefCell<Workspace> = RefCell::new(Workspace::default());
}

impl Heat {
    /// Prepares the surface of `mesh` for fingertips of the given radius (m).
    pub fn new(settings: &HeatSettings, mesh: &Mesh, radius: f64) -> Result<Self, BuildError> {
        settings.validate()?;
        let rolling = Rolling::new(mesh, radius, settings.sharp_angle_deg, settings.step);
        let fine = Fine::new(mesh, settings.fewest_facets as usize).map_err(|error| {
            BuildError::Unsupported(format!(
                "{error}; choose a smaller `fewest_facets` or use `surface/geodesic`"
            ))
        })?;
        let field = Field::new(&fine, settings.smoothing)?;
        Ok(Self { rolling, fine, field })
    }

    /// Leads `strip` down the distances from a target.
    fn descend(&self, from: &FinePoint, target: &FinePoint, phi: &[f64], strip: &mut Strip) {
        let (coarse, fine) = (&self.rolling.polyhedron, &self.fine);
        Descent { coarse, fine, phi, strip, target: *target }.run(from);
    }

    /// The shortest of the straightened paths down both fields and through the places between, in
    /// `workspace.best`.
    fn search(&self, workspace: &mut Workspace, [start, end]: [&(Spot, FinePoint); 2]) {
        let coarse = &self.rolling.polyhedron;
        let Workspace { phi, divergence, sides, half, best, tried, .. } = workspace;
        for (phi, from) in phi.iter_mut().zip([start, end]) {
            self.field.distances(&self.fine, &from.1, phi, divergence);
        }
        let [from_start, from_end] = [&phi[0][..], &phi[1][..]];
        best.legs.clear();
        self.descend(&start.1, &end.1, from_end, &mut tried.strip);
        self.compare([start, end], tried, best);
        self.descend(&end.1, &start.1, from_start, &mut tried.strip);
        tried.strip.reverse(coarse);
        self.compare([start, end], tried, best);
        for place in sides.find(&self.fine, [from_start, from_end]) {
            self.descend(&place, &start.1, from_start, &mut tried.strip);
            tried.strip.reverse(coarse);
            self.descend(&place, &end.1, from_end, half);
            half.crossings.iter().for_each(|&crossing| tried.strip.cross(coarse, crossing));
            self.compare([start, end], tried, best);
        }
        self.pass_corners([start, end], tried, best);
    }

    /// Leads the best path around the other side of corners as long as that makes it shorter.
    fn pass_corners(&self, ends: [&(Spot, FinePoint); 2], tried: &mut Way, best: &mut Way) {
        let coarse = &self.rolling.polyhedron;
        for _ in 0..MOST_CORNERS {
            let shorter = best.strip.corners(coarse, CORNER).into_iter().any(|corner| {
                tried.strip.pass(coarse, &best.strip, corner);
                self.compare(ends, tried, best)
            });
            if !shorter {
                break;
            }
        }
    }

    /// Pulls the tried strip tight; it becomes the best if it is shorter.
    fn compare(&self, [start, end]: [&(Spot, FinePoint); 2], tried: &mut Way, best: &mut Way) -> bool {
        let only = self.fine.parent(start.1.facet);
        tried.strip.straighten(&self.rolling.polyhedron, (&start.0, &end.0), only, &mut tried.legs);
        let [ours, theirs] = [&*tried, &*best].map(|way| length(&way.legs, &end.0.contact));
        let is_shorter = best.legs.is_empty() || ours < theirs * (1.0 - 1e-12);
        if is_shorter {
            std::mem::swap(tried, best);
        }
        is_shorter
    }
}

impl SurfaceParam for Heat {
    rolling_answers!();

    fn geodesic(
        &self,
        from: &Contact,
        to: &Contact,
        path: &mut SurfacePath,
        context: &mut Context<'_>,
    ) -> Result<bool, CallError> {
        context.count_call(Slot::Surface);
        context.proceed()?;
        let [start, end] = [from, to].map(|contact| {
            let spot = self.rolling.spot(contact);
            (spot, self.fine.locate(&self.rolling.polyhedron, &spot))
        });
        if !self.fine.connected(start.1.facet, end.1.facet) {
            path.restart(*from);
            return Ok(false);
        }
        WORKSPACE.with_borrow_mut(|workspace| {
            self.search(workspace, [&start, &end]);
            Ok(self.rolling.roll((&start.0, &end.0), &workspace.best.legs, path, &mut workspace.room))
        })
    }

    fn walk(&self, from: &Contact, direction_O: &Vec3, distance: f64) -> Contact {
        self.rolling.walk(from, direction_O, distance)
    }
}
