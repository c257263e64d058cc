//! Weights of cones' edges, within the joints' efforts, that hold the object's weight and a load at a share
//! of the friction: a proof by arithmetic, whoever found the weights.

use super::edges::Edges;
use super::load::icosahedron;
use super::socp;
use nalgebra::{Cholesky, Matrix6, Vector6};
use regrasp_api::{HoldLoad, Rotation, Vec3};

/// The least room of a proof; weights in units of the load, efforts in parts of their limits.
const LEAST_ROOM: f64 = 1e-8;
/// The part of the solver's room below which carried weights are no longer taken.
const DWINDLED: f64 = 0.4;

/// What must be held.
pub(super) struct EdgeHold {
    load: HoldLoad,
    weight_H: Vec3,
    length: f64,
    /// What forces are divided by (N).
    unit: f64,
    /// The last weights for each wrench that is wanted ...
    carried: Vec<Vec<f64>>,
    /// ... and the room that the solver found when it was last asked.
    solved: f64,
}

impl EdgeHold {
    /// For an object of this weight (N, in H); torques count over `length` (m). `None` where the claim has no
    /// meaning.
    pub(super) fn new(load: &HoldLoad, weight_H: Vec3, length: f64) -> Option<Self> {
        let HoldLoad { friction_factor, disturbance_force, disturbance_torque, .. } = *load;
        let sizes = [disturbance_force, disturbance_torque, load.max_normal_force.unwrap_or(1.0)];
        let sound = sizes.iter().all(|x| *x >= 0.0 && x.is_finite())
            && friction_factor > 0.0
            && friction_factor <= 1.0
            && length > 0.0
            && length.is_finite()
            // What drags while it spins is judged by elliptic cones alone.
            && load.drag == 0.0;
        let weight_H = if load.weight { weight_H } else { Vec3::zeros() };
        let unit = weight_H.norm().max(disturbance_force).max(disturbance_torque / length);
        (sound && unit > 0.0).then(|| Self {
            load: *load,
            weight_H,
            length,
            unit,
            carried: Vec::new(),
            solved: 0.0,
        })
    }

    /// The share of the friction that the plan relies on.
    pub(super) fn friction_factor(&self) -> f64 {
        self.load.friction_factor
    }

    /// The room with which the contacts are proved to hold the load on the object in this orientation, by
    /// the carried weights, else (or where their room has dwindled) by the solver's; `Err` gives what could
    /// not be proved.
    pub(super) fn prove(&mut self, contacts: &[Edges], R_HO: &Rotation) -> Result<f64, f64> {
        let scaled: Vec<Edges> = contacts.iter().map(|contact| contact.over(self.unit)).collect();
        let grasp = Grasp::new(&scaled, self.load.max_normal_force.map(|most| most / self.unit));
        let (grasp, wanted) = (grasp.ok_or(f64::NEG_INFINITY)?, self.wanted(R_HO));
        let carried = std::mem::take(&mut self.carried);
        if carried.len() == wanted.len()
            && let Ok((weights, room)) = grasp.check(carried, &wanted)
            && room > DWINDLED * self.solved
        {
            self.carried = weights;
            return Ok(room);
        }
        let solve = |wanted: &Vector6<f64>| socp::best_weights_within(&scaled, grasp.most, wanted);
        let solved: Option<Vec<_>> = wanted.iter().map(solve).collect();
        let (weights, room) = grasp.check(solved.ok_or(f64::NEG_INFINITY)?, &wanted)?;
        (self.carried, self.solved) = (weights, room);
        Ok(room)
    }

    /// The wrenches that the contacts must give, over the unit.
    fn wanted(&self, R_HO: &Rotation) -> Vec<Vector6<f64>> {
        let f = R_HO.inverse() * -self.weight_H / self.unit;
        let weight = Vector6::new(f.x, f.y, f.z, 0.0, 0.0, 0.0);
        let force = self.load.disturbance_force / self.unit;
        let torque = self.load.disturbance_torque / (self.unit * self.length);
        let mut wanted = vec![weight];
        if force > 0.0 || torque > 0.0 {
            for v in icosahedron() {
                wanted.push(weight + Vector6::new(v.x, v.y, v.z, 0.0, 0.0, 0.0) * force);
                wanted.push(weight + Vector6::new(0.0, 0.0, 0.0, v.x, v.y, v.z) * torque);
            }
        }
        wanted
    }
}

/// Contacts with what is worked out once for all that they must hold.
struct Grasp<'e> {
    contacts: &'e [Edges],
    most: Option<f64>,
    columns: Vec<&'e Vector6<f64>>,
    factor: Cholesky<f64, nalgebra::U6>,
    /// A lower bound of the columns' smallest singular value.
    singular: f64,
    /// How fast a sum of weights, or an effort, grows with the length of a change of the weights.
    steepest: f64,
}

impl<'e> Grasp<'e> {
    fn new(contacts: &'e [Edges], most: Option<f64>) -> Option<Self> {
        let columns: Vec<&Vector6<f64>> = contacts.iter().flat_map(|contact| &contact.columns).collect();
        let gram: Matrix6<f64> = columns.iter().map(|column| *column * column.transpose()).sum();
        let factor = Cholesky::new(gram)?;
        let singular = 1.0 / factor.inverse().norm().sqrt();
        let steepest = 1.0 + contacts.iter().map(Edges::steepest).fold(0.0, f64::max);
        Some(Self { contacts, most, columns, factor, singular, steepest })
    }

