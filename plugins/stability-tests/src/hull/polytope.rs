//! A simplicial polytope in R⁶ that grows by one point at a time.

use super::{Point, dot};
use regrasp_api::Total;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// How far beyond a facet a point must be to see it.
const BEYOND: f64 = 1e-13;

struct Facet {
    corners: [u32; 6],
    /// The facet across the ridge opposite each corner.
    neighbours: [u32; 6],
    normal: Point,
    offset: f64,
    alive: bool,
}

/// A ridge of the horizon: five corners, the facet beyond that stays, and the place of the ridge there.
struct Ridge {
    corners: [u32; 5],
    beyond: u32,
    place: usize,
}

/// The growing polytope.
pub(super) struct Polytope {
    points: Vec<Point>,
    facets: Vec<Facet>,
    /// Facets with their offsets, the one nearest to the origin first; equal ones in their order of birth.
    queue: BinaryHeap<Reverse<(Total, u32)>>,
    inside: Point,
    living: usize,
}

impl Polytope {
    pub fn new(simplex: [Point; 7]) -> Self {
        let inside = std::array::from_fn(|k| simplex.iter().map(|p| p[k]).sum::<f64>() / 7.0);
        let mut polytope = Self {
            points: simplex.to_vec(),
            facets: Vec::new(),
            queue: BinaryHeap::new(),
            inside,
            living: 0,
        };
        for missing in 0..7_u32 {
            let others = |k: usize| k as u32 + u32::from(k as u32 >= missing);
            let corners = std::array::from_fn(others);
            polytope.add(corners, corners);
        }
        polytope
    }

    pub fn point_count(&self) -> usize {
        self.points.len()
    }

    pub fn facet_count(&self) -> usize {
        self.living
    }

    /// The facet nearest to the origin, counted below 0 where the origin is beyond it, with its outward unit
    /// normal and offset.
    pub fn nearest(&mut self) -> Option<(u32, Point, f64)> {
        loop {
            let &Reverse((_, top)) = self.queue.peek()?;
            let facet = &self.facets[top as usize];
            if facet.alive {
                return Some((top, facet.normal, facet.offset));
            }
            self.queue.pop();
        }
    }

    /// Takes in a point beyond `facet`; `false` where rounding leaves no clean horizon, and then nothing more
    /// may be asked.
    pub fn push_out(&mut self, facet: u32, point: Point) -> bool {
        let Some(horizon) = self.horizon(facet, &point) else { return false };
        self.points.push(point);
        let apex = self.points.len() as u32 - 1;
        let mut open = Vec::with_capacity(5 * horizon.len());
        for ridge in horizon {
            let [a, b, c, d, e] = ridge.corners;
            let new = self.add([a, b, c, d, e, apex], [u32::MAX; 6]);
            self.facets[new as usize].neighbours[5] = ridge.beyond;
            self.facets[ridge.beyond as usize].neighbours[ridge.place] = new;
            for place in 0..5 {
                open.push((without(&ridge.corners, place), new, place));
            }
        }
        self.join(open)
    }

    /// Joins the new facets across the ridges that they share.
    fn join(&mut self, mut open: Vec<([u32; 4], u32, usize)>) -> bool {
        open.sort_unstable();
        for pair in open.chunks(2) {
            let &[(first, a, i), (second, b, j)] = pair else { return false };
            if first != second {
                return false;
            }
            self.facets[a as usize].neighbours[i] = b;
            self.facets[b as usize].neighbours[j] = a;
        }
        true
    }

    /// Removes the facets that `point` sees and gives the ridges around them.
    fn horizon(&mut self, seen: u32, point: &Point) -> Option<Vec<Ridge>> {
        if !self.sees(seen, point) {
            return None;
        }
        let (mut ridges, mut stack) = (Vec::new(), vec![seen]);
        self.remove(seen);
        while let Some(facet) = stack.pop() {
            for place in 0..6 {
                let beyond = self.facets[facet as usize].neighbours[place];
                if !self.facets[beyond as usize].alive {
                    continue;
                }
                if self.sees(beyond, point) {
                    self.remove(beyond);
                    stack.push(beyond);
                    continue;
                }
                let mut corners = without(&self.facets[facet as usize].corners, place);
                corners.sort_unstable();
                let place = self.facets[beyond as usize].neighbours.iter().position(|&n| n == facet)?;
                ridges.push(Ridge { corners, beyond, place });
            }
        }
        Some(ridges)
    }

    fn sees(&self, facet: u32, point: &Point) -> bool {
        let facet = &self.facets[facet as usize];
        dot(&facet.normal, point) - facet.offset > BEYOND
    }

    fn remove(&mut self, facet: u32) {
        self.facets[facet as usize].alive = false;
        self.living -= 1;
    }

    fn add(&mut self, corners: [u32; 6], neighbours: [u32; 6]) -> u32 {
        let (normal, offset) = self.plane(&corners);
        let facet = self.facets.len() as u32;
        self.facets.push(Facet { corners, neighbours, normal, offset, alive: true });
        self.queue.push(Reverse((Total(offset), facet)));
        self.living += 1;
        facet
    }

    /// The hyperplane through six points, its unit normal away from the inside.
    fn plane(&self, corners: &[u32; 6]) -> (Point, f64) {
        let first = &self.points[corners[0] as usize];
        let row = |k: usize| {
            let p = &self.points[corners[k + 1] as usize];
            std::array::from_fn(|i| p[i] - first[i])
        };
        let mut normal = normal_to(std::array::from_fn(row));
        let offset = dot(&normal, first);
        if dot(&normal, &self.inside) > offset {
            normal = normal.map(|x| -x);
            return (normal, -offset);
        }
        (normal, offset)
    }
}

fn without<const N: usize, const M: usize>(corners: &[u32; N], place: usize) -> [u32; M] {
    std::array::from_fn(|k| corners[k + usize::from(k >= place)])
}

/// The unit vector orthogonal to five vectors, by elimination with complete pivoting.
#[allow(clippy::needless_range_loop)] // rows and columns are swapped and eliminated by index
fn normal_to(mut rows: [Point; 5]) -> Point {
    let mut order = [0, 1, 2, 3, 4, 5];
    for k in 0..5 {
        let (mut row, mut column, mut largest) = (k, k, -1.0);
        for i in k..5 {
            for j in k..6 {
                if rows[i][j].abs() > largest {
                    (row, column, largest) = (i, j, rows[i][j].abs());
                }
            }
        }
        rows.swap(k, row);
        order.swap(k, column);
        rows.iter_mut().for_each(|r| r.swap(k, column));
        let pivot = if rows[k][k] == 0.0 { f64::MIN_POSITIVE } else { rows[k][k] };
        for i in k + 1..5 {
            let c = rows[i][k] / pivot;
            for j in k..6 {
                rows[i][j] -= c * rows[k][j];
            }
        }
    }
    let mut x = [0.0; 6];
    x[5] = 1.0;
    for k in (0..5).rev() {
        let sum: f64 = (k + 1..6).map(|j| rows[k][j] * x[j]).sum();
        x[k] = if rows[k][k] == 0.0 { 0.0 } else { -sum / rows[k][k] };
    }
    let size = dot(&x, &x).sqrt();
    let mut normal = [0.0; 6];
    for k in 0..6 {
        normal[order[k]] = x[k] / size;
    }
    normal
}
