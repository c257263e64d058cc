//! Plans carried out in simulation, and planning with simulated transfers.
#![allow(missing_docs)]

use regrasp::api::Slot;
use regrasp::host::Registry;
use regrasp::physics::{Happening, ReplayReport, ReplaySettings, SimulationSettings, Stage, replay};
use regrasp::plan::{Motion, Plan, SegmentKind};
use regrasp::planner::{Clock, Silent};
use regrasp::run::{NeverStops, Run, RunOptions, Setup, scenario};
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
        .map(|segment| Stage {
            states: &segment.states,
            times: &segment.times,
            moving: moving(segment.kind),
            forces: &segment.forces,
        })
        .collect()
}

fn replayed(plan: &Plan, settings: &ReplaySettings) -> ReplayReport {
    let motion = regrasp::plan::motion(plan).unwrap();
    replay(&plan.scenario.problem, &stages(&motion), settings).unwrap()
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
        let motion = regrasp::plan::motion(&plan).unwrap();
        let goal = motion.segments.last().and_then(|segment| segment.states.last()).unwrap().X_HO;
        let (last, moved) = (report.stages.last().unwrap(), report.X_HO.translation.vector);
        assert_eq!(last.end_distance, (moved - goal.translation.vector).norm());
        // A pose for each state, and one after the object was held for a while.
        assert!(
            report
                .stages
                .iter()
                .zip(&motion.segments)
                .all(|(stage, segment)| stage.track.len() >= segment.states.len())
        );
        assert_eq!(
            last.track.last().map(|moment| (moment.time, moment.X_HO)),
            Some((report.time, report.X_HO))
        );
    }
}

/// By default plans know nothing of weight and efforts: a few in a hundred fall.
#[test]
fn nearly_all_default_plans_arrive() {
    for name in ["sphere", "cubic"] {
        let arrived = (0..8).filter(|&seed| {
            let plan = plan(name, seed, &[]).plan.expect("it is solved");
            replayed(&plan, &ReplaySettings::default()).arrived
        });
        let count = arrived.count();
        assert!(count >= 7, "{name}: {count} of 8");
    }
}

#[test]
fn the_same_plan_falls_where_friction_is_far_lower_or_the_object_far_heavier() {
    let plan = balanced("sphere", 2);
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
    for name in ["sphere", "sphere-tilt", "cubic", "ellip-obst"] {
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

#[test]
fn contacts_that_count_on_torsion_are_refused_for_simulated_transfers_and_replays() {
    let registry = Registry::linked().unwrap();
    let scenario = scenario::load("sphere-soft", &registry).unwrap();
    let mut choices = scenario.choices.clone();
    choices.use_plugin(Slot::TransferPlanner, "rapier-checked");
    let setup = Setup::new(&scenario, &choices, &registry).unwrap();
    let options = RunOptions { seed: 0, threads: 1, stop: &NeverStops, clock: &NoClock, progress: &Silent };
    let error = setup.run(&options).err().expect("refused").to_string();
    assert!(error.contains("rapier-checked") && error.contains("torsional"), "{error}");
    let soft = plan("sphere-soft", 0, &[]).plan.expect("it is solved");
    let folder = tempfile::tempdir().unwrap();
    regrasp::plan::write(&folder.path().join("soft.json"), &soft).unwrap();
    let (code, _, err) = command(folder.path(), "replay soft.json");
    assert!(code == 2 && err.contains("soft.json") && err.contains("torsional"), "{err}");
}

/// Runs the program in a folder: exit code, standard output, standard error.
fn command(folder: &Path, arguments: &str) -> (i32, String, String) {
    let output = std::process::Command::new(env!("CARGO_BIN_EXE_regrasp"))
        .args(arguments.split_whitespace())
        .current_dir(folder)
        .output()
        .unwrap();
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    (output.status.code().unwrap_or(-1), text(&output.stdout), text(&output.stderr))
}

#[test]
fn the_command_reports_segments_and_ends_with_4_where_the_object_does_not_arrive() {
    let folder = tempfile::tempdir().unwrap();
    let plan = balanced("sphere", 2);
    regrasp::plan::write(&folder.path().join("plan.json"), &plan).unwrap();
    let run = |arguments: &str| command(folder.path(), arguments);
    let (code, out, err) = run("replay plan.json -o replay.json");
    assert_eq!((code, err.as_str()), (0, ""));
    assert!(
        out.contains("the object arrives") && out.contains("transfer") && out.contains("regrasp"),
        "{out}"
    );
    let file = std::fs::read_to_string(folder.path().join("replay.json")).unwrap();
    let file: serde_json::Value = serde_json::from_str(&file).unwrap();
    let segments = file["segments"].as_array().unwrap();
    assert_eq!((segments.len(), file["arrived"].as_bool()), (plan.segments.len(), Some(true)));
    for (told, planned) in segments.iter().zip(&plan.segments) {
        assert!(told["object"].as_array().unwrap().len() >= planned.states.len());
        assert!(told["distance_m"].as_f64().unwrap() < 5e-3 && told["failure"].is_null());
    }
    let (code, out, err) = run("replay plan.json --json --friction-scale 0.1");
    let told: serde_json::Value = serde_json::from_str(&out).unwrap();
    assert!(code == 4 && told["arrived"] == false && told["assumed"]["friction"].as_f64().unwrap() < 0.1);
    assert!(err.contains("does not arrive: dropped in segment") && told["reason"] == err.trim_end(), "{err}");
    for (bad, word) in [
        ("replay plan.json --slowdown 0", "slowdown"),
        ("replay plan.json --gravity 1,2", "gravity"),
        ("replay plan.json --mass-scale much", "mass-scale"),
        ("replay nothing.json", "nothing.json"),
        ("replay plan.json -o no/where.json", "where.json"),
    ] {
        let (code, _, err) = run(bad);
        assert!(code == 2 && err.contains(word), "{bad}: {err}");
    }
    // Where nothing weighs anything, mass does not matter at this pace.
    assert_eq!(run("replay plan.json --gravity 0,0,0 --mass-scale 2").0, 0);
}
