//! `surface/steiner`: shortest paths over points on the edges, as the paper cites them.
//!
//! Lanthier, Maheshwari & Sack put *Steiner points* on the edges of a polyhedron, join those that lie on
//! different edges of one facet, and find the shortest path of that graph. Here an edge of length e carries
//! m = max(`fewest`, ⌈e / `spacing`⌉) points, each in the middle of one of m equal parts, so that no point of
//! the edge is farther than e / 2m from one. The graph is made once for an object, and A* finds the paths in
//! it.
//!
//! # Bound
//! The graph's path is at most Σ eᵢ/mᵢ longer than the shortest one, summed over the edges that the shortest
//! one crosses: moving each crossing to the nearest Steiner point lengthens the two pieces that meet there by
//! eᵢ/2mᵢ each at most. Hence `spacing` for each crossing. [`Steiner::bound`] adds it up for a path. The
//! paper's own points are the ends and the inner ends of equal parts; points at the vertices would make
//! strips of facets ambiguous and the bound no better.
//!
//! # Straightening
//! With `straighten` (default) the strip of facets of the graph's path is unfolded, and the path pulled tight
//! in it and in the strips around its bends: it becomes locally shortest, never longer than before. What is
//! left of the bound is the case that the graph prefers a strip on the wrong side of a vertex. Without, the
//! paths are those of the cited algorithm.
//!
//! # Beside paths
//! The fingertip's way above a path, samples, projections and walks are those of `surface/geodesic`. `false`
//! in the same cases: parts that are not connected, ends that cannot be touched, a fingertip that would have
//! to leap.
//!
//! # Cost
//! About the number of points within an ellipse around the two ends, each with its neighbours in two facets.

mod graph;

use crate::hollows::Room;
use crate::lift::Leg;
use crate::rolling::{Rolling, Spot, rolling_answers};
use crate::strip::Strip;
use graph::{Found, Graph, START, Scratch, Search};
use regrasp_api::{
    Build, BuildError, Built, CallError, Contact, Context, Entry, Mesh, Parts, Projection, Random, Settings,
    Slot, SurfaceParam, SurfacePath, Vec3, Waypoint, check_settings, inventory,
};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::cell::RefCell;

inventory::submit! {
    Entry {
        id: "surface/steiner",
        slots: &[Slot::Surface],
        summary: "Shortest paths over points on the edges, straightened (as the paper cites)",
        references: &[
            "Lanthier, Maheshwari & Sack, Approximating weighted shortest paths on polyhedral surfaces, \
             SoCG 1997",
            "Xin & Wang, Efficiently determining a locally exact shortest path on polyhedral surfaces, \
             Computer-Aided Design 39, 2007",
        ],
        schema: SteinerSettings::schema,
        check: check_settings::<SteinerSettings>,
        build: Build::Surface(build),
    }
}

fn build(json: &str, parts: &Parts<'_>) -> Built<dyn SurfaceParam> {
    let settings = SteinerSettings::from_json(json)?;
    Ok(Box::new(Steiner::new(&settings, parts.object.contact_mesh(), parts.hand.fingertip_radius())?))
}

/// Most points of one object: a spacing that needs more is refused.
const MOST_POINTS: f64 = 2e6;

/// Settings of [`Steiner`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct SteinerSettings {
    /// The fewest points on an edge. Default 2, a neutral choice.
    #[schemars(range(min = 1, max = 64))]
    pub fewest: u32,
    /// Largest distance (m) between neighbouring points of an edge. Default 0.002, a neutral choice.
    #[schemars(range(min = 1e-5, max = 1.0), extend("x-unit" = "m"))]
    pub spacing: f64,
    /// Whether paths are pulled tight in their strip of facets. Default true; false is the cited algorithm.
    pub straighten: bool,
    /// An edge is sharp where its facets' normals differ by more than this angle (degrees). Default 30, a
    /// neutral choice.
    #[schemars(range(min = 1.0, max = 180.0), extend("x-unit" = "degrees"))]
    pub sharp_angle_deg: f64,
    /// On solids that are not convex, the largest distance (m) between two places where the fingertip is
    /// checked; at most a fifth of its radius. Default 0.001, as for `surface/geodesic`.
    #[schemars(range(min = 1e-5, max = 1e-2), extend("x-unit" = "m"))]
    pub step: f64,
}

impl Default for SteinerSettings {
    fn default() -> Self {
        Self { fewest: 2, spacing: 2e-3, straighten: true, sharp_angle_deg: 30.0, step: 1e-3 }
    }
}

