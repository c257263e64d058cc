//! Newton's method to the analytic centre of the polar body, stopped as soon as a proof either way is at
//! hand.

use super::polar::{Local, Locals, PolarBody};
use super::symmetric::{Factor, Symmetric6};
use crate::contacts::{ScaledContact, ScaledGrasp, Twist};
use regrasp_api::{MAX_FINGERS, Vec3};

/// The most Newton steps; a dozen decide any grasp that was ever tried, near-boundary ones included.
const MAX_STEPS: usize = 100;
/// Smallest slack of an accepted force relative to the largest number that was cancelled to find it.
const SLACK: f64 = 1e-9;
/// A hint's claim counts only where it holds with this margin, so that a search without the hint must come to
/// the same verdict.
const COMFORT: f64 = 1e-3;

/// Smallest pivot of the scaled grasp map's square at which its rank is beyond doubt, and so is a solution to
/// rounding.
const SOUND: f64 = 1e-5;
/// Distance from w = 0 at which a separating twist of the second kind ([`Search::rounded`]) is first looked
/// for ...
const FIRST_LOOK: f64 = 10.0;
/// ... and by how much farther for another look.
const LOOK_AGAIN: f64 = 5.0;
/// Contacts that feel a far point w of Ω by at most this times sqrt |w| are taken to be those that hold it:
/// what they feel stays bounded while w, and what the others feel, grows.
const AT_REST: f64 = 2.0;
/// How many times farther than 1/τ the search for a twist goes on, for the proof's sake; closure is ruled out
/// there.
const BEYOND: f64 = 1e3;
/// What is added to a singular matrix so that solving with it projects onto its null space.
const PROJECTION: f64 = 1e-13;

/// What a search found.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Outcome {
    /// Force closure: Newton's multipliers at this point of Ω are an internal force strictly inside every
    /// cone.
    Closed(Twist),
    /// Not force closure: no contact resists this twist.
    Separated(Twist),
    /// Neither was proved; this point of Ω is so far out that the margin is at most 1 over its norm.
    Undecided(Twist),
}

/// The internal force that Newton's multipliers give, in scaled coordinates: a force and a torsional torque a
/// contact.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Forces {
    /// Force on the object and torque about the inward normal over the length.
    pub each: [(Vec3, f64); MAX_FINGERS],
    /// Sum of the normal parts.
    pub normal_sum: f64,
    /// Smallest f_n - |(f_t/μ, m/γ)|.
    pub slack: f64,
}

/// One search for a proof; pure.
#[derive(Clone, Copy)]
pub(crate) struct Search<'a> {
    /// The polar body of the grasp.
    pub body: PolarBody<'a>,
    /// Margins up to this one are left undecided.
    pub tau: f64,
}

impl<'a> Search<'a> {
    pub fn new(grasp: &'a ScaledGrasp, tau: f64) -> Self {
        Self { body: PolarBody { grasp }, tau }
    }

    /// Searches from w = 0, where the first step needs the grasp map alone.
    pub fn run(&self) -> Outcome {
        let (M, sum) = self.body.grasp_map_square();
        let factor = M.factor(0.5 * self.tau * self.tau);
        let sound = factor.smallest >= SOUND;
        let thin = match if sound { None } else { self.unfelt_direction(&M) } {
            Some(u) => match self.look_along(&u) {
                Outcome::Undecided(far) => Some(far),
                proof => return proof,
            },
            None => None,
        };
        let d = Twist::from_array(factor.solve(sum));
        if sound && self.first_forces_hold(&d) {
            return Outcome::Closed(Twist::ZERO);
        }
        if self.body.separates(&d) {
            return Outcome::Separated(d);
        }
        let here = self.body.at(&Twist::ZERO);
        let along = self.body.along(&here, &d);
        if !sound && thin.is_none() && self.forces_hold(&here, &along, &factor) {
            return Outcome::Closed(Twist::ZERO);
        }
        match self.body.best_step(&here, &along, 0.0) {
            Some(t) => self.descend(d.scaled(t), &factor, thin),
            None => self.last_look(thin.unwrap_or_else(|| self.far(&d))),
        }
    }

