//! Forces that balance a load inside cones and efforts: Newton's method to their analytic centre, or a proof
//! that there are none.

use super::bearing::{Bearing, Exerted};
use nalgebra::{Cholesky, Matrix4, Matrix6, Vector4, Vector6};
use regrasp_api::MAX_FINGERS;

/// The most Newton steps; about ten from the start, two or three from a centre nearby.
const MAX_STEPS: usize = 60;
/// The share of the way to the boundary that a step may go.
const SHY: f64 = 0.9;
/// A step shorter than this leaves forces near a bound, from where no step goes far.
const SHORT: f64 = 0.7;
/// The most steps back to the centre.
const RECENTRING: usize = 6;
/// Newton decrement at which a centre is as good as exact, for forces that must be continuous.
const CENTRED: f64 = 1e-4;
/// Room that accepted forces keep to every bound.
const ROOM: f64 = 1e-9;
/// Residual of balance, relative to the largest force, that is rounding.
const BALANCED: f64 = 1e-11;

/// One [`Exerted`] for each contact; those beyond the grasp's stay as they are.
pub type Forces = [Exerted; MAX_FINGERS];

/// Whether forces balance a load.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(clippy::large_enum_variant)] // it lives on the stack of an inner loop, which allocates nothing
pub enum Balanced {
    /// These do, strictly inside all bounds.
    Yes(Forces),
    /// None do. On this twist of the object, the joints giving way as they can, the load has more power than
    /// the efforts at their limits: force part, and torque part over the length.
    No(Vector6<f64>),
    /// Neither was proved.
    Unknown,
}

/// The linear response of forces to a change of the load.
pub(crate) struct Response {
    factor: Cholesky<f64, nalgebra::U6>,
    inverses: [Matrix4<f64>; MAX_FINGERS],
}

impl Response {
    /// The forces after a change of what is wanted.
    pub fn after(&self, search: &Search<'_>, forces: &Forces, change: &Vector6<f64>) -> Forces {
        let multiplier = self.factor.solve(change);
        let mut forces = *forces;
        for (i, bearing) in search.bearings.iter().enumerate() {
            forces[i] += self.inverses[i] * (bearing.map.transpose() * multiplier);
        }
        forces
    }
}

/// One search: the contacts, and the share of the friction that forces may rely on.
#[derive(Clone, Copy)]
pub(crate) struct Search<'a> {
    pub bearings: &'a [Bearing],
    pub share: f64,
}

/// Gradient and Hessian of one contact's barrier, cone and bounds apart.
struct Barrier {
    cone_gradient: Vector4<f64>,
    cone_hessian: Matrix4<f64>,
    gradient: Vector4<f64>,
    inverse: Matrix4<f64>,
}

struct Step {
    multiplier: Vector6<f64>,
    change: Forces,
    /// The largest multiple of the change that stays inside.
    reach: f64,
    decrement: f64,
    /// The most power that forces within all bounds have on the multiplier; infinite where this step proves
    /// no bound.
    power: f64,
}

