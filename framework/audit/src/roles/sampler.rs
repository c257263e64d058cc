//! Samplers under audit.

use crate::auditor::{Key, bits};
use crate::laws::{self, Chain, Ground, Kept, ensure};
use crate::{Audited, input};
use regrasp_api::{
    CallError, ClosedChainSampler, Configuration, Contact, Context, FingerSet, PerFinger, Pose, PoseRequest,
    Reason, Slot, Task,
};
use serde_json::json;

/// Closure of a sampled chain (m).
const CLOSED: f64 = 1e-6;

impl Audited<'_, dyn ClosedChainSampler + '_> {
    fn chain<'t>(&'t self, task: &'t Task<'t>) -> Chain<'t> {
        let ground = Ground { mesh: &self.auditor.object.mesh, radius: self.auditor.radius };
        Chain { task, ground, closure: CLOSED }
    }
}

/// What a sample is known by: its random numbers.
fn key(context: &Context<'_>) -> Key {
    Key::Long(context.random.state().iter().fold(0, |sum, word| sum ^ word))
}

/// A sampler that finds nothing has counted why.
fn refusals_counted(context: &Context<'_>) -> Kept {
    let counted: u64 =
        Reason::ALL.iter().map(|&reason| context.tally.rejections(Slot::Sampler, reason)).sum();
    ensure("counts-reasons", counted > 0, || {
        "it finds nothing and counts no reason (`context.reject`)".into()
    })
}

impl ClosedChainSampler for Audited<'_, dyn ClosedChainSampler + '_> {
    fn sample(
        &self,
        task: &Task<'_>,
        pose: PoseRequest<'_>,
        holding: FingerSet,
        context: &mut Context<'_>,
    ) -> Result<Option<Configuration>, CallError> {
        self.call(
            ("sample", key(context)),
            context,
            |sampler, context| sampler.sample(task, pose, holding, context),
            |context| {
                json!({
                    "pose": input::request(&pose),
                    "holding": input::fingers(holding),
                    "random": input::random(context),
                })
            },
            |_, found, context| {
                let Some(q) = found else { return refusals_counted(context) };
                laws::chain_kept(&self.chain(task), q, holding)?;
                laws::pose_kept(task, &pose, q)?;
                match task.admissible.admit(task, q, &mut context.twin()) {
                    Ok(Some(reason)) => laws::broken(
                        "sample-admissible",
                        format!(
                            "refused for \
                        `{}`",
                            reason.name()
                        ),
                    ),
                    _ => Ok(()),
                }
            },
        )
    }

    fn close(
        &self,
        task: &Task<'_>,
        X_HO: &Pose,
        contacts: &PerFinger<Option<Contact>>,
        near: &Configuration,
        context: &mut Context<'_>,
    ) -> Result<Option<Configuration>, CallError> {
        self.value_of(
            ("close", Key::Long(bits(X_HO.translation.vector.iter()))),
            context,
            |sampler, context| sampler.close(task, X_HO, contacts, near, context),
            |context| {
                json!({
                    "object": input::pose(X_HO),
                    "contacts": input::contacts(contacts),
                    "near": input::configuration(near),
                    "random": input::random(context),
                })
            },
            |_, found, _| {
                let Some(q) = found else { return Ok(()) };
                ensure("close-exact", q.X_HO == *X_HO && q.contacts == *contacts, || {
                    "it changes the pose or the contacts that are given".into()
                })?;
                laws::chain_kept(&self.chain(task), q, q.holding())
            },
        )
    }
}
