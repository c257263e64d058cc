//! Between the planner's motion and the file's segments.

use crate::{
    ContactRecord, Motion, Plan, PoseRecord, Segment, SegmentKind, SegmentName, SegmentRecord, StateRecord,
};
use nalgebra::{Quaternion, Translation3};
use regrasp_api::{
    Configuration, Contact, FingerDescription, FingerIndex, FingerJoints, Hand, MAX_FINGER_JOINTS,
    MAX_FINGERS, PerFinger, Pose, Rotation, Vec3,
};
use thiserror::Error;

/// The facet of contacts that come from a file: a plan does not say which plugin's coordinates it was made
/// with.
pub const UNKNOWN_FACET: u32 = u32::MAX;

/// What is wrong with one state of a file.
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
#[non_exhaustive]
pub enum StateError {
    /// It was made for another hand.
    #[error("other fingers or joints than the plan's hand has; `regrasp verify` says more")]
    OtherHand,
    /// Joints and contacts of different numbers of fingers, or of too many.
    #[error(
        "joints of {joints} fingers and contacts of {contacts}; both must be 1 to {MAX_FINGERS} and the same"
    )]
    Fingers {
        /// Of how many fingers it has joints.
        joints: usize,
        /// Of how many it has contacts.
        contacts: usize,
    },
    /// A finger with too many joints.
    #[error("a finger with {0} joints; at most {MAX_FINGER_JOINTS}")]
    Joints(usize),
}

/// Why segments and motion cannot be turned into each other.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[non_exhaustive]
pub enum ConvertError {
    /// The motion has no times yet.
    #[error("segment {} has {states} states but {times} times; assign times first", .segment + 1)]
    NotTimed {
        /// The segment.
        segment: usize,
        /// How many states it has.
        states: usize,
        /// How many times.
        times: usize,
    },
    /// A state does not have the hand's form.
    #[error("segment {}, state {}: {error}", .segment + 1, .state + 1)]
    Form {
        /// The segment.
        segment: usize,
        /// The state.
        state: usize,
        /// What is wrong.
        error: StateError,
    },
    /// A regrasp without its finger, or a transfer with one.
    #[error(
        "segment {}: a regrasp names the one of the hand's fingers that moves, a transfer names none",
        .segment + 1
    )]
    Finger {
        /// The segment.
        segment: usize,
    },
}

/// The file's segments of a timed motion.
pub fn records(motion: &Motion, hand: &dyn Hand) -> Result<Vec<SegmentRecord>, ConvertError> {
    let one = |(index, segment): (usize, &Segment)| {
        let (states, times) = (segment.states.len(), segment.times.len());
        if states != times {
            return Err(ConvertError::NotTimed { segment: index, states, times });
        }
        let (kind, finger) = match segment.kind {
            SegmentKind::Transfer => (SegmentName::Transfer, None),
            SegmentKind::Regrasp(finger) => (SegmentName::Regrasp, Some(finger.0)),
        };
        let states = segment.states.iter().zip(&segment.times).enumerate();
        let states = states.map(|(k, (q, &time))| {
            let velocities = segment.velocities.get(k).map(rows);
            let forces = segment.forces.get(k).and_then(Option::as_ref).map(force_rows);
            StateRecord { velocities, forces, ..state_record(q, time, hand) }
        });
        let states = states.collect();
        Ok(SegmentRecord { kind, finger, states })
    };
    motion.segments.iter().enumerate().map(one).collect()
}

fn rows(joints: &PerFinger<FingerJoints>) -> Vec<Vec<f64>> {
    joints.iter().map(|(_, joints)| joints.to_vec()).collect()
}

fn force_rows(forces: &PerFinger<Option<Vec3>>) -> Vec<Option<[f64; 3]>> {
    forces.iter().map(|(_, force)| force.map(Into::into)).collect()
}

/// The file's form of one configuration at a time (s), without velocities and forces.
pub fn state_record(q: &Configuration, time: f64, hand: &dyn Hand) -> StateRecord {
    let orientation = q.X_HO.rotation.quaternion();
    let contact = |(finger, contact): (FingerIndex, &Option<Contact>)| {
        contact.map(|contact| {
            let R_HF = hand.tip_kinematics(finger, &q.joints[finger]).R_HF;
            let inward_F = R_HF.inverse() * (q.X_HO.rotation * -contact.n_O);
            ContactRecord {
                point_O: contact.p_OC.into(),
                normal_O: contact.n_O.into(),
                point_F: (inward_F * hand.fingertip_radius()).into(),
            }
        })
    };
    StateRecord {
        time,
        object: PoseRecord {
            position: q.X_HO.translation.vector.into(),
            orientation: [orientation.w, orientation.i, orientation.j, orientation.k],
        },
        joints: rows(&q.joints),
        velocities: None,
        contacts: q.contacts.iter().map(contact).collect(),
        cones: None,
        forces: None,
    }
}

