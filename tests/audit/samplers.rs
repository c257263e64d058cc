//! Mistakes of samplers.

use regrasp::api::{
    CallError, ClosedChainSampler, Configuration, Contact, Context, FingerIndex, FingerSet, Parts, PerFinger,
    Pose, PoseRequest, Slot, Task,
};

struct Liar {
    lie: String,
    honest: Box<dyn ClosedChainSampler>,
}

impl ClosedChainSampler for Liar {
    fn sample(
        &self,
        task: &Task<'_>,
        pose: PoseRequest<'_>,
        holding: FingerSet,
        context: &mut Context<'_>,
    ) -> Result<Option<Configuration>, CallError> {
        match self.lie.as_str() {
            "counts-nothing" => return self.honest.sample(task, pose, holding, &mut context.twin()),
            "counts-twice" => context.count_call(Slot::Sampler),
            "no-reasons" => {
                context.count_call(Slot::Sampler);
                return Ok(None);
            }
            _ => {}
        }
        let mut found = self.honest.sample(task, pose, holding, context)?;
        let Some(q) = &mut found else { return Ok(found) };
        let first = FingerIndex(0);
        match self.lie.as_str() {
            "lets-go" => q.contacts[first] = None,
            "beside-the-pose" => q.X_HO.translation.vector.x += 1e-6,
            "open-chain" => q.joints[first][1] += 1e-3,
            "flipped" => {
                if let Some(contact) = &mut q.contacts[first] {
                    contact.n_O = -contact.n_O;
                }
            }
            "impure" if super::odd() => return self.honest.sample(task, pose, holding, context),
            _ => {}
        }
        Ok(found)
    }

    fn close(
        &self,
        task: &Task<'_>,
        X_HO: &Pose,
        contacts: &PerFinger<Option<Contact>>,
        near: &Configuration,
        context: &mut Context<'_>,
    ) -> Result<Option<Configuration>, CallError> {
        self.honest.close(task, X_HO, contacts, near, context)
    }
}

crate::liar!(Sampler, "sampler", &[Slot::Sampler], |lie, parts: &Parts<'_>| {
    Ok(Liar { lie, honest: parts.plugins.sampler(None, "", parts)? })
});

#[test]
fn caught() {
    super::judge(
        Slot::Sampler,
        &[
            ("counts-nothing", "counted"),
            ("counts-twice", "counted"),
            ("no-reasons", "counts-reasons"),
            ("lets-go", "holding"),
            ("beside-the-pose", "closed|sample-pose"),
            ("open-chain", "closed"),
            ("flipped", "contact-on-surface"),
            ("impure", "pure"),
        ],
    );
}