    /// Newton steps from `w`; `thin` is a far point of Ω if one is known already, which rules closure out.
    #[inline(never)]
    fn descend(&self, mut w: Twist, grasp_map: &Factor, mut thin: Option<Twist>) -> Outcome {
        let mut next_look = FIRST_LOOK;
        for _ in 0..MAX_STEPS {
            let next = match self.step(&w, grasp_map, &mut thin) {
                Ok(next) => next,
                Err(outcome) => return outcome,
            };
            // Without a change there is nothing to come.
            if next == w {
                break;
            }
            w = next;
            let norm = w.norm();
            if norm * self.tau >= 1.0 {
                thin = thin.or(Some(w));
            }
            if norm * self.tau >= BEYOND {
                break;
            }
            if norm > next_look {
                next_look = LOOK_AGAIN * norm;
                if let Some(twist) = self.rounded(&w) {
                    return Outcome::Separated(twist);
                }
            }
        }
        self.last_look(thin.unwrap_or(w))
    }

    /// One Newton step from `w`: where it leads, or the proof that it found.
    #[inline]
    fn step(&self, w: &Twist, grasp_map: &Factor, thin: &mut Option<Twist>) -> Result<Twist, Outcome> {
        let here = self.body.at(w);
        let (H, g) = self.body.newton_system(&here);
        let factor = H.factor(self.tau * self.tau);
        if let (None, Some(u)) = (&thin, factor.weak_direction()) {
            match self.look_along(&u) {
                Outcome::Undecided(far) => *thin = Some(far),
                proof => return Err(proof),
            }
        }
        let d = Twist::from_array(factor.solve(g));
        let along = self.body.along(&here, &d);
        if thin.is_none() && self.forces_hold(&here, &along, grasp_map) {
            return Err(Outcome::Closed(*w));
        }
        if self.body.separates(&d) {
            return Err(Outcome::Separated(d));
        }
        match self.body.best_step(&here, &along, 0.0) {
            Some(t) => Ok(w.plus(t, &d)),
            None => Err(self.last_look(self.far(&d))),
        }
    }

    /// The outcome where Newton's method ends at the far point `w`.
    #[cold]
    fn last_look(&self, w: Twist) -> Outcome {
        if self.body.separates(&w) {
            return Outcome::Separated(w);
        }
        self.rounded(&w).map_or(Outcome::Undecided(w), Outcome::Separated)
    }

    /// The twist near the far point `w` that leaves the contacts that hold it altogether at rest, if it
    /// separates.
    ///
    /// Where some contacts can squeeze and no force at the others helps (an antipodal pair with the rest on
    /// one side), the only separating twists are those that the squeezing contacts do not feel, a face of no
    /// volume that Newton's method nears without reaching it.
    #[cold]
    fn rounded(&self, w: &Twist) -> Option<Twist> {
        let norm = w.norm();
        let mut felt = self.body.felt_square(w, AT_REST * norm.sqrt());
        felt.add_identity(PROJECTION);
        let factor = felt.factor(PROJECTION);
        let mut d = w.scaled(1.0 / norm);
        for _ in 0..2 {
            d = Twist::from_array(factor.solve(d.to_array()));
            d = d.scaled(1.0 / d.norm());
        }
        self.body.separates(&d).then_some(d)
    }

    /// The unit twist that the contacts feel least, where that is so little that the margin is at most τ.
    ///
    /// A pivot alone does not tell: where the factors grow it is rounding. Eigenvalues do, and few grasps
    /// come here.
    #[cold]
    fn unfelt_direction(&self, M: &Symmetric6) -> Option<Twist> {
        let M = M.full();
        let noise = 2e-15 * M.trace();
        let eigen = M.symmetric_eigen();
        let least = eigen.eigenvalues.imin();
        // Q1² ≤ 2 uᵀMu for every unit u.
        let unfelt = eigen.eigenvalues[least] <= noise.max(0.5 * self.tau * self.tau);
        unfelt.then(|| Twist::from_array(std::array::from_fn(|i| eigen.eigenvectors[(i, least)])))
    }

