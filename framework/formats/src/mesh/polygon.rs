//! Polygons to triangles.

use regrasp_api::Vec3;

/// Polygons with more corners than this take any ear instead of the roundest ...
const MANY: usize = 48;
/// ... and with more than this are cut as a fan: ears cost the square of the number of corners.
const TOO_MANY: usize = 2000;

/// Appends the triangles of the polygon with these corners (indices into `vertices`), by cutting ears.
///
/// Seen along the polygon's mean normal, an ear is a convex corner whose triangle holds no other corner
/// (Meisters, "Polygons have ears", Am. Math. Monthly 1975). A polygon that has no ear left (it crosses
/// itself) or too many corners is cut as a fan. One of fewer than three corners has no area and no triangle.
pub(super) fn triangulate(corners: &[u32], vertices: &[Vec3], facets: &mut Vec<[u32; 3]>) {
    if corners.len() < 3 {
        return;
    }
    if let Ok(facet) = corners.try_into() {
        facets.push(facet);
        return;
    }
    let at = |index: u32| vertices.get(index as usize).copied().unwrap_or_default();
    let mut rest = corners.to_vec();
    let normal = mean_normal(&rest, at);
    while rest.len() > 3 && rest.len() <= TOO_MANY {
        let n = rest.len();
        let corner = |i: usize| [rest[(i + n - 1) % n], rest[i], rest[(i + 1) % n]];
        let mut ears = (0..n).filter(|&i| is_ear(corner(i), &rest, normal, at));
        let round = |i: &usize| roundness(corner(*i).map(at));
        let roundest = |i: &usize, j: &usize| round(i).total_cmp(&round(j)).then(j.cmp(i));
        let Some(ear) = (if n > MANY { ears.next() } else { ears.max_by(roundest) }) else { break };
        facets.push(corner(ear));
        rest.remove(ear);
    }
    facets.extend((1..rest.len().saturating_sub(1)).map(|i| [rest[0], rest[i], rest[i + 1]]));
}

/// Twice the area vector of the polygon (Newell).
fn mean_normal(corners: &[u32], at: impl Fn(u32) -> Vec3) -> Vec3 {
    let origin = at(corners[0]);
    corners.windows(2).map(|pair| (at(pair[0]) - origin).cross(&(at(pair[1]) - origin))).sum()
}

fn is_ear([a, b, c]: [u32; 3], rest: &[u32], normal: Vec3, at: impl Fn(u32) -> Vec3) -> bool {
    let turns_left = |p: u32, q: u32, r: u32| (at(q) - at(p)).cross(&(at(r) - at(p))).dot(&normal) > 0.0;
    let holds = |v: u32| !(turns_left(b, a, v) || turns_left(c, b, v) || turns_left(a, c, v));
    turns_left(a, b, c) && !rest.iter().any(|&v| v != a && v != b && v != c && holds(v))
}

/// Area over the longest side squared: large for a round triangle, small for a sliver.
fn roundness([a, b, c]: [Vec3; 3]) -> f64 {
    let longest = (b - a).norm_squared().max((c - b).norm_squared()).max((a - c).norm_squared());
    (b - a).cross(&(c - a)).norm() / longest
}
