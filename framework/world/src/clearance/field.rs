//! Distance from any closed mesh, bounded by a grid of distances.

use super::convex::Verdict;
use super::exact::MeshSolid;
use super::rod::{Bounds, Rod};
use regrasp_api::Vec3;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, OnceLock};

/// Cells along the longest side of the grid: at most 14,000 exact distances. A finer grid saves little in the
/// search, where the exact distance decides beside it, and costs its third power here.
const CELLS: f64 = 24.0;

/// A closed mesh with signed distances at the centres of a grid's cells.
///
/// The signed distance changes by at most the way travelled, so the value at a cell's centre bounds it from
/// both sides everywhere in the cell, whatever the mesh: nothing is interpolated, and nothing can be
/// overestimated.
pub(crate) struct Field {
    solid: Arc<MeshSolid>,
    grid: Bounds,
    cell: f64,
    counts: [usize; 3],
    /// Signed distances at the cells' centres (m), x running fastest; more than a cell deep inside, upper
    /// bounds of them.
    values: Vec<f64>,
    /// The same at the centres of smaller cells, each computed when it is first asked for; 0 where it was not
    /// yet, else the bits of the distance. It depends on nothing else, so that threads may race for it.
    fine: OnceLock<Box<[AtomicU64]>>,
}

/// Smaller cells along the edge of a cell.
const FINE: usize = 4;

/// Along a rod, no step is shorter than this (m): a rod that does touch is found out quickly, and one that
/// does not, but comes that near to being too close, is left to the exact distance.
const SHORTEST_STEP: f64 = 50e-6;

impl Field {
    /// A field about `solid` that reaches `wide` (m) beyond it: the largest radius of a rod, and the
    /// clearance.
    pub fn new(solid: Arc<MeshSolid>, wide: f64) -> Self {
        let wide = Vec3::repeat(wide);
        let grid = Bounds { lower: solid.bounds.lower - wide, upper: solid.bounds.upper + wide };
        let size = grid.upper - grid.lower;
        let cell = size.max() / CELLS;
        let counts: [usize; 3] = size.map(|length| (length / cell).ceil().max(1.0) as usize).into();
        let mut values = Vec::with_capacity(counts.iter().product());
        for (k, j) in (0..counts[2]).flat_map(|k| (0..counts[1]).map(move |j| (k, j))) {
            let mut before = f64::INFINITY;
            for i in 0..counts[0] {
                let center =
                    grid.lower + (Vec3::new(i as f64, j as f64, k as f64) + Vec3::repeat(0.5)) * cell;
                // Deep inside, "deeper than this" is enough: every rod there is close.
                let deep = before + cell < -cell;
                before = if deep {
                    before + cell
                } else {
                    solid.signed_distance_within(&center, before.abs() + cell)
                };
                values.push(before);
            }
        }
        Self { solid, grid, cell, counts, values, fine: OnceLock::new() }
    }

    /// Bounds of the signed distance (m) at a point.
    #[inline]
    fn bounds(&self, p: &Vec3) -> (f64, f64) {
        let place = (p - self.grid.lower) / self.cell;
        let (x, y, z) = (place.x.floor(), place.y.floor(), place.z.floor());
        let inside = |index: f64, count: usize| index >= 0.0 && index < count as f64;
        if !(inside(x, self.counts[0]) && inside(y, self.counts[1]) && inside(z, self.counts[2])) {
            return (self.solid.bounds.distance(p), f64::INFINITY);
        }
        let (i, j, k) = (x as usize, y as usize, z as usize);
        let value = self.values[i + self.counts[0] * (j + self.counts[1] * k)];
        let off = (place - Vec3::new(x + 0.5, y + 0.5, z + 0.5)).norm() * self.cell;
        (value - off, value + off)
    }

    /// Closer bounds of the signed distance (m) at a point of the grid, which is at most `limit` in size.
    fn fine_bounds(&self, p: &Vec3, limit: f64) -> Option<(f64, f64)> {
        let cell = self.cell / FINE as f64;
        let place = (p - self.grid.lower) / cell;
        let whole = place.map(f64::floor);
        let counts = self.counts.map(|count| count * FINE);
        if !(0..3).all(|axis| whole[axis] >= 0.0 && whole[axis] < counts[axis] as f64) {
            return None;
        }
        let [i, j, k] = [whole.x as usize, whole.y as usize, whole.z as usize];
        let values = self.fine.get_or_init(|| {
            let zeros = vec![0; counts.iter().product()];
            zeros.into_iter().map(AtomicU64::new).collect()
        });
        let center = whole + Vec3::repeat(0.5);
        let off = (place - center).norm() * cell;
        let entry = &values[i + counts[0] * (j + counts[1] * k)];
        let known = entry.load(Ordering::Relaxed);
        let value = if known != 0 {
            f64::from_bits(known)
        } else {
            let center = self.grid.lower + center * cell;
            let value = self.solid.signed_distance_within(&center, limit + off);
            // Zero has a sign that makes its bits differ from those of no answer.
            entry.store(if value == 0.0 { -0.0_f64 } else { value }.to_bits(), Ordering::Relaxed);
            value
        };
        Some((value - off, value + off))
    }

    /// Whether the rod, given in the mesh's frame, keeps the solid at more than `clear` (m).
    ///
    /// Walks along the axis from the middle to both ends, each time as far as the distance there allows (J.
    /// C. Hart, "Sphere tracing", The Visual Computer 1996); where the grid cannot tell, the exact distance
    /// of the point does.
    pub fn verdict(&self, rod: &Rod, clear: f64) -> Verdict {
        let middle = rod.middle();
        let half = (rod.b - rod.a).norm() / 2.0;
        match self.walk(&middle, &rod.a, half, rod.radius + clear) {
            Verdict::Close => Verdict::Close,
            first if half > 0.0 => match self.walk(&middle, &rod.b, half, rod.radius + clear) {
                Verdict::Free => first,
                second => second,
            },
            first => first,
        }
    }

    fn walk(&self, from: &Vec3, to: &Vec3, length: f64, apart: f64) -> Verdict {
        let direction = if length > 0.0 { (to - from) / length } else { Vec3::zeros() };
        let (mut done, mut verdict) = (0.0, Verdict::Free);
        loop {
            let p = from + direction * done;
            let (mut lower, mut upper) = self.bounds(&p);
            let may_end = |step: f64| done >= length || done + step > length;
            let is_short = |step: f64, cell: f64| step <= 0.0 || (step < 0.5 * cell && !may_end(step));
            if upper > apart && is_short(lower - apart, self.cell) {
                (lower, upper) = self.fine_bounds(&p, upper.max(-lower)).unwrap_or((lower, upper));
            }
            if upper <= apart {
                return Verdict::Close;
            }
            let mut step = lower - apart;
            if is_short(step, self.cell / FINE as f64) {
                // The grid's bound makes the exact distance cheaper, too.
                step = self.solid.signed_distance_within(&p, upper.max(-lower)) - apart;
            }
            // NaN must end here too.
            if step <= 0.0 || step.is_nan() {
                return Verdict::Close;
            }
            if may_end(step) {
                return verdict;
            }
            if step < SHORTEST_STEP {
                verdict = Verdict::Unknown;
            }
            done = (done + step.max(SHORTEST_STEP)).min(length);
        }
    }

    /// A lower bound (m) of the distance of a point.
    pub fn lower(&self, p: &Vec3) -> f64 {
        self.bounds(p).0
    }
}
