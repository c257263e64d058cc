//! A motion in memory: segments of configurations, what the planner makes and the plan file holds.

use regrasp_api::{Configuration, FingerIndex, FingerJoints, PerFinger, Vec3};

/// What happens in a segment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SegmentKind {
    /// The object moves, every holding fingertip rolls without slip.
    Transfer,
    /// The object rests, this finger moves.
    Regrasp(FingerIndex),
}

/// One segment. Consecutive segments share their end states exactly.
#[derive(Clone, Debug, PartialEq)]
pub struct Segment {
    /// What happens.
    pub kind: SegmentKind,
    /// The states; between two of them joints and position move linearly, orientation by slerp.
    pub states: Vec<Configuration>,
    /// Time of each state from the motion's start (s); empty until the motion is timed.
    pub times: Vec<f64>,
    /// Joint velocities at each state (rad/s; m/s where prismatic); empty until the motion is timed, and in
    /// motions of plans of version 1.
    pub velocities: Vec<PerFinger<FingerJoints>>,
    /// For each state the force of each finger that holds on the object, in O (N); `None` where nothing says
    /// what holds it there. Empty until forces are chosen.
    pub forces: Vec<Option<PerFinger<Option<Vec3>>>>,
}

impl Segment {
    /// A segment without times.
    pub fn new(kind: SegmentKind, states: Vec<Configuration>) -> Self {
        Self { kind, states, times: Vec::new(), velocities: Vec::new(), forces: Vec::new() }
    }
}

/// A motion from the start through all goals.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Motion {
    /// The segments in turn.
    pub segments: Vec<Segment>,
}
