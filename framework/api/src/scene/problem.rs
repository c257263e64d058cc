//! A planning problem as plain data: what a scenario file says, and what a plan file repeats.

use super::{
    HandDescription, HoldDescription, Limits, ObjectDescription, ObstacleDescription, PoseDescription,
};
use crate::{Body, FingerIndex, Pose, PoseError, Refusal, Refuse, Vec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// How one finger takes part in a given grasp.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FingerGrasp {
    /// Contact point on the object, in the object's frame (m), within 1 mm of the surface; absent for a free
    /// finger.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("examples" = [[0.0, 0.03, 0.0]]))]
    #[schemars(extend("x-unit" = "m"))]
    pub contact: Option<[f64; 3]>,
    /// Joint positions (rad; m where prismatic); where absent, inverse kinematics for a contact and the rest
    /// posture for a free finger.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("examples" = [[0.0, -0.9, 0.6]]))]
    #[schemars(extend("x-unit" = "rad; m where prismatic"))]
    pub joints: Option<Vec<f64>>,
}

/// Where the object starts.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StartDescription {
    /// The object's pose in the hand's frame.
    pub pose: PoseDescription,
    /// One entry for each finger; where absent, a grasp is found.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub grasp: Option<Vec<FingerGrasp>>,
}

/// Where the object goes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GoalDescription {
    /// The object's pose in the hand's frame.
    pub pose: PoseDescription,
    /// One entry for each finger; where absent, any admissible grasp will do.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub grasp: Option<Vec<FingerGrasp>>,
}

/// The positions in which the object's origin may be sampled.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Workspace {
    /// Lowest coordinates in the hand's frame (m).
    #[schemars(inner(range(min = -1e3, max = 1e3)), extend("x-unit" = "m"))]
    #[schemars(extend("examples" = [[-0.02, -0.02, 0.07]]))]
    pub lower: [f64; 3],
    /// Highest coordinates in the hand's frame (m).
    #[schemars(inner(range(min = -1e3, max = 1e3)), extend("x-unit" = "m"))]
    #[schemars(extend("examples" = [[0.02, 0.02, 0.11]]))]
    pub upper: [f64; 3],
}

/// A whole problem: hand, object, obstacles, start, goals and limits.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Problem {
    /// The hand.
    pub hand: HandDescription,
    /// The object.
    pub object: ObjectDescription,
    /// Obstacles fixed to the hand's frame.
    #[serde(default)]
    pub obstacle: Vec<ObstacleDescription>,
    /// Acceleration of gravity in the hand's frame (m/s²).
    #[serde(default = "default_gravity")]
    #[schemars(inner(range(min = -1e3, max = 1e3)), extend("x-unit" = "m/s²"))]
    pub gravity: [f64; 3],
    /// Where the object starts.
    pub start: StartDescription,
    /// The goals, visited in turn.
    pub goal: Vec<GoalDescription>,
    /// Where the object may be sampled; by default a box about start and goals, 15 mm wider on each side.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub workspace: Option<Workspace>,
    /// What grasps must hold in the world; where absent, what the stability test asks for by itself.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub hold: Option<HoldDescription>,
    /// Tolerances, resolution and budgets.
    #[serde(default)]
    pub limits: Limits,
}

fn default_gravity() -> [f64; 3] {
    [0.0, 0.0, -9.81]
}

/// How far beyond start and goals the object may be sampled where the problem gives no workspace (m).
const WORKSPACE_MARGIN: f64 = 0.015;

/// Why start and goals make no task.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum EndsError {
    /// A pose that cannot be read.
    #[error("`{key}`: {error}")]
    Pose {
        /// The path of the key, such as `goal[1].pose`.
        key: String,
        /// What is wrong with it.
        error: PoseError,
    },
    /// Two consecutive goals, or the start and the first goal, coincide.
    #[error(
        "`goal[{goal}].pose`: `goal[{goal}]` coincides with {}: there is nothing to do; a full turn is given \
            as several goals, for example four quarters",
        before(*goal)
    )]
    Coincide {
        /// The later one.
        goal: usize,
    },
}

