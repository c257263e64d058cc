//! What soft fingers do while they spin: they drag the object along, and they creep.
//!
//! A contact whose friction and torsion share an ellipsoid slides and spins in the direction in which that
//! dissipates most (S. Goyal, A. Ruina, J. Papadopoulos, "Planar sliding with dry friction", Wear 1991; R.
//! Howe, M. Cutkosky, "Practical force-motion models for sliding manipulation", IJRR 1996). So one that spins
//! drags with nearly all of its torsional friction, and each tangential force makes it slide.

use crate::force::Friction;
use crate::hold::Held;
use crate::stage::Stage;
use regrasp_api::{
    Configuration, EffortBounds, FingerIndex, FingerJoints, Hand, Mat3, PerFinger, Pose, Rotation, Vec3,
};

/// The spin (rad) over which a contact's drag builds up: forces must be continuous. Our choice.
const BUILD_UP: f64 = 0.02;
/// The largest share of the friction with which creep is reckoned: at all of it there is no bound.
const MOST: f64 = 0.95;

/// For each state of a stage, what part of its torsional friction each contact drags with on the way to the
/// next one, and how far it spins there (rad), both about the outward normal.
pub(crate) fn spins(hand: &dyn Hand, stage: &Stage<'_>) -> Vec<PerFinger<(f64, f64)>> {
    let count = stage.states.first().map_or(0, |q| q.joints.len());
    let mut all = vec![PerFinger::filled(count, (0.0, 0.0)); stage.states.len()];
    for finger in (0..count as u8).map(FingerIndex) {
        let mut part = 0.0_f64;
        for (k, pair) in stage.states.windows(2).enumerate() {
            let spin = spin(hand, finger, [&pair[0], &pair[1]]);
            all[k][finger] = (part, spin);
            part = (part + spin / BUILD_UP).clamp(-1.0, 1.0);
        }
        if let Some(last) = all.last_mut() {
            last[finger] = (part, 0.0);
        }
    }
    all
}

/// How far (rad) a fingertip spins on the object between two states; 0 where it does not touch.
fn spin(hand: &dyn Hand, finger: FingerIndex, ends: [&Configuration; 2]) -> f64 {
    let [Some(a), Some(b)] = ends.map(|q| q.contacts[finger]) else { return 0.0 };
    let R_OF = |q: &Configuration| -> Rotation {
        q.X_HO.rotation.inverse() * hand.tip_kinematics(finger, &q.joints[finger]).R_HF
    };
    let turn_O = (R_OF(ends[1]) * R_OF(ends[0]).inverse()).scaled_axis();
    turn_O.dot(&(a.n_O + b.n_O).normalize())
}

/// For each state of a motion, how far each finger's joints must be from the plan's so that the object stays
/// on its way although the contacts creep.
///
/// A contact that bears the share u of its friction slides by γ/μ · u/√(1 - u²) a radian of spin, against the
/// force that the object has from it: about 5 mm · u for the soft fingers of the built-in scenarios, whatever
/// the forces. The fingertip goes on before by as much. A finger that is regrasped is set down where the plan
/// has it. First order: the contacts' frames are the plan's.
pub fn creep(
    hand: &dyn Hand,
    friction: Friction,
    stages: &[Stage<'_>],
    held: &[Vec<Option<Held>>],
) -> Vec<Vec<PerFinger<FingerJoints>>> {
    let mut ahead: Option<PerFinger<FingerJoints>> = None;
    let mut all = Vec::with_capacity(stages.len());
    for (stage, held) in stages.iter().zip(held) {
        let Some(first) = stage.states.first() else {
            all.push(Vec::new());
            continue;
        };
        let still = || PerFinger::from_fn(first.joints.len(), |f| FingerJoints::zeros(first.joints[f].len()));
        let from = ahead.unwrap_or_else(still);
        let of_stage = match stage.moving {
            Some(finger) => set_down(&from, finger, stage.states.len()),
            None => crept(hand, friction, stage, held, from),
        };
        ahead = of_stage.last().copied();
        all.push(of_stage);
    }
    all
}

/// The moving finger of a regrasp goes back to the plan's way while it is up.
fn set_down(
    from: &PerFinger<FingerJoints>,
    finger: FingerIndex,
    states: usize,
) -> Vec<PerFinger<FingerJoints>> {
    let way = |k: usize| {
        let left = (1.0 - 2.0 * k as f64 / (states.max(2) - 1) as f64).max(0.0);
        let mut there = *from;
        there[finger].iter_mut().for_each(|joint| *joint *= left);
        there
    };
    (0..states).map(way).collect()
}

fn crept(
    hand: &dyn Hand,
    friction: Friction,
    stage: &Stage<'_>,
    held: &[Option<Held>],
    mut ahead: PerFinger<FingerJoints>,
) -> Vec<PerFinger<FingerJoints>> {
    let mut all = Vec::with_capacity(stage.states.len());
    for ((q, spins), held) in stage.states.iter().zip(spins(hand, stage)).zip(held) {
        all.push(ahead);
        let Some(held) = held else { continue };
        for (finger, exerted) in held.forces.iter() {
            let (Some(exerted), Some(contact)) = (exerted, q.contacts[finger]) else { continue };
            let force_O = q.X_HO.rotation.inverse() * exerted.force;
            let slid_O = slide(friction, &contact.n_O, &force_O) * spins[finger].1.abs();
            let step = joints_for(hand, finger, (&q.joints[finger], &q.X_HO), &contact.n_O, &slid_O);
            ahead[finger].iter_mut().zip(step.iter()).for_each(|(joint, step)| *joint += step);
        }
    }
    all
}

/// How far (m, in O) a fingertip slides on the object in a radian of spin, exerting this force on it.
fn slide(friction: Friction, n_O: &Vec3, force_O: &Vec3) -> Vec3 {
    let share = friction.share(n_O, force_O).min(MOST);
    let tangential = force_O - n_O * n_O.dot(force_O);
    let rate = friction.lever() * share / (1.0 - share * share).sqrt();
    tangential.try_normalize(1e-12).map_or(Vec3::zeros(), |along| along * rate)
}

/// The smallest change of a finger's joints that moves its material point at the contact by `moved_O`; none
/// at a singularity.
fn joints_for(
    hand: &dyn Hand,
    finger: FingerIndex,
    (joints, X_HO): (&FingerJoints, &Pose),
    n_O: &Vec3,
    moved_O: &Vec3,
) -> FingerJoints {
    let bounds = EffortBounds::at(hand, finger, joints, X_HO, n_O);
    let columns = || bounds.joints().iter().map(|joint| joint.column_O);
    let gram: Mat3 = columns().map(|column| column * column.transpose()).sum();
    let mut change = FingerJoints::zeros(joints.len());
    if let Some(inverse) = gram.try_inverse() {
        let weights = inverse * moved_O;
        change.iter_mut().zip(columns()).for_each(|(change, column)| *change = column.dot(&weights));
    }
    change
}
