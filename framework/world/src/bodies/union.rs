//! Bodies that overlap, united: what they share counts once.

use super::Part;
use boolmesh::prelude::{Manifold, OpType, compute_boolean};
use regrasp_api::{Mesh, Vec3};
use std::panic::catch_unwind;

/// More bodies than this are not united one after the other.
const MANY: usize = 64;

/// How bodies are changed, in parts of the mesh's size, before they are united: where faces and edges meet by
/// accident in one plane or line, moving a body by less than anybody measures makes the union possible.
const SHIFTS: [f64; 4] = [0.0, 1e-9, 3e-8, 1e-6];
/// The union of bodies whose facets all look outward, and that `is_sound`; `None` where it cannot be made.
///
/// M. Smith, "Towards robust inexact geometric computation", PhD thesis, Cambridge 2009, as in the library
/// Manifold.
pub(super) fn united(mesh: &Mesh, parts: &[Part], is_sound: impl Fn(&Mesh) -> bool) -> Option<Mesh> {
    let size = mesh.radius();
    let made = |part: &f64| union(mesh, parts, part * size).filter(&is_sound);
    SHIFTS.iter().find_map(made)
}

/// The union of bodies that do not overlap, where they touch by faces and so become one piece; `None` where
/// they do not.
pub(super) fn joined(mesh: &Mesh, parts: &[Part], is_sound: impl Fn(&Mesh) -> bool) -> Option<Mesh> {
    let margin = 1e-9 * mesh.radius();
    let meet = |a: &Part, b: &Part| {
        (0..3).all(|k| a.lower[k] <= b.upper[k] + margin && b.lower[k] <= a.upper[k] + margin)
    };
    // A body that no other one's box meets stays apart.
    let meets_one = |i: usize| (0..parts.len()).any(|j| j != i && meet(&parts[i], &parts[j]));
    let may_touch = parts.len() <= MANY && (0..parts.len()).all(meets_one);
    let volume: f64 = parts.iter().map(|part| part.volume).sum();
    // They share nothing: a union of another volume is none.
    let is_whole = |union: &Mesh| (union.mass_properties().volume - volume).abs() < 1e-6 * volume;
    may_touch.then(|| union(mesh, parts, 0.0)).flatten().filter(is_whole).filter(is_sound)
}

/// The union of bodies of which each is moved by a little (m) from the one before.
fn union(mesh: &Mesh, parts: &[Part], shift: f64) -> Option<Mesh> {
    if parts.len() > MANY || parts.iter().any(|part| part.volume <= 0.0) {
        return None;
    }
    // In no plane and on no line that a drawing has.
    let step = Vec3::new(0.531, 0.677, 0.509) * shift;
    // The library may panic on input that is worse than it looks; such bodies are then refused.
    catch_unwind(|| {
        let bodies = parts.iter().enumerate();
        let mut rest = bodies.map(|(i, part)| manifold(mesh, part, &(step * i as f64)));
        let first = rest.next()??;
        let all = rest.try_fold(first, |all, next| compute_boolean(&all, &next?, OpType::Add).ok())?;
        ordered(&all)
    })
    .ok()
    .flatten()
}

fn manifold(mesh: &Mesh, part: &Part, shift: &Vec3) -> Option<Manifold> {
    let corners = part.facets.iter().flat_map(|&facet| mesh.facets()[facet as usize]);
    let mut used: Vec<u32> = corners.clone().collect();
    used.sort_unstable();
    used.dedup();
    let placed = |&v: &u32| <[f64; 3]>::from(mesh.vertices()[v as usize] + shift);
    let points: Vec<f64> = used.iter().flat_map(placed).collect();
    let indices: Vec<usize> = corners.map(|v| used.binary_search(&v).unwrap_or(0)).collect();
    Manifold::new(&points, &indices).ok()
}

/// The result as a mesh, vertices and facets in an order of their own: whatever order the library made them
/// in.
fn ordered(all: &Manifold) -> Option<Mesh> {
    let points: Vec<Vec3> = all.ps.iter().map(|p| Vec3::new(p.x, p.y, p.z)).collect();
    let mut order: Vec<usize> = (0..points.len()).collect();
    let by_place = |a: &usize, b: &usize| {
        let pairs = points[*a].iter().zip(points[*b].iter());
        pairs.map(|(x, y)| x.total_cmp(y)).find(|order| order.is_ne()).unwrap_or(a.cmp(b))
    };
    order.sort_by(by_place);
    let mut place = vec![0; order.len()];
    order.iter().enumerate().for_each(|(new, &old)| place[old] = new as u32);
    let turned = |corners: [u32; 3]| {
        let first = (0..3).min_by_key(|&k| corners[k]).unwrap_or(0);
        [corners[first], corners[(first + 1) % 3], corners[(first + 2) % 3]]
    };
    let tails: Vec<u32> = all.hs.iter().map(|half| place[half.tail]).collect();
    let mut facets: Vec<[u32; 3]> = tails.chunks_exact(3).map(|t| turned([t[0], t[1], t[2]])).collect();
    facets.sort_unstable();
    Mesh::new(order.iter().map(|&old| points[old]).collect(), facets).ok()
}
