//! Numeric inverse kinematics for chains without a closed form.

use super::{Choice, JointRange};
use nalgebra::{Matrix3, Vector3};
use regrasp_api::Vec3;

/// Largest distance of an accepted solution from the wished position (m).
const ACCEPTED: f64 = 1e-10;
/// Distance (m) at which a solution is not improved any more.
const PERFECT: f64 = 1e-14;
/// Most steps from one start.
const STEPS: usize = 60;
/// Fractions of the joints' ranges at which the search starts anew: the first points of Halton's sequence,
/// after the middle.
const STARTS: [[f64; 3]; 9] = [
    [0.5, 0.5, 0.5],
    [0.25, 2.0 / 3.0, 0.4],
    [0.75, 1.0 / 9.0, 0.6],
    [0.125, 4.0 / 9.0, 0.8],
    [0.625, 7.0 / 9.0, 0.04],
    [0.375, 2.0 / 9.0, 0.24],
    [0.875, 5.0 / 9.0, 0.44],
    [0.0625, 8.0 / 9.0, 0.64],
    [0.5625, 1.0 / 27.0, 0.84],
];

/// Joint positions within the limits that put the fingertip at `p` (m), or `None`.
///
/// The solution that continues from `near` if there is one, otherwise the closest to `near` of those that the
/// other starts (`rest`, the middle of the ranges, eight spread points) lead to. A solution may be missed,
/// never invented.
///
/// `tip_jacobian` gives the tip's place (m) and its velocity per speed of each of the three joints.
pub(super) fn solve(
    tip_jacobian: &impl Fn(&[f64; 3]) -> (Vec3, Matrix3<f64>),
    p: &Vec3,
    ranges: &[JointRange; 3],
    near: &[f64; 3],
    rest: &[f64; 3],
) -> Option<[f64; 3]> {
    if let Some(q) = descend(tip_jacobian, p, ranges, near) {
        return Some(q);
    }
    let mut best = Choice::new(near);
    let spread = STARTS.iter().map(|s| std::array::from_fn(|joint| ranges[joint].at(s[joint])));
    for start in std::iter::once(*rest).chain(spread) {
        if let Some(q) = descend(tip_jacobian, p, ranges, &start) {
            best.offer(q);
        }
    }
    best.taken()
}

/// Levenberg-Marquardt steps from `start`, projected onto the limits (Levenberg 1944; Marquardt, J. SIAM
/// 1963).
///
/// A joint at a limit that the gradient pushes outward takes no part in the step. Converges quadratically to
/// a regular solution, as Newton's method does, since the damping vanishes.
fn descend(
    tip_jacobian: &impl Fn(&[f64; 3]) -> (Vec3, Matrix3<f64>),
    p: &Vec3,
    ranges: &[JointRange; 3],
    start: &[f64; 3],
) -> Option<[f64; 3]> {
    let mut q: [f64; 3] = std::array::from_fn(|joint| ranges[joint].clamp(start[joint]));
    let (tip, mut J) = tip_jacobian(&q);
    let mut residual = p - tip;
    let mut error = residual.norm();
    let (mut damping, mut lame) = (1e-3, 0);
    for _ in 0..STEPS {
        if error <= PERFECT || lame > 3 || damping > 1e8 {
            break;
        }
        let Some(step) = damped_step(&J, &residual, damping, &q, ranges) else { break };
        let trial: [f64; 3] = std::array::from_fn(|joint| ranges[joint].clamp(q[joint] + step[joint]));
        let (tip, J_trial) = tip_jacobian(&trial);
        let residual_trial = p - tip;
        let error_trial = residual_trial.norm();
        if error_trial < error {
            // Little progress a few times in a row: a local minimum, or rounding.
            lame = if error_trial > 0.99 * error { lame + 1 } else { 0 };
            (q, J, residual, error) = (trial, J_trial, residual_trial, error_trial);
            damping *= 0.03;
        } else if error <= ACCEPTED {
            break;
        } else {
            damping = (damping * 10.0).max(1e-6);
        }
    }
    (error <= ACCEPTED).then_some(q)
}

/// The damped step of the joints that are not held by a limit; `None` if all are held.
fn damped_step(
    J: &Matrix3<f64>,
    residual: &Vec3,
    damping: f64,
    q: &[f64; 3],
    ranges: &[JointRange; 3],
) -> Option<Vector3<f64>> {
    let mut gradient = J.tr_mul(residual);
    let mut H = J.tr_mul(J);
    let mut held = 0;
    for joint in 0..3 {
        let outward = (q[joint] <= ranges[joint].lower && gradient[joint] <= 0.0)
            || (q[joint] >= ranges[joint].upper && gradient[joint] >= 0.0);
        if outward {
            held += 1;
            H.fill_row(joint, 0.0);
            H.fill_column(joint, 0.0);
            H[(joint, joint)] = 1.0;
            gradient[joint] = 0.0;
        } else {
            H[(joint, joint)] *= 1.0 + damping;
            H[(joint, joint)] += 1e-18;
        }
    }
    if held == 3 {
        return None;
    }
    H.cholesky().map(|factor| factor.solve(&gradient))
}