impl Search<'_> {
    /// Where searches begin: pressing along the normals.
    pub fn start(&self) -> Forces {
        let mut forces = [Exerted::zeros(); MAX_FINGERS];
        for (x, bearing) in forces.iter_mut().zip(self.bearings) {
            x[0] = bearing.start;
        }
        forces
    }

    /// Looks for any forces whose wrench is `wanted`, from forces inside.
    pub fn any(&self, from: &Forces, wanted: &Vector6<f64>) -> Balanced {
        self.run(*from, wanted, f64::INFINITY)
    }

    /// Looks for the analytic centre of the forces whose wrench is `wanted`: unique, and continuous in all
    /// data.
    pub fn centre(&self, from: &Forces, wanted: &Vector6<f64>) -> Balanced {
        self.run(*from, wanted, CENTRED)
    }

    /// Whether forces are strictly inside all bounds.
    pub fn inside(&self, forces: &Forces) -> bool {
        forces.iter().zip(self.bearings).all(|(x, bearing)| bearing.room(x, self.share) >= ROOM)
    }

    /// Whether forces are so far inside that a search may begin there.
    pub fn well_inside(&self, forces: &Forces) -> bool {
        forces.iter().zip(self.bearings).all(|(x, bearing)| bearing.room(x, self.share) >= 1e-3)
    }

    /// How forces follow a change of the wrench that is wanted, by H⁻¹Gᵀ(G H⁻¹Gᵀ)⁻¹.
    pub fn response(&self, forces: &Forces) -> Option<Response> {
        let mut S = Matrix6::zeros();
        let mut inverses = [Matrix4::zeros(); MAX_FINGERS];
        for ((inverse, x), bearing) in inverses.iter_mut().zip(forces).zip(self.bearings) {
            *inverse = Barrier::new(bearing, self.share, x)?.inverse;
            S += bearing.map * *inverse * bearing.map.transpose();
        }
        Some(Response { factor: Cholesky::new(S)?, inverses })
    }

    /// The wrench that forces lack (force, torque over length).
    pub fn residual(&self, forces: &Forces, wanted: &Vector6<f64>) -> Vector6<f64> {
        let wrenches = forces.iter().zip(self.bearings).map(|(x, bearing)| bearing.map * x);
        wrenches.fold(*wanted, |left, wrench| left - wrench)
    }

    /// Newton's method from forces inside that need not balance (S. Boyd, L. Vandenberghe, "Convex
    /// Optimization", 2004, section 10.3).
    ///
    /// The Hessian is one block for each contact, since a finger's joints see its own contact alone: each
    /// step is one 6×6 system.
    fn run(&self, mut forces: Forces, wanted: &Vector6<f64>, precision: f64) -> Balanced {
        if self.bearings.is_empty() {
            return if *wanted == Vector6::zeros() { Balanced::Yes(forces) } else { Balanced::Unknown };
        }
        let mut feasible = false;
        for _ in 0..MAX_STEPS {
            let Some(step) = self.step(&forces, wanted) else { return Balanced::Unknown };
            if !feasible && wanted.dot(&step.multiplier) > step.power * (1.0 + 1e-9) {
                return Balanced::No(step.multiplier);
            }
            let t = self.advance(&mut forces, &step, feasible);
            feasible |= t >= 1.0;
            if feasible && step.decrement < precision && self.balances(&forces, wanted) {
                return Balanced::Yes(forces);
            }
            if t < SHORT
                && !feasible
                && let Some(proof) = self.recentre(&mut forces, wanted)
            {
                return Balanced::No(proof);
            }
        }
        if feasible && self.balances(&forces, wanted) { Balanced::Yes(forces) } else { Balanced::Unknown }
    }

    /// Takes a step as far as the bounds allow; how much of it.
    fn advance(&self, forces: &mut Forces, step: &Step, damped: bool) -> f64 {
        let damping = if damped && step.decrement > 0.3 { 1.0 / (1.0 + step.decrement) } else { 1.0 };
        let t = damping.min(SHY * step.reach);
        for (x, d) in forces.iter_mut().zip(&step.change).take(self.bearings.len()) {
            *x += d * t;
        }
        t
    }

    /// Brings forces that a short step left near a bound back to the centre of those with the same wrench; a
    /// proof where one is met.
    ///
    /// With it the search follows the path of centres from the wrench of the start to the one that is wanted:
    /// where that is out of reach, the path ends at the boundary, and the multiplier there is a proof.
    fn recentre(&self, forces: &mut Forces, wanted: &Vector6<f64>) -> Option<Vector6<f64>> {
        for _ in 0..RECENTRING {
            let here = -self.residual(forces, &Vector6::zeros());
            let step = self.step(forces, &here)?;
            if wanted.dot(&step.multiplier) > step.power * (1.0 + 1e-9) {
                return Some(step.multiplier);
            }
            self.advance(forces, &step, true);
            if step.decrement < 0.5 {
                return None;
            }
        }
        None
    }

    fn balances(&self, forces: &Forces, wanted: &Vector6<f64>) -> bool {
        let largest = forces.iter().zip(self.bearings).map(|(x, _)| x.amax()).fold(wanted.amax(), f64::max);
        self.inside(forces) && self.residual(forces, wanted).amax() <= BALANCED * largest
    }

    fn step(&self, forces: &Forces, wanted: &Vector6<f64>) -> Option<Step> {
        let mut S = Matrix6::zeros();
        let mut right = *wanted;
        let mut barriers: [Option<Barrier>; MAX_FINGERS] = [const { None }; MAX_FINGERS];
        for ((barrier, x), bearing) in barriers.iter_mut().zip(forces).zip(self.bearings) {
            let made = Barrier::new(bearing, self.share, x)?;
            let mapped = bearing.map * made.inverse;
            S += mapped * bearing.map.transpose();
            right += mapped * made.gradient - bearing.map * x;
            *barrier = Some(made);
        }
        let multiplier = Cholesky::new(S)?.solve(&right);
        let mut step = Step {
            multiplier,
            change: [Exerted::zeros(); MAX_FINGERS],
            reach: f64::INFINITY,
            decrement: 0.0,
            power: 0.0,
        };
        for (i, bearing) in self.bearings.iter().enumerate() {
            let barrier = barriers[i].as_ref()?;
            let seen = bearing.map.transpose() * multiplier;
            let uphill = seen - barrier.gradient;
            let d = barrier.inverse * uphill;
            step.reach = step.reach.min(reach(bearing, self.share, &forces[i], &d));
            step.decrement += uphill.dot(&d);
            step.power += barrier.power(bearing, self.share, &forces[i], &d);
            step.change[i] = d;
        }
        step.decrement = step.decrement.max(0.0).sqrt();
        Some(step)
    }
}

