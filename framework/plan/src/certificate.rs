//! What the verifier certifies about a plan, with the place where each figure is reached.

use regrasp_api::BodyPair;
use serde::{Deserialize, Serialize};

/// A place in a plan: what a check or a certificate speaks of. Only what applies is given.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Place {
    /// The segment, counted from 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub segment: Option<usize>,
    /// The state within the segment, counted from 0; the last one before the place where that lies between
    /// two.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub state: Option<usize>,
    /// Time from the motion's start (s).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time: Option<f64>,
    /// The finger, counted from 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub finger: Option<usize>,
    /// The finger's joint, counted from 0 at the base.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub joint: Option<usize>,
    /// The two bodies.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pair: Option<BodyPair>,
    /// The goal, counted from 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub goal: Option<usize>,
    /// What there is to say in words.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub note: Option<String>,
}

/// A figure and where the plan reaches it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Extreme {
    /// The figure, in the unit that the field's documentation gives.
    pub value: f64,
    /// Where it is reached.
    #[serde(rename = "where")]
    pub place: Place,
    /// Whether the figure bounds all times of the motion, or is the worst of the verifier's samples. Absent
    /// in files of earlier programs.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub holds_at: Option<HoldsAt>,
}

/// At which times a figure of the certificate holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum HoldsAt {
    /// A bound: at no time of the motion it is worse.
    EveryTime,
    /// A bound at each of the plan's states. Between them the verifier checks the same demand, not this
    /// figure.
    EveryState,
    /// The worst of the verifier's samples, ten to a step; in between it may be a little worse.
    Samples,
}

impl HoldsAt {
    /// What stands behind the figure in print.
    pub fn remark(self) -> &'static str {
        match self {
            Self::EveryTime => "",
            Self::EveryState => ", at the states",
            Self::Samples => ", sampled",
        }
    }
}

impl Extreme {
    /// A figure, where it is reached, and the times at which it holds.
    pub fn new(value: f64, place: Place, times: HoldsAt) -> Self {
        Self { value, place, holds_at: Some(times) }
    }
}

/// The verifier's figures on a whole plan. They speak of the facets of the object's mesh, the plan's true
/// surface.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlanCertificate {
    /// Certified lower bound of the smallest closure margin over all states: the largest ball of wrenches
    /// about the claimed centre, torques divided by the claimed length, that the contacts resist with unit
    /// total normal force (Ferrari and Canny, "Planning optimal grasps", ICRA 1992, with the sum of the
    /// normal forces bounded). Absent where stability was not checked.
    pub closure_margin: Option<Extreme>,
    /// Smallest distance of two bodies that may not touch (m). Absent where no two such bodies exist.
    pub clearance: Option<Extreme>,
    /// Largest net slip of a contact from its finger's touch-down to its lift (m), sampled at ten times the
    /// plan's resolution. Absent without transfers.
    pub slip: Option<Extreme>,
    /// Largest distance between a holding fingertip and the surface (m), sampled likewise. Absent where no
    /// finger holds.
    pub closure_residual: Option<Extreme>,
    /// What the grasps hold within the joints' efforts. Absent where the plan holds no forces.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub holds: Option<Holds>,
}

/// How far from failing the plan's grasps are, each figure with the place that decides it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Holds {
    /// The smallest coefficient of friction at which every grasp still bears what it must (no unit).
    pub friction: Extreme,
    /// The largest mass of the object at which it does (kg).
    pub mass: Extreme,
    /// The largest disturbing force at the centre of mass, in any direction, at which it does (N).
    pub disturbance: Extreme,
    /// The largest share of its limit that a joint's effort takes (no unit).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub effort: Option<Extreme>,
}
