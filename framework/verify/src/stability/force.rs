//! Internal forces: a proof of force closure that arithmetic can check, whoever found the force.
//!
//! A grasp is force closure exactly if its grasp map G has rank 6 and some contact forces y with G y = 0 lie
//! strictly inside every cone. (J. Kerr and B. Roth, "Analysis of multifingered hands", IJRR 1986; NUMERICS
//! of this project, section 1.)

use super::six::{Factor, Six};
use nalgebra::Vector6;
use regrasp_api::{Cone, MAX_FINGERS, Vec3};

/// The least slack of a proof, for forces whose normal parts sum to 1: below, solvers and rounding decide,
/// not the grasp.
pub(crate) const LEAST_SLACK: f64 = 1e-8;
/// The least singular value of the scaled grasp map that counts as rank 6.
const LEAST_SINGULAR: f64 = 1e-6;

/// One contact of a grasp, torques about the claimed centre and in units of force times the claimed length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Contact {
    /// The point, from the centre and divided by the length.
    pub(crate) r: Vec3,
    /// The inward unit normal.
    pub(crate) n: Vec3,
    /// Coefficient of friction; with a grain the smaller one.
    pub(crate) mu: f64,
    /// Torsional radius divided by the length.
    pub(crate) gamma: f64,
    /// The torque about the inward normal, divided by the length, with which a spinning contact drags per
    /// unit of normal force; 0 where it does not spin.
    pub(crate) drag: f64,
    /// The tangent along which a grain gives more friction, and how much more; `None` where it is the same
    /// all round.
    pub(crate) more: Option<(Vec3, f64)>,
}

/// A grain whose tangential part is shorter than this share of it stands on the contact.
const STANDING: f64 = 1e-9;

impl Contact {
    /// The contact at `r` with the inward unit normal `n` and this cone, torsional radii over `length`;
    /// `None` where the cone is a polyhedron.
    pub(crate) fn new(r: Vec3, n: Vec3, cone: &Cone<'_>, length: f64) -> Option<Self> {
        let round = |mu: f64, gamma: f64| Self { r, n, mu, gamma: gamma / length, drag: 0.0, more: None };
        let grain = match cone {
            Cone::Elliptic { mu, gamma } => return Some(round(*mu, *gamma)),
            Cone::Polyhedral(_) => return None,
            Cone::Grained(grain) => grain,
        };
        let flat = grain.axis_O - n * n.dot(&grain.axis_O);
        let [along, across] = grain.mu;
        let contact = round(along.min(across), grain.gamma);
        if flat.norm() <= STANDING * grain.axis_O.norm() {
            return Some(contact);
        }
        let tangent = flat.normalize();
        let tangent = if along >= across { tangent } else { n.cross(&tangent) };
        Some(Self { more: Some((tangent, (along - across).abs())), ..contact })
    }

    /// The tangential force whose scaled coordinates are `t`; symmetric.
    #[inline]
    pub(crate) fn stretch(&self, t: &Vec3) -> Vec3 {
        match &self.more {
            None => t * self.mu,
            Some((tangent, more)) => t * self.mu + tangent * (more * tangent.dot(t)),
        }
    }

    /// The scaled coordinates of a tangential force.
    fn shrink(&self, f: &Vec3) -> Vec3 {
        match &self.more {
            None => f / self.mu,
            Some((tangent, more)) => {
                let along = tangent * tangent.dot(f);
                (f - along) / self.mu + along / (self.mu + more)
            }
        }
    }

    /// The wrench (force, torque) of a force in scaled coordinates.
    #[inline]
    pub(crate) fn wrench(&self, y: &Force) -> Vector6<f64> {
        let force = self.n * y.normal + self.stretch(&y.tangential);
        let torque = self.r.cross(&force) + self.n * (self.gamma * y.spin + self.drag * y.normal);
        stack(&force, &torque)
    }

