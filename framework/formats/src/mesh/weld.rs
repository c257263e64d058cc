//! Merging of vertices at equal coordinates.

use super::Raw;
use regrasp_api::Vec3;
use std::collections::HashMap;

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
