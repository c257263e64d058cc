//! Several goals in turn: a cube shown from its sides, one quarter turn after the other, and back.
//!
//! `cargo run --example 11_several_goals`
//!
//! A scenario is plain data once it is loaded: this one gets other goals than its file has. The plan says
//! after which segment each is reached.

use regrasp::api::{GoalDescription, PoseDescription, angle_between};
use regrasp::plan::SegmentName;
use std::error::Error;

/// The turns about the vertical that are wished, in this order (degrees).
const TURNS_DEG: [f64; 4] = [90.0, 180.0, 90.0, 0.0];

/// The object where it starts, turned about the vertical.
fn turned(start: &PoseDescription, angle_deg: f64) -> GoalDescription {
    let (axis, angle_deg) = (Some([0.0, 0.0, 1.0]), Some(angle_deg));
    // Without a `grasp` any grasp will do that holds the object there.
    GoalDescription { pose: PoseDescription { axis, angle_deg, ..start.clone() }, grasp: None }
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut scenario = regrasp::load("cubic")?;
    let start = scenario.problem.start.pose.clone();
    scenario.problem.goal = TURNS_DEG.map(|angle_deg| turned(&start, angle_deg)).to_vec();

    let run = regrasp::solve(&scenario, 0)?;
    if let Some(why) = run.why_not_solved() {
        return Err(why.into());
    }
    assert!(run.is_verified());
    let plan = run.plan.ok_or("a solved problem has a plan")?;
    assert_eq!(plan.goals_reached.len(), TURNS_DEG.len());

    let mut done = 0;
    for (turn, &end) in TURNS_DEG.iter().zip(&plan.goals_reached) {
        let segments = &plan.segments[done..end];
        let regrasps = segments.iter().filter(|segment| segment.kind == SegmentName::Regrasp).count();
        let state =
            segments.last().and_then(|segment| segment.states.last()).ok_or("a goal is somewhere else")?;
        let X_HO = regrasp::plan::pose(&state.object);
        let error = angle_between(&X_HO.rotation, &turned(&start, *turn).pose.pose()?.rotation);
        println!(
            "at {turn:>5.1}° after {:>5.1} s: {} transfers and {regrasps} regrasps",
            state.time,
            segments.len() - regrasps
        );
        assert!(error < 1e-6, "the goal is reached");
        done = end;
    }
    assert_eq!(done, plan.segments.len());
    Ok(())
}
