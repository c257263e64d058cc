//! The active part's first element: the object's pose.

use super::RlgSettings;
use regrasp_api::{Pose, PoseRequest, Random, Rotation, Task, Vec3, slerp};

/// Draws a pose of the object as `request` wants it.
pub(super) fn draw(
    task: &Task<'_>,
    request: PoseRequest<'_>,
    settings: &RlgSettings,
    random: &mut Random,
) -> Pose {
    match request {
        PoseRequest::At(X_HO) => X_HO,
        PoseRequest::Near { configuration, radius, angle } => {
            let p =
                configuration.X_HO.translation.vector + random.direction() * (radius * random.unit().cbrt());
            Pose::from_parts(p.into(), turned(&configuration.X_HO.rotation, angle, random))
        }
        PoseRequest::Anywhere => anywhere(task, settings, random),
    }
}

/// A position anywhere in the workspace; an orientation anywhere, or near the motion between two landmarks.
fn anywhere(task: &Task<'_>, settings: &RlgSettings, random: &mut Random) -> Pose {
    let (lower, upper) = task.workspace;
    let p = Vec3::from_fn(|i, _| random.range(lower[i], upper[i]));
    let legs = task.landmarks.len().saturating_sub(1);
    let R_HO = if legs == 0 || random.unit() < settings.anywhere {
        random.rotation()
    } else {
        let leg = random.index(legs);
        let (from, to) = (&task.landmarks[leg], &task.landmarks[leg + 1]);
        let between = slerp(&from.rotation, &to.rotation, random.unit());
        turned(&between, settings.spread_deg.to_radians(), random)
    };
    Pose::from_parts(p.into(), R_HO)
}

/// `R` turned by up to `angle` rad about a random axis, the turns spread evenly over the ball of rotation vectors.
fn turned(R: &Rotation, angle: f64, random: &mut Random) -> Rotation {
    Rotation::from_scaled_axis(random.direction() * (angle * random.unit().cbrt())) * R
}
