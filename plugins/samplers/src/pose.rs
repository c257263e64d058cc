//! Where a sample's pose comes from: drawn as the request wants it, and kept where the request wants it.

use regrasp_api::{Pose, PoseRequest, Random, Rotation, Task, Vec3, slerp};

/// How poses anywhere are drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PoseLaw {
    /// The fraction of poses drawn with any orientation; the others are drawn near the motion from start to
    /// goal.
    pub anywhere: f64,
    /// How far the latter may turn away from that motion (rad).
    pub spread: f64,
}

/// Draws a pose of the object as `request` wants it.
pub(crate) fn draw(task: &Task<'_>, request: PoseRequest<'_>, law: &PoseLaw, random: &mut Random) -> Pose {
    match request {
        PoseRequest::At(X_HO) => X_HO,
        PoseRequest::Near { configuration, radius, angle } => {
            let p =
                configuration.X_HO.translation.vector + random.direction() * (radius * random.unit().cbrt());
            Pose::from_parts(p.into(), turned(&configuration.X_HO.rotation, angle, random))
        }
        PoseRequest::Anywhere => anywhere(task, law, random),
    }
}

/// A position anywhere in the workspace; an orientation anywhere, or near the motion between two landmarks.
fn anywhere(task: &Task<'_>, law: &PoseLaw, random: &mut Random) -> Pose {
    let (lower, upper) = task.workspace;
    let p = Vec3::from_fn(|i, _| random.range(lower[i], upper[i]));
    let legs = task.landmarks.len().saturating_sub(1);
    let R_HO = if legs == 0 || random.unit() < law.anywhere {
        random.rotation()
    } else {
        let leg = random.index(legs);
        let (from, to) = (&task.landmarks[leg], &task.landmarks[leg + 1]);
        let between = slerp(&from.rotation, &to.rotation, random.unit());
        turned(&between, law.spread, random)
    };
    Pose::from_parts(p.into(), R_HO)
}

/// `R` turned by up to `angle` rad about a random axis, the turns spread evenly over the ball of rotation
/// vectors.
fn turned(R: &Rotation, angle: f64, random: &mut Random) -> Rotation {
    Rotation::from_scaled_axis(random.direction() * (angle * random.unit().cbrt())) * R
}

/// Where the request lets the object be: a pose that was moved is brought back into it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Region {
    /// At the pose and nowhere else.
    Point,
    /// The origin in a box (m), any orientation.
    Box(Vec3, Vec3),
    /// Within a displacement (m) and a turn (rad) of the pose.
    Ball(Pose, f64, f64),
}

impl Region {
    /// The region of a request.
    pub fn of(task: &Task<'_>, request: &PoseRequest<'_>) -> Self {
        match *request {
            PoseRequest::At(_) => Self::Point,
            PoseRequest::Anywhere => Self::Box(task.workspace.0, task.workspace.1),
            PoseRequest::Near { configuration, radius, angle } => {
                Self::Ball(configuration.X_HO, radius, angle)
            }
        }
    }

    /// The pose of the region nearest to `X_HO`: position and orientation each by the shortest way.
    pub fn clamp(&self, X_HO: &Pose) -> Pose {
        match self {
            Self::Point => *X_HO,
            Self::Box(lower, upper) => {
                let p = X_HO.translation.vector.sup(lower).inf(upper);
                Pose::from_parts(p.into(), X_HO.rotation)
            }
            Self::Ball(center, radius, angle) => {
                let moved = X_HO.translation.vector - center.translation.vector;
                let turn = (X_HO.rotation * center.rotation.inverse()).scaled_axis();
                let p = center.translation.vector + moved * shrink(moved.norm(), *radius);
                let R = Rotation::from_scaled_axis(turn * shrink(turn.norm(), *angle)) * center.rotation;
                Pose::from_parts(p.into(), R)
            }
        }
    }
}

/// What brings a length within `most`.
fn shrink(length: f64, most: f64) -> f64 {
    if length > most { most / length } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use regrasp_api::angle_between;

    #[test]
    fn clamping_keeps_what_is_inside_and_brings_the_rest_to_the_border() {
        let mut random = Random::from_key(1, 0, 0, 0);
        let center = Pose::from_parts(Vec3::new(0.01, 0.02, 0.08).into(), random.rotation());
        let region = Region::Ball(center, 0.01, 0.3);
        let mut outside = 0;
        for _ in 0..500 {
            let p = center.translation.vector + random.direction() * random.range(0.0, 0.02);
            let X_HO = Pose::from_parts(p.into(), turned(&center.rotation, 0.6, &mut random));
            let kept = region.clamp(&X_HO);
            let moved = |X: &Pose| (X.translation.vector - center.translation.vector).norm();
            let turn = |X: &Pose| angle_between(&X.rotation, &center.rotation);
            assert!((moved(&kept) - moved(&X_HO).min(0.01)).abs() < 1e-12);
            assert!((turn(&kept) - turn(&X_HO).min(0.3)).abs() < 1e-9);
            // The shortest way back lies on the straight line to the centre.
            let back = (X_HO.translation.vector - kept.translation.vector).norm();
            assert!((back - (moved(&X_HO) - 0.01).max(0.0)).abs() < 1e-12);
            outside += usize::from(moved(&X_HO) > 0.01);
        }
        assert!((100..400).contains(&outside));
        let region = Region::Box(Vec3::zeros(), Vec3::repeat(1.0));
        let p = region.clamp(&Pose::translation(-1.0, 0.5, 2.0)).translation.vector;
        assert_eq!(p, Vec3::new(0.0, 0.5, 1.0));
    }
}