    /// What a direction in which Ω is very long proves: separation, or a far point.
    #[cold]
    fn look_along(&self, u: &Twist) -> Outcome {
        let back = u.scaled(-1.0);
        if self.body.separates(u) {
            return Outcome::Separated(*u);
        }
        if self.body.separates(&back) {
            return Outcome::Separated(back);
        }
        let (fore, aft) = (self.far(u), self.far(&back));
        Outcome::Undecided(if fore.norm() > aft.norm() { fore } else { aft })
    }

    /// The last point of Ω in direction `d`, or a very far one where there is no last.
    fn far(&self, d: &Twist) -> Twist {
        let smallest = 1e-12 * d.norm();
        d.scaled(1.0 / self.body.gauge(d).max(smallest))
    }

    /// Whether the multipliers of the step `d` from w = 0 are strictly inside every cone: h_i(d) < 1.
    #[inline]
    fn first_forces_hold(&self, d: &Twist) -> bool {
        let (mut slack, mut magnitude) = (f64::INFINITY, 0.0_f64);
        for contact in self.body.grasp.contacts() {
            let v = d.a + d.b.cross(&contact.r);
            let v_n = v.dot(&contact.n);
            let v_t = v - contact.n * v_n;
            let spin = contact.gamma * d.b.dot(&contact.n);
            let spread = (contact.form(&v_t, &v_t) + spin * spin).sqrt();
            slack = slack.min(1.0 - v_n - spread);
            magnitude = magnitude.max(1.0 + 3.0 * v_n.abs() + spread);
        }
        slack >= SLACK * magnitude
    }

    /// Whether the multipliers of a step prove closure.
    ///
    /// The margin: pushing every force by at most slack/√2 keeps it in its cone, so Q1 ≥ slack σ_min(G) / (√2
    /// (1 + 1/√2) Σ f_n).
    #[inline]
    fn forces_hold(&self, here: &Locals, along: &Locals, grasp_map: &Factor) -> bool {
        self.forces_hold_at(here, along, || grasp_map.trace_of_inverse(), 0.0)
    }

    /// The same with a certified margin above `margin`, given (a bound of) tr M⁻¹.
    #[inline]
    fn forces_hold_at(
        &self,
        here: &Locals,
        along: &Locals,
        trace: impl FnOnce() -> f64,
        margin: f64,
    ) -> bool {
        let (mut slack, mut magnitude, mut normal_sum) = (f64::INFINITY, 0.0_f64, 0.0);
        for ((contact, here), along) in self.body.grasp.contacts().iter().zip(here).zip(along) {
            let force = Multiplier::new(contact, here, along);
            slack = slack.min(force.slack());
            magnitude = magnitude.max(Multiplier::magnitude(contact, here, along));
            normal_sum += force.normal;
        }
        if slack.is_nan() || slack < SLACK * magnitude {
            return false;
        }
        let residual = self.residual(here, along);
        let trace = trace();
        residual.dot(&residual) * trace <= 0.25 * slack * slack
            && (0.41 * slack).powi(2) > (margin * normal_sum).powi(2) * trace
    }

    #[inline]
    fn residual(&self, here: &Locals, along: &Locals) -> Twist {
        let mut sum = Twist::ZERO;
        for ((contact, here), along) in self.body.grasp.contacts().iter().zip(here).zip(along) {
            let (f, m) = Multiplier::new(contact, here, along).wrench(contact);
            sum.a += f;
            sum.b += contact.r.cross(&f) + contact.n * m;
        }
        sum
    }

