//! Why a mesh is not closed, in words that lead to the fix.

use regrasp_api::{MeshError, Vec3};
use std::collections::{HashMap, HashSet};

/// Vertices nearer than this, as part of the mesh's size, were probably meant to be one.
const NEAR: f64 = 1e-3;
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
    let junction = edges.iter().find_map(|&(a, b)| {
        let inside = ends
            .iter()
            .find(|&&v| v != a && v != b && is_within(&at(v), &at(a), &at(b), NEAR * 1e-3 * size))?;
        Some(MeshError::TJunction { vertex: at(*inside).into(), from: at(a).into(), to: at(b).into() })
    });
    junction.or_else(|| seam(&ends, at, NEAR * size))
}

/// Whether a point lies on a segment, its ends left out.
fn is_within(p: &Vec3, a: &Vec3, b: &Vec3, tolerance: f64) -> bool {
    let along = b - a;
    let t = (p - a).dot(&along) / along.norm_squared().max(f64::MIN_POSITIVE);
    let margin = tolerance / along.norm().max(f64::MIN_POSITIVE);
    (margin..=1.0 - margin).contains(&t) && (p - a - along * t).norm() <= tolerance
}

/// The nearest two open vertices, if they were probably meant to be one.
fn seam(ends: &[u32], at: impl Fn(u32) -> Vec3, near: f64) -> Option<MeshError> {
    let pairs = ends.iter().enumerate().flat_map(|(i, &a)| ends[i + 1..].iter().map(move |&b| (a, b)));
    let apart = |&(a, b): &(u32, u32)| (at(a) - at(b)).norm();
    let (a, b) = pairs.min_by(|p, q| apart(p).total_cmp(&apart(q)))?;
    let apart = apart(&(a, b));
    (apart <= near).then(|| MeshError::Seam { a: at(a).into(), b: at(b).into(), apart })
}
