//! Why a problem cannot be planned at all; "no plan found" is not among these but an outcome.

use regrasp_api::{BodyPair, CallError, EndsError, FingerIndex, Reason, Refusal, Refuse};
use std::fmt;
use thiserror::Error;

/// Which end of the problem: the start or the goal with this index, counted from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// The start.
    Start,
    /// A goal.
    Goal(usize),
}

impl fmt::Display for End {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Start => write!(f, "start"),
            Self::Goal(index) => write!(f, "goal[{index}]"),
        }
    }
}

/// What is wrong with a problem.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum PlanError {
    /// A pose that cannot be read, or two in turn that coincide.
    #[error(transparent)]
    Ends(#[from] EndsError),
    /// A given grasp that cannot be read: wrong number of fingers or joints, a contact away from the surface.
    #[error("`{end}.grasp`: {reason}")]
    Grasp {
        /// Which end.
        end: End,
        /// What is wrong with it.
        reason: String,
    },
    /// A finger of a given grasp cannot be where it should.
    #[error("`{end}.grasp[{}]`: finger `{name}` {reason}", finger.0)]
    Finger {
        /// Which end.
        end: End,
        /// Which finger.
        finger: FingerIndex,
        /// The finger's name.
        name: String,
        /// What is wrong with it.
        reason: String,
    },
    /// Two bodies are in collision at a given configuration.
    #[error("`{end}`: {} and {} are closer than the clearance; move the object or choose another \
        grasp", body(&pair.0), body(&pair.1))]
    Collision {
        /// Which end.
        end: End,
        /// The bodies.
        pair: BodyPair,
    },
    /// The given grasp is not stable.
    #[error(
        "`{end}.grasp`: the grasp is not stable under contact model and friction {friction}; spread the \
            contacts round the object or raise the friction"
    )]
    Unstable {
        /// Which end.
        end: End,
        /// The friction coefficient that was used.
        friction: f64,
    },
    /// The hand has too few fingers.
    #[error("the hand has {fingers} fingers, but under this contact model {fewest} contacts are the fewest \
        that can be stable, and regrasping needs one more: {}", fewest + 1)]
    TooFewFingers {
        /// How many fingers the hand has.
        fingers: usize,
        /// The fewest contacts that can be stable.
        fewest: usize,
    },
    /// The motion cannot be timed.
    #[error(transparent)]
    Timing(#[from] regrasp_plan::TimingError),
    /// A plugin failed.
    #[error(transparent)]
    Call(#[from] CallError),
}

impl Refuse for PlanError {
    fn refusal(&self) -> Refusal {
        let problem = |key: String| Refusal::new("problem", self).key(key);
        match self {
            Self::Ends(error) => error.refusal(),
            Self::Grasp { end, .. } | Self::Unstable { end, .. } => problem(format!("{end}.grasp")),
            Self::Finger { end, finger, .. } => problem(format!("{end}.grasp[{}]", finger.0)),
            Self::Collision { end, .. } => problem(end.to_string()),
            Self::TooFewFingers { .. } => problem("hand".into()),
            Self::Timing(_) => Refusal::new("timing", self),
            Self::Call(error) => error.refusal(),
        }
    }
}

/// A body in words.
pub(crate) fn body(body: &regrasp_api::Body) -> String {
    use regrasp_api::Body;
    match body {
        Body::Palm => "the palm".into(),
        Body::Object => "the object".into(),
        Body::Obstacle(index) => format!("`obstacle[{index}]`"),
        Body::Link(finger, link) => format!("link {} of finger {}", link + 1, finger.0 + 1),
        Body::Fingertip(finger) => format!("the tip of finger {}", finger.0 + 1),
    }
}

/// A reason in words, for warnings about a start or goal that is hard to leave.
pub(crate) fn explain(reason: Reason) -> &'static str {
    match reason {
        Reason::Liftable => "too few of its fingers can be lifted with the rest stable",
        Reason::Retreat => "a finger cannot retreat from the object (reach or collision)",
        Reason::Edge => "a contact lies close to a sharp edge",
        Reason::Stability => "the grasp is stable only without the planner's friction margin",
        Reason::Collision => "bodies are closer than the planner's clearance",
        Reason::Reach | Reason::Limits => "a finger is at the end of its reach",
        _ => "it is hard to leave",
    }
}
