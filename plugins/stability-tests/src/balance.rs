//! Contact forces that balance a given load inside cones and under a bound of the normal forces: Newton's
//! method to their analytic centre.

use crate::closure::{Factor, Symmetric6};
use crate::contacts::{ScaledContact, ScaledGrasp, Twist};
use regrasp_api::{MAX_FINGERS, Vec3};

/// The most Newton steps; about eight from the start, two or three from a centre nearby.
const MAX_STEPS: usize = 80;
/// The share of the way to the boundary that a step may go.
const SHY: f64 = 0.9;
/// Newton decrement at which a centre is near enough.
const CENTRED: f64 = 0.5;
/// Room that an accepted force keeps to the boundary of its cone and to the bound, of the largest normal
/// force.
const ROOM: f64 = 1e-9;
/// Pivots of the grasp map's square at or below this mean that its rank is not surely 6.
const FLAT: f64 = 1e-12;

/// One contact's force, the largest allowed normal force as unit: f_n = normal, f_t = μ tangential
/// (stretched by a grain), m = γ spin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Force {
    pub normal: f64,
    /// Orthogonal to the contact's normal.
    pub tangential: Vec3,
    pub spin: f64,
}

impl Force {
    const ZERO: Self = Self { normal: 0.0, tangential: Vec3::new(0.0, 0.0, 0.0), spin: 0.0 };
    /// Where a search starts: midway between none and the largest.
    pub const START: Self = Self { normal: 0.5, tangential: Vec3::new(0.0, 0.0, 0.0), spin: 0.0 };

    /// f_n² - |(f_t/μ, m/γ)|².
    #[inline]
    fn q(&self) -> f64 {
        self.product(self)
    }

    /// The Lorentz product.
    #[inline]
    fn product(&self, other: &Self) -> f64 {
        self.normal * other.normal - self.tangential.dot(&other.tangential) - self.spin * other.spin
    }

    #[inline]
    pub fn dot(&self, other: &Self) -> f64 {
        self.normal * other.normal + self.tangential.dot(&other.tangential) + self.spin * other.spin
    }

    #[inline]
    pub fn plus(&self, s: f64, other: &Self) -> Self {
        Self {
            normal: self.normal + s * other.normal,
            tangential: self.tangential + other.tangential * s,
            spin: self.spin + s * other.spin,
        }
    }

    /// Room to the cone's surface and to the bound.
    #[inline]
    pub fn room(&self) -> f64 {
        let spread = (self.tangential.norm_squared() + self.spin * self.spin).sqrt();
        (self.normal - spread).min(1.0 - self.normal)
    }

    /// G of one contact: its wrench.
    #[inline]
    pub fn wrench(&self, contact: &ScaledContact) -> Twist {
        let f = contact.n * self.normal + contact.stretched(&self.tangential);
        Twist { a: f, b: contact.r.cross(&f) + contact.n * (contact.gamma * self.spin) }
    }

    /// Gᵀ of one contact: what it sees of a twist.
    #[inline]
    pub fn seen(contact: &ScaledContact, w: &Twist) -> Self {
        let v = w.a + w.b.cross(&contact.r);
        let normal = v.dot(&contact.n);
        let tangential = contact.stretched(&(v - contact.n * normal));
        Self { normal, tangential, spin: contact.gamma * w.b.dot(&contact.n) }
    }
}

/// A force of every contact.
pub(crate) type Forces = [Force; MAX_FINGERS];

/// The barrier -log(f_n² - |u|²) - log(1 - f_n) of one contact at a force.
#[derive(Clone, Copy)]
pub(crate) struct Barrier {
    at: Force,
    q: f64,
    /// (f_n² + |u|²)/2 and f_n u: what the inverse Hessian of the first term makes of the unit normal force.
    lifted: Force,
    /// Weight of the second term in the inverse.
    weight: f64,
}

impl Barrier {
    #[inline]
    /// At a force inside.
    pub fn new(at: &Force) -> Self {
        let q = at.q();
        let lifted = Force {
            normal: at.normal * at.normal - 0.5 * q,
            tangential: at.tangential * at.normal,
            spin: at.spin * at.normal,
        };
        let curvature = (1.0 - at.normal).powi(-2);
        Self { at: *at, q, lifted, weight: curvature / (1.0 + curvature * lifted.normal) }
    }

    #[inline]
    pub fn gradient(&self) -> Force {
        let scale = 2.0 / self.q;
        Force {
            normal: 1.0 / (1.0 - self.at.normal) - scale * self.at.normal,
            tangential: self.at.tangential * scale,
            spin: self.at.spin * scale,
        }
    }

