//! Making the call.

use super::input::Input;
use super::{ReplayError, form};
use crate::fixtures::Bench;
use regrasp_api::{
    Build, ClosedChainSampler, ContactModel, Context, Entry, Hint, LocalPlanner, PoseRequest, Slot,
    StabilityTest, SurfaceParam, SurfacePath, Target, Uninterrupted,
};
use regrasp_audit::{Audited, Auditor};
use serde_json::Value;

/// Builds the plugin and makes the call that `breach` names, under audit. What it answers is the auditor's.
pub(super) fn make(
    entry: &Entry,
    settings: &str,
    slot: Slot,
    bench: &Bench,
    auditor: &Auditor<'_>,
    breach: &Value,
) -> Result<(), ReplayError> {
    let Some(call) = breach["call"].as_str() else { return Err(form("breach.call", "a text is wanted")) };
    let input = Input::new(&breach["input"], "input");
    let parts = bench.parts();
    match entry.build {
        Build::ContactModel(build) => {
            let plugin = build(settings, &parts)?;
            contact_model(&Audited::new(&*plugin, slot, auditor), call, input)
        }
        Build::StabilityTest(build) => {
            let plugin = build(settings, &parts)?;
            stability_test(&Audited::new(&*plugin, slot, auditor), call, input)
        }
        Build::Surface(build) => {
            let plugin = build(settings, &parts)?;
            surface(&Audited::new(&*plugin, slot, auditor), call, input)
        }
        Build::Sampler(build) => {
            let plugin = build(settings, &parts)?;
            sampler(&Audited::new(&*plugin, slot, auditor), bench, call, input)
        }
        Build::LocalPlanner(build) => {
            let plugin = build(settings, &parts)?;
            local_planner(&Audited::new(&*plugin, slot, auditor), bench, call, input)
        }
        Build::GraphStrategy(_) => Err(ReplayError::NeedsTheRun { call: call.to_owned() }),
    }
}

fn unknown<T>(call: &str) -> Result<T, ReplayError> {
    Err(form("breach.call", format!("the role has no call `{call}`")))
}

fn context(input: Input<'_>) -> Result<Context<'static>, ReplayError> {
    Ok(Context::new(input.get("random").random()?, &Uninterrupted))
}

fn contact_model(model: &dyn ContactModel, call: &str, input: Input<'_>) -> Result<(), ReplayError> {
    if call == "fewest_contacts" {
        model.fewest_contacts();
        return Ok(());
    }
    let (finger, contact) = (input.get("finger").finger()?, input.get("contact").contact()?);
    let mu = input.get("mu").number()?;
    match call {
        "cone" => drop(model.cone(finger, &contact, mu)),
        "spinning_cone" => drop(model.spinning_cone(finger, &contact, mu)),
        _ => return unknown(call),
    }
    Ok(())
}

fn stability_test(test: &dyn StabilityTest, call: &str, input: Input<'_>) -> Result<(), ReplayError> {
    let mut context = context(input)?;
    // What a call answers, and whether it fails, is the auditor's to judge.
    match call {
        "test" => drop(test.test(&input.grasp()?, &mut Hint::default(), &mut context)),
        "assess" => {
            let length = input.get("length");
            let length = if length.is_null() { None } else { Some(length.number()?) };
            let center = input.get("center_O");
            let center = if center.is_null() { None } else { Some(center.vector()?) };
            drop(test.assess(&input.get("grasp").grasp()?, length, center, &mut context));
        }
        "liftable" => {
            let enough = input.get("enough").count()? as usize;
            drop(test.liftable(&input.get("grasp").grasp()?, enough, &mut context));
        }
        "stable_without" => {
            let finger = input.get("finger").finger()?;
            drop(test.stable_without(&input.get("grasp").grasp()?, finger, &mut context));
        }
        _ => return unknown(call),
    }
    Ok(())
}

fn surface(surface: &dyn SurfaceParam, call: &str, input: Input<'_>) -> Result<(), ReplayError> {
    match call {
        "sample" => {
            surface.sample(&mut input.get("random").random()?);
        }
        "geodesic" => {
            let (from, to) = (input.get("from").contact()?, input.get("to").contact()?);
            drop(surface.geodesic(&from, &to, &mut SurfacePath::default(), &mut context(input)?));
        }
        "project" => {
            let hint = input.get("hint");
            let hint = if hint.is_null() { None } else { Some(hint.count()? as u32) };
            surface.project(&input.get("p_OF").vector()?, hint);
        }
        "walk" => {
            let direction_O = input.get("direction_O").vector()?;
            surface.walk(&input.get("from").contact()?, &direction_O, input.get("distance").number()?);
        }
        "edge_distance" => {
            surface.edge_distance(&input.get("contact").contact()?);
        }
        _ => return unknown(call),
    }
    Ok(())
}

fn sampler(
    sampler: &dyn ClosedChainSampler,
    bench: &Bench,
    call: &str,
    input: Input<'_>,
) -> Result<(), ReplayError> {
    let (task, mut context) = (bench.task(), context(input)?);
    match call {
        "sample" => {
            let (pose, holding) = (input.get("pose"), input.get("holding").fingers()?);
            let (at, near) = (pose.get("at"), pose.get("near"));
            let configuration;
            let request = if !at.is_null() {
                PoseRequest::At(at.pose()?)
            } else if !near.is_null() {
                configuration = near.configuration()?;
                let (radius, angle) = (pose.get("radius").number()?, pose.get("angle").number()?);
                PoseRequest::Near { configuration: &configuration, radius, angle }
            } else {
                PoseRequest::Anywhere
            };
            drop(sampler.sample(&task, request, holding, &mut context));
        }
        "close" => {
            let X_HO = input.get("object").pose()?;
            let near = input.get("near").configuration()?;
            drop(sampler.close(&task, &X_HO, &input.get("contacts").contacts()?, &near, &mut context));
        }
        _ => return unknown(call),
    }
    Ok(())
}

fn local_planner(
    planner: &dyn LocalPlanner,
    bench: &Bench,
    call: &str,
    input: Input<'_>,
) -> Result<(), ReplayError> {
    if call != "connect" {
        return unknown(call);
    }
    let from = input.get("from").configuration()?;
    let to = input.get("to");
    let (grasp, transfer, regrasp) = (to.get("grasp"), to.get("transfer"), to.get("regrasp"));
    let (configuration, X_HO, joints, contact);
    let target = if !grasp.is_null() {
        configuration = grasp.configuration()?;
        Target::Grasp(&configuration)
    } else if !transfer.is_null() {
        X_HO = transfer.pose()?;
        Target::Transfer(&X_HO)
    } else {
        joints = regrasp.get("joints").joints()?;
        contact = regrasp.get("contact").contact_or_none()?;
        Target::Regrasp {
            finger: regrasp.get("finger").finger()?,
            contact: contact.as_ref(),
            joints: &joints,
        }
    };
    drop(planner.connect(&bench.task(), &from, &target, None, &mut context(input)?));
    Ok(())
}
