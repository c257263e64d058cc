//! From a problem to a plan file, and back: plans, writes the plan, reads it, verifies it, spoils it,
//! verifies again.
//!
//! `cargo run --example 05_plan_and_verify`
//!
//! The verifier shares no code with the planner: its own kinematics, its own stability test, exact distances,
//! ten times the plan's resolution.

use regrasp::plan::{Plan, SegmentName};
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let scenario = regrasp::load("sphere")?; // `regrasp scenarios` lists what is built in; a file's path works too
    let run = regrasp::solve(&scenario, 0)?;
    if let Some(why) = run.why_not_solved() {
        return Err(why.into());
    }
    let plan = run.plan.ok_or("a solved problem has a plan")?;

    // A plan file stands alone: problem, meshes, plugins, seed and motion are inside.
    let folder = tempfile::tempdir()?;
    let file = folder.path().join("plan.json");
    regrasp::plan::write(&file, &plan)?;
    let read = regrasp::plan::read(&file)?;
    assert_eq!(read, plan, "every number is read as it was written");

    let count = |kind| read.segments.iter().filter(|segment| segment.kind == kind).count();
    let (transfers, regrasps) = (count(SegmentName::Transfer), count(SegmentName::Regrasp));
    println!("{}: {transfers} transfers, {regrasps} regrasps", read.scenario.name);

    let verdict = regrasp::verify::verify(&read);
    assert!(verdict.valid);
    let worst = verdict.certificate.ok_or("a valid plan has a certificate")?;
    let figures = [
        ("smallest margin of force closure", worst.closure_margin, 1.0, ""),
        ("smallest clearance", worst.clearance, 1e3, " mm"),
        ("largest slip of a contact", worst.slip, 1e3, " mm"),
        ("largest gap at a contact", worst.closure_residual, 1e6, " µm"),
    ];
    for (what, extreme, scale, unit) in figures {
        let extreme = extreme.ok_or("this plan has contacts, transfers and obstacles")?;
        let time = extreme.place.time.unwrap_or_default();
        println!("  {what:<33} {:.3}{unit} at {time:.2} s", extreme.value * scale);
    }

    println!("\nthe ball lifted by half a millimetre in one state of the first transfer:");
    let verdict = regrasp::verify::verify(&spoilt(read)?);
    assert!(!verdict.valid);
    for check in verdict.failures() {
        println!("  {} fails", check.name);
    }
    assert!(verdict.check("closure").is_some_and(|check| !check.ok), "the fingertips lose the ball");
    Ok(())
}

/// The plan with one state changed, in the middle of its first transfer.
fn spoilt(mut plan: Plan) -> Result<Plan, Box<dyn Error>> {
    let mut transfers = plan.segments.iter_mut().filter(|segment| segment.kind == SegmentName::Transfer);
    let states = &mut transfers.next().ok_or("the ball moves")?.states;
    let middle = states.len() / 2;
    states[middle].object.position[2] += 0.0005;
    Ok(plan)
}
