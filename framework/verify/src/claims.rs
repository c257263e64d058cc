//! Whether what the plan claims of its contacts agrees with its scenario.

use crate::verdict::{Check, Gauge};
use regrasp_api::{FrictionFactor, HoldLoad, ObjectModel, Slot};
use regrasp_plan::{ConeClaim, ConeRecord, Criterion, MarginFrame, Place, Plan, TransferLaw};

/// The contact models that the verifier knows.
const KNOWN: [&str; 3] = ["contact-model/pcwf", "contact-model/frictionless", "contact-model/soft-finger"];

/// The stability test that holds a load.
const EQUILIBRIUM: &str = "stability-test/equilibrium";
/// The stability test that holds a load within the joints' efforts.
const HOLDING: &str = "stability-test/holding";
/// The stability tests that decide closure.
const CLOSURE: [&str; 4] = [
    "stability-test/force-closure",
    "stability-test/socp",
    "stability-test/linearised",
    "stability-test/wrench-ball",
];

/// Checks the claims against the scenario: the contact model that was used, no more friction than the object
/// has, the criterion of the test that was used, the object's own centre and length.
pub(crate) fn claims(plan: &Plan, object: &ObjectModel) -> Check {
    let mut gauge = Gauge::faults("claims");
    let mut fault = |note: String| gauge.fault(|| Place { note: Some(note), ..Default::default() });
    let claim = &plan.claims.contact;
    let choice = plan.scenario.plugins.get(&Slot::ContactModel);
    if choice.is_none_or(|choice| choice.id != claim.model) {
        fault(format!("the plan claims `{}`, which is not its scenario's contact model", claim.model));
    }
    let known = KNOWN.contains(&claim.model.as_str());
    match &claim.cone {
        Some(cone) => {
            if let Some(note) = wrong_cone(&claim.model, cone, plan, object.friction) {
                fault(note);
            }
        }
        None if known && claim.cones.is_empty() => {
            fault(format!("`{}` has an elliptic cone, but the plan claims none", claim.model))
        }
        None => {}
    }
    if let Some(note) = claim.cones.iter().find_map(|cone| wrong_record(cone, object.friction)) {
        fault(note);
    }
    if !frame_agrees(&plan.claims.margin, object) {
        fault("margins must be measured about the object's centre of mass, in its largest radius".into());
    }
    if let Some(note) = wrong_criterion(plan) {
        fault(note);
    }
    let fingertip = plan.scenario.problem.hand.fingertip;
    if plan.claims.transfer_law != TransferLaw::of_fingertips(fingertip) {
        let law = plan.claims.transfer_law;
        fault(format!(
            "the plan claims transfers by the law {law:?}, the hand declares fingertips of the kind \
             {fingertip:?}"
        ));
    }
    if !known && gauge.worst() == Some(0.0) {
        gauge.remark(&format!(
            "not independently checked: `{}` is not a model that the verifier knows",
            claim.model
        ));
    }
    gauge.check()
}

/// What is wrong with the claimed cone, if anything.
fn wrong_cone(model: &str, cone: &ConeClaim, plan: &Plan, friction: f64) -> Option<String> {
    let (mu, gamma) = (cone.most(), cone.gamma);
    if !cone.is_sound() {
        return Some(format!("a cone without meaning is claimed: {cone:?}"));
    }
    if !(0.0..=friction).contains(&mu) {
        return Some(format!("friction {mu} is claimed, the object has {friction}"));
    }
    if !(gamma >= 0.0 && gamma.is_finite()) {
        return Some(format!("a torsional radius of {gamma} m is claimed"));
    }
    let settings = plan.scenario.plugins.get(&Slot::ContactModel).map(|choice| &choice.settings);
    match model {
        _ if cone.grain.is_some() && KNOWN.contains(&model) => Some(format!("`{model}` has no grain")),
        "contact-model/pcwf" if gamma != 0.0 => {
            Some(format!("`{model}` transmits no torsion, {gamma} m is claimed"))
        }
        "contact-model/frictionless" if mu != 0.0 || gamma != 0.0 => {
            Some(format!("`{model}` has no friction"))
        }
        "contact-model/soft-finger" => {
            let set = settings.and_then(|settings| settings.get("gamma")?.as_f64());
            (set.is_none_or(|set| gamma > set))
                .then(|| format!("a torsional radius of {gamma} m is claimed, the scenario sets {set:?}"))
        }
        _ => None,
    }
}

