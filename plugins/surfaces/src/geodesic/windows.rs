//! What a search for a shortest path keeps: windows, sources, labels of vertices.

use super::queue::Queue;
use crate::polyhedron::Planar;
use regrasp_api::Vec3;

/// Tells indices of sources (and, in the queue, of vertices) from those of windows.
pub(super) const FLAG: u32 = 1 << 31;

/// Where a straight piece of a path comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Arrival {
    /// Through the window of this number.
    Window(u32),
    /// From the source of this number, within one facet.
    Source(u32, u32),
}

/// Part of an edge, seen from the facet being entered.
#[derive(Clone, Copy, Debug)]
pub(super) struct Window {
    pub half_edge: u32,
    pub parent: u32,
    /// Ends of the part along the half-edge (m).
    pub ends: [f64; 2],
    /// The source, unfolded into the half-edge's frame (m); below the edge.
    pub source: Planar,
    /// Length of the path to the source (m).
    pub so_far: f64,
}

impl Window {
    /// The window or the source that this one continues.
    pub fn parent(&self) -> Parent {
        if self.parent & FLAG == 0 {
            Parent::Window(self.parent)
        } else {
            Parent::Source(self.parent & !FLAG)
        }
    }
}

/// What a window continues, by number.
#[derive(Clone, Copy, Debug)]
pub(super) enum Parent {
    /// A window.
    Window(u32),
    /// A source, whose facet is across the window's edge.
    Source(u32),
}

/// The start, or a saddle vertex where a path bends.
#[derive(Clone, Copy, Debug)]
pub(super) struct Source {
    pub p_OS: Vec3,
    pub length: f64,
    /// How the path comes here; `None` for the start.
    pub before: Option<Arrival>,
}

/// The best known way to a vertex.
#[derive(Clone, Copy, Debug)]
pub(super) struct Label {
    /// The search that wrote it.
    pub epoch: u64,
    pub length: f64,
    pub arrival: Arrival,
}
pub(super) const UNKNOWN: Label = Label { epoch: 0, length: f64::INFINITY, arrival: Arrival::Window(0) };

/// Memory of a search, kept between calls; nothing of one call shows in the next.
#[derive(Default)]
pub(super) struct Scratch {
    pub windows: Vec<Window>,
    pub sources: Vec<Source>,
    pub queue: Queue,
    pub labels: Vec<Label>,
    pub epoch: u64,
    /// Facets that hold the start.
    pub start_facets: Vec<u32>,
    /// Facets that hold the target.
    pub target_facets: Vec<u32>,
}
