//! Plane geometry of unfolded facets.

use crate::polyhedron::{HalfEdge, Planar, planar_norm};

/// The part of the edge opposite to a frame's origin between two directions (rad) from the frame's edge, in
/// metres from the frame's head.
pub(super) fn part_of_opposite(frame: &HalfEdge, low: f64, high: f64) -> std::ops::RangeInclusive<f64> {
    let [ax, ay] = frame.apex;
    let (dx, dy) = (ax - frame.length, ay);
    let length = planar_norm(dx, dy);
    let hit = |angle: f64| {
        let (sin, cos) = angle.sin_cos();
        // (length + t dx, t dy) is parallel to (cos, sin).
        let t = frame.length * sin / (dy * cos - dx * sin);
        t.clamp(0.0, 1.0) * length
    };
    hit(low)..=hit(high)
}

/// Where the segment between a point below an edge's line and one above crosses it (m along the edge).
pub(super) fn cross(below: &Planar, above: &Planar) -> f64 {
    let height = above[1] - below[1];
    if height > 0.0 { below[0] + (above[0] - below[0]) * (-below[1] / height) } else { above[0] }
}

/// Where the ray from `source` through `via` leaves through the line y = 0, clamped to the edge.
pub(super) fn exit(source: &Planar, via: &Planar, length: f64) -> f64 {
    let rise = via[1] - source[1];
    let x = if rise > 0.0 { source[0] + (via[0] - source[0]) * (-source[1] / rise) } else { via[0] };
    x.clamp(0.0, length)
}

/// A vector in a frame whose x axis is `axis`.
pub(super) fn rotate(axis: &Planar, v: Planar) -> Planar {
    [axis[0] * v[0] + axis[1] * v[1], axis[0] * v[1] - axis[1] * v[0]]
}
