//! Which three joints of a finger inverse kinematics solves for; the others are spare.

use super::{JointRange, Method, Triple, method};
use crate::hand::chain::FingerChain;
use nalgebra::{Matrix3, SMatrix};
use regrasp_api::{FingerJoints, MAX_FINGER_JOINTS, Random};

/// Postures at which a finger is judged.
const POSTURES: u64 = 64;
/// Singular values below this share of the largest count as zero.
const RANK: f64 = 1e-6;
/// A closed form is preferred over joints that are at most this many times better conditioned.
const PREFERENCE: f64 = 10.0;

/// Why no three joints were found: in how many directions the joints can move the tip.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::hand) struct Conditioning {
    pub independent: usize,
}

/// Chooses the joints to solve for.
///
/// The conditioning of three joints is the mean, over 64 fixed random postures, of the smallest singular
/// value of their columns of the tip's Jacobian, each scaled by half its joint's range (so: how far, in
/// metres, the joints can move the tip in its worst direction). Of the triples whose conditioning is at least
/// a tenth of the best one's, those with a closed form come first, then the best conditioned, then the first
/// in the order of the joints.
pub(super) fn choose(
    chain: &FingerChain,
    ranges: &[JointRange],
) -> Result<([usize; 3], Method), Conditioning> {
    let count = ranges.len();
    let postures = postures(ranges);
    let jacobians: Vec<_> = postures.iter().map(|q| scaled_jacobian(chain, ranges, q)).collect();
    let independent = jacobians.iter().map(rank).max().unwrap_or(0);
    if independent < 3 {
        return Err(Conditioning { independent });
    }
    let triples: Vec<_> = (0..count)
        .flat_map(|i| (i + 1..count).flat_map(move |j| (j + 1..count).map(move |k| [i, j, k])))
        .map(|triple| (triple, conditioning(&jacobians, &triple)))
        .collect();
    let best = triples.iter().map(|(_, value)| *value).fold(0.0, f64::max);
    let mut chosen = (triples[0].0, Method::Numeric, (false, -1.0));
    for (solved, value) in triples.into_iter().filter(|(_, value)| *value * PREFERENCE >= best) {
        let method = common_method(chain, &solved, &postures);
        let merit = (method != Method::Numeric, value);
        if merit > chosen.2 {
            chosen = (solved, method, merit);
        }
    }
    Ok((chosen.0, chosen.1))
}

/// Fixed random postures within the limits.
fn postures(ranges: &[JointRange]) -> Vec<FingerJoints> {
    let mut random = Random::from_key(0, 0, 0, 0);
    let mut posture = || {
        let mut joints = FingerJoints::zeros(ranges.len());
        joints.iter_mut().zip(ranges).for_each(|(q, range)| *q = range.at(random.unit()));
        joints
    };
    (0..POSTURES).map(|_| posture()).collect()
}

type ScaledJacobian = SMatrix<f64, 3, MAX_FINGER_JOINTS>;

/// The tip's Jacobian with each column scaled by half the joint's range.
fn scaled_jacobian(chain: &FingerChain, ranges: &[JointRange], joints: &FingerJoints) -> ScaledJacobian {
    let mut J = chain.tip_kinematics(joints).J_v;
    for (mut column, range) in J.column_iter_mut().zip(ranges) {
        column *= 0.5 * (range.upper - range.lower);
    }
    J
}

fn rank(J: &ScaledJacobian) -> usize {
    let values = J.transpose().singular_values();
    values.iter().filter(|&&value| value > RANK * values.max()).count()
}

fn conditioning(jacobians: &[ScaledJacobian], triple: &[usize; 3]) -> f64 {
    let smallest = |J: &ScaledJacobian| {
        Matrix3::from_columns(&triple.map(|joint| J.column(joint).into_owned())).singular_values().min()
    };
    jacobians.iter().map(smallest).sum::<f64>() / jacobians.len() as f64
}

/// The method that works wherever the spare joints stand.
fn common_method(chain: &FingerChain, solved: &[usize; 3], postures: &[FingerJoints]) -> Method {
    if !chain.couplings.is_empty() {
        return Method::Numeric;
    }
    let mut methods = postures.iter().map(|joints| method(&Triple::new(chain, solved, joints)));
    let first = methods.next().unwrap_or(Method::Numeric);
    if methods.all(|other| other == first) { first } else { Method::Numeric }
}
