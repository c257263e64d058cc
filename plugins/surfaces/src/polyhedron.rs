//! A closed mesh prepared for walking across its edges: half-edges, stars of vertices, convexity.

use regrasp_api::{Mesh, Vec3};
use std::f64::consts::TAU;

/// Points closer than this fraction of the object's size to an edge or vertex count as lying on it.
const SNAP: f64 = 1e-7;

/// An edge as seen from the facet to its left: the planar frame for unfolding that facet.
///
/// The frame's origin is the edge's first vertex, x runs along the edge, y into the facet.
#[derive(Clone, Copy, Debug)]
pub(crate) struct HalfEdge {
    /// Where the edge begins (m, in O).
    pub p_OE: Vec3,
    /// Its unit direction, in O.
    pub along_O: Vec3,
    /// Its length (m).
    pub length: f64,
    /// The facet's third corner in the edge's frame (m).
    pub apex: [f64; 2],
    /// The same edge seen from the facet across.
    pub twin: u32,
    /// The vertex where it begins.
    pub vertex: u32,
}

/// Coordinates of a point in the plane of an edge's frame (m).
pub(crate) type Planar = [f64; 2];

/// Length of a planar vector: quicker than `hypot`, whose care for overflow lengths of objects do not need.
pub(crate) fn planar_norm(x: f64, y: f64) -> f64 {
    (x * x + y * y).sqrt()
}

impl HalfEdge {
    /// The point `x` (m) along the edge, in O.
    pub fn at(&self, x: f64) -> Vec3 {
        self.p_OE + self.along_O * x
    }

    /// Position along the edge and distance from its line (m) of a point, as if turned into the facet's
    /// half-plane.
    pub fn unfold(&self, p_OP: &Vec3) -> Planar {
        let from = p_OP - self.p_OE;
        let x = from.dot(&self.along_O);
        [x, (from.norm_squared() - x * x).max(0.0).sqrt()]
    }
}

/// Where a point lies on the mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Place {
    /// Inside a facet.
    Facet(u32),
    /// On an edge, given by one of its half-edges.
    Edge(u32),
    /// At a vertex.
    Vertex(u32),
}

/// The prepared mesh. Half-edge `3 f + k` is edge `k` of facet `f`.
#[derive(Clone, Debug)]
pub(crate) struct Polyhedron {
    pub mesh: Mesh,
    /// The corners of every facet (m, in O), side by side.
    pub corners: Vec<[Vec3; 3]>,
    pub half_edges: Vec<HalfEdge>,
    /// The angle (rad) of each half-edge's direction around the vertex where it begins, counter-clockwise.
    pub direction: Vec<f64>,
    /// One half-edge that begins at each vertex: the one of direction 0.
    pub outgoing: Vec<u32>,
    /// The sum of the facets' angles at each vertex (rad).
    pub total_angle: Vec<f64>,
    /// Whether the solid is convex.
    pub convex: bool,
    /// Largest distance of a vertex from the origin (m).
    pub radius: f64,
    /// Distance below which points coincide (m).
    pub snap: f64,
}

/// The next half-edge of the same facet.
pub(crate) fn next(half_edge: u32) -> u32 {
    if half_edge % 3 == 2 { half_edge - 2 } else { half_edge + 1 }
}

/// The previous half-edge of the same facet.
pub(crate) fn previous(half_edge: u32) -> u32 {
    if half_edge.is_multiple_of(3) { half_edge + 2 } else { half_edge - 1 }
}

impl Polyhedron {
    /// Prepares a mesh; linear in its facets.
    pub fn new(mesh: &Mesh) -> Self {
        let count = mesh.facets().len() as u32;
        let half_edges: Vec<_> = (0..3 * count).map(|index| half_edge(mesh, index)).collect();
        let mut prepared = Self {
            mesh: mesh.clone(),
            corners: (0..count).map(|facet| mesh.corners(facet)).collect(),
            direction: vec![0.0; half_edges.len()],
            outgoing: vec![u32::MAX; mesh.vertices().len()],
            total_angle: vec![0.0; mesh.vertices().len()],
            convex: false,
            radius: mesh.radius(),
            snap: SNAP * mesh.radius(),
            half_edges,
        };
        prepared.measure_stars();
        prepared.convex = prepared.is_convex();
        prepared
    }

