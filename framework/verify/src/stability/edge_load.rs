//! Weights of polyhedral cones' edges that hold the object's weight and a load: a proof by arithmetic,
//! whoever found the weights.

use super::load::LoadCheck;
use super::socp;
use nalgebra::{Cholesky, Matrix6, Vector6};
use regrasp_api::Rotation;

/// The least room of a proof, in parts of the largest normal force.
const LEAST_ROOM: f64 = 1e-8;

/// The room with which the edges of each contact (`columns`, their wrenches at unit normal force) hold every
/// load of the claim on the object in this orientation: weights λ > 0 that sum to less than 1 at each
/// contact. `Err` gives what could not be proved.
pub(super) fn prove(columns: &[Vec<Vector6<f64>>], load: &LoadCheck, R_HO: &Rotation) -> Result<f64, f64> {
    let all: Vec<&Vector6<f64>> = columns.iter().flatten().collect();
    let gram: Matrix6<f64> = all.iter().map(|column| *column * column.transpose()).sum();
    let factor = Cholesky::new(gram).ok_or(f64::NEG_INFINITY)?;
    let singular = 1.0 / factor.inverse().norm().sqrt();
    let mut least = f64::INFINITY;
    for wanted in load.wanted(R_HO) {
        let mut weights = socp::best_weights(columns, &wanted).ok_or(f64::NEG_INFINITY)?;
        let residual = |weights: &[f64]| -> Vector6<f64> {
            all.iter().zip(weights).map(|(column, weight)| *column * *weight).sum::<Vector6<f64>>() - wanted
        };
        // The closest weights that give exactly the wanted wrench, up to rounding.
        let correction = factor.solve(&residual(&weights));
        weights.iter_mut().zip(&all).for_each(|(weight, column)| *weight -= column.dot(&correction));
        let room = room(columns, &weights);
        // What balances the residual exactly is smaller than residual/singular.
        if !(room >= LEAST_ROOM && residual(&weights).norm() <= 0.5 * singular * room) {
            return Err(room.min(0.0));
        }
        least = least.min(room);
    }
    Ok(least)
}

/// By how much all weights may change together and stay within their bounds.
fn room(columns: &[Vec<Vector6<f64>>], weights: &[f64]) -> f64 {
    let mut rest = weights;
    let mut room = f64::INFINITY;
    for columns in columns {
        let (own, others) = rest.split_at(columns.len());
        let left = 1.0 - own.iter().sum::<f64>();
        room = own.iter().copied().fold(room, f64::min).min(left / (own.len() as f64).sqrt());
        rest = others;
    }
    room
}

#[cfg(test)]
mod tests {
    use super::*;
    use regrasp_api::{Load, Vec3, tangents};

    /// Edges of contacts round the equator of a ball of 30 mm, at friction `mu`.
    fn columns(contacts: usize, mu: f64) -> Vec<Vec<Vector6<f64>>> {
        let contact = |k: usize| {
            let (sin, cos) = (std::f64::consts::TAU * k as f64 / contacts as f64).sin_cos();
            let n_O = Vec3::new(cos, sin, 0.0);
            let [t1, t2] = tangents(&-n_O);
            let edge = |j: usize| {
                let (y, x) = (std::f64::consts::FRAC_PI_4 * j as f64).sin_cos();
                let f = -n_O + t1 * (mu * x) + t2 * (mu * y);
                let m = n_O.cross(&f);
                Vector6::new(f.x, f.y, f.z, m.x, m.y, m.z)
            };
            (0..8).map(edge).collect()
        };
        (0..contacts).map(contact).collect()
    }

    fn held(mass: f64) -> Result<f64, f64> {
        let load = Load { disturbance_force: 1e-3, disturbance_torque: 1e-6, max_normal_force: 10.0 };
        let load = LoadCheck::new(&load, Vec3::new(0.0, 0.0, -9.81 * mass), 0.03).unwrap();
        prove(&columns(4, 0.5), &load, &Rotation::identity())
    }

    #[test]
    fn edges_carry_what_their_friction_allows() {
        // Each of four contacts pushes up with at most half of its 10 N.
        let most = 4.0 * 0.5 * 10.0 / 9.81;
        assert!(held(0.98 * most).is_ok());
        assert!(held(1.01 * most).is_err());
    }
}