/// What is wrong with the cone of a single contact, if anything.
fn wrong_record(cone: &ConeRecord, friction: f64) -> Option<String> {
    let (mu, torsions): (f64, Vec<f64>) = match cone {
        ConeRecord::Elliptic(cone) if !cone.is_sound() => (f64::NAN, vec![]),
        ConeRecord::Elliptic(cone) => (cone.most(), vec![cone.gamma]),
        ConeRecord::Polyhedral(edges) => {
            let reach = edges.iter().map(|edge| edge.tangential[0].hypot(edge.tangential[1]));
            // NaN must not hide behind a larger number.
            let reach = reach.fold(0.0, |most: f64, x| if x > most || x.is_nan() { x } else { most });
            (reach, edges.iter().map(|edge| edge.torsion).collect())
        }
    };
    let sound = (0.0..=friction * (1.0 + 1e-9)).contains(&mu) && torsions.iter().all(|m| m.is_finite());
    (!sound).then(|| format!("a contact's cone reaches friction {mu}, the object has {friction}"))
}

/// What is wrong with the claimed criterion, if anything: it must be no weaker than what the scenario's test
/// demands.
fn wrong_criterion(plan: &Plan) -> Option<String> {
    let choice = plan.scenario.plugins.get(&Slot::StabilityTest);
    let id = choice.map_or("", |choice| choice.id.as_str());
    let claimed = &plan.claims.criterion;
    match claimed {
        Criterion::Holding(load) => wrong_holding(plan, id, load),
        _ if id == HOLDING => {
            Some(format!("the scenario's test is `{id}`, and the plan claims something else"))
        }
        Criterion::Closure if id == EQUILIBRIUM => {
            Some(format!("closure is claimed, the scenario's test is `{id}`"))
        }
        Criterion::Closure => None,
        Criterion::Equilibrium(_) if CLOSURE.contains(&id) => {
            Some(format!("equilibrium is claimed, the scenario's test is `{id}`"))
        }
        Criterion::Equilibrium(load) if id == EQUILIBRIUM => {
            let set = |key: &str| choice.and_then(|choice| choice.settings.get(key)?.as_f64());
            let agrees = set("disturbance_force").is_some_and(|x| load.disturbance_force >= x)
                && set("disturbance_torque").is_some_and(|x| load.disturbance_torque >= x)
                && set("max_normal_force").is_some_and(|x| load.max_normal_force <= x);
            (!agrees).then(|| format!("a load is claimed that is less than the scenario sets for `{id}`"))
        }
        Criterion::Equilibrium(_) => None,
        _ => Some("a criterion is claimed that cannot be checked".into()),
    }
}

/// What is wrong with the claim that a load is held: it must be no less than what the scenario's test and its
/// `hold` ask for.
fn wrong_holding(plan: &Plan, id: &str, load: &HoldLoad) -> Option<String> {
    if CLOSURE.contains(&id) || id == EQUILIBRIUM {
        return Some(format!("holding is claimed, the scenario's test is `{id}`"));
    }
    let settings = plan.scenario.plugins.get(&Slot::StabilityTest).map(|choice| &choice.settings);
    let set = |key: &str| settings.and_then(|settings| settings.get(key));
    let number = |key: &str| set(key).and_then(|value| value.as_f64());
    let mut asked = HoldLoad {
        weight: set("weight").and_then(|value| value.as_bool()).unwrap_or(true),
        friction_factor: number("friction_factor").unwrap_or(1.0),
        disturbance_force: number("disturbance_force").unwrap_or(0.0),
        disturbance_torque: number("disturbance_torque").unwrap_or(0.0),
        drag: number("drag").unwrap_or(0.0),
        max_normal_force: number("max_normal_force"),
    };
    if let Some(hold) = &plan.scenario.problem.hold {
        if let FrictionFactor::Share(share) = hold.friction_factor {
            asked.friction_factor = share;
        }
        asked.weight |= hold.weight;
        asked.disturbance_force = asked.disturbance_force.max(hold.disturbance[0]);
        asked.disturbance_torque = asked.disturbance_torque.max(hold.disturbance[1]);
        asked.drag = asked.drag.max(hold.drag.unwrap_or(0.0));
    }
    let most = |load: &HoldLoad| load.max_normal_force.unwrap_or(f64::INFINITY);
    let agrees = (load.weight || !asked.weight)
        && load.friction_factor <= asked.friction_factor
        && load.disturbance_force >= asked.disturbance_force
        && load.disturbance_torque >= asked.disturbance_torque
        && load.drag >= asked.drag
        && most(load) <= most(&asked);
    (!agrees).then(|| "less is claimed to be held than the scenario asks for".into())
}

fn frame_agrees(claimed: &MarginFrame, object: &ObjectModel) -> bool {
    let own = MarginFrame::of_object(object);
    let near = |a: f64, b: f64| (a - b).abs() <= 1e-9 * own.length;
    near(claimed.length, own.length) && (0..3).all(|i| near(claimed.center_O[i], own.center_O[i]))
}