    fn measure_stars(&mut self) {
        for start in 0..self.half_edges.len() as u32 {
            let vertex = self.half_edges[start as usize].vertex as usize;
            if self.outgoing[vertex] != u32::MAX {
                continue;
            }
            self.outgoing[vertex] = start;
            let mut sum = 0.0;
            let mut at = start;
            loop {
                self.direction[at as usize] = sum;
                let [x, y] = self.half_edges[at as usize].apex;
                sum += y.atan2(x);
                at = self.counter_clockwise(at);
                if at == start {
                    break;
                }
            }
            self.total_angle[vertex] = sum;
        }
    }

    /// A locally convex closed surface that is connected and winds once (total curvature 4π) bounds a convex
    /// solid.
    fn is_convex(&self) -> bool {
        let curvature: f64 = self.total_angle.iter().map(|angle| TAU - angle).sum();
        self.mesh.is_locally_convex()
            && self.total_angle.iter().all(|&angle| angle < TAU + 1e-9)
            && (curvature - 2.0 * TAU).abs() < 1e-3
    }

    /// The next half-edge that begins at the same vertex, counter-clockwise seen from outside.
    pub fn counter_clockwise(&self, half_edge: u32) -> u32 {
        self.half_edges[previous(half_edge) as usize].twin
    }

    /// The half-edges that begin at a vertex, counter-clockwise from direction 0; each stands for the facet
    /// to its left.
    pub fn star(&self, vertex: u32) -> impl Iterator<Item = u32> + '_ {
        let first = self.outgoing[vertex as usize];
        let step = move |&at: &u32| Some(self.counter_clockwise(at)).filter(|&after| after != first);
        std::iter::successors((first != u32::MAX).then_some(first), step)
    }

    /// Whether more than a full turn of facets meets at the vertex, so that shortest paths may bend there.
    pub fn is_saddle(&self, vertex: u32) -> bool {
        self.total_angle[vertex as usize] > TAU + 1e-9
    }

    /// The vertex opposite to a half-edge in its facet.
    pub fn apex(&self, half_edge: u32) -> u32 {
        self.half_edges[previous(half_edge) as usize].vertex
    }

    /// Whether a point (m, in O) lies in a facet, to rounding.
    pub fn holds(&self, facet: u32, p_OP: &Vec3) -> bool {
        let Some(edges) = self.half_edges.get(3 * facet as usize..3 * facet as usize + 3) else {
            return false;
        };
        let n = self.mesh.normal(facet);
        let near = |edge: &HalfEdge| n.cross(&edge.along_O).dot(&(p_OP - edge.p_OE)) > -self.snap;
        n.dot(&(p_OP - edges[0].p_OE)).abs() < self.snap && edges.iter().all(near)
    }

    /// Where the point of a facet lies: inside, on an edge or at a vertex.
    pub fn place(&self, facet: u32, p_OP: &Vec3) -> Place {
        let edges = [3 * facet, 3 * facet + 1, 3 * facet + 2];
        for index in edges {
            if (p_OP - self.half_edges[index as usize].p_OE).norm_squared() < self.snap * self.snap {
                return Place::Vertex(self.half_edges[index as usize].vertex);
            }
        }
        for index in edges {
            let edge = &self.half_edges[index as usize];
            let [x, y] = edge.unfold(p_OP);
            if y < self.snap && (0.0..=edge.length).contains(&x) {
                return Place::Edge(index);
            }
        }
        Place::Facet(facet)
    }

    /// Calls `visit` with each facet that holds the place.
    pub fn facets_at(&self, place: Place, mut visit: impl FnMut(u32)) {
        match place {
            Place::Facet(facet) => visit(facet),
            Place::Edge(edge) => {
                visit(edge / 3);
                visit(self.half_edges[edge as usize].twin / 3);
            }
            Place::Vertex(vertex) => self.star(vertex).for_each(|edge| visit(edge / 3)),
        }
    }
}

fn half_edge(mesh: &Mesh, index: u32) -> HalfEdge {
    let (facet, k) = (index / 3, (index % 3) as usize);
    let corners = mesh.corners(facet);
    let (from, to, apex) = (corners[k], corners[(k + 1) % 3], corners[(k + 2) % 3]);
    let length = (to - from).norm();
    let along_O = (to - from) / length;
    let x = (apex - from).dot(&along_O);
    let y = along_O.cross(&(apex - from)).norm();
    let across = mesh.neighbors(facet)[k];
    HalfEdge {
        p_OE: from,
        along_O,
        length,
        apex: [x, y],
        twin: 3 * across.facet + u32::from(across.edge),
        vertex: mesh.facets()[facet as usize][k],
    }
}
