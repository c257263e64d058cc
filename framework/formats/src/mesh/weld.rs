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
    let first = firsts(&vertices);
    let mut place = vec![u32::MAX; vertices.len()];
    let mut kept: Vec<Vec3> = Vec::new();
    for index in facets.iter_mut().flatten() {
        let Some(&name) = first.get(*index as usize) else {
            *index = u32::MAX;
            continue;
        };
        let place = &mut place[name as usize];
        if *place == u32::MAX {
            *place = kept.len() as u32;
            kept.push(vertices[*index as usize]);
        }
        *index = *place;
    }
    (kept, facets)
}

/// The first vertex at the place of each.
///
/// Vertices are dealt out to about as many buckets as there are vertices, and sorted within each: linear as a
/// rule, and no worse than sorting all for a file that was made to fill one bucket.
fn firsts(vertices: &[Vec3]) -> Vec<u32> {
    let shift = 63 - vertices.len().max(2).ilog2();
    let bucket = |v: &Vec3| (mixed(bits(v)) >> shift) as usize;
    let mut begins = vec![0_u32; (1 << (64 - shift)) + 1];
    vertices.iter().for_each(|v| begins[bucket(v) + 1] += 1);
    for i in 1..begins.len() {
        begins[i] += begins[i - 1];
    }
    let mut next = begins.clone();
    let mut order = vec![0; vertices.len()];
    for (index, v) in vertices.iter().enumerate() {
        let place = &mut next[bucket(v)];
        order[*place as usize] = index as u32;
        *place += 1;
    }
    let at = |index: u32| bits(&vertices[index as usize]);
    let mut first: Vec<u32> = (0..vertices.len() as u32).collect();
    for ends in begins.windows(2).filter(|ends| ends[1] - ends[0] > 1) {
        let there = &mut order[ends[0] as usize..ends[1] as usize];
        there.sort_unstable_by_key(|&index| (at(index), index));
        for pair in there.windows(2).filter(|pair| at(pair[0]) == at(pair[1])) {
            first[pair[1] as usize] = first[pair[0] as usize];
        }
    }
    first
}

/// A place by its bits; adding 0 turns -0 into 0.
fn bits(vertex: &Vec3) -> [u64; 3] {
    vertex.map(|x| (x + 0.0).to_bits()).into()
}

/// A number whose upper bits depend on all of those given.
fn mixed(bits: [u64; 3]) -> u64 {
    bits.into_iter()
        .fold(0, |hash: u64, word| (hash.rotate_left(29) ^ word).wrapping_mul(0x9e37_79b9_7f4a_7c15))
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
