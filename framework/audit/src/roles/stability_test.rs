//! Stability tests under audit.

use crate::auditor::{Key, bits};
use crate::laws::{self, Kept, broken, ensure};
use crate::{Audited, input};
use regrasp_api::{
    Assessment, CallError, Cone, Context, Criterion, EffortBounds, FingerIndex, FingerSet, Grasp,
    GraspContact, Hint, Stability, StabilityTest, Vec3,
};
use serde_json::json;

/// More friction, with which a stable grasp stays stable.
const MORE: f64 = 1.25;

/// What a grasp is known by.
fn key(grasp: &Grasp<'_>) -> Key {
    Key::Short(bits(grasp.contacts().iter().flat_map(|contact| contact.p_OC.iter())))
}

/// The verdict without a hint; `None` where the run ends, or the test does not handle the cones.
fn plain(test: &dyn StabilityTest, grasp: &Grasp<'_>, context: &mut Context<'_>) -> Option<Stability> {
    test.test(grasp, &mut Hint::default(), context).ok()
}

/// The same grasp with more friction; round cones alone.
fn with_more_friction(grasp: &Grasp<'_>) -> Option<Grasp<'static>> {
    let mut other = Grasp::new(grasp.g_O);
    for (i, contact) in grasp.contacts().iter().enumerate() {
        let Cone::Elliptic { mu, gamma } = contact.cone else { return None };
        let cone = Cone::Elliptic { mu: MORE * mu, gamma };
        let (finger, p_OC, n_O) = (contact.finger, contact.p_OC, contact.n_O);
        put(&mut other, GraspContact { cone, finger, p_OC, n_O }, grasp.efforts(i));
    }
    Some(other)
}

/// Adds a contact with what the joints behind it can do, where the grasp says that.
fn put<'a>(grasp: &mut Grasp<'a>, contact: GraspContact<'a>, efforts: Option<&EffortBounds>) {
    match efforts {
        Some(efforts) => grasp.push_bounded(contact, *efforts),
        None => grasp.push(contact),
    }
}

/// Laws that relate the verdict to those on other grasps.
fn verdict_kept(
    test: &dyn StabilityTest,
    grasp: &Grasp<'_>,
    found: Stability,
    context: &mut Context<'_>,
) -> Kept {
    if !found.is_stable() {
        return Ok(());
    }
    if let Some(other) = with_more_friction(grasp)
        && let Some(verdict) = plain(test, &other, context)
    {
        ensure("monotone-in-friction", verdict.is_stable(), || {
            format!("stable, and {verdict:?} with {MORE} times the friction")
        })?;
    }
    let mut other = Grasp::new(grasp.g_O);
    for (i, contact) in grasp.contacts().iter().enumerate().rev() {
        put(&mut other, contact.clone(), grasp.efforts(i));
    }
    match plain(test, &other, context) {
        Some(verdict) if !verdict.is_stable() => {
            broken("permutation", format!("stable, and {verdict:?} with the contacts in reverse order"))
        }
        _ => Ok(()),
    }
}

impl StabilityTest for Audited<'_, dyn StabilityTest + '_> {
    fn test(
        &self,
        grasp: &Grasp<'_>,
        hint: &mut Hint,
        context: &mut Context<'_>,
    ) -> Result<Stability, CallError> {
        // The second call knows nothing from before: a hint never decides.
        let first = std::cell::Cell::new(true);
        let hint = std::cell::RefCell::new(hint);
        self.call(
            ("test", key(grasp)),
            context,
            |test, context| match first.replace(false) {
                true => test.test(grasp, &mut hint.borrow_mut(), context),
                false => test.test(grasp, &mut Hint::default(), context),
            },
            |_| input::grasp(grasp),
            |test, found, context| verdict_kept(test, grasp, *found, &mut context.twin()),
        )
    }

    fn assess(
        &self,
        grasp: &Grasp<'_>,
        length: Option<f64>,
        center_O: Option<Vec3>,
        context: &mut Context<'_>,
    ) -> Result<Assessment, CallError> {
        let object = self.auditor.object;
        self.value_of(
            ("assess", Key::Always),
            context,
            |test, context| test.assess(grasp, length, center_O, context),
            |_| {
                json!({
                    "grasp": input::grasp(grasp),
                    "length": length,
                    "center_O": center_O.as_ref().map(input::vector),
                })
            },
            |test, found, context| {
                laws::assessment_kept(found)?;
                laws::certificate_kept(grasp, object, test.criterion(), found)?;
                let Some(tested) = plain(test, grasp, &mut context.twin()) else { return Ok(()) };
                let same = tested.is_stable() == found.stability.is_stable();
                ensure("test-equals-assess", same, || {
                    format!("`test` says {tested:?}, `assess` {:?}", found.stability)
                })
            },
        )
    }

    fn liftable(
        &self,
        grasp: &Grasp<'_>,
        enough: usize,
        context: &mut Context<'_>,
    ) -> Result<FingerSet, CallError> {
        self.value_of(
            ("liftable", key(grasp)),
            context,
            |test, context| test.liftable(grasp, enough, context),
            |_| json!({ "grasp": input::grasp(grasp), "enough": enough }),
            |test, found, context| {
                let holds = |finger: &FingerIndex| {
                    let rest = grasp.without(*finger);
                    rest.contacts().is_empty()
                        || plain(test, &rest, &mut context.twin()).is_some_and(|s| !s.is_stable())
                };
                match found.iter().find(holds) {
                    Some(finger) => broken(
                        "liftable",
                        format!("`finger[{}]` may be lifted, but the rest is not stable", finger.0),
                    ),
                    None => Ok(()),
                }
            },
        )
    }

    fn stable_without(
        &self,
        grasp: &Grasp<'_>,
        finger: FingerIndex,
        context: &mut Context<'_>,
    ) -> Result<bool, CallError> {
        self.value_of(
            ("stable_without", key(grasp)),
            context,
            |test, context| test.stable_without(grasp, finger, context),
            |_| json!({ "grasp": input::grasp(grasp), "finger": finger.0 }),
            |test, found, context| {
                let rest = grasp.without(finger);
                let says = !rest.contacts().is_empty()
                    && plain(test, &rest, &mut context.twin()).is_none_or(Stability::is_stable);
                ensure("liftable", !found || says, || {
                    format!("says that the rest holds without `finger[{}]`, `test` says no", finger.0)
                })
            },
        )
    }

    fn criterion(&self) -> Criterion {
        self.inner.criterion()
    }

    fn uses_efforts(&self) -> bool {
        self.inner.uses_efforts()
    }
}