    /// Whether the hint `w`, from a grasp nearby, proves closure with a margin that any search would see.
    ///
    /// The grasp map's square M is not needed: every contact's part of the Hessian H is at most 2 (s0 +
    /// |u|)²/q² times its part of M, u its tangential and torsional part, so tr M⁻¹ is at most the largest of
    /// those times tr H⁻¹.
    pub fn closed_from(&self, w: &Twist) -> bool {
        let gauge = self.body.gauge(w);
        if gauge.is_nan() || gauge <= 0.0 {
            return false;
        }
        let w = w.scaled((0.9 / gauge).min(1.0));
        let here = self.body.at(&w);
        let (H, g) = self.body.newton_system(&here);
        let factor = H.factor(self.tau * self.tau);
        let along = self.body.along(&here, &Twist::from_array(factor.solve(g)));
        let stiffest =
            here[..self.body.grasp.contacts().len()].iter().map(Local::stiffness).fold(0.0, f64::max);
        factor.smallest >= SOUND * stiffest
            && self.forces_hold_at(&here, &along, || stiffest * factor.trace_of_inverse(), 10.0 * self.tau)
    }

    /// Whether the hint `d`, from a grasp nearby, separates this one with a margin that any search would see.
    pub fn separated_by(&self, d: &Twist) -> bool {
        let bound = -COMFORT * d.norm();
        let back = d.scaled(-1.0);
        bound < 0.0 && self.body.grasp.contacts().iter().all(|contact| contact.support(&back) <= bound)
    }

    /// The internal force of the Newton step at `w`, which [`Outcome::Closed`] names.
    pub fn forces(&self, w: &Twist) -> Forces {
        let here = self.body.at(w);
        let (H, g) = self.body.newton_system(&here);
        let along = self.body.along(&here, &Twist::from_array(H.factor(0.0).solve(g)));
        let mut forces =
            Forces { each: [(Vec3::zeros(), 0.0); MAX_FINGERS], normal_sum: 0.0, slack: f64::INFINITY };
        for (i, contact) in self.body.grasp.contacts().iter().enumerate() {
            let force = Multiplier::new(contact, &here[i], &along[i]);
            forces.each[i] = force.wrench(contact);
            forces.normal_sum += force.normal;
            forces.slack = forces.slack.min(force.slack());
        }
        forces
    }
}

/// One contact's part of Newton's multipliers: f_n = normal, f_t = -μ² tangential, m = -γ² torsional.
struct Multiplier {
    normal: f64,
    tangential: Vec3,
    torsional: f64,
    /// |(f_t/μ, m/γ)|.
    spread: f64,
}

impl Multiplier {
    #[inline]
    fn new(contact: &ScaledContact, here: &Local, along: &Local) -> Self {
        let scale = 2.0 / here.q;
        let k = 1.0 - along.q / here.q;
        let tangential = (here.v_t * k + along.v_t) * scale;
        let torsional = (here.beta * k + along.beta) * scale;
        let spread = (contact.form(&tangential, &tangential) + (contact.gamma * torsional).powi(2)).sqrt();
        Self { normal: (k * here.s0 + along.s0) * scale, tangential, torsional, spread }
    }

    #[inline]
    fn slack(&self) -> f64 {
        self.normal - self.spread
    }

    /// The largest number before cancellation, up to a small factor.
    #[inline]
    fn magnitude(contact: &ScaledContact, here: &Local, along: &Local) -> f64 {
        let mut move_size =
            along.s0.abs() + contact.mu * along.v_t.lp_norm(1) + contact.gamma * along.beta.abs();
        if contact.grained {
            move_size += contact.g.norm() * along.v_t.lp_norm(1);
        }
        let k = 1.0 + 2.0 * here.s0 * move_size / here.q;
        (k * here.s0 + move_size) * 2.0 / here.q
    }

    #[inline]
    fn wrench(&self, contact: &ScaledContact) -> (Vec3, f64) {
        let f = contact.n * self.normal - contact.squared(&self.tangential);
        (f, -contact.gamma * contact.gamma * self.torsional)
    }
}