impl Barrier {
    /// -log(s²μ² f_n² - |f_t|²) - Σ log(1 - (a·x)²) - log(1 - f_n/most).
    fn new(bearing: &Bearing, share: f64, x: &Exerted) -> Option<Self> {
        let sigma = share * bearing.mu;
        let z = Vector4::new(sigma * sigma * x[0], -x[1], -x[2], -x[3]);
        let q = z.dot(x);
        let cone_gradient = z * (-2.0 / q);
        let mut cone_hessian = z * z.transpose() * (4.0 / (q * q));
        cone_hessian[(0, 0)] -= 2.0 * sigma * sigma / q;
        (1..4).for_each(|k| cone_hessian[(k, k)] += 2.0 / q);
        let (mut gradient, mut hessian) = (cone_gradient, cone_hessian);
        for row in bearing.rows() {
            let (first, second) = slopes(row.dot(x));
            gradient += row * first;
            hessian += row * row.transpose() * second;
        }
        if bearing.most.is_finite() {
            let slope = 1.0 / (bearing.most - x[0]);
            gradient[0] += slope;
            hessian[(0, 0)] += slope * slope;
        }
        if !bearing.has_torsion() {
            // The coordinate does nothing and stays 0.
            (0..4).for_each(|k| (hessian[(3, k)], hessian[(k, 3)]) = (0.0, 0.0));
            hessian[(3, 3)] = 2.0 / q;
            gradient[3] = 0.0;
        }
        let inverse = Cholesky::new(hessian)?.inverse();
        Some(Self { cone_gradient, cone_hessian, gradient, inverse })
    }

    /// The most power that this contact's forces can have on the step's multiplier, by weak duality.
    ///
    /// What the contact sees of the multiplier is exactly a part v in the cone's coordinates and parts λ_j
    /// along the efforts' rows. Where v is in the polar of the cone it has no power, and the rest has at most
    /// Σ |λ_j| within the efforts.
    fn power(&self, bearing: &Bearing, share: f64, x: &Exerted, d: &Exerted) -> f64 {
        let v = self.cone_gradient + self.cone_hessian * d;
        let tangential = v.fixed_rows::<3>(1).norm();
        let over = v[0] + share * bearing.mu * tangential;
        let mut power = 0.0;
        if over > 0.0 {
            // Only the bound of the normal force limits what the cone gives along v.
            power += over * bearing.most;
        }
        for row in bearing.rows() {
            let (first, second) = slopes(row.dot(x));
            power += (first + second * row.dot(d)).abs();
        }
        if bearing.most.is_finite() {
            let slope = 1.0 / (bearing.most - x[0]);
            power += (slope + slope * slope * d[0]).max(0.0) * bearing.most;
        }
        power
    }
}

/// First and second derivative of -log(1 - u²).
pub(super) fn slopes(u: f64) -> (f64, f64) {
    let inverse = 1.0 / (1.0 - u * u);
    (2.0 * u * inverse, 2.0 * (1.0 + u * u) * inverse * inverse)
}

/// The largest multiple of `d` that may be added to `x` within the bounds.
fn reach(bearing: &Bearing, share: f64, x: &Exerted, d: &Exerted) -> f64 {
    let sigma2 = (share * bearing.mu).powi(2);
    let form =
        |a: &Exerted, b: &Exerted| sigma2 * a[0] * b[0] - a.fixed_rows::<3>(1).dot(&b.fixed_rows::<3>(1));
    let (q, slope, curve) = (form(x, x), 2.0 * form(x, d), form(d, d));
    // The smallest positive root of q + t q' + t² c, for q > 0.
    let root = (slope * slope - 4.0 * curve * q).max(0.0).sqrt();
    let mut reach = if root > slope { 2.0 * q / (root - slope) } else { f64::INFINITY };
    for row in bearing.rows() {
        let (u, du) = (row.dot(x), row.dot(d));
        if du != 0.0 {
            reach = reach.min((du.signum() - u) / du);
        }
    }
    if d[0] > 0.0 {
        reach = reach.min((bearing.most - x[0]) / d[0]);
    }
    reach
}
