//! On which sides a path may pass: places as far from the one end as from the other, where the way through is
//! short.
//!
//! Every path has to pass the line of equal distances. The sum of both fields is least there where shortest
//! paths cross it, once for each side of an obstacle. The fields are off by some per cent, so that the lowest
//! of these places need not be the best.

use super::fine::{Fine, FinePoint};
use crate::polyhedron::{next, previous};

/// Crossed edges to either side in which no lower place may lie.
const NEIGHBORHOOD: usize = 4;
/// Places are left out if the way through is longer than the shortest by more than this share.
const MARGIN: f64 = 0.15;
/// Places at most.
const MOST: usize = 6;

/// Where the line of equal distances crosses edges of the fine mesh.
#[derive(Default)]
pub(super) struct Sides {
    /// For each half-edge the sum of both distances at the crossing (m), infinite where there is none.
    sums: Vec<f64>,
    found: Vec<(f64, u32)>,
}

impl Sides {
    /// The places, best first.
    pub fn find(&mut self, fine: &Fine, phi: [&[f64]; 2]) -> impl Iterator<Item = FinePoint> {
        let edges = &fine.polyhedron.half_edges;
        self.sums.clear();
        self.sums.resize(edges.len(), f64::INFINITY);
        for (index, edge) in edges.iter().enumerate().filter(|(index, edge)| *index < edge.twin as usize) {
            if let Some(t) = crossing(fine, phi, index as u32) {
                let ends = [edge.vertex, edges[edge.twin as usize].vertex].map(|v| v as usize);
                let sum = ends.map(|v| phi[0][v] + phi[1][v]);
                self.sums[index] = sum[0] + (sum[1] - sum[0]) * t;
                self.sums[edge.twin as usize] = self.sums[index];
            }
        }
        self.found.clear();
        for (index, edge) in edges.iter().enumerate().filter(|(index, edge)| *index < edge.twin as usize) {
            let sum = self.sums[index];
            if sum.is_finite()
                && [index as u32, edge.twin].iter().all(|&from| self.is_lowest(fine, sum, from))
            {
                self.found.push((sum, index as u32));
            }
        }
        self.found.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let most = self.found.first().map_or(0.0, |best| best.0 * (1.0 + MARGIN));
        let near = self.found.iter().take_while(move |found| found.0 <= most).take(MOST);
        near.filter_map(move |&(_, edge)| Some(place(edge, crossing(fine, phi, edge)?)))
    }

    /// Whether no crossing is lower on the way into the facet of a half-edge.
    fn is_lowest(&self, fine: &Fine, sum: f64, half_edge: u32) -> bool {
        let mut at = half_edge;
        for _ in 0..NEIGHBORHOOD {
            let ahead =
                [next(at), previous(at)].into_iter().find(|&edge| self.sums[edge as usize].is_finite());
            let Some(ahead) = ahead else { return true };
            if self.sums[ahead as usize] < sum {
                return false;
            }
            at = fine.polyhedron.half_edges[ahead as usize].twin;
        }
        true
    }
}

/// How far along a half-edge, from 0 to 1, both distances are equal.
fn crossing(fine: &Fine, phi: [&[f64]; 2], half_edge: u32) -> Option<f64> {
    let edge = &fine.polyhedron.half_edges[half_edge as usize];
    let ends = [edge.vertex, fine.polyhedron.half_edges[edge.twin as usize].vertex];
    let [a, b] = ends.map(|v| phi[0][v as usize] - phi[1][v as usize]);
    ((a <= 0.0) != (b <= 0.0)).then(|| a / (a - b))
}

/// The place a share `t` along a half-edge, in its facet.
fn place(half_edge: u32, t: f64) -> FinePoint {
    let k = (half_edge % 3) as usize;
    let mut weights = [0.0; 3];
    (weights[k], weights[(k + 1) % 3]) = (1.0 - t, t);
    FinePoint { facet: half_edge / 3, weights }
}