fn before(goal: usize) -> String {
    if goal == 0 { "the start".into() } else { format!("`goal[{}]`", goal - 1) }
}

impl Refuse for EndsError {
    fn refusal(&self) -> Refusal {
        match self {
            Self::Pose { key, error } => error.refusal().told(self).below(key),
            Self::Coincide { goal } => Refusal::new("value", self).key(format!("goal[{goal}].pose")),
        }
    }
}

impl Problem {
    /// The poses of start and goals, in turn. Consecutive ones that coincide, to the tolerances of a goal,
    /// are refused where no grasp tells them apart.
    pub fn poses(&self) -> Result<Vec<Pose>, EndsError> {
        let read =
            |pose: &PoseDescription, key: String| pose.pose().map_err(|error| EndsError::Pose { key, error });
        let mut poses = vec![read(&self.start.pose, "start.pose".into())?];
        let mut held = &self.start.grasp;
        for (i, goal) in self.goal.iter().enumerate() {
            let X_HG = read(&goal.pose, format!("goal[{i}].pose"))?;
            let same_grasp = goal.grasp.is_none() || goal.grasp == *held;
            if same_grasp && self.limits.tolerances.coincide(&poses[i], &X_HG) {
                return Err(EndsError::Coincide { goal: i });
            }
            held = &goal.grasp;
            poses.push(X_HG);
        }
        Ok(poses)
    }

    /// Lowest and highest coordinates of the object's origin in H (m) for samples: the workspace, or a box
    /// about `poses`, those of start and goals.
    pub fn sampling_box(&self, poses: &[Pose]) -> (Vec3, Vec3) {
        if let Some(given) = self.workspace {
            return (given.lower.into(), given.upper.into());
        }
        let margin = Vec3::repeat(WORKSPACE_MARGIN);
        let positions = || poses.iter().map(|pose| pose.translation.vector);
        let lower = positions().reduce(|a, b| a.inf(&b)).unwrap_or_default();
        let upper = positions().reduce(|a, b| a.sup(&b)).unwrap_or_default();
        (lower - margin, upper + margin)
    }

    /// A body in words, with the name that the problem gives it; by its number, counted from 1, where it has
    /// none.
    pub fn name_of(&self, body: Body) -> String {
        let finger = |index: FingerIndex| match self.hand.finger.get(index.index()) {
            Some(finger) if !finger.name.is_empty() => format!("finger `{}`", finger.name),
            _ => format!("finger {}", index.0 + 1),
        };
        match body {
            Body::Palm => "the palm".into(),
            Body::Object => "the object".into(),
            Body::Obstacle(index) => match self.obstacle.get(usize::from(index)) {
                Some(obstacle) if !obstacle.name.is_empty() => format!("obstacle `{}`", obstacle.name),
                _ => format!("`obstacle[{index}]`"),
            },
            Body::Link(index, link) => format!("link {} of {}", link + 1, finger(index)),
            Body::Fingertip(index) => format!("the tip of {}", finger(index)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn poses_are_read_in_both_forms_and_refused_in_none() {
        let axis =
            PoseDescription { axis: Some([0.0, 0.0, 2.0]), angle_deg: Some(90.0), ..Default::default() };
        let pose = axis.pose().unwrap();
        assert!(
            (pose * nalgebra::Point3::new(1.0, 0.0, 0.0) - nalgebra::Point3::new(0.0, 1.0, 0.0)).norm()
                < 1e-12
        );
        let back = PoseDescription::from(&pose).pose().unwrap();
        assert!(crate::angle_between(&back.rotation, &pose.rotation) < 1e-12);
        let half = PoseDescription { axis: Some([0.0, 0.0, 1.0]), ..Default::default() };
        assert!(half.pose().unwrap_err().to_string().contains("angle_deg"));
        let zero = PoseDescription { orientation: Some([0.0; 4]), ..Default::default() };
        assert!(zero.pose().is_err());
        let nan = PoseDescription { position: [f64::NAN, 0.0, 0.0], ..Default::default() };
        assert!(nan.pose().is_err());
    }
}