/// The motion that a plan describes, with its times. Contacts come back with [`UNKNOWN_FACET`].
///
/// Every state has as many fingers and joints as the plan's hand; nothing else is judged here.
pub fn motion(plan: &Plan) -> Result<Motion, ConvertError> {
    let fingers = &plan.scenario.problem.hand.finger;
    let one = |(index, record): (usize, &SegmentRecord)| {
        let kind = match (record.kind, record.finger) {
            (SegmentName::Transfer, None) => SegmentKind::Transfer,
            (SegmentName::Regrasp, Some(finger)) if usize::from(finger) < fingers.len() => {
                SegmentKind::Regrasp(FingerIndex(finger))
            }
            _ => return Err(ConvertError::Finger { segment: index }),
        };
        let state =
            |(state, record): (usize, &StateRecord)| {
                fits(record, fingers)
                    .and_then(|()| configuration(record))
                    .map_err(|error| ConvertError::Form { segment: index, state, error })
            };
        Ok(Segment {
            kind,
            states: record.states.iter().enumerate().map(state).collect::<Result<_, _>>()?,
            times: record.states.iter().map(|state| state.time).collect(),
            velocities: record.states.iter().map_while(velocities).collect(),
            forces: forces(&record.states),
        })
    };
    Ok(Motion { segments: plan.segments.iter().enumerate().map(one).collect::<Result<_, _>>()? })
}

/// Whether a state has the hand's fingers and joints.
fn fits(state: &StateRecord, fingers: &[FingerDescription]) -> Result<(), StateError> {
    let wanted = || fingers.iter().map(|finger| finger.joint.len());
    let fits = |rows: &Vec<Vec<f64>>| rows.iter().map(Vec::len).eq(wanted());
    let forces = state.forces.as_ref().is_none_or(|forces| forces.len() == fingers.len());
    if fits(&state.joints) && state.velocities.as_ref().is_none_or(fits) && forces {
        return Ok(());
    }
    Err(StateError::OtherHand)
}

/// The configuration that a file's state describes; `Err` says what does not fit.
pub fn configuration(state: &StateRecord) -> Result<Configuration, StateError> {
    let count = state.joints.len();
    if count == 0 || count > MAX_FINGERS || state.contacts.len() != count {
        return Err(StateError::Fingers { joints: count, contacts: state.contacts.len() });
    }
    if let Some(joints) = state.joints.iter().find(|joints| joints.len() > MAX_FINGER_JOINTS) {
        return Err(StateError::Joints(joints.len()));
    }
    let joints = |finger: FingerIndex| row(&state.joints[finger.index()]);
    let contact = |finger: FingerIndex| {
        state.contacts[finger.index()].map(|contact| Contact {
            facet: UNKNOWN_FACET,
            p_OC: Vec3::from(contact.point_O),
            n_O: Vec3::from(contact.normal_O),
        })
    };
    Ok(Configuration {
        X_HO: pose(&state.object),
        joints: PerFinger::from_fn(count, joints),
        contacts: PerFinger::from_fn(count, contact),
    })
}

/// The joint velocities of a state that fits its hand, where it has any.
fn velocities(state: &StateRecord) -> Option<PerFinger<FingerJoints>> {
    let rows = state.velocities.as_ref()?;
    Some(PerFinger::from_fn(rows.len(), |finger: FingerIndex| row(&rows[finger.index()])))
}

/// The forces of the states, where any of them has some.
fn forces(states: &[StateRecord]) -> Vec<Option<PerFinger<Option<Vec3>>>> {
    if states.iter().all(|state| state.forces.is_none()) {
        return Vec::new();
    }
    let of_fingers = |rows: &Vec<Option<[f64; 3]>>| {
        PerFinger::from_fn(rows.len(), |finger: FingerIndex| rows[finger.index()].map(Vec3::from))
    };
    states.iter().map(|state| state.forces.as_ref().map(of_fingers)).collect()
}

fn row(values: &[f64]) -> FingerJoints {
    let mut joints = FingerJoints::zeros(values.len());
    joints.copy_from_slice(values);
    joints
}

/// The pose with exactly the file's numbers: the quaternion is not normalised again.
pub fn pose(record: &PoseRecord) -> Pose {
    let [w, x, y, z] = record.orientation;
    let rotation = Rotation::new_unchecked(Quaternion::new(w, x, y, z));
    Pose::from_parts(Translation3::from(Vec3::from(record.position)), rotation)
}