    /// The inverse Hessian times `c`: x xᵀ - (q/2) diag(1, -1, -1, -1), less the second term by Sherman and
    /// Morrison.
    #[inline]
    pub fn inverse(&self, c: &Force) -> Force {
        let (along, half) = (self.at.dot(c), 0.5 * self.q);
        let mirrored =
            Force { normal: -half * c.normal, tangential: c.tangential * half, spin: half * c.spin };
        mirrored.plus(along, &self.at).plus(-self.weight * self.lifted.dot(c), &self.lifted)
    }

    /// Adds G H⁻¹ Gᵀ of the contact.
    #[inline]
    pub fn add_to(&self, S: &mut Symmetric6, contact: &ScaledContact) {
        let (mu2, gamma2) = (contact.mu * contact.mu, contact.gamma * contact.gamma);
        let half = 0.5 * self.q;
        let normal = Twist { a: contact.n, b: contact.r.cross(&contact.n) };
        S.add_outer(1.0, &self.at.wrench(contact).to_array());
        S.add_outer(-self.weight, &self.lifted.wrench(contact).to_array());
        S.add_outer(-half * (1.0 + mu2), &normal.to_array());
        S.add_velocity(half * mu2, &contact.r);
        if contact.grained {
            S.add_outer(half, &contact.grain_wrench());
        }
        if gamma2 > 0.0 {
            S.add_spin(half * gamma2, &contact.n);
        }
    }

    /// The largest step along `d` that stays inside.
    #[inline]
    pub fn reach(&self, d: &Force) -> f64 {
        let bound = if d.normal > 0.0 { (1.0 - self.at.normal) / d.normal } else { f64::INFINITY };
        bound.min(first_root(self.q, 2.0 * self.at.product(d), d.q()))
    }
}

/// The smallest positive root of q + t q' + t² c, for q > 0; infinite where there is none.
#[inline]
fn first_root(q: f64, slope: f64, c: f64) -> f64 {
    let root = (slope * slope - 4.0 * c * q).max(0.0).sqrt();
    if root > slope { 2.0 * q / (root - slope) } else { f64::INFINITY }
}

/// Whether some load can be balanced.
#[derive(Clone, Copy, Debug)]
#[allow(clippy::large_enum_variant)] // lives on the stack for the length of one call
pub(crate) enum Balanced {
    /// By these forces, strictly inside.
    Yes(Forces),
    /// No: a twist on which all contacts together have less power than the load asks for.
    No,
    /// Neither was proved.
    Unknown,
}

/// The contacts of one grasp with normal forces up to 1.
pub(crate) struct Balance<'a> {
    grasp: &'a ScaledGrasp,
    /// Trace of the inverse of the grasp map's square.
    trace: f64,
}

/// A centre of balancing forces, and the forces' response to a change of the load.
pub(crate) struct Response<'a> {
    balance: &'a Balance<'a>,
    forces: &'a Forces,
    factor: Factor,
}

impl<'a> Balance<'a> {
    /// `None` where the contacts cannot resist every direction of wrench, whatever the forces.
    pub fn new(grasp: &'a ScaledGrasp) -> Option<Self> {
        let factor = crate::closure::PolarBody { grasp }.grasp_map_square().0.factor(FLAT);
        (factor.smallest > FLAT).then(|| Self { grasp, trace: factor.trace_of_inverse() })
    }

    /// Looks for forces whose wrench is `wanted`, near the centre of all such forces.
    pub fn centre(&self, wanted: &Twist) -> Balanced {
        self.search([Force::START; MAX_FINGERS], wanted, true)
    }

    /// Looks for any forces whose wrench is `wanted`, from forces of a load nearby.
    pub fn follow(&self, from: &Forces, wanted: &Twist) -> Balanced {
        self.search(*from, wanted, false)
    }

    /// Newton's method from forces inside that need not balance (Boyd & Vandenberghe, "Convex Optimization",
    /// 2004, section 10.3), with 6×6 systems G H⁻¹ Gᵀ.
    fn search(&self, mut forces: Forces, wanted: &Twist, centred: bool) -> Balanced {
        let mut feasible = false;
        for _ in 0..MAX_STEPS {
            let step = self.step(&forces, wanted);
            if !feasible && self.cannot(&step.multiplier, wanted) {
                return Balanced::No;
            }
            let t = (SHY * step.reach).min(1.0);
            for (force, d) in forces.iter_mut().zip(&step.change) {
                *force = force.plus(t, d);
            }
            feasible |= t >= 1.0;
            if feasible && (!centred || step.decrement < CENTRED) && self.balances(&forces, wanted) {
                return Balanced::Yes(forces);
            }
        }
        if feasible && self.balances(&forces, wanted) { Balanced::Yes(forces) } else { Balanced::Unknown }
    }

