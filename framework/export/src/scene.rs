//! A plan with everything that its exports need.

use crate::ExportError;
use crate::forces::Forces;
use crate::names::Names;
use crate::solid::{Solids, pose};
use regrasp_api::{Configuration, FingerIndex, Hand, HandDescription, ObjectModel, Pose};
use regrasp_plan::{Motion, Plan};
use regrasp_world::ChainHand;

/// A plan, its hand and its object, ready to be exported.
pub struct Scene<'a> {
    pub(crate) plan: &'a Plan,
    pub(crate) hand: ChainHand,
    pub(crate) object: ObjectModel,
    pub(crate) motion: Motion,
    pub(crate) names: Names,
    pub(crate) forces: Forces,
    pub(crate) solids: Solids,
    /// For each finger and joint the pose of the joint's frame, at position 0, in the frame of the link
    /// before (H for the first).
    pub(crate) origins: Vec<Vec<Pose>>,
}

impl<'a> Scene<'a> {
    /// Prepares a plan, which need not be valid but must fit its own hand.
    pub fn new(plan: &'a Plan) -> Result<Self, ExportError> {
        Self::with_grip(plan, None)
    }

    /// The same with at most this normal force (N, 0.01 to 1e4) at each contact; what the plan claims to hold
    /// by, or else what the joints can, where `None`.
    pub fn with_grip(plan: &'a Plan, grip: Option<f64>) -> Result<Self, ExportError> {
        let problem = &plan.scenario.problem;
        let hand = ChainHand::new(problem.hand.clone())?;
        let object = regrasp_world::load_object(&problem.object)?;
        let motion = regrasp_plan::motion(plan)?;
        if motion.segments.iter().all(|segment| segment.states.is_empty()) {
            return Err(ExportError::Empty);
        }
        let names = Names::new(&problem.hand, &problem.obstacle);
        let forces = Forces::new(plan, &motion, (&hand, &object), grip)?;
        let solids = Solids::new(problem)?;
        let origins = origins(&problem.hand)?;
        Ok(Self { plan, hand, object, motion, names, forces, solids, origins })
    }

    /// What whoever exports should know: why there are no forces, or that some are outside their cones.
    pub fn notes(&self) -> Vec<String> {
        self.forces.notes()
    }

    pub(crate) fn description(&self) -> &HandDescription {
        self.hand.description()
    }

    /// Every state of the motion, with its segment and time (s).
    pub(crate) fn states(&self) -> impl Iterator<Item = (usize, f64, &Configuration)> {
        let segments = self.motion.segments.iter().enumerate();
        segments.flat_map(|(s, segment)| {
            segment.states.iter().zip(&segment.times).map(move |(q, &time)| (s, time, q))
        })
    }

    /// The states without those that repeat the end of the segment before.
    pub(crate) fn keys(&self) -> Vec<(f64, &Configuration)> {
        let mut keys: Vec<(f64, &Configuration)> = Vec::new();
        for (_, time, q) in self.states() {
            if keys.last().is_none_or(|&(last, _)| time > last) {
                keys.push((time, q));
            }
        }
        keys
    }

    /// What drives a joint that does not move by itself.
    pub(crate) fn driver(&self, finger: usize, joint: usize) -> Option<Driver> {
        let joints = &self.description().finger[finger].joint;
        let mimic = joints[joint].mimic.as_ref()?;
        let driver = joints.iter().position(|other| other.name == mimic.joint)?;
        Some(Driver { joint: driver, multiplier: mimic.multiplier, offset: mimic.offset })
    }

    pub(crate) fn fingers(&self) -> impl Iterator<Item = FingerIndex> + use<> {
        (0..self.hand.finger_count()).map(|finger| FingerIndex(finger as u8))
    }
}

/// q = `multiplier` · q of the finger's joint number `joint` + `offset`.
pub(crate) struct Driver {
    pub joint: usize,
    pub multiplier: f64,
    pub offset: f64,
}

fn origins(hand: &HandDescription) -> Result<Vec<Vec<Pose>>, ExportError> {
    let mut all = Vec::new();
    for (f, finger) in hand.finger.iter().enumerate() {
        let mut X = pose(&finger.base, || format!("hand.finger[{f}].base"))?;
        let mut origins = Vec::new();
        for (j, joint) in finger.joint.iter().enumerate() {
            origins.push(X * pose(&joint.origin, || format!("hand.finger[{f}].joint[{j}].origin"))?);
            X = Pose::identity();
        }
        all.push(origins);
    }
    Ok(all)
}
