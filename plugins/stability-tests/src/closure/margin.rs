//! A bracket of the margin Q1: a certified lower bound from the analytic centre, an upper bound from far
//! points of Ω.

use super::newton::Search;
use super::symmetric::Symmetric6;
use crate::contacts::{ScaledGrasp, Twist};
use nalgebra::{Matrix3, Matrix6, SymmetricEigen, Vector6};
use regrasp_api::{Vec3, cross_matrix};

/// Newton steps to a centre; quadratic convergence needs about fifteen.
const CENTRING_STEPS: usize = 200;
/// Newton decrement at which the centre is exact to rounding ...
const EXACTLY: f64 = 1e-7;
/// ... and one at which bounds lose little.
const ROUGHLY: f64 = 0.1;
/// How much faster each stretch of the path to a farthest point is than the one before.
const WEIGHT_STEP: f64 = 30.0;
/// Rounds of one ascent; four are usual.
const ASCENT_ROUNDS: usize = 20;

/// The coordinates that margins are given in, as the map from a grasp's own scaled coordinates.
pub(crate) struct Frame {
    map: Matrix6<f64>,
    back: Matrix6<f64>,
}

impl Frame {
    /// Torques about `center_O` (the contacts' centroid if `None`) over `length` (the grasp's own if `None`).
    pub fn new(grasp: &ScaledGrasp, length: Option<f64>, center_O: Option<Vec3>) -> Self {
        let shift = center_O.map_or(Vec3::zeros(), |center| (center - grasp.center_O) / grasp.length);
        let scale = length.map_or(1.0, |length| length / grasp.length);
        let mut map = Matrix6::identity();
        // v at the new centre: a' = a + b × shift; ω' = b times the ratio of lengths.
        map.fixed_view_mut::<3, 3>(0, 3).copy_from(&-cross_matrix(&shift));
        map.fixed_view_mut::<3, 3>(3, 3).copy_from(&(Matrix3::identity() * scale));
        let back = map.try_inverse().expect("a triangular matrix whose diagonal is 1 and a ratio of lengths");
        Self { map, back }
    }

    /// The grasp's own twist for a covector given in these coordinates.
    pub fn twist(&self, w: &[f64; 6]) -> Twist {
        Twist::from_array((self.back * Vector6::from(*w)).into())
    }

    /// The wrench in these coordinates: powers stay what they are.
    pub fn wrench(&self, wrench: &Twist) -> [f64; 6] {
        self.back.tr_mul(&Vector6::from(wrench.to_array())).into()
    }

    /// The twist's norm in these coordinates.
    pub fn norm(&self, w: &Twist) -> f64 {
        (self.map * Vector6::from(w.to_array())).norm()
    }
}

/// A certified lower bound of Q1 in `frame` for a grasp that is force closure, looser than that of [`glance`]
/// and a few times cheaper.
pub(crate) fn floor(search: &Search<'_>, frame: &Frame) -> f64 {
    let Some(centre) = Centre::find(search, ROUGHLY) else { return 0.0 };
    let factor = centre.H.factor(0.0);
    // The trace of map H⁻¹ mapᵀ is at least its largest eigenvalue.
    let rows = frame.map.row_iter().map(|row| {
        let row: [f64; 6] = std::array::from_fn(|k| row[k]);
        Twist::from_array(row).dot(&Twist::from_array(factor.solve(row)))
    });
    let longest = rows.sum::<f64>().max(0.0).sqrt();
    1.0 / (frame.norm(&centre.w) + centre.radius(search) * longest)
}

/// The centre, the axes of the ellipsoid about it in `frame`, and the lower bound of Q1 that it certifies.
fn around_centre(search: &Search<'_>, frame: &Frame) -> Option<(Twist, Matrix6<f64>, f64)> {
    let centre = Centre::find(search, EXACTLY)?;
    let inverse = centre.H.full().cholesky().map(|factor| factor.inverse())?;
    let ellipsoid = SymmetricEigen::new(frame.map * inverse * frame.map.transpose());
    let longest = ellipsoid.eigenvalues.max().max(0.0).sqrt();
    let lower = 1.0 / (frame.norm(&centre.w) + centre.radius(search) * longest);
    Some((centre.w, ellipsoid.eigenvectors, lower))
}