    /// Adds weight times the outer products of this contact's columns: normal with weight `w`, tangential and
    /// torsional with weight `u`.
    #[inline]
    fn accumulate(&self, sum: &mut Six, w: f64, u: f64) {
        let normal = stack(&self.n, &self.r.cross(&self.n));
        let mu_squared = u * self.mu * self.mu;
        sum.add(&normal, w - mu_squared);
        if self.drag != 0.0 {
            sum.add(&stack(&self.n, &(self.r.cross(&self.n) + self.n * self.drag)), w);
            sum.add(&normal, -w);
        }
        sum.add_point(&self.r, mu_squared);
        if let Some((tangent, more)) = &self.more {
            let column = stack(tangent, &self.r.cross(tangent));
            sum.add(&column, u * more * (2.0 * self.mu + more));
        }
        if self.gamma != 0.0 {
            sum.add(&stack(&Vec3::zeros(), &self.n), u * self.gamma * self.gamma);
        }
    }
}

#[inline]
fn stack(force: &Vec3, torque: &Vec3) -> Vector6<f64> {
    Vector6::new(force.x, force.y, force.z, torque.x, torque.y, torque.z)
}

/// The force of one contact in coordinates in which its cone is `normal ≥ |(tangential, spin)|`: tangential
/// force divided by μ, torsion by γ.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Force {
    pub(crate) normal: f64,
    /// Orthogonal to the contact's normal.
    pub(crate) tangential: Vec3,
    pub(crate) spin: f64,
}

impl Force {
    /// How far inside its cone the force is; negative outside.
    #[inline]
    pub(crate) fn slack(&self) -> f64 {
        let tangential = self.tangential.norm();
        self.normal - if self.spin == 0.0 { tangential } else { tangential.hypot(self.spin) }
    }
}

/// The forces of all contacts of a grasp.
pub(crate) type Forces = [Force; MAX_FINGERS];

/// Forces on the object (in O), one for each contact, in the contacts' scaled coordinates; no torsion.
pub(crate) fn scaled(contacts: &[Contact], given_O: &[Vec3]) -> Forces {
    let mut forces = [Force::default(); MAX_FINGERS];
    for (force, (contact, given)) in forces.iter_mut().zip(contacts.iter().zip(given_O)) {
        force.normal = contact.n.dot(given);
        force.tangential = contact.shrink(&(given - contact.n * force.normal));
    }
    forces
}

/// Checked forces: balanced and strictly inside every cone, with normal parts that sum to 1, at a grasp of
/// rank 6.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Proof {
    pub(crate) forces: Forces,
    /// The smallest slack.
    pub(crate) slack: f64,
}

/// Tries to prove the grasp force closure with `forces` found somewhere else, such as at a grasp close by:
/// takes them to this grasp's normals, balances them by the smallest correction, and checks.
pub(crate) fn prove(contacts: &[Contact], forces: &Forces) -> Option<Proof> {
    let correction = Correction::new(contacts)?;
    let forces = correction.towards(contacts, forces, &Vector6::zeros());
    check(contacts, &forces, &correction)
}

/// Corrects forces so that their wrench is a wanted one.
pub(crate) struct Correction {
    factor: Factor,
    /// A lower bound of the grasp map's smallest singular value: 1/‖(G Gᵀ)⁻¹‖ ≤ λ_min(G Gᵀ).
    pub(crate) singular: f64,
}

impl Correction {
    /// `None` where the grasp map has no rank 6.
    pub(crate) fn new(contacts: &[Contact]) -> Option<Self> {
        let mut gram = Six::ZERO;
        contacts.iter().for_each(|contact| contact.accumulate(&mut gram, 1.0, 1.0));
        let factor = gram.factor()?;
        let singular = factor.least().sqrt();
        (singular >= LEAST_SINGULAR).then_some(Self { factor, singular })
    }

