//! Mistakes of stability tests.

use regrasp::api::{
    Assessment, CallError, Cone, Context, FingerIndex, FingerSet, Grasp, GraspContact, Hint, Parts, Slot,
    Stability, StabilityTest, Vec3,
};

struct Liar {
    lie: String,
    honest: Box<dyn StabilityTest>,
}

fn friction(contact: &GraspContact<'_>) -> f64 {
    if let Cone::Elliptic { mu, .. } = contact.cone { mu } else { 0.0 }
}

impl StabilityTest for Liar {
    fn test(
        &self,
        grasp: &Grasp<'_>,
        hint: &mut Hint,
        context: &mut Context<'_>,
    ) -> Result<Stability, CallError> {
        let contacts = grasp.contacts();
        let refuse = match self.lie.as_str() {
            "counts-nothing" => return self.honest.test(grasp, hint, &mut context.twin()),
            "believes-hints" => {
                hint.tag += 1;
                hint.tag.is_multiple_of(2)
            }
            "impure" => super::odd(),
            "afraid-of-friction" => contacts.iter().any(|contact| friction(contact) > 0.7),
            "goes-by-order" => contacts[0].finger > contacts[contacts.len() - 1].finger,
            "draws" => context.random.unit() < 0.0,
            _ => false,
        };
        let honest = self.honest.test(grasp, hint, context)?;
        Ok(if refuse { Stability::Unstable } else { honest })
    }

    fn assess(
        &self,
        grasp: &Grasp<'_>,
        length: Option<f64>,
        center_O: Option<Vec3>,
        context: &mut Context<'_>,
    ) -> Result<Assessment, CallError> {
        self.honest.assess(grasp, length, center_O, context)
    }

    fn liftable(
        &self,
        grasp: &Grasp<'_>,
        enough: usize,
        context: &mut Context<'_>,
    ) -> Result<FingerSet, CallError> {
        match self.lie.as_str() {
            "lifts-all" => Ok(grasp.contacts().iter().map(|contact| contact.finger).collect()),
            _ => self.honest.liftable(grasp, enough, context),
        }
    }

    fn stable_without(
        &self,
        grasp: &Grasp<'_>,
        finger: FingerIndex,
        context: &mut Context<'_>,
    ) -> Result<bool, CallError> {
        self.honest.stable_without(grasp, finger, context)
    }
}

crate::liar!(StabilityTest, "stability-test", &[Slot::StabilityTest], |lie, parts: &Parts<'_>| {
    Ok(Liar { lie, honest: parts.plugins.stability_test(None, "", parts)? })
});

#[test]
fn caught() {
    super::judge(
        Slot::StabilityTest,
        &[
            ("counts-nothing", "counted"),
            ("believes-hints", "pure|monotone-in-friction|permutation"),
            ("impure", "pure"),
            ("afraid-of-friction", "monotone-in-friction"),
            ("goes-by-order", "permutation"),
            ("lifts-all", "liftable"),
        ],
    );
}