    #[inline]
    fn step(&self, forces: &Forces, wanted: &Twist) -> Step {
        let mut S = Symmetric6::zeros();
        let mut right = *wanted;
        let mut barriers = [Barrier::new(&Force::START); MAX_FINGERS];
        for ((barrier, force), contact) in barriers.iter_mut().zip(forces).zip(self.grasp.contacts()) {
            *barrier = Barrier::new(force);
            barrier.add_to(&mut S, contact);
            let downhill = barrier.inverse(&barrier.gradient());
            right = right.plus(1.0, &downhill.plus(-1.0, force).wrench(contact));
        }
        let multiplier = Twist::from_array(S.factor(f64::MIN_POSITIVE).solve(right.to_array()));
        let mut step =
            Step { multiplier, change: [Force::ZERO; MAX_FINGERS], reach: f64::INFINITY, decrement: 0.0 };
        for ((d, barrier), contact) in step.change.iter_mut().zip(&barriers).zip(self.grasp.contacts()) {
            let uphill = Force::seen(contact, &multiplier).plus(-1.0, &barrier.gradient());
            *d = barrier.inverse(&uphill);
            step.reach = step.reach.min(barrier.reach(d));
            step.decrement += uphill.dot(d);
        }
        step.decrement = step.decrement.max(0.0).sqrt();
        step
    }

    /// Whether all contacts together have less power on `w` than `wanted`: what is wanted is outside the
    /// forces' wrenches.
    fn cannot(&self, w: &Twist, wanted: &Twist) -> bool {
        let most: f64 = self.grasp.contacts().iter().map(|contact| contact.support(w).max(0.0)).sum();
        wanted.dot(w) > most + 1e-12 * w.norm()
    }

    /// Whether the forces are strictly inside and balance to far less than their room can take.
    fn balances(&self, forces: &Forces, wanted: &Twist) -> bool {
        let (mut residual, mut room) = (wanted.scaled(-1.0), f64::INFINITY);
        for (force, contact) in forces.iter().zip(self.grasp.contacts()) {
            residual = residual.plus(1.0, &force.wrench(contact));
            room = room.min(force.room());
        }
        room >= ROOM && residual.dot(&residual) * self.trace <= (0.1 * room).powi(2)
    }

    /// How the forces respond to a change of the load.
    pub fn response(&'a self, forces: &'a Forces) -> Response<'a> {
        let mut S = Symmetric6::zeros();
        for (force, contact) in forces.iter().zip(self.grasp.contacts()) {
            Barrier::new(force).add_to(&mut S, contact);
        }
        Response { balance: self, forces, factor: S.factor(f64::MIN_POSITIVE) }
    }
}

/// One Newton step.
struct Step {
    multiplier: Twist,
    change: Forces,
    /// The largest multiple of the change that stays inside.
    reach: f64,
    decrement: f64,
}

impl Response<'_> {
    /// The forces after a change of what is wanted, by the linear response H⁻¹Gᵀ(G H⁻¹Gᵀ)⁻¹, if they are
    /// strictly inside.
    #[inline]
    pub fn absorbs(&self, change: &Twist) -> bool {
        let w = Twist::from_array(self.factor.solve(change.to_array()));
        self.forces.iter().zip(self.balance.grasp.contacts()).all(|(force, contact)| {
            let d = Barrier::new(force).inverse(&Force::seen(contact, &w));
            force.plus(1.0, &d).room() >= ROOM
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use regrasp_api::Random;

    fn random_force(random: &mut Random, n: &Vec3) -> Force {
        let normal = random.range(0.05, 0.95);
        let u = random.direction();
        let tangential = (u - n * u.dot(n)) * (0.6 * normal);
        Force { normal, tangential, spin: random.range(-0.5, 0.5) * normal }
    }

    #[test]
    fn the_barriers_derivatives_agree_with_differences() {
        let mut random = Random::from_key(1, 0, 0, 0);
        let value = |force: &Force| -force.q().ln() - (1.0 - force.normal).ln();
        for _ in 0..100 {
            let n = random.direction();
            let at = random_force(&mut random, &n);
            let barrier = Barrier::new(&at);
            let d = random_force(&mut random, &n);
            let step = 1e-6;
            let slope = (value(&at.plus(step, &d)) - value(&at.plus(-step, &d))) / (2.0 * step);
            assert!((slope - barrier.gradient().dot(&d)).abs() < 1e-5 * (1.0 + slope.abs()));
            // H⁻¹ undoes the change of the gradient.
            let change = Barrier::new(&at.plus(step, &d)).gradient();
            let back = Barrier::new(&at.plus(-step, &d)).gradient();
            let curved = change.plus(-1.0, &back);
            let again = barrier.inverse(&curved);
            let off = again.plus(-2.0 * step, &d);
            assert!(off.dot(&off).sqrt() < 1e-4 * step, "{again:?} {d:?}");
        }
    }
}
