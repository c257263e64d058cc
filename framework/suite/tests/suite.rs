//! Protocols run: the same on any number of threads; chains go on from where they ended.

use regrasp_contact_models as _;
use regrasp_graph_strategies as _;
use regrasp_host::Registry;
use regrasp_local_planners as _;
use regrasp_plan::Plan;
use regrasp_planner::Clock;
use regrasp_run::NeverStops;
use regrasp_samplers as _;
use regrasp_stability_tests as _;
use regrasp_suite::{
    Files, Options, Outcome, Problems, Protocol, Published, Replayed, Series, Told, Trial, Unreplayable,
    World, journal, run, scenarios,
};
use regrasp_surfaces as _;
use std::ops::ControlFlow;
use std::sync::Mutex;

/// Time stands still.
struct Still;

impl Clock for Still {
    fn seconds(&self) -> f64 {
        0.0
    }
}

/// Turns of 60° on and on, and turns about random axes.
fn protocol() -> Protocol {
    let series = |name: &str, problems| Series {
        name: name.into(),
        scenario: "sphere".into(),
        preset: None,
        max_nodes: Some(20),
        problems,
        published: vec![Published {
            what: "goals".into(),
            figure: "1".into(),
            world: World::Model,
            method: "none".into(),
        }],
    };
    let axis = [0.0, 0.0, 1.0];
    let on_and_on = Problems::Continuing { trials: 1, most: 3, axis, step_deg: 60.0 };
    let random = Problems::Random { count: 3, angle_deg: Some([10.0, 60.0]), displacement: [0.0, 0.005] };
    Protocol {
        title: String::new(),
        paper: String::new(),
        like: String::new(),
        chosen: String::new(),
        series: vec![series("on", on_and_on), series("random", random)],
    }
}

fn trials(threads: usize, told: Told<'_>) -> Vec<Trial> {
    go_on(Vec::new(), threads, told)
}

fn go_on(known: Vec<Trial>, threads: usize, told: Told<'_>) -> Vec<Trial> {
    let arrives = |_: &Plan| Ok(Replayed { arrived: true, distance: 0.0, angle: 0.0 });
    let options = Options { threads, stop: &NeverStops, clock: &Still, judge: Some(&arrives), told };
    let registry = Registry::linked().unwrap();
    let scenarios = scenarios(&protocol(), &Files::BuiltIn(&[]), &registry).unwrap();
    run(&protocol(), &scenarios, &registry, known, &options).unwrap()
}

/// Takes notice, and wants more.
fn more(_: &Trial, _: &[Plan]) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

#[test]
fn trials_are_the_same_on_two_threads_and_counted() {
    let one = trials(1, &more);
    assert_eq!(one, trials(2, &more));
    assert_eq!(one.len(), 4);
    let outcome = Outcome::of(&protocol().series[0], &[&one[0]]);
    assert_eq!(outcome.chain.map(|chain| chain.mean), Some(3.0), "{one:?}");
    assert_eq!(outcome.revolutions.map(|turns| turns.mean), Some(0.5));
    assert_eq!(outcome.arrived, Some(3));
}

#[test]
fn a_plan_that_cannot_be_replayed_ends_nothing_and_says_why() {
    let why = Unreplayable("points stay where they are set down".into());
    let refuses = |_: &Plan| Err(why.clone());
    let options =
        Options { threads: 1, stop: &NeverStops, clock: &Still, judge: Some(&refuses), told: &more };
    let registry = Registry::linked().unwrap();
    let of = scenarios(&protocol(), &Files::BuiltIn(&[]), &registry).unwrap();
    let all = run(&protocol(), &of, &registry, Vec::new(), &options).unwrap();
    assert_eq!(all.len(), 4);
    let attempt = &all[0].attempts[0];
    assert!(attempt.solved && attempt.replayed.is_none());
    assert_eq!(attempt.unreplayable, Some(why));
}

#[test]
fn each_goal_of_a_chain_begins_where_the_one_before_ended() {
    let chains = Mutex::new(Vec::new());
    trials(1, &|trial, plans| {
        if trial.series == 0 {
            chains.lock().unwrap().push(plans.to_vec());
        }
        ControlFlow::Continue(())
    });
    let plans = chains.into_inner().unwrap().remove(0);
    assert_eq!(plans.len(), 3);
    for pair in plans.windows(2) {
        let end = pair[0].segments.last().unwrap().states.last().unwrap();
        let begin = &pair[1].segments.first().unwrap().states[0];
        // The start's grasp is given as points and joints, and made exact again: the object stays, joints are
        // found anew near what they were.
        let apart = |k: usize| (end.object.position[k] - begin.object.position[k]).abs();
        assert!((0..3).all(|k| apart(k) < 1e-9));
        for (a, b) in end.joints.iter().flatten().zip(begin.joints.iter().flatten()) {
            assert!((a - b).abs() < 0.05, "{a} {b}");
        }
    }
}

#[test]
fn a_run_that_was_ended_goes_on_from_its_journal() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("results.part");
    let registry = Registry::linked().unwrap();
    let of = scenarios(&protocol(), &Files::BuiltIn(&[]), &registry).unwrap();
    let open = |way: &str| journal(&path, &protocol(), &of, way, false);
    let kept = Mutex::new(open("replayed").unwrap().0);
    let two = trials(1, &|trial, _| {
        kept.lock().unwrap().append(trial).unwrap();
        if trial.series == 1 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    assert_eq!(two.len(), 2);
    drop(kept);
    assert!(open("not replayed").is_err(), "other work");
    let (_, known) = open("replayed").unwrap();
    assert_eq!(known, two);
    let made = Mutex::new(0);
    let all = go_on(known, 1, &|_, _| {
        *made.lock().unwrap() += 1;
        ControlFlow::Continue(())
    });
    assert_eq!((all.len(), made.into_inner().unwrap()), (4, 2));
    assert_eq!(all, trials(1, &more));
}
