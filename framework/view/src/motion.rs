//! The motion as the page plays it: columns of numbers, one entry for each state, segment after segment.

use crate::ViewError;
use crate::hand::contact;
use crate::number::{micro, nano};
use regrasp_api::{FingerIndex, FingerJoints, Hand};
use regrasp_plan::{SegmentName, SegmentRecord, StateRecord};
use regrasp_world::ChainHand;
use serde::Serialize;

/// At how many states the page is told where the fingertips are, to hold its own kinematics against.
const CHECKED_STATES: usize = 12;

#[derive(Serialize)]
pub(crate) struct MotionData {
    segments: Vec<SegmentData>,
    states: StatesData,
    checks: Vec<TipCheck>,
}

#[derive(Serialize)]
struct SegmentData {
    kind: SegmentName,
    finger: Option<u8>,
    /// Index of its first state.
    first: usize,
    count: usize,
}

/// States in columns.
#[derive(Default, Serialize)]
pub(crate) struct StatesData {
    time: Vec<f64>,
    /// Seven numbers a state: position, quaternion w, x, y, z.
    object: Vec<f64>,
    /// As many numbers a state as the hand has joints, finger after finger.
    joints: Vec<f64>,
    /// For each state and finger: empty, or point_O, normal_O, point_F.
    contacts: Vec<Vec<Vec<f64>>>,
    /// As `joints` (rad/s; m/s); empty where a state has none.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    velocities: Vec<f64>,
}

/// Where the fingertips' centres are at a state (m, in H).
#[derive(Serialize)]
struct TipCheck {
    state: usize,
    tips: Vec<[f64; 3]>,
}

impl StatesData {
    pub(crate) fn push(&mut self, state: &StateRecord) {
        self.time.push(micro(state.time));
        self.object.extend(state.object.position.iter().chain(&state.object.orientation).map(|&x| nano(x)));
        self.joints.extend(state.joints.iter().flatten().map(|&q| nano(q)));
        self.contacts.push(state.contacts.iter().map(|c| contact(c.as_ref())).collect());
        self.velocities.extend(state.velocities.iter().flatten().flatten().map(|&v| micro(v)));
    }

    /// Forgets velocities that only some of the states have.
    fn settle(&mut self) {
        if self.velocities.len() != self.joints.len() {
            self.velocities.clear();
        }
    }
}

pub(crate) fn motion(segments: &[SegmentRecord], hand: &ChainHand) -> Result<MotionData, ViewError> {
    let (mut list, mut states) = (Vec::with_capacity(segments.len()), StatesData::default());
    for (s, segment) in segments.iter().enumerate() {
        let refuse = |state, reason| ViewError::State { segment: s, state, reason };
        check_segment(segment, hand).map_err(|reason| refuse(0, reason))?;
        let (first, count) = (states.time.len(), segment.states.len());
        list.push(SegmentData { kind: segment.kind, finger: segment.finger, first, count });
        for (k, state) in segment.states.iter().enumerate() {
            check_state(state, hand).map_err(|reason| refuse(k, reason))?;
            if states.time.last().is_some_and(|&before| before > micro(state.time)) {
                return Err(refuse(k, "it is earlier than the state before"));
            }
            states.push(state);
        }
    }
    states.settle();
    Ok(MotionData { checks: tip_checks(segments, hand), segments: list, states })
}

fn check_segment(segment: &SegmentRecord, hand: &ChainHand) -> Result<(), &'static str> {
    let fits = match (segment.kind, segment.finger) {
        (SegmentName::Transfer, None) => true,
        (SegmentName::Regrasp, Some(finger)) => usize::from(finger) < hand.finger_count(),
        _ => false,
    };
    if segment.states.is_empty() {
        Err("the segment has no states")
    } else if !fits {
        Err("a regrasp names one of the hand's fingers, a transfer names none")
    } else {
        Ok(())
    }
}

/// Whether a state can be shown: as many joints and contacts as the hand has, every number finite.
pub(crate) fn check_state(state: &StateRecord, hand: &ChainHand) -> Result<(), &'static str> {
    let count = |f: usize| hand.finger(FingerIndex(f as u8)).joints.len();
    let fingers = hand.finger_count();
    if state.joints.len() != fingers || (0..fingers).any(|f| state.joints[f].len() != count(f)) {
        return Err("not one position for each joint of the hand");
    }
    if let Some(velocities) = &state.velocities
        && !velocities.iter().map(Vec::len).eq((0..fingers).map(count))
    {
        return Err("not one velocity for each joint of the hand");
    }
    if state.contacts.len() != fingers {
        return Err("not one contact (or null) for each finger");
    }
    let contacts = state.contacts.iter().flatten().flat_map(|c| [c.point_O, c.normal_O, c.point_F]).flatten();
    let pose = state.object.position.into_iter().chain(state.object.orientation);
    let joints = state.joints.iter().chain(state.velocities.iter().flatten()).flatten().copied();
    if !contacts.chain(pose).chain(joints).chain([state.time]).all(|x| x.abs() < 1e6) {
        return Err("a number that is not finite, or far beyond any hand");
    }
    let length: f64 = state.object.orientation.iter().map(|x| x * x).sum();
    if length < 1e-12 { Err("an orientation that is zero") } else { Ok(()) }
}

fn tip_checks(segments: &[SegmentRecord], hand: &ChainHand) -> Vec<TipCheck> {
    let states: Vec<&StateRecord> = segments.iter().flat_map(|segment| &segment.states).collect();
    let step = states.len().div_ceil(CHECKED_STATES).max(1);
    let tip = |(f, joints): (usize, &Vec<f64>)| {
        hand.tip_center(FingerIndex(f as u8), &FingerJoints::from_slice(joints)).into()
    };
    let check = |state: usize| {
        let tips = states[state].joints.iter().enumerate().map(tip).collect();
        TipCheck { state, tips }
    };
    (0..states.len()).step_by(step).map(check).collect()
}
