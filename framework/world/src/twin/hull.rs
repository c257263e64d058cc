//! The convex twin: a hull through few vertices of the mesh.

use super::touch::Touch;
use crate::hull::convex_hull;
use regrasp_api::{Mat3, Mesh, Twin, Vec3};
use std::f64::consts::{PI, TAU};

/// Numbers of directions in which the outermost vertices are taken, the coarsest first.
const DIRECTIONS: [usize; 6] = [100, 200, 400, 800, 1600, 3200];

/// The coarsest convex twin within a tolerance (m); `None` where the mesh is not as nearly convex.
///
/// A hull lies outside of the mesh at best; one that stands off too far is moved in by half of that.
pub(super) fn within(mesh: &Mesh, touch: &Touch, tolerance: f64) -> Option<Twin> {
    let whole = convex_hull(mesh.vertices())?;
    // Between hull and mesh a ball has at most twice the tolerance, if half of it can be made up for.
    touch.range(&whole, 2.0 * tolerance)?;
    let outermost = DIRECTIONS.iter().filter_map(|&count| convex_hull(&supports(whole.vertices(), count)));
    outermost.chain([whole.clone()]).find_map(|candidate| {
        let (above, below) = touch.range(&candidate, 2.0 * tolerance)?;
        let centred = if above.max(below) <= tolerance {
            candidate
        } else {
            moved_in(&candidate, (above - below) / 2.0)?
        };
        super::accepted(centred, touch, tolerance)
    })
}

/// The vertices that are outermost in evenly spread directions (a Fibonacci lattice), each once.
fn supports(vertices: &[Vec3], count: usize) -> Vec<Vec3> {
    let turn = PI * (3.0 - 5.0f64.sqrt());
    let outermost = |i: usize| {
        let z = 1.0 - (2.0 * i as f64 + 1.0) / count as f64;
        let (sin, cos) = (turn * i as f64 % TAU).sin_cos();
        let r = (1.0 - z * z).sqrt();
        let n = Vec3::new(r * cos, r * sin, z);
        (0..vertices.len()).max_by(|&a, &b| vertices[a].dot(&n).total_cmp(&vertices[b].dot(&n)))
    };
    let mut chosen: Vec<usize> = (0..count).filter_map(outermost).collect();
    chosen.sort_unstable();
    chosen.dedup();
    chosen.into_iter().map(|i| vertices[i]).collect()
}

/// The hull with every facet moved in by a distance (m), as far as its vertices can follow.
fn moved_in(convex: &Mesh, distance: f64) -> Option<Mesh> {
    let count = convex.vertices().len();
    let mut sums = vec![(Mat3::zeros(), Vec3::zeros()); count];
    for facet in 0..convex.facets().len() as u32 {
        let (n, area) = (convex.normal(facet), convex.area(facet));
        for &vertex in &convex.facets()[facet as usize] {
            let (A, b) = &mut sums[vertex as usize];
            *A += n * n.transpose() * area;
            *b += n * area;
        }
    }
    let shifted = convex.vertices().iter().zip(&sums).map(|(p, (A, b))| {
        // Least squares of n · x = -distance over the facets round the vertex, held where they leave it open.
        let held = A + Mat3::identity() * (1e-3 * A.trace());
        let step = held.try_inverse().map_or(Vec3::zeros(), |inverse| inverse * b * -distance);
        p + step.cap_magnitude(3.0 * distance.abs())
    });
    convex_hull(&shifted.collect::<Vec<_>>())
}
