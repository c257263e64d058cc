//! Facets without area, as programs write them, left out where the rest stays closed.

use super::Raw;
use regrasp_api::Vec3;
use std::collections::{HashMap, HashSet};

/// A height below this part of the longest edge is rounding, not a facet: what [`regrasp_api::Mesh`] refuses
/// as having no area.
const FLAT: f64 = 1e-9;
/// Flat facets that lie side by side are taken out one after the other, so many times round.
const ROUNDS: usize = 20;

/// The mesh without facets that have no area, and how many there were.
///
/// A facet with two equal corners is left out: its other two sides are one edge, and what lay beside them
/// meets there. A facet whose corners are in one line gives its middle corner to the facet beyond its longest
/// side, which falls in two: then too nothing is left open.
pub(super) fn healed((vertices, mut facets): Raw) -> (Raw, usize) {
    let before = facets.len();
    facets.retain(|[a, b, c]| a != b && b != c && c != a);
    let mut dropped = before - facets.len();
    for _ in 0..ROUNDS {
        let flat: Vec<usize> = (0..facets.len()).filter(|&i| is_flat(&vertices, facets[i])).collect();
        if flat.is_empty() {
            break;
        }
        let split = split_beyond(&vertices, &mut facets, &flat);
        if split == 0 {
            break;
        }
        dropped += split;
    }
    ((vertices, facets), dropped)
}

fn is_flat(vertices: &[Vec3], facet: [u32; 3]) -> bool {
    let Some([a, b, c]) = corners(vertices, facet) else { return false };
    let longest = (b - a).norm().max((c - b).norm()).max((a - c).norm());
    (b - a).cross(&(c - a)).norm() <= FLAT * longest * longest
}

fn corners(vertices: &[Vec3], facet: [u32; 3]) -> Option<[Vec3; 3]> {
    let at = |index: u32| vertices.get(index as usize).copied();
    Some([at(facet[0])?, at(facet[1])?, at(facet[2])?])
}

/// Takes flat facets out; returns how many.
fn split_beyond(vertices: &[Vec3], facets: &mut Vec<[u32; 3]>, flat: &[usize]) -> usize {
    let owner = beyond_longest(vertices, facets, flat);
    let mut touched = vec![false; facets.len()];
    let mut gone = vec![false; facets.len()];
    let mut count = 0;
    for &index in flat {
        let Some([u, v, w]) = longest_first(vertices, facets[index]) else { continue };
        let Some(&beyond) = owner.get(&(v, u)) else { continue };
        let Some(k) = (0..3).find(|&k| facets[beyond][k] == v && facets[beyond][(k + 1) % 3] == u) else {
            continue;
        };
        let apex = facets[beyond][(k + 2) % 3];
        if touched[index] || touched[beyond] || beyond == index || apex == w {
            continue;
        }
        // Beyond v-u-apex; the middle corner w comes between v and u.
        facets[beyond] = [v, w, apex];
        facets[index] = [w, u, apex];
        (touched[index], touched[beyond]) = (true, true);
        count += 1;
    }
    // Two flat facets back to back leave a pair of equal corners, or two facets that are each other's back.
    for i in 0..facets.len() {
        let [a, b, c] = facets[i];
        gone[i] = a == b || b == c || c == a;
    }
    let mut keep = gone.iter().map(|&gone| !gone);
    facets.retain(|_| keep.next().unwrap_or(true));
    count
}

/// The facets beyond the longest sides of flat ones, by the sides as they run there.
fn beyond_longest(vertices: &[Vec3], facets: &[[u32; 3]], flat: &[usize]) -> HashMap<(u32, u32), usize> {
    let longest = flat.iter().filter_map(|&index| longest_first(vertices, facets[index]));
    let wanted: HashSet<(u32, u32)> = longest.map(|[u, v, _]| (v, u)).collect();
    // Flat facets are few: most sides begin where none that is wanted does.
    let mut begins = vec![false; vertices.len()];
    wanted.iter().for_each(|side| begins[side.0 as usize] = true);
    let mut owner = HashMap::with_capacity(wanted.len());
    for (i, facet) in facets.iter().enumerate() {
        for k in 0..3 {
            let side = (facet[k], facet[(k + 1) % 3]);
            if begins.get(side.0 as usize) == Some(&true) && wanted.contains(&side) {
                owner.insert(side, i);
            }
        }
    }
    owner
}

/// The corners from the longest side on: its two ends, and the corner between them.
fn longest_first(vertices: &[Vec3], facet: [u32; 3]) -> Option<[u32; 3]> {
    let p = corners(vertices, facet)?;
    let length = |k: usize| (p[(k + 1) % 3] - p[k]).norm();
    let k = (0..3).max_by(|&i, &j| length(i).total_cmp(&length(j)))?;
    Some([facet[k], facet[(k + 1) % 3], facet[(k + 2) % 3]])
}

#[cfg(test)]
mod tests {
    use super::*;
    use regrasp_api::Mesh;

    /// A tetrahedron with one side cut at its middle on one side only, closed by a facet without area.
    fn with_flat_facet() -> Raw {
        let o = Vec3::zeros();
        let vertices = vec![o, Vec3::x(), Vec3::y(), Vec3::z(), Vec3::x() * 0.5];
        let facets = vec![[0, 2, 1], [0, 4, 3], [4, 1, 3], [1, 2, 3], [0, 3, 2], [0, 1, 4]];
        (vertices, facets)
    }

    #[test]
    fn a_facet_whose_corners_are_in_line_goes_and_the_rest_is_closed() {
        let raw = with_flat_facet();
        assert!(Mesh::new(raw.0.clone(), raw.1.clone()).is_err());
        let ((vertices, facets), dropped) = healed(raw);
        assert_eq!(dropped, 1);
        let mesh = Mesh::new(vertices, facets).unwrap();
        assert!((mesh.mass_properties().volume - 1.0 / 6.0).abs() < 1e-15);
    }

    #[test]
    fn a_facet_with_two_equal_corners_goes() {
        let (vertices, _) = with_flat_facet();
        let facets = vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2], [1, 1, 3], [2, 0, 2]];
        let ((vertices, facets), dropped) = healed((vertices, facets));
        assert_eq!((dropped, facets.len()), (2, 4));
        assert!(Mesh::new(vertices, facets).is_ok());
    }

    #[test]
    fn a_good_mesh_is_left_alone() {
        let (vertices, _) = with_flat_facet();
        let facets = vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]];
        assert_eq!(healed((vertices, facets.clone())).0.1, facets);
    }
}