    /// Brings weights to exactly the wanted wrenches, up to rounding, by the smallest changes; they and the
    /// least room of all, `Err` where that is too little.
    fn check(&self, mut all: Vec<Vec<f64>>, wanted: &[Vector6<f64>]) -> Result<(Vec<Vec<f64>>, f64), f64> {
        let mut least = f64::INFINITY;
        for (weights, wanted) in all.iter_mut().zip(wanted) {
            if weights.len() != self.columns.len() {
                return Err(f64::NEG_INFINITY);
            }
            let residual = |weights: &[f64]| -> Vector6<f64> {
                let each = self.columns.iter().zip(weights);
                each.map(|(column, x)| *column * *x).sum::<Vector6<f64>>() - wanted
            };
            let correction = self.factor.solve(&residual(weights));
            weights.iter_mut().zip(&self.columns).for_each(|(x, column)| *x -= column.dot(&correction));
            let room = room(self.contacts, self.most, weights);
            // What balances the residual exactly is smaller than residual/singular.
            let off = residual(weights).norm() * self.steepest;
            if !(room >= LEAST_ROOM && off <= 0.5 * self.singular * room) {
                return Err(room.min(0.0));
            }
            least = least.min(room);
        }
        Ok((all, least))
    }
}

/// The least room of any weight, sum of weights and effort.
fn room(contacts: &[Edges], most: Option<f64>, weights: &[f64]) -> f64 {
    let (mut rest, mut room) = (weights, f64::INFINITY);
    for contact in contacts {
        let (own, others) = rest.split_at(contact.columns.len());
        room = own.iter().copied().fold(room, f64::min);
        if let Some(most) = most {
            room = room.min(most - own.iter().sum::<f64>());
        }
        for effort in &contact.efforts {
            let share: f64 = effort.iter().zip(own).map(|(a, x)| a * x).sum();
            room = room.min(1.0 - share.abs());
        }
        rest = others;
    }
    room
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::DVector;
    use regrasp_api::tangents;

    /// Contacts round the equator of a ball of 30 mm, at friction 0.5, with eight edges each; behind each a
    /// joint that takes the whole normal force on a lever of `lever` (m) with at most 1 N·m.
    fn contacts(lever: f64) -> Vec<Edges> {
        let contact = |k: usize| {
            let (sin, cos) = (std::f64::consts::TAU * k as f64 / 4.0).sin_cos();
            let n_O = Vec3::new(cos, sin, 0.0);
            let [t1, t2] = tangents(&-n_O);
            let edge = |j: usize| {
                let (y, x) = (std::f64::consts::FRAC_PI_4 * j as f64).sin_cos();
                -n_O + t1 * (0.5 * x) + t2 * (0.5 * y)
            };
            let forces: Vec<Vec3> = (0..8).map(edge).collect();
            let column = |f: &Vec3| {
                let m = n_O.cross(f);
                Vector6::new(f.x, f.y, f.z, m.x, m.y, m.z)
            };
            let effort = DVector::from_iterator(8, forces.iter().map(|f| lever * -n_O.dot(f)));
            Edges { columns: forces.iter().map(column).collect(), efforts: vec![effort] }
        };
        (0..4).map(contact).collect()
    }

    fn held(mass: f64, lever: f64, max_normal_force: Option<f64>) -> Result<f64, f64> {
        let load = HoldLoad {
            weight: true,
            friction_factor: 1.0,
            disturbance_force: 0.0,
            disturbance_torque: 0.0,
            drag: 0.0,
            max_normal_force,
        };
        let mut hold = EdgeHold::new(&load, Vec3::new(0.0, 0.0, -9.81 * mass), 0.03).unwrap();
        hold.prove(&contacts(lever), &Rotation::identity())
    }

    #[test]
    fn edges_carry_what_joints_and_friction_allow() {
        // Each of four contacts presses with at most 10 N, by its joint, and pushes up with half of that.
        let most = 4.0 * 0.5 * 10.0 / 9.81;
        assert!(held(0.98 * most, 0.1, None).is_ok());
        assert!(held(1.01 * most, 0.1, None).is_err());
        // The same by a bound of the normal force.
        assert!(held(0.98 * most, 1e-3, Some(10.0)).is_ok());
        assert!(held(1.01 * most, 1e-3, Some(10.0)).is_err());
    }

    #[test]
    fn carried_weights_are_checked_at_each_grasp() {
        let load = HoldLoad {
            weight: true,
            friction_factor: 1.0,
            disturbance_force: 0.5,
            disturbance_torque: 0.0,
            drag: 0.0,
            max_normal_force: None,
        };
        let mut hold = EdgeHold::new(&load, Vec3::new(0.0, 0.0, -9.81), 0.03).unwrap();
        let level = Rotation::identity();
        let first = hold.prove(&contacts(0.1), &level).unwrap();
        assert!(hold.prove(&contacts(0.1), &level).is_ok_and(|room| (room - first).abs() < 1e-6));
        // The joints of the next grasp have a lever ten times as long: what was carried is too much for them.
        assert!(hold.prove(&contacts(1.0), &level).is_err());
        assert!(hold.prove(&contacts(0.1), &level).is_ok());
    }

    #[test]
    fn a_claim_without_meaning_is_none() {
        let good = HoldLoad {
            weight: true,
            friction_factor: 0.8,
            disturbance_force: 0.1,
            disturbance_torque: 0.001,
            drag: 0.0,
            max_normal_force: Some(5.0),
        };
        let sound = |load: HoldLoad| EdgeHold::new(&load, Vec3::z(), 0.03).is_some();
        assert!(sound(good));
        assert!(!sound(HoldLoad { friction_factor: 0.0, ..good }));
        assert!(!sound(HoldLoad { friction_factor: 1.2, ..good }));
        assert!(!sound(HoldLoad { disturbance_force: f64::NAN, ..good }));
        assert!(!sound(HoldLoad { max_normal_force: Some(-1.0), ..good }));
        assert!(!sound(HoldLoad { drag: 0.5, ..good }), "edges know no drag");
    }
}
