//! A grid about facets, with values that are negative inside.

use super::winding::Winding;
use regrasp_api::{Mesh, Vec3};

/// Facets farther off than this many steps do not say where the surface is: holes are closed half way. An
/// edge of a tetrahedron that goes through a facet has no end as far from it.
const NEAR: f64 = 1.8;
/// No value is nearer to zero than this many steps: the surface keeps off the grid's own points.
const LEAST: f64 = 0.04;
/// Bodies of fewer cells than this are specks.
const SPECK: f64 = 30.0;

/// Points at equal steps.
pub(super) struct Grid {
    low: Vec3,
    /// (m).
    pub step: f64,
    /// Points along each axis.
    pub counts: [usize; 3],
}

impl Grid {
    /// With so many steps along the longest side, and some to spare; `None` where there is no side.
    pub fn around(vertices: &[Vec3], steps: usize) -> Option<Self> {
        let low = vertices.iter().copied().reduce(|a, b| a.inf(&b))?;
        let high = vertices.iter().copied().reduce(|a, b| a.sup(&b))?;
        let step = (high - low).max() / steps as f64;
        if !(step > 0.0 && step.is_finite()) {
            return None;
        }
        // Off the places where drawings have their planes.
        let low = low - Vec3::new(1.53, 1.61, 1.57) * step;
        let counts = [0, 1, 2].map(|axis| ((high[axis] - low[axis]) / step).ceil() as usize + 3);
        Some(Self { low, step, counts })
    }

    pub fn number(&self, [i, j, k]: [usize; 3]) -> usize {
        i + self.counts[0] * (j + self.counts[1] * k)
    }

    /// Where a point of the grid is (m).
    pub fn point(&self, number: usize) -> Vec3 {
        let [x, y, _] = self.counts;
        let index = [number % x, number / x % y, number / (x * y)];
        self.low + Vec3::from(index.map(|i| i as f64)) * self.step
    }

    /// Values at all points (steps): how far the surface is where facets are near, else how surely the point
    /// is in- or outside.
    pub fn values(&self, winding: &Winding, distance: &(impl Fn(&Vec3) -> f64 + Sync)) -> Vec<f64> {
        let count = self.counts.iter().product();
        let winds = self.on_all(count, &|number| winding.at(&self.point(number)));
        self.on_all(count, &|number| {
            let inside = 0.5 - winds[number];
            let is_beside = self.around_point(number).any(|other| (0.5 - winds[other]) * inside < 0.0);
            let off = if is_beside { distance(&self.point(number)) / self.step } else { NEAR };
            let size = if off < NEAR { off } else { NEAR * (2.0 * inside.abs()).min(1.0) };
            size.max(LEAST).copysign(inside)
        })
    }

    /// The points of the cells that meet at one.
    fn around_point(&self, number: usize) -> impl Iterator<Item = usize> + '_ {
        let [x, y, z] = self.counts;
        let at = [number % x, number / x % y, number / (x * y)];
        let range = |axis: usize, count: usize| at[axis].saturating_sub(1)..=(at[axis] + 1).min(count - 1);
        let (columns, rows) = (range(0, x), range(1, y));
        range(2, z).flat_map(move |k| {
            let columns = columns.clone();
            rows.clone().flat_map(move |j| columns.clone().map(move |i| self.number([i, j, k])))
        })
    }

    /// A function of each point, by two threads.
    fn on_all(&self, count: usize, of: &(impl Fn(usize) -> f64 + Sync)) -> Vec<f64> {
        let mut values = vec![0.0; count];
        let half = count / 2;
        let (some, others) = values.split_at_mut(half);
        std::thread::scope(|scope| {
            scope.spawn(|| some.iter_mut().enumerate().for_each(|(number, value)| *value = of(number)));
            others.iter_mut().enumerate().for_each(|(number, value)| *value = of(half + number));
        });
        values
    }

    /// The surface without bodies, and bubbles, of a few cells; `None` where nothing else is there.
    pub fn without_specks(&self, mesh: Mesh) -> Option<Mesh> {
        let bodies = crate::bodies::facets_of_bodies(&mesh);
        let mut facets = Vec::new();
        for (volume, body) in &bodies {
            if volume.abs() > SPECK * self.step.powi(3) {
                facets.extend(body.iter().map(|&facet| mesh.facets()[facet as usize]));
            }
        }
        if facets.len() == mesh.facets().len() {
            return Some(mesh);
        }
        Mesh::new(mesh.vertices().to_vec(), facets).ok()
    }
}
