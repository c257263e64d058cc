//! Merging of vertices at equal coordinates.

use super::Raw;
use regrasp_api::Vec3;
use std::collections::HashMap;

/// Vertices nearer than this, as part of the mesh's size, are one if that closes the mesh.
pub(super) const NEARLY_EQUAL: f64 = 1e-5;

/// One vertex for each place, in the order of first use; vertices that no facet uses are dropped.
///
/// STL has no shared vertices at all, and exporters of other formats double them along seams. Only exactly
/// equal coordinates are merged: a tolerance could close what is open. Indices out of range are left for the
/// mesh to refuse.
pub(super) fn welded((vertices, mut facets): Raw) -> Raw {
    let mut place = HashMap::with_capacity(vertices.len());
    let mut kept: Vec<Vec3> = Vec::new();
    for index in facets.iter_mut().flatten() {
        let Some(&vertex) = vertices.get(*index as usize) else {
            *index = u32::MAX;
            continue;
        };
        // Adding 0 turns -0 into 0.
        let bits: [u64; 3] = vertex.map(|x| (x + 0.0).to_bits()).into();
        *index = *place.entry(bits).or_insert_with(|| {
            kept.push(vertex);
            kept.len() as u32 - 1
        });
    }
    (kept, facets)
}

/// The same with vertices at most `tolerance` apart merged too, each into the first such one.
pub(super) fn welded_within((vertices, mut facets): Raw, tolerance: f64) -> Raw {
    let cell = |v: &Vec3| -> [i64; 3] { v.map(|x| (x / tolerance).floor() as i64).into() };
    let mut cells: HashMap<[i64; 3], Vec<u32>> = HashMap::with_capacity(vertices.len());
    let mut place = Vec::with_capacity(vertices.len());
    for (index, vertex) in vertices.iter().enumerate() {
        let [x, y, z] = cell(vertex);
        let around =
            (-1..=1).flat_map(|i| (-1..=1).flat_map(move |j| (-1..=1).map(move |k| [x + i, y + j, z + k])));
        let near = around.filter_map(|cell| cells.get(&cell)).flatten();
        let first =
            near.copied().filter(|&other| (vertices[other as usize] - vertex).norm() <= tolerance).min();
        place.push(first.unwrap_or(index as u32));
        if first.is_none() {
            cells.entry([x, y, z]).or_default().push(index as u32);
        }
    }
    for index in facets.iter_mut().flatten() {
        *index = place.get(*index as usize).copied().unwrap_or(u32::MAX);
    }
    welded((vertices, facets))
}