/// Quick bounds of Q1 in `frame` for a grasp that is force closure: the certified one from the centre, and
/// the depth along the ellipsoid's axes.
pub(crate) fn glance(search: &Search<'_>, frame: &Frame) -> (f64, f64) {
    let Some((_, axes, lower)) = around_centre(search, frame) else { return (0.0, f64::INFINITY) };
    let along = |axis: Vector6<f64>| search.body.gauge(&frame.twist(&axis.into()));
    let depths = axes.column_iter().map(|axis| along(axis.into()).min(along(-axis)));
    (lower, depths.fold(f64::INFINITY, f64::min))
}

/// Lower and upper bound of Q1 in `frame` for a grasp that is force closure.
pub(crate) fn bracket(search: &Search<'_>, frame: &Frame) -> (f64, f64) {
    let Some((w, axes, lower)) = around_centre(search, frame) else { return (0.0, f64::INFINITY) };
    (lower, 1.0 / longest_point(search, frame, &w, &axes))
}

/// The (nearly) analytic centre of Ω.
struct Centre {
    w: Twist,
    H: Symmetric6,
    decrement: f64,
}

impl Centre {
    /// Newton's method until the decrement is below `near`.
    fn find(search: &Search<'_>, near: f64) -> Option<Self> {
        let mut w = Twist::ZERO;
        let mut best = None;
        for _ in 0..CENTRING_STEPS {
            let here = search.body.at(&w);
            let (H, g) = search.body.newton_system(&here);
            let factor = H.factor(0.0);
            let d = Twist::from_array(factor.solve(g));
            let decrement = d.dot(&Twist::from_array(g)).max(0.0).sqrt();
            if decrement < 0.5 {
                best = Some(Self { w, H, decrement });
            }
            if decrement < near {
                break;
            }
            w = w.plus(search.body.best_step(&here, &search.body.along(&here, &d), 0.0)?, &d);
        }
        best
    }

    /// How many times the ellipsoid of H around w covers Ω.
    ///
    /// Along any line the 2n reciprocal roots λ of Π q_i have Σ λ² = 1 and |Σ λ| ≤ the Newton decrement δ, so
    /// one root is at most 1/x away with ν(ν-1)x² + 2(ν-1)δx = 1 - δ², ν = 2n: sqrt(2n(2n-1)) at the centre
    /// itself.
    fn radius(&self, search: &Search<'_>) -> f64 {
        let nu = 2.0 * search.body.grasp.contacts().len() as f64;
        let (half, delta) = ((nu - 1.0) * self.decrement, self.decrement);
        let root = (half * half + nu * (nu - 1.0) * (1.0 - delta * delta)).sqrt();
        (half + root) / (1.0 - delta * delta)
    }
}

/// How far ascents go: relative gap of each point to the farthest one along its covector, and relative rise
/// of the norm below which a local maximum is reached.
#[derive(Clone, Copy)]
struct Precision {
    gap: f64,
    rise: f64,
}

/// Which local maximum an ascent nears ...
const ROUGH: Precision = Precision { gap: 3e-2, rise: 3e-2 };
/// ... and what its norm is.
const FINE: Precision = Precision { gap: 1e-8, rise: 1e-7 };
/// A rough ascent that ends below this share of the longest one does not go on.
const PROMISING: f64 = 0.9;
/// Ascents whose directions have this product, or more, end at the same place.
const SAME: f64 = 0.999;

/// The largest norm over Ω that ascents from both ends of the ellipsoid's axes find: all of them roughly
/// first, then the best ones, those that end at different places, to the end.
fn longest_point(search: &Search<'_>, frame: &Frame, centre: &Twist, axes: &Matrix6<f64>) -> f64 {
    let start = |end: usize| axes.column(end / 2) * if end.is_multiple_of(2) { 1.0 } else { -1.0 };
    let mut rough: [(f64, Vector6<f64>); 12] =
        std::array::from_fn(|end| ascend(search, frame, centre, start(end), ROUGH));
    rough.sort_by(|a, b| b.0.total_cmp(&a.0));
    let promising = rough.iter().filter(|(norm, _)| *norm >= PROMISING * rough[0].0);
    let (mut best, mut places) = (0.0_f64, Vec::with_capacity(rough.len()));
    for (_, direction) in promising {
        if places.iter().all(|place: &Vector6<f64>| place.dot(direction) < SAME) {
            let (norm, place) = ascend(search, frame, centre, *direction, FINE);
            best = best.max(norm);
            places.extend([place, *direction]);
        }
    }
    best
}

