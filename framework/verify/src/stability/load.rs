//! Bounded contact forces that hold the object's weight and a load: a proof by arithmetic, whoever found the
//! forces.

use super::force::{Contact, Correction, Forces, LEAST_SLACK};
use super::socp;
use nalgebra::Vector6;
use regrasp_api::{Load, MAX_FINGERS, Rotation, Vec3};

/// The weight alone, and with each vertex of two icosahedra.
const CASES: usize = 25;
/// The part of the solver's slack below which carried forces are no longer taken.
const DWINDLED: f64 = 0.4;

/// Follows the forces that hold the object along the plan.
pub(crate) struct LoadCheck {
    /// The disturbances that must be held (N; N·m over the length), over the largest normal force.
    disturbances: Vec<Vector6<f64>>,
    /// The weight in H, over the largest normal force.
    weight_H: Vec3,
    carried: Option<Held>,
    /// The slack that the solver found when it was last asked.
    solved: f64,
    /// The grasp last looked at, and what was found.
    last: Option<(Vec<Contact>, Rotation, Result<f64, f64>)>,
}

/// Forces for each case, strictly inside every cone and below the largest normal force.
struct Held {
    forces: Box<[Forces; CASES]>,
    /// The smallest room to a cone or to the largest force, in parts of that force.
    slack: f64,
}

impl LoadCheck {
    /// For an object of this weight (N, in H); torques are taken about its centre of mass and divided by
    /// `length` (m). `None` where the load has no meaning.
    pub(crate) fn new(load: &Load, weight_H: Vec3, length: f64) -> Option<Self> {
        let Load { disturbance_force, disturbance_torque, max_normal_force } = *load;
        let sizes = [disturbance_force, disturbance_torque, max_normal_force, length];
        if !sizes.iter().all(|x| *x > 0.0 && x.is_finite()) {
            return None;
        }
        let mut disturbances = Vec::with_capacity(CASES - 1);
        for vertex in icosahedron() {
            let f = vertex * (disturbance_force / max_normal_force);
            let m = vertex * (disturbance_torque / (max_normal_force * length));
            disturbances.push(Vector6::new(f.x, f.y, f.z, 0.0, 0.0, 0.0));
            disturbances.push(Vector6::new(0.0, 0.0, 0.0, m.x, m.y, m.z));
        }
        let weight_H = weight_H / max_normal_force;
        Some(Self { disturbances, weight_H, carried: None, solved: 0.0, last: None })
    }

    /// Starts a segment: the contacts change, so no forces are carried over.
    pub(crate) fn start(&mut self) {
        self.carried = None;
    }

    /// The slack with which the contacts are proved to hold the load on the object in this orientation; `Err`
    /// gives what could not be proved.
    pub(crate) fn prove(&mut self, contacts: &[Contact], R_HO: &Rotation) -> Result<f64, f64> {
        if let Some((before, R, found)) = &self.last
            && before == contacts
            && R == R_HO
        {
            return *found;
        }
        let found = self.look(contacts, R_HO);
        self.last = Some((contacts.to_vec(), *R_HO, found));
        found
    }

    fn look(&mut self, contacts: &[Contact], R_HO: &Rotation) -> Result<f64, f64> {
        let wanted = self.wanted(R_HO);
        let correction = Correction::new(contacts).ok_or(f64::NEG_INFINITY)?;
        let before = self.carried.take();
        let carried = before.and_then(|held| check(contacts, &correction, held.forces, &wanted).ok());
        if let Some(held) = carried
            && held.slack > DWINDLED * self.solved
        {
            let slack = held.slack;
            self.carried = Some(held);
            return Ok(slack);
        }
        let held = best(contacts, &correction, &wanted)?;
        self.solved = held.slack;
        self.carried = Some(held);
        Ok(self.solved)
    }

    /// The wrenches that the contacts must give, in O about the centre of mass.
    pub(super) fn wanted(&self, R_HO: &Rotation) -> [Vector6<f64>; CASES] {
        let f = R_HO.inverse() * -self.weight_H;
        let weight = Vector6::new(f.x, f.y, f.z, 0.0, 0.0, 0.0);
        std::array::from_fn(|case| if case == 0 { weight } else { weight + self.disturbances[case - 1] })
    }
}

/// The forces brought to exactly the wanted wrenches, and checked; `Err` gives the slack that is too little.
fn check(
    contacts: &[Contact],
    correction: &Correction,
    mut forces: Box<[Forces; CASES]>,
    wanted: &[Vector6<f64>; CASES],
) -> Result<Held, f64> {
    let mut least = f64::INFINITY;
    for (forces, wanted) in forces.iter_mut().zip(wanted) {
        *forces = correction.towards(contacts, forces, wanted);
        let (mut residual, mut slack) = (-wanted, f64::INFINITY);
        for (contact, force) in contacts.iter().zip(forces.iter()) {
            residual += contact.wrench(force);
            slack = slack.min(force.slack()).min(1.0 - force.normal);
        }
        // What balances the residual exactly is smaller than residual/singular, and must not leave the cones.
        let proved = slack >= LEAST_SLACK && residual.norm() <= 0.5 * correction.singular * slack;
        if !proved {
            return Err(slack.min(0.0));
        }
        least = least.min(slack);
    }
    Ok(Held { forces, slack: least })
}

