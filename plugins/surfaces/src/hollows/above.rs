//! What lies above each facet: all that a ball that touches the facet can sink into.

use super::SINK;
use crate::closest::ClosestPoints;
use crate::polyhedron::Polyhedron;
use regrasp_api::Vec3;

/// Balls larger than the fingertip by this factor are looked at around a facet: enough for all places of a
/// turn between two facets whose normals differ by [`GENTLE`] at most.
///
/// With n = α n_A + β n_B between the two normals, a point that the ball at n holds lies in one of the balls
/// at n_A and n_B of the radius α + β ≤ 1 / cos(0.2).
const SWELL: f64 = 1.021;
/// The cosine of 0.4 rad.
pub(super) const GENTLE: f64 = 0.921_061;
/// Facets around one facet that are looked at before what lies above it stays unknown: a bound of the time to
/// prepare an object.
const MOST_AROUND: usize = 500;
/// Facets above one facet beyond which they stay unknown: a bound of memory.
const MOST_ABOVE: usize = 64;

/// For each facet the others that rise above its plane within reach of a ball that touches it.
#[derive(Clone, Debug, Default)]
pub(crate) struct Above {
    /// Where each facet's list begins and ends in `facets`; `None` where it would be too long.
    ranges: Vec<Option<(u32, u32)>>,
    facets: Vec<u32>,
    /// A ball around each facet: middle and radius (m).
    balls: Vec<(Vec3, f64)>,
}

impl Above {
    /// Looks around every facet for a fingertip of the given radius (m).
    pub fn new(polyhedron: &Polyhedron, closest: &ClosestPoints, radius: f64) -> Self {
        let ball = |corners: &[Vec3; 3]| {
            let middle = corners.iter().sum::<Vec3>() / 3.0;
            (middle, corners.iter().map(|corner| (corner - middle).norm()).fold(0.0, f64::max))
        };
        let balls = polyhedron.corners.iter().map(ball).collect();
        let mut above = Self { ranges: Vec::new(), facets: Vec::new(), balls };
        for facet in 0..polyhedron.corners.len() as u32 {
            let start = above.facets.len();
            let known = above.look_around(polyhedron, closest, facet, SWELL * radius);
            if !known {
                above.facets.truncate(start);
            }
            above.ranges.push(known.then_some((start as u32, above.facets.len() as u32)));
        }
        above
    }

    /// Appends what rises above a facet; false if that is too much.
    fn look_around(
        &mut self,
        polyhedron: &Polyhedron,
        closest: &ClosestPoints,
        facet: u32,
        radius: f64,
    ) -> bool {
        let n = polyhedron.mesh.normal(facet);
        let (middle, width) = self.balls[facet as usize];
        let (p_OB, reach) = (middle + n * radius, radius + width + polyhedron.snap);
        let (mut around, most) = (0, self.facets.len() + MOST_ABOVE);
        !closest.any_box(&p_OB, reach, |other| {
            around += 1;
            if self.comes_within(other, &p_OB, reach) && rises(polyhedron, other, &middle, &n) {
                self.facets.push(other);
            }
            around > MOST_AROUND || self.facets.len() > most
        })
    }

    /// What rises above a facet, unless that is too much.
    pub fn facet(&self, facet: u32) -> Option<&[u32]> {
        let (start, end) = (*self.ranges.get(facet as usize)?)?;
        Some(&self.facets[start as usize..end as usize])
    }

    /// Whether the ball around a facet comes within `reach` (m) of a point.
    pub fn comes_within(&self, facet: u32, p: &Vec3, reach: f64) -> bool {
        let (middle, width) = &self.balls[facet as usize];
        (middle - p).norm_squared() < (reach + width).powi(2)
    }
}

/// Whether a facet rises above the plane through `p` with the normal `n`.
pub(super) fn rises(polyhedron: &Polyhedron, facet: u32, p: &Vec3, n: &Vec3) -> bool {
    polyhedron.corners[facet as usize].iter().any(|corner| n.dot(&(corner - p)) > SINK / 2.0)
}