/// The norm and direction of a local maximum of |w| over Ω: w ← argmax over Ω of <w/|w|, ·> until it stays.
fn ascend(
    search: &Search<'_>,
    frame: &Frame,
    centre: &Twist,
    mut direction: Vector6<f64>,
    precision: Precision,
) -> (f64, Vector6<f64>) {
    let mut best = 0.0_f64;
    for _ in 0..ASCENT_ROUNDS {
        let covector = Twist::from_array((frame.map.transpose() * direction).into());
        let point = farthest(search, centre, &covector, precision.gap);
        let image = frame.map * Vector6::from(point.to_array());
        let norm = image.norm();
        let done = norm <= best * (1.0 + precision.rise);
        best = best.max(norm);
        if norm > 0.0 {
            direction = image / norm;
        }
        if done || norm == 0.0 {
            break;
        }
    }
    (best, direction)
}

/// The point of Ω that is farthest along `covector`, from inside, to a relative `precision`: path following
/// with the same barrier.
fn farthest(search: &Search<'_>, centre: &Twist, covector: &Twist, precision: f64) -> Twist {
    let gap = 2.0 * search.body.grasp.contacts().len() as f64;
    let mut w = *centre;
    let mut weight = 1.0;
    for _ in 0..CENTRING_STEPS {
        let here = search.body.at(&w);
        let (H, g) = search.body.newton_system(&here);
        let g = Twist::from_array(g).plus(weight, covector);
        let d = Twist::from_array(H.factor(0.0).solve(g.to_array()));
        let along = search.body.along(&here, &d);
        let Some(t) = search.body.best_step(&here, &along, weight * covector.dot(&d)) else { break };
        let next = w.plus(t, &d);
        if search.body.gauge(&next) >= 1.0 {
            break;
        }
        w = next;
        if d.dot(&g) < 0.5 {
            if gap < precision * weight * covector.dot(&w) {
                break;
            }
            weight *= WEIGHT_STEP;
        }
    }
    w
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::closure::Outcome;
    use regrasp_api::{Cone, FingerIndex, Grasp, GraspContact, Random};

    fn random_grasp(random: &mut Random) -> ScaledGrasp {
        let mut grasp = Grasp::new(Vec3::zeros());
        let cone = Cone::Elliptic { mu: random.range(0.3, 1.0), gamma: random.range(0.0, 0.02) };
        for finger in 0..3 + random.index(4) as u8 {
            let n_O = random.direction();
            let p_OC = n_O * 0.03 + random.direction() * random.range(0.0, 0.02);
            grasp.push(GraspContact { finger: FingerIndex(finger), p_OC, n_O, cone: cone.clone() });
        }
        ScaledGrasp::gather(&grasp, None, "test").unwrap()
    }

    #[test]
    fn no_ascent_goes_farther_than_those_that_were_promising() {
        let mut random = Random::from_key(9, 0, 0, 0);
        let (mut closed, mut short) = (0, 0);
        while closed < 200 {
            let grasp = random_grasp(&mut random);
            let search = Search::new(&grasp, 1e-6);
            if !matches!(search.run(), Outcome::Closed(_)) {
                continue;
            }
            closed += 1;
            let frame = Frame::new(&grasp, None, None);
            let centre = Centre::find(&search, EXACTLY).unwrap();
            let inverse = centre.H.full().cholesky().unwrap().inverse();
            let axes = SymmetricEigen::new(frame.map * inverse * frame.map.transpose()).eigenvectors;
            let all = axes.column_iter().flat_map(|axis| [axis.into_owned(), -axis.into_owned()]);
            let ascents = all.map(|axis| ascend(&search, &frame, &centre.w, axis, FINE).0);
            let farthest = ascents.fold(0.0, f64::max);
            let found = longest_point(&search, &frame, &centre.w, &axes);
            assert!(found > 0.97 * farthest, "{found} {farthest}");
            short += usize::from(found < (1.0 - 1e-5) * farthest);
        }
        assert!(short <= 4, "{short} of {closed} end at a smaller maximum");
    }
}
