//! The surface where values on a grid change their sign, tetrahedron by tetrahedron.

use super::grid::Grid;
use regrasp_api::Vec3;
use std::collections::HashMap;

/// The six ways from a cell's lowest corner to its highest along its edges, by axes: each is a tetrahedron,
/// and cells side by side are cut alike where they meet.
const WAYS: [[usize; 3]; 6] = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];

/// Corners and triangles, looking to where values are positive.
pub(super) fn surface(grid: &Grid, values: &[f64]) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let mut made =
        Surface { grid, values, known: HashMap::new(), corners: Vec::new(), triangles: Vec::new() };
    let [x, y, z] = grid.counts;
    for k in 0..z - 1 {
        for j in 0..y - 1 {
            for i in 0..x - 1 {
                made.cell([i, j, k]);
            }
        }
    }
    (made.corners, made.triangles)
}

struct Surface<'a> {
    grid: &'a Grid,
    values: &'a [f64],
    /// The corners on edges of tetrahedra, by the points at their ends.
    known: HashMap<(usize, usize), u32>,
    corners: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
}

impl Surface<'_> {
    fn cell(&mut self, low: [usize; 3]) {
        let high = self.grid.number(low.map(|i| i + 1));
        let first = self.values[self.grid.number(low)] < 0.0;
        let corner = |bits: usize| self.grid.number([0, 1, 2].map(|axis| low[axis] + (bits >> axis & 1)));
        if (1..8).all(|bits| (self.values[corner(bits)] < 0.0) == first) {
            return;
        }
        for way in WAYS {
            let mut at = low;
            let mut tetrahedron = [self.grid.number(low), 0, 0, high];
            for step in 0..2 {
                at[way[step]] += 1;
                tetrahedron[step + 1] = self.grid.number(at);
            }
            self.tetrahedron(tetrahedron);
        }
    }

    fn tetrahedron(&mut self, mut points: [usize; 4]) {
        // Those inside come first.
        points.sort_by_key(|&point| (self.values[point] >= 0.0, point));
        let [a, b, c, d] = points;
        match points.iter().filter(|&&point| self.values[point] < 0.0).count() {
            1 => self.triangle([(a, b), (a, c), (a, d)], d),
            2 => {
                self.triangle([(a, c), (a, d), (b, d)], d);
                self.triangle([(a, c), (b, d), (b, c)], d);
            }
            3 => self.triangle([(a, d), (b, d), (c, d)], d),
            _ => {}
        }
    }

    /// A triangle with its corners on edges, turned to look at a point outside.
    fn triangle(&mut self, edges: [(usize, usize); 3], outside: usize) {
        let [a, b, c] = edges.map(|(one, other)| self.corner(one, other));
        let [p, q, r] = [a, b, c].map(|corner| self.corners[corner as usize]);
        let looks_out = (q - p).cross(&(r - p)).dot(&(self.grid.point(outside) - p)) > 0.0;
        self.triangles.push(if looks_out { [a, b, c] } else { [a, c, b] });
    }

    fn corner(&mut self, one: usize, other: usize) -> u32 {
        let (from, to) = (one.min(other), one.max(other));
        *self.known.entry((from, to)).or_insert_with(|| {
            let (u, v) = (self.values[from], self.values[to]);
            self.corners.push(self.grid.point(from).lerp(&self.grid.point(to), u / (u - v)));
            self.corners.len() as u32 - 1
        })
    }
}