impl Settings for SteinerSettings {}

/// The surface of a polyhedron with Steiner points on its edges.
#[derive(Clone, Debug)]
pub struct Steiner {
    straighten: bool,
    rolling: Rolling,
    graph: Graph,
}

/// What a path needs beside the answer; one a thread, overwritten by every call.
#[derive(Default)]
struct Workspace {
    search: Scratch,
    points: Vec<u32>,
    strip: Strip,
    legs: Vec<Leg>,
    room: Room,
}

thread_local! {
    static WORKSPACE: RefCell<Workspace> = RefCell::new(Workspace::default());
}

impl Steiner {
    /// Prepares the surface of `mesh` for fingertips of the given radius (m).
    pub fn new(settings: &SteinerSettings, mesh: &Mesh, radius: f64) -> Result<Self, BuildError> {
        settings.validate()?;
        let rolling = Rolling::new(mesh, radius, settings.sharp_angle_deg, settings.step);
        let count = |length: f64| (length / settings.spacing).ceil().max(f64::from(settings.fewest));
        let points: f64 = rolling.polyhedron.half_edges.iter().map(|edge| count(edge.length) / 2.0).sum();
        if points > MOST_POINTS {
            return Err(BuildError::Unsupported(format!(
                "`surface/steiner`: {points:.0} points on this object's edges are too many \
                 ({MOST_POINTS:.0}): \
                 choose a larger `spacing` or fewer points an edge, or use `surface/geodesic`"
            )));
        }
        let graph = Graph::new(&rolling.polyhedron, settings.fewest, settings.spacing);
        Ok(Self { straighten: settings.straighten, rolling, graph })
    }

    /// By how much (m) a path of this surface may be longer than one that crosses the facets of `shortest` in
    /// turn.
    ///
    /// Edges shared by consecutive facets count; where a path crosses a vertex, edges between the facets
    /// before and behind it would have to be added.
    pub fn bound(&self, shortest: &SurfacePath) -> f64 {
        let polyhedron = &self.rolling.polyhedron;
        let part = |pair: &[Waypoint]| {
            let [from, to] = [pair[0].contact.facet, pair[1].contact.facet];
            let shared =
                (3 * from..3 * from + 3).find(|&edge| polyhedron.half_edges[edge as usize].twin / 3 == to);
            shared.map_or(0.0, |edge| self.graph.part(polyhedron, edge))
        };
        shortest.waypoints.windows(2).map(part).sum()
    }

    /// Writes the legs of the path that was found.
    fn trace(&self, workspace: &mut Workspace, found: &Found, (start, end): (&Spot, &Spot)) {
        let Workspace { search, points, strip, legs, .. } = workspace;
        points.clear();
        let mut at = found.last;
        while at != START {
            points.push(at);
            at = search.labels[at as usize].before;
        }
        points.reverse();
        let left_through =
            |index: usize| points.get(index + 1).map_or(found.facet, |&p| search.labels[p as usize].facet);
        let first = points.first().map_or(found.facet, |&p| search.labels[p as usize].facet);
        legs.clear();
        legs.push(Leg { p_OP: start.contact.p_OC, facet: first });
        strip.crossings.clear();
        for (index, &point) in points.iter().enumerate() {
            let (from, to) = (search.labels[point as usize].facet, left_through(index));
            legs.push(Leg { p_OP: self.graph.at(point), facet: to });
            if from != to {
                let edge = self.graph.edges[point as usize];
                let twin = self.rolling.polyhedron.half_edges[edge as usize].twin;
                strip.cross(&self.rolling.polyhedron, if edge / 3 == to { edge } else { twin });
            }
        }
        if self.straighten {
            strip.straighten(&self.rolling.polyhedron, (start, end), first, legs);
        }
    }
}

impl SurfaceParam for Steiner {
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
            let ends = (&self.rolling.spot(from), &self.rolling.spot(to));
            let search = Search {
                polyhedron: &self.rolling.polyhedron,
                graph: &self.graph,
                scratch: &mut workspace.search,
                p_OT: to.p_OC,
            };
            let Some(found) = search.run(ends, context)? else {
                path.restart(*from);
                return Ok(false);
            };
            self.trace(workspace, &found, ends);
            Ok(self.rolling.roll(ends, &workspace.legs, path, &mut workspace.room))
        })
    }

    fn walk(&self, from: &Contact, direction_O: &Vec3, distance: f64) -> Contact {
        self.rolling.walk(from, direction_O, distance)
    }
}
