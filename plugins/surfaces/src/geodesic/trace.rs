//! From the windows of a search back to the path's points.

use super::plane::cross;
use super::windows::{Arrival, Parent, Scratch};
use crate::lift::Leg;
use crate::polyhedron::{Planar, Polyhedron, next, previous};
use regrasp_api::Vec3;

/// Writes the path's points from start to target, the target excluded, each with the facet of the piece that
/// follows.
pub(super) fn trace(
    polyhedron: &Polyhedron,
    scratch: &Scratch,
    last: Arrival,
    p_OT: &Vec3,
    legs: &mut Vec<Leg>,
) {
    legs.clear();
    let (mut arrival, mut to) = (last, *p_OT);
    loop {
        let source = match arrival {
            Arrival::Window(index) => strip(polyhedron, scratch, index, &to, legs),
            Arrival::Source(source, facet) => {
                legs.push(Leg { p_OP: scratch.sources[source as usize].p_OS, facet });
                source
            }
        };
        let source = &scratch.sources[source as usize];
        match source.before {
            Some(before) => (arrival, to) = (before, source.p_OS),
            None => break,
        }
    }
    legs.reverse();
}

/// Follows one unfolded strip back to its source.
fn strip(polyhedron: &Polyhedron, scratch: &Scratch, last: u32, p_OT: &Vec3, legs: &mut Vec<Leg>) -> u32 {
    let mut window = &scratch.windows[last as usize];
    let mut to = polyhedron.half_edges[window.half_edge as usize].unfold(p_OT);
    loop {
        let frame = &polyhedron.half_edges[window.half_edge as usize];
        let x = cross(&window.source, &to).clamp(0.0, frame.length);
        legs.push(Leg { p_OP: frame.at(x), facet: window.half_edge / 3 });
        match window.parent() {
            Parent::Window(parent) => {
                let child = window.half_edge;
                window = &scratch.windows[parent as usize];
                to = in_parent(polyhedron, window.half_edge, child, x);
            }
            Parent::Source(source) => {
                let p_OS = scratch.sources[source as usize].p_OS;
                legs.push(Leg { p_OP: p_OS, facet: frame.twin / 3 });
                return source;
            }
        }
    }
}

/// The point `x` along a child's half-edge, in the frame of the half-edge through which its facet was
/// entered.
fn in_parent(polyhedron: &Polyhedron, parent: u32, child: u32, x: f64) -> Planar {
    let frame = &polyhedron.half_edges[parent as usize];
    let edge = polyhedron.half_edges[child as usize].twin;
    let t = x / polyhedron.half_edges[child as usize].length;
    let [ax, ay] = frame.apex;
    if edge == next(parent) {
        [ax + (frame.length - ax) * t, ay * (1.0 - t)]
    } else {
        debug_assert_eq!(edge, previous(parent));
        [ax * t, ay * t]
    }
}