    /// The forces closest to `forces` that lie in these contacts' planes and have the wanted wrench.
    ///
    /// G Gᵀ λ = G y - wanted; y - Gᵀ λ has it.
    #[inline]
    pub(crate) fn towards(&self, contacts: &[Contact], forces: &Forces, wanted: &Vector6<f64>) -> Forces {
        let mut forces = *forces;
        let mut residual = -wanted;
        for (contact, force) in contacts.iter().zip(&mut forces) {
            force.tangential -= contact.n * contact.n.dot(&force.tangential);
            residual += contact.wrench(force);
        }
        let lambda = self.factor.solve(&residual);
        let (a, b) = (lambda.fixed_rows::<3>(0).into_owned(), lambda.fixed_rows::<3>(3).into_owned());
        for (contact, force) in contacts.iter().zip(&mut forces) {
            let v = a + b.cross(&contact.r);
            let v_n = contact.n.dot(&v);
            force.normal -= v_n + contact.drag * b.dot(&contact.n);
            force.tangential -= contact.stretch(&(v - contact.n * v_n));
            force.spin -= b.dot(&contact.n) * contact.gamma;
        }
        forces
    }
}

/// The proof itself: residual, cones, rank.
fn check(contacts: &[Contact], forces: &Forces, correction: &Correction) -> Option<Proof> {
    let total: f64 = forces[..contacts.len()].iter().map(|force| force.normal).sum();
    if !(total > 0.0 && total.is_finite()) {
        return None;
    }
    let mut proof = Proof { forces: *forces, slack: f64::INFINITY };
    let mut residual = Vector6::zeros();
    for (contact, force) in contacts.iter().zip(&mut proof.forces) {
        force.normal /= total;
        force.tangential /= total;
        force.spin /= total;
        proof.slack = proof.slack.min(force.slack());
        residual += contact.wrench(force);
    }
    // What balances the residual exactly is smaller than residual/singular, and must not leave the cones.
    let inside = proof.slack >= LEAST_SLACK && residual.norm() <= 0.5 * correction.singular * proof.slack;
    inside.then_some(proof)
}

/// A certified lower bound of the closure margin Q1 = min over |w| = 1 of max_i h_i(w), from one internal
/// force.
///
/// For every unit w, Σ y_i h_i(w) (y_i the normal forces, which sum to 1) is at least the sum over the
/// contacts of slack times the length of w on the contact's tangential and torsional columns, since the force
/// may move by its slack without leaving the cone's slice. Hence Q1² is at least the smallest eigenvalue of Σ
/// slack² (those columns' outer products). The normal columns count too where the force moves by slack/√2 in
/// all directions, which takes up to that much more normal force. The larger of the two bounds holds.
pub(crate) fn margin(contacts: &[Contact], proof: &Proof) -> f64 {
    let (mut tangential, mut all, mut more) = (Six::ZERO, Six::ZERO, 1.0);
    for (contact, force) in contacts.iter().zip(&proof.forces) {
        let slack = force.slack();
        contact.accumulate(&mut tangential, 0.0, slack * slack);
        contact.accumulate(&mut all, slack * slack / 2.0, slack * slack / 2.0);
        more += slack / std::f64::consts::SQRT_2;
    }
    let smallest = |matrix: &Six| matrix.smallest_eigenvalue().max(0.0).sqrt();
    smallest(&tangential).max(smallest(&all) / more)
}

/// No more than [`margin`], at a tenth of its cost: eigenvalues are bounded, not found.
pub(crate) fn rough_margin(contacts: &[Contact], proof: &Proof) -> f64 {
    let (mut tangential, mut all, mut more) = (Six::ZERO, Six::ZERO, 1.0);
    for (contact, force) in contacts.iter().zip(&proof.forces) {
        let slack = force.slack();
        contact.accumulate(&mut tangential, 0.0, slack * slack);
        contact.accumulate(&mut all, slack * slack / 2.0, slack * slack / 2.0);
        more += slack / std::f64::consts::SQRT_2;
    }
    let bound = |matrix: &Six| matrix.factor().map_or(0.0, |factor| factor.least().sqrt());
    // Less a part for rounding, which [`margin`] has too.
    (1.0 - 1e-6) * bound(&tangential).max(bound(&all) / more)
}
