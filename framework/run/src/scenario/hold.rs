//! `[hold]`: what it sets, and what contradicts it.

use super::{Document, ScenarioError, ScenarioFile, key_path};
use regrasp_api::{FrictionFactor, HoldDescription, Limits, Most, Refusal, Slot};
use regrasp_host::Choices;
use serde_json::Value;

/// The stability test that does what `[hold]` asks for.
pub(crate) const HOLDING: &str = "stability-test/holding";

/// The contact model whose contacts drag while they spin, where `[hold]` says nothing else.
const SOFT_FINGER: &str = "contact-model/soft-finger";

/// The range of `friction_factor`.
const FACTORS: std::ops::RangeInclusive<f64> = 0.05..=1.0;

/// Checks `[hold]` and chooses the stability test that keeps it, unless the file chooses one.
pub(super) fn apply(
    document: &Document,
    content: &ScenarioFile,
    choices: &mut Choices,
) -> Result<(), ScenarioError> {
    let Some(asked) = &content.hold else { return Ok(()) };
    check(document, content, asked)?;
    refuse_both(document, content)?;
    if content.plugins.stability_test.id.is_none() && content.plugins.stability_test.settings.is_empty() {
        choices.use_plugin(Slot::StabilityTest, HOLDING);
    }
    let is_soft = choices.choice(Slot::ContactModel).id == SOFT_FINGER;
    let hold = &HoldDescription { drag: asked.drag.or(is_soft.then_some(1.0)), ..*asked };
    if choices.choice(Slot::StabilityTest).id != HOLDING {
        let refused = other_test(asked, &choices.choice(Slot::StabilityTest).id);
        return refused.map_or(Ok(()), |refusal| Err(document.refused(&refusal)));
    }
    let mut set = |key: &str, value: Value| choices.set(Slot::StabilityTest, key, value);
    set("weight", hold.weight.into());
    set("friction_factor", share(hold).into());
    set("disturbance_force", hold.disturbance[0].into());
    set("disturbance_torque", hold.disturbance[1].into());
    if let Some(drag) = hold.drag {
        set("drag", drag.into());
    }
    if let Some(most) = hold.max_normal_force {
        set("max_normal_force", most.into());
    }
    Ok(())
}

/// The limits with the share of the friction that `[hold]` plans with.
pub(super) fn limits(content: &ScenarioFile) -> Limits {
    let mut limits = content.limits;
    if let Some(hold) = &content.hold {
        limits.resolution.friction_margin = share(hold);
    }
    limits
}

/// The first share to plan with.
fn share(hold: &HoldDescription) -> f64 {
    hold.friction_factor.shares()[0]
}

fn check(document: &Document, content: &ScenarioFile, hold: &HoldDescription) -> Result<(), ScenarioError> {
    let refuse = |key: &str, message: String| Err(document.refuse(&key_path(key), message));
    if let FrictionFactor::Share(factor) = hold.friction_factor
        && !FACTORS.contains(&factor)
    {
        let range = format!("{}..={}", FACTORS.start(), FACTORS.end());
        return refuse(
            "hold.friction_factor",
            format!(
                "`hold.friction_factor` = {factor} is outside {range}; give a share of the friction, or \
                 \"most\""
            ),
        );
    }
    if document.has(&key_path("limits.resolution.friction_margin")) {
        let both = "`limits.resolution.friction_margin` and `[hold]` both say how much friction plans rely \
         on; leave one out";
        return refuse("limits.resolution.friction_margin", both.into());
    }
    if !hold.weight && hold.disturbance == [0.0; 2] {
        let nothing = "`hold.weight` = false with no `disturbance` asks for nothing to be held; give one, \
         or leave `[hold]` out";
        return refuse("hold.weight", nothing.into());
    }
    let weight = content.object.mass * content.gravity.iter().map(|g| g * g).sum::<f64>().sqrt();
    if let Some(most) = hold.max_normal_force.filter(|_| hold.weight) {
        let fingers = regrasp_api::MAX_FINGERS as f64;
        // Each contact gives at most its normal force and as much friction as goes with it.
        let carried = fingers * most * (1.0 + content.object.friction.powi(2)).sqrt();
        if carried < weight {
            return refuse(
                "hold.max_normal_force",
                format!(
                    "`hold.max_normal_force` = {most} N cannot carry the object's weight of {weight:.3} N"
                ),
            );
        }
    }
    Ok(())
}

/// Refuses settings of the stability test that `[hold]` gives too.
fn refuse_both(document: &Document, content: &ScenarioFile) -> Result<(), ScenarioError> {
    let pairs = [
        ("weight", "hold.weight"),
        ("friction_factor", "hold.friction_factor"),
        ("disturbance_force", "hold.disturbance"),
        ("disturbance_torque", "hold.disturbance"),
        ("drag", "hold.drag"),
        ("max_normal_force", "hold.max_normal_force"),
    ];
    let settings = &content.plugins.stability_test.settings;
    let both = |(key, _): &&(&str, &str)| settings.keys().any(|set| set == key);
    let Some((key, of_hold)) = pairs.iter().find(both) else { return Ok(()) };
    let key = format!("plugins.stability-test.{key}");
    let message = format!("`{key}` and `{of_hold}` both say what grasps must hold; leave the former out");
    Err(document.refuse(&key_path(&key), message))
}

/// Refuses a hand whose efforts are guesses where `[hold]` plans by them.
pub(super) fn ask_for_efforts(
    document: &Document,
    content: &ScenarioFile,
    effortless: Option<String>,
) -> Result<(), ScenarioError> {
    let (Some(joint), Some(_)) = (effortless, &content.hold) else { return Ok(()) };
    let message = format!(
        "`[hold]` plans by what the joints can give, and {joint} has none; write its `effort` (N·m), or make \
         the hand file with `regrasp hand FILE --effort N·m`"
    );
    Err(document.refuse(&key_path("hold"), message))
}

/// Why the stability test `id` cannot do what `[hold]` asks for; another test than `holding` may stand where
/// that is no more than a share of the friction.
pub(crate) fn other_test(hold: &HoldDescription, id: &str) -> Option<Refusal> {
    if id == HOLDING {
        return None;
    }
    let asked = [
        (hold.disturbance != [0.0; 2], "disturbance"),
        (hold.drag.is_some_and(|drag| drag > 0.0), "drag"),
        (hold.max_normal_force.is_some(), "max_normal_force"),
        (hold.friction_factor == FrictionFactor::Most(Most::Most), "friction_factor"),
    ];
    let (_, key) = asked.into_iter().find(|(is_asked, _)| *is_asked)?;
    let fix = format!("use `{HOLDING}`, or leave the key out");
    let message = format!("`hold.{key}`: `{id}` cannot do what it asks for; {fix}");
    Some(Refusal::new("unsupported", &message).key(format!("hold.{key}")).value(id).remedy(fix))
}
