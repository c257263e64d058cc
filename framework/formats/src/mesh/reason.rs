//! Why a mesh is refused, in words that lead to the fix.

use super::weld::NEARLY_EQUAL;
use regrasp_api::{MeshError, Vec3};
use std::collections::{BTreeMap, HashMap, HashSet};

/// Vertices nearer than this, as part of the mesh's size, were probably meant to be one ...
const NEAR: f64 = 1e-3;
/// ... and those nearer than this certainly were.
const VERY_NEAR: f64 = 1e-4;
/// More open edges than this are not compared with each other one by one.
const MANY: usize = 4000;

/// The true reason behind a fault that was found edge by edge; the fault itself where there is no better.
pub(super) fn reason(vertices: &[Vec3], facets: &[[u32; 3]], fault: MeshError) -> MeshError {
    match fault {
        MeshError::Open { .. } => open(vertices, facets).unwrap_or(fault),
        MeshError::NotManifold { .. } => duplicated(vertices, facets).unwrap_or(fault),
        fault => fault,
    }
}

/// What is wrong with a mesh that is inside out as a whole, where some of its bodies are not: names the
/// largest whose facets look inward.
pub(super) fn inward_body(vertices: &[Vec3], facets: &[[u32; 3]]) -> Option<String> {
    let bodies = bodies(vertices.len(), facets);
    if bodies.len() < 2 {
        return None;
    }
    let volume = |body: &Vec<usize>| -> f64 {
        let at = vertices[facets[body[0]][0] as usize];
        let corners = |facet: usize| facets[facet].map(|vertex| vertices[vertex as usize] - at);
        body.iter().map(|&facet| corners(facet)).map(|[a, b, c]| a.dot(&b.cross(&c))).sum()
    };
    let volumes: Vec<f64> = bodies.iter().map(volume).collect();
    if volumes.iter().all(|volume| *volume <= 0.0) {
        return None;
    }
    let body = (0..bodies.len()).min_by(|&i, &j| volumes[i].total_cmp(&volumes[j]))?;
    let at = vertices[facets[bodies[body][0]][0] as usize];
    Some(format!(
        "body {} of {} ({} facets, near [{:.4}, {:.4}, {:.4}]) is inside out: its facets look inward; \
         reverse the \
         order of their vertices",
        body + 1,
        bodies.len(),
        bodies[body].len(),
        at.x,
        at.y,
        at.z
    ))
}

/// The facets of each connected surface, in the order of its first one.
fn bodies(count: usize, facets: &[[u32; 3]]) -> Vec<Vec<usize>> {
    let mut parents: Vec<u32> = (0..count as u32).collect();
    let root = |parents: &mut Vec<u32>, mut vertex: u32| {
        while parents[vertex as usize] != vertex {
            parents[vertex as usize] = parents[parents[vertex as usize] as usize];
            vertex = parents[vertex as usize];
        }
        vertex
    };
    for &[a, b, c] in facets {
        for (from, to) in [(b, a), (c, a)] {
            let (from, to) = (root(&mut parents, from), root(&mut parents, to));
            parents[from as usize] = to;
        }
    }
    let (mut place, mut bodies) = (BTreeMap::new(), Vec::<Vec<usize>>::new());
    for (facet, corners) in facets.iter().enumerate() {
        let body = *place.entry(root(&mut parents, corners[0])).or_insert(bodies.len());
        if body == bodies.len() {
            bodies.push(Vec::new());
        }
        bodies[body].push(facet);
    }
    bodies
}

/// The first two facets with the same corners.
fn duplicated(vertices: &[Vec3], facets: &[[u32; 3]]) -> Option<MeshError> {
    let mut seen = HashMap::with_capacity(facets.len());
    facets.iter().enumerate().find_map(|(second, facet)| {
        let mut corners = *facet;
        corners.sort_unstable();
        let first = seen.insert(corners, second)?;
        let at = facet.iter().filter_map(|&v| vertices.get(v as usize)).sum::<Vec3>() / 3.0;
        Some(MeshError::Duplicated { first, second, at: at.into() })
    })
}

/// A vertex within an open edge, or two open vertices that nearly meet.
fn open(vertices: &[Vec3], facets: &[[u32; 3]]) -> Option<MeshError> {
    let size = vertices.iter().map(|v| v.amax()).fold(0.0, f64::max);
    let sides = facets.iter().flat_map(|f| [(f[0], f[1]), (f[1], f[2]), (f[2], f[0])]);
    let known: HashSet<(u32, u32)> = sides.clone().collect();
    let edges: Vec<(u32, u32)> = sides.filter(|&(a, b)| !known.contains(&(b, a))).collect();
    if edges.len() > MANY {
        return None;
    }
    let at = |vertex: u32| vertices[vertex as usize];
    let mut ends: Vec<u32> = edges.iter().flat_map(|&(a, b)| [a, b]).collect();
    ends.sort_unstable();
    ends.dedup();
    let seam = |most| seam(&ends, at, most, NEARLY_EQUAL * size);
    let junction = || {
        edges.iter().find_map(|&(a, b)| {
            let within =
                |&&v: &&u32| v != a && v != b && is_within(&at(v), &at(a), &at(b), NEAR * 1e-3 * size);
            let vertex = at(*ends.iter().find(within)?).into();
            Some(MeshError::TJunction { vertex, from: at(a).into(), to: at(b).into() })
        })
    };
    seam(VERY_NEAR * size).or_else(junction).or_else(|| seam(NEAR * size))
}

/// Whether a point lies on a segment, its ends left out.
fn is_within(p: &Vec3, a: &Vec3, b: &Vec3, tolerance: f64) -> bool {
    let along = b - a;
    let t = (p - a).dot(&along) / along.norm_squared().max(f64::MIN_POSITIVE);
    let margin = tolerance / along.norm().max(f64::MIN_POSITIVE);
    (margin..=1.0 - margin).contains(&t) && (p - a - along * t).norm() <= tolerance
}

/// The nearest two open vertices, if they were probably meant to be one: at most `near` apart, and more than
/// what is welded unasked, if there are such.
fn seam(ends: &[u32], at: impl Fn(u32) -> Vec3, near: f64, welded: f64) -> Option<MeshError> {
    let pairs = || ends.iter().enumerate().flat_map(|(i, &a)| ends[i + 1..].iter().map(move |&b| (a, b)));
    let apart = |(a, b): (u32, u32)| (at(a) - at(b)).norm();
    let nearest = |least: f64| {
        let all = pairs().map(|pair| (apart(pair), pair)).filter(|(apart, _)| *apart > least);
        all.min_by(|p, q| p.0.total_cmp(&q.0))
    };
    let found = nearest(welded).filter(|(apart, _)| *apart <= near).or_else(|| nearest(0.0));
    let (apart, (a, b)) = found.filter(|(apart, _)| *apart <= near)?;
    Some(MeshError::Seam { a: at(a).into(), b: at(b).into(), apart })
}