/// The solver's best forces for each case, checked.
fn best(contacts: &[Contact], correction: &Correction, wanted: &[Vector6<f64>; CASES]) -> Result<Held, f64> {
    let mut all = Box::new([[Default::default(); MAX_FINGERS]; CASES]);
    for (forces, wanted) in all.iter_mut().zip(wanted) {
        let (found, slack) = socp::best_forces_for(contacts, wanted).ok_or(f64::NEG_INFINITY)?;
        if slack < LEAST_SLACK {
            return Err(slack.min(0.0));
        }
        *forces = found;
    }
    check(contacts, correction, all, wanted)
}

/// The regular icosahedron whose faces touch the unit ball.
pub(super) fn icosahedron() -> &'static [Vec3; 12] {
    static VERTICES: std::sync::LazyLock<[Vec3; 12]> = std::sync::LazyLock::new(|| {
        let golden = 0.5 * (1.0 + 5.0_f64.sqrt());
        let size = 3.0_f64.sqrt() / (golden * golden);
        let corners = [(1.0, golden), (-1.0, golden), (1.0, -golden), (-1.0, -golden)];
        std::array::from_fn(|k| {
            let (short, long) = corners[k / 3];
            Vec3::from([[0.0, short, long], [short, long, 0.0], [long, 0.0, short]][k % 3]) * size
        })
    });
    &VERTICES
}

#[cfg(test)]
mod tests {
    use super::*;

    const LENGTH: f64 = 0.03;

    /// Contacts around the equator of a ball of 30 mm, torques about its centre.
    fn equator(count: usize, mu: f64) -> Vec<Contact> {
        let contact = |k: usize| {
            let (sin, cos) = (std::f64::consts::TAU * k as f64 / count as f64).sin_cos();
            let n = Vec3::new(cos, sin, 0.0);
            Contact { r: n, n: -n, mu, gamma: 0.0, drag: 0.0, more: None }
        };
        (0..count).map(contact).collect()
    }

    fn held(count: usize, mu: f64, mass: f64, R_HO: &Rotation) -> Result<f64, f64> {
        let load = Load { disturbance_force: 1e-3, disturbance_torque: 1e-6, max_normal_force: 10.0 };
        let weight = Vec3::new(0.0, 0.0, -9.81 * mass);
        LoadCheck::new(&load, weight, LENGTH).unwrap().prove(&equator(count, mu), R_HO)
    }

    #[test]
    fn fingers_around_a_ball_carry_what_friction_allows() {
        for (count, mu) in [(3, 0.5), (4, 0.8)] {
            let most = count as f64 * mu * 10.0 / 9.81;
            assert!(held(count, mu, 0.99 * most, &Rotation::identity()).is_ok());
            assert!(held(count, mu, 1.01 * most, &Rotation::identity()).is_err());
        }
    }

    #[test]
    fn the_weight_turns_with_the_object() {
        // Three fingers push up; one of friction 0.2 cannot pull down.
        let below = [0.0_f64, 2.1, 4.2].map(|angle| {
            let n = Vec3::new(0.6 * angle.cos(), 0.6 * angle.sin(), -0.8);
            Contact { r: n, n: -n, mu: 0.5, gamma: 0.0, drag: 0.0, more: None }
        });
        let load = Load { disturbance_force: 1e-3, disturbance_torque: 1e-6, max_normal_force: 10.0 };
        let mut check = LoadCheck::new(&load, Vec3::new(0.0, 0.0, -1.0), LENGTH).unwrap();
        let over = Rotation::from_scaled_axis(Vec3::x() * std::f64::consts::PI);
        assert!(check.prove(&below, &Rotation::identity()).is_ok());
        assert!(check.prove(&below, &over).is_err());
        // Carried forces do not hide it either.
        assert!(check.prove(&below, &Rotation::identity()).is_ok());
        let mut lost = 0;
        for k in 0..=60 {
            let R = Rotation::from_scaled_axis(Vec3::x() * (std::f64::consts::PI * f64::from(k) / 60.0));
            lost += usize::from(check.prove(&below, &R).is_err());
        }
        assert!((20..60).contains(&lost), "{lost}");
    }

    #[test]
    fn a_load_without_meaning_is_refused() {
        let good = Load { disturbance_force: 0.1, disturbance_torque: 0.001, max_normal_force: 10.0 };
        for load in [
            Load { disturbance_force: 0.0, ..good },
            Load { disturbance_torque: f64::NAN, ..good },
            Load { max_normal_force: -1.0, ..good },
        ] {
            assert!(LoadCheck::new(&load, Vec3::z(), LENGTH).is_none());
        }
        assert!(LoadCheck::new(&good, Vec3::z(), LENGTH).is_some());
    }
}
