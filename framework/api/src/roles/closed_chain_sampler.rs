//! Role 4: random configurations of GS_n, whose chains finger-object-palm close.

use crate::{CallError, Configuration, Contact, Context, FingerSet, PerFinger, Pose, Task};

/// Where the object's pose comes from in a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PoseRequest<'a> {
    /// Anywhere in the task's workspace.
    Anywhere,
    /// Near the given configuration: within `radius` (m) and `angle` (rad) of its pose; contacts near its
    /// contacts if that helps.
    Near {
        /// The configuration to stay near.
        configuration: &'a Configuration,
        /// Largest displacement of the object (m).
        radius: f64,
        /// Largest turn of the object (rad).
        angle: f64,
    },
    /// Exactly this pose.
    At(Pose),
}

/// Samples configurations in which given fingers hold the object.
pub trait ClosedChainSampler: Send + Sync {
    /// One random admissible configuration with exactly the fingers `holding` in contact, or `None` after the
    /// sampler's own number of tries.
    ///
    /// Fingers that do not hold take their rest posture, or any posture in which they touch nothing. What is
    /// returned has passed [`crate::Admissible::admit`]. Every failed try is counted with its reason. Pure in
    /// its arguments and the context's random stream.
    fn sample(
        &self,
        task: &Task<'_>,
        pose: PoseRequest<'_>,
        holding: FingerSet,
        context: &mut Context<'_>,
    ) -> Result<Option<Configuration>, CallError>;

    /// Closes the chains for given contacts at a given pose: the joints of every finger with a contact, close
    /// to `near` where there is a choice; `None` if some finger cannot reach. Checks neither collision nor
    /// stability.
    fn close(
        &self,
        task: &Task<'_>,
        X_HO: &Pose,
        contacts: &PerFinger<Option<Contact>>,
        near: &Configuration,
        context: &mut Context<'_>,
    ) -> Result<Option<Configuration>, CallError>;
}
const _: Option<&dyn ClosedChainSampler> = None; // must stay object safe
