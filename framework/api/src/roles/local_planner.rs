//! Role 5: connecting two configurations inside one kind of subspace.

use crate::{
    CallError, Configuration, Contact, Context, FingerIndex, FingerJoints, Path, Pose, Reason, Resolution,
    Task, angle_between,
};

/// Where a local planner is to go.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Target<'a> {
    /// Slot `local-planner.grasp`: to this configuration with the same fingers holding; contacts slide.
    Grasp(&'a Configuration),
    /// Slot `local-planner.transfer`: the object to this pose, every holding fingertip rolling without slip.
    Transfer(&'a Pose),
    /// Slot `local-planner.regrasp`: one finger moves, everything else rests.
    Regrasp {
        /// The finger that moves.
        finger: FingerIndex,
        /// Its contact at the end, `None` if it ends free.
        contact: Option<&'a Contact>,
        /// Its joint positions at the end; they bring the fingertip to `contact`.
        joints: &'a FingerJoints,
    },
}

impl Target<'_> {
    /// The share of the object's way from `from` that is made at a state of a transfer, in [0, 1]: what a
    /// planner that wraps another gives as [`Reached::fraction`] where it cuts its path at that state.
    ///
    /// Of shift and turn that one counts which takes more steps. `None` in the other slots, where planners
    /// are all or nothing.
    pub fn fraction_at(
        &self,
        resolution: &Resolution,
        from: &Configuration,
        state: &Configuration,
    ) -> Option<f64> {
        let Self::Transfer(X_HO) = self else { return None };
        let shift = |X: &Pose| (X.translation.vector - from.X_HO.translation.vector).norm();
        let turn = |X: &Pose| angle_between(&from.X_HO.rotation, &X.rotation);
        let (shifts, turns) = (shift(X_HO), turn(X_HO));
        let (made, whole) = match shifts / resolution.transfer_step >= turns / resolution.transfer_turn {
            true => (shift(&state.X_HO), shifts),
            false => (turn(&state.X_HO), turns),
        };
        Some(if whole > 0.0 { (made / whole).min(1.0) } else { 1.0 })
    }
}

/// How far a local planner came.
#[derive(Clone, Debug, PartialEq)]
pub struct Reached {
    /// The last valid configuration: for a transfer with its drifted contacts.
    pub end: Configuration,
    /// The fraction of the motion made, in [0, 1]; 1 exactly when the target was reached, 0 exactly where no
    /// way was made. Of a transfer it is the share of the object's way.
    pub fraction: f64,
    /// Why it stopped short; `None` exactly when `fraction` is 1.
    pub stop: Option<Reason>,
}

impl Reached {
    /// Whether the target was reached.
    pub fn is_complete(&self) -> bool {
        self.stop.is_none()
    }
}

/// Connects a configuration with a target inside one kind of subspace: GS_n, transfer, or regrasp.
///
/// Every state it stores is valid, and so is the motion between consecutive states, to half of the task's
/// tolerances (but for the contacts of a grasp planner, which slide: its path is an aim that nobody executes,
/// closes at its states, and in between to five tolerances, so that no joint jumps to another branch); the
/// first stored state equals `from`, the last equals the returned end. A refusal is counted in the context
/// with its reason by the local planner itself. Grasp and regrasp planners are all or nothing where it suits
/// them: then `end` is `from` and `fraction` 0.
///
/// In a regrasp the moving fingertip touches at the ends alone: from its contact it rises, and never falls by
/// more than a micrometre, until it is as high as the lowest of [`crate::Resolution::lift`] and
/// [`crate::Resolution::retreat`]; that high it must come between two contacts; and while it touches it does
/// not slide by more than the tolerance for slip. The same holds backwards in time from the contact at the
/// end. (The verifier has this law, the kit and an audit have it as `regrasp-lifts`.)
///
/// While the object moves, and along a path in GS_n, the grasp must hold as [`Task::transfer_grasp`] gives
/// it, in a regrasp as [`Task::grasp`] does. How contacts move in a transfer is the fingertips' matter
/// ([`crate::Hand::fingertip`]): balls roll, points stay.
pub trait LocalPlanner: Send + Sync {
    /// Goes from `from` towards `to`; restarts and fills `path` if given (`None` = check only, store
    /// nothing).
    fn connect(
        &self,
        task: &Task<'_>,
        from: &Configuration,
        to: &Target<'_>,
        path: Option<&mut Path>,
        context: &mut Context<'_>,
    ) -> Result<Reached, CallError>;
}
const _: Option<&dyn LocalPlanner> = None; // must stay object safe

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{PerFinger, Rotation, Vec3, interpolate};

    #[test]
    fn the_fraction_of_a_state_is_the_share_of_the_way_that_takes_more_steps() {
        let at = |X_HO| Configuration {
            X_HO,
            joints: PerFinger::filled(1, FingerJoints::default()),
            contacts: PerFinger::filled(1, None),
        };
        let (start, resolution) = (at(Pose::translation(0.1, 0.0, 0.0)), Resolution::default());
        let turned = Rotation::from_scaled_axis(Vec3::z());
        for end in [
            Pose::translation(0.2, 0.0, 0.05),
            Pose::from_parts(start.X_HO.translation, turned),
            Pose::from_parts(Vec3::new(0.1001, 0.0, 0.0).into(), turned),
        ] {
            let to = Target::Transfer(&end);
            for s in [0.0, 0.25, 0.5, 1.0] {
                let state = at(interpolate(&start.X_HO, &end, s));
                let found = to.fraction_at(&resolution, &start, &state).expect("it is a transfer");
                assert!((found - s).abs() < 1e-9, "{found} for {s}");
            }
        }
        // There is no way to make.
        assert_eq!(Target::Transfer(&start.X_HO).fraction_at(&resolution, &start, &start), Some(1.0));
        assert_eq!(Target::Grasp(&start).fraction_at(&resolution, &start, &start), None);
    }
}
