//! Weights of cones' edges, within the joints' efforts, that hold the object's weight and a load at a share of
//! the friction: a proof by arithmetic, whoever found the weights.

use super::load::icosahedron;
use super::socp;
use nalgebra::{Cholesky, DVector, Matrix6, Vector6};
use regrasp_api::{HoldLoad, Rotation, Vec3};

/// The least room of a proof; weights in units of the load, efforts in parts of their limits.
const LEAST_ROOM: f64 = 1e-8;

/// What must be held.
pub(super) struct EdgeHold {
    load: HoldLoad,
    weight_H: Vec3,
    length: f64,
    /// What forces are divided by (N).
    unit: f64,
}

/// One contact: the wrenches of its cone's edges at unit normal force, and what each takes of each joint's
/// effort, of its limit (1/N).
pub(super) struct Edges {
    pub(super) columns: Vec<Vector6<f64>>,
    pub(super) efforts: Vec<DVector<f64>>,
}

impl EdgeHold {
    /// For an object of this weight (N, in H); torques count over `length` (m). `None` where the claim has no
    /// meaning.
    pub(super) fn new(load: &HoldLoad, weight_H: Vec3, length: f64) -> Option<Self> {
        let HoldLoad { friction_factor, disturbance_force, disturbance_torque, max_normal_force, weight } =
            *load;
        let sizes = [disturbance_force, disturbance_torque, max_normal_force.unwrap_or(1.0)];
        let sound = sizes.iter().all(|x| *x >= 0.0 && x.is_finite())
            && friction_factor > 0.0
            && friction_factor <= 1.0
            && length > 0.0
            && length.is_finite();
        let weight_H = if weight { weight_H } else { Vec3::zeros() };
        let unit = weight_H.norm().max(disturbance_force).max(disturbance_torque / length);
        (sound && unit > 0.0).then_some(Self { load: *load, weight_H, length, unit })
    }

    /// The share of the friction that the plan relies on.
    pub(super) fn friction_factor(&self) -> f64 {
        self.load.friction_factor
    }

    /// The room with which the contacts are proved to hold the load on the object in this orientation; `Err`
    /// gives what could not be proved.
    pub(super) fn prove(&self, contacts: &[Edges], R_HO: &Rotation) -> Result<f64, f64> {
        let columns: Vec<&Vector6<f64>> = contacts.iter().flat_map(|contact| &contact.columns).collect();
        let gram: Matrix6<f64> = columns.iter().map(|column| *column * column.transpose()).sum();
        let factor = Cholesky::new(gram).ok_or(f64::NEG_INFINITY)?;
        let singular = 1.0 / factor.inverse().norm().sqrt();
        let most = self.load.max_normal_force.map(|most| most / self.unit);
        let scaled: Vec<Edges> = contacts.iter().map(|contact| contact.over(self.unit)).collect();
        let steepest = 1.0 + scaled.iter().map(Edges::steepest).fold(0.0, f64::max);
        let mut least = f64::INFINITY;
        for wanted in self.wanted(R_HO) {
            let found = socp::best_weights_within(&scaled, most, &wanted);
            let mut weights = found.ok_or(f64::NEG_INFINITY)?;
            let residual = |weights: &[f64]| -> Vector6<f64> {
                columns.iter().zip(weights).map(|(column, x)| *column * *x).sum::<Vector6<f64>>() - wanted
            };
            // The closest weights that give exactly the wanted wrench, up to rounding.
            let correction = factor.solve(&residual(&weights));
            weights.iter_mut().zip(&columns).for_each(|(weight, column)| *weight -= column.dot(&correction));
            let room = room(&scaled, most, &weights);
            // What balances the residual exactly is smaller than residual/singular.
            if !(room >= LEAST_ROOM && residual(&weights).norm() * steepest <= 0.5 * singular * room) {
                return Err(room.min(0.0));
            }
            least = least.min(room);
        }
        Ok(least)
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

impl Edges {
    /// The same with weights over a unit (N).
    fn over(&self, unit: f64) -> Self {
        let efforts = self.efforts.iter().map(|effort| effort * unit).collect();
        Self { columns: self.columns.clone(), efforts }
    }

    /// How fast a sum of weights, or an effort, grows with the length of a change of the weights.
    fn steepest(&self) -> f64 {
        let sum = (self.columns.len() as f64).sqrt();
        self.efforts.iter().map(|effort| effort.norm()).fold(sum, f64::max)
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
            max_normal_force,
        };
        let hold = EdgeHold::new(&load, Vec3::new(0.0, 0.0, -9.81 * mass), 0.03).unwrap();
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
    fn a_claim_without_meaning_is_none() {
        let good = HoldLoad {
            weight: true,
            friction_factor: 0.8,
            disturbance_force: 0.1,
            disturbance_torque: 0.001,
            max_normal_force: Some(5.0),
        };
        let sound = |load: HoldLoad| EdgeHold::new(&load, Vec3::z(), 0.03).is_some();
        assert!(sound(good));
        assert!(!sound(HoldLoad { friction_factor: 0.0, ..good }));
        assert!(!sound(HoldLoad { friction_factor: 1.2, ..good }));
        assert!(!sound(HoldLoad { disturbance_force: f64::NAN, ..good }));
        assert!(!sound(HoldLoad { max_normal_force: Some(-1.0), ..good }));
    }
}
