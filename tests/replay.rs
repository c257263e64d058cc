//! Plans carried out in simulation, and planning with simulated transfers.
#![allow(missing_docs)]

use regrasp::api::Slot;
use regrasp::host::Registry;
use regrasp::physics::{Happening, ReplayReport, ReplaySettings, SimulationSettings, Stage, replay};
use regrasp::plan::{Motion, Plan, SegmentKind};
use regrasp::planner::{Clock, Silent};
use regrasp::study::{NeverStops, Run, RunOptions, Setup, scenario};
use std::path::Path;

struct NoClock;

impl Clock for NoClock {
    fn seconds(&self) -> f64 {
        0.0
    }
}

fn plan(name: &str, seed: u64, choose: &[(Slot, &str)]) -> Run {
    let registry = Registry::linked().unwrap();
    let scenario = scenario::load(name, &registry).unwrap();
    let mut choices = scenario.choices.clone();
    choose.iter().for_each(|(slot, id)| choices.use_plugin(*slot, id));
    if choose.iter().any(|(_, id)| *id == "equilibrium") {
        // What the joints' efforts of 1 N·m can press.
        choices.set(Slot::StabilityTest, "max_normal_force", 5.0.into());
    }
    let setup = Setup::new(&scenario, &choices, &registry).unwrap();
    let options = RunOptions { seed, threads: 1, stop: &NeverStops, clock: &NoClock, progress: &Silent };
    setup.run(&options).unwrap()
}

fn stages(motion: &Motion) -> Vec<Stage<'_>> {
    let moving = |kind| match kind {
        SegmentKind::Transfer => None,
        SegmentKind::Regrasp(finger) => Some(finger),
    };
    let segments = motion.segments.iter();
    segments
        .map(|segment| Stage { states: &segment.states, times: &segment.times, moving: moving(segment.kind) })
        .collect()
}

fn replayed(plan: &Plan, settings: &ReplaySettings) -> ReplayReport {
    let motion = regrasp::plan::motion(&plan.segments).unwrap();
    replay(&plan.scenario.problem, Path::new(""), &stages(&motion), settings).unwrap()
}

fn balanced(name: &str, seed: u64) -> Plan {
    plan(name, seed, &[(Slot::StabilityTest, "equilibrium")]).plan.expect("it is solved")
}

#[test]
fn plans_whose_grasps_hold_the_weight_arrive() {
    for (name, seed) in [("sphere", 1), ("sphere", 2), ("cubic", 1)] {
        let plan = balanced(name, seed);
        let report = replayed(&plan, &ReplaySettings::default());
        assert!(report.arrived, "{name} {seed}: {:?}", report.failure());
        assert_eq!(report.stages.len(), plan.segments.len());
        assert!(report.distance() < 5e-3 && report.angle() < 5_f64.to_radians(), "{}", report.distance());
        assert!(report.stages.iter().all(|stage| stage.margin > 0.0));
        let end = report.stages.last().map(|stage| stage.end_distance);
        let goal = regrasp::plan::motion(&plan.segments)
            .unwrap()
            .segments
            .last()
            .unwrap()
            .states
            .last()
            .unwrap()
            .X_HO;
        assert_eq!(end, Some((report.X_HO.translation.vector - goal.translation.vector).norm()));
    }
}

#[test]
fn the_same_plan_falls_where_friction_is_far_lower_or_the_object_far_heavier() {
    let plan = balanced("sphere", 1);
    for simulation in [
        SimulationSettings { friction: Some(0.1), ..Default::default() },
        SimulationSettings { mass: Some(5.0), ..Default::default() },
    ] {
        let report = replayed(&plan, &ReplaySettings { simulation, ..Default::default() });
        assert!(!report.arrived);
        assert_eq!(report.failure().map(|(_, failure)| failure.what), Some(Happening::Stray));
    }
}

#[test]
fn a_replay_gives_the_same_bits_each_time() {
    let plan = balanced("sphere", 3);
    let settings = ReplaySettings::default();
    assert_eq!(replayed(&plan, &settings), replayed(&plan, &settings));
}

#[test]
fn simulated_transfers_solve_the_papers_problems() {
    for name in ["sphere", "cubic"] {
        let run = plan(name, 1, &[(Slot::TransferPlanner, "rapier-checked")]);
        assert!(run.is_verified(), "{name}");
        assert_eq!(run.outcome.status, regrasp::planner::Status::Solved);
        let plan = run.plan.unwrap();
        let choice = plan.scenario.plugins.get(&Slot::TransferPlanner).expect("recorded");
        assert_eq!(choice.id, "local-planner/rapier-checked");
    }
}

#[test]
fn a_ball_too_slippery_for_its_plan_is_not_planned() {
    let registry = Registry::linked().unwrap();
    let mut scenario = scenario::load("sphere", &registry).unwrap();
    scenario.problem.limits.budget.max_nodes = 5;
    let solved = [0.8, 0.05].map(|friction| {
        let mut choices = scenario.choices.clone();
        choices.use_plugin(Slot::TransferPlanner, "rapier-checked");
        choices.set(Slot::TransferPlanner, "friction", friction.into());
        let setup = Setup::new(&scenario, &choices, &registry).unwrap();
        let options =
            RunOptions { seed: 3, threads: 1, stop: &NeverStops, clock: &NoClock, progress: &Silent };
        setup.run(&options).unwrap().is_verified()
    });
    assert_eq!(solved, [true, false]);
}
