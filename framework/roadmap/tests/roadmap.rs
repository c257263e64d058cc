//! Roadmaps of built-in problems: what they are bound to, that they are the same however they were grown, and
//! that plans through them verify.

use regrasp_contact_models as _;
use regrasp_graph_strategies as _;
use regrasp_local_planners as _;
use regrasp_samplers as _;
use regrasp_stability_tests as _;
use regrasp_surfaces as _;

use regrasp_api::{GoalDescription, PoseDescription, Problem};
use regrasp_host::Registry;
use regrasp_planner::roadmap::{Grown, Roadmap, RoadmapGraph, Through, grow, learn, pairs};
use regrasp_planner::{Clock, Request, Silent, Status, solve_through};
use regrasp_roadmap::{Difference, Identity, RoadmapError, judge, load, save};
use regrasp_run::scenario::{self, Scenario};
use regrasp_run::{NeverStops, RunOptions, Setup};

struct Zero;

impl Clock for Zero {
    fn seconds(&self) -> f64 {
        0.0
    }
}

fn options(threads: usize) -> RunOptions<'static> {
    RunOptions { seed: 3, threads, stop: &NeverStops, clock: &Zero, progress: &Silent }
}

fn scenario(name: &str) -> Scenario {
    scenario::load(name, &Registry::linked().unwrap()).unwrap()
}

fn setup(scenario: &Scenario) -> Setup<'_> {
    Setup::new(scenario, &scenario.choices, &Registry::linked().unwrap()).unwrap()
}

/// Grows by steps to these numbers of nodes.
fn grown(setup: &Setup<'_>, steps: &[usize], threads: usize) -> Roadmap {
    let mut roadmap = Roadmap::new(setup.hand(), 5);
    for &nodes in steps {
        let grow = |request: &Request<'_>| grow(request, &mut roadmap, nodes, &mut |_| true);
        assert_eq!(setup.ask(&options(threads), grow).unwrap(), Grown::Enough);
        assert_eq!(roadmap.node_count(), nodes);
    }
    roadmap
}

#[test]
fn a_roadmap_is_the_same_in_pieces_and_on_threads() {
    let scenario = scenario("sphere");
    let setup = setup(&scenario);
    let whole = grown(&setup, &[50], 1);
    assert!(whole.edge_count() > 40, "{} edges", whole.edge_count());
    assert!(whole == grown(&setup, &[7, 41, 50], 1), "in pieces");
    assert!(whole == grown(&setup, &[50], 2), "on two threads");
    let mut other = Roadmap::new(setup.hand(), 6);
    let grow = |request: &Request<'_>| grow(request, &mut other, 50, &mut |_| true);
    setup.ask(&options(1), grow).unwrap();
    assert!(whole != other, "another seed");
}

#[test]
fn a_killed_run_goes_on_from_what_was_saved() {
    let scenario = scenario("sphere");
    let setup = setup(&scenario);
    let folder = tempfile::tempdir().unwrap();
    let (path, identity) = (folder.path().join("sphere.roadmap"), Identity::of(&setup, 5));
    let mut roadmap = Roadmap::new(setup.hand(), 5);
    // What is grown after the last time that it was saved is lost with the process.
    let mut saved = 0;
    let mut told = |roadmap: &Roadmap| {
        if saved == 0 {
            save(&path, roadmap, &identity).unwrap();
            saved = roadmap.node_count();
        }
        roadmap.node_count() < 70
    };
    let ended = setup.ask(&options(1), |request| grow(request, &mut roadmap, 100, &mut told)).unwrap();
    assert_eq!(ended, Grown::Interrupted);
    let (mut again, of) = load(&path).unwrap();
    assert_eq!((of.difference_to_grow(&identity), again.node_count()), (None, saved));
    assert!(saved < roadmap.node_count());
    setup.ask(&options(1), |request| grow(request, &mut again, 100, &mut |_| true)).unwrap();
    assert!(again == grown(&setup, &[100], 1), "as if nothing had happened");
}

#[test]
fn roadmaps_of_other_problems_are_told_by_what_is_different() {
    let sphere = scenario("sphere");
    let of = |scenario: &Scenario, seed| Identity::of(&setup(scenario), seed);
    let own = of(&sphere, 5);
    let mut goals = scenario("sphere");
    goals.problem.goal[0].pose.angle_deg = Some(30.0);
    assert_eq!(of(&goals, 5).difference_to_grow(&own), None, "goals do not count");
    assert!(matches!(of(&scenario("cubic"), 5).difference(&own), Some(Difference::Object(..))));
    assert!(matches!(of(&scenario("allegro-ball"), 5).difference(&own), Some(Difference::Hand(..))));
    let mut settings = scenario("sphere");
    settings.problem.limits.resolution.friction_margin = 0.9;
    assert_eq!(of(&settings, 5).difference(&own), Some(Difference::Settings));
    let mut budget = scenario("sphere");
    budget.problem.limits.budget.max_nodes = 7;
    assert_eq!(of(&budget, 5).difference(&own), None, "budgets change nothing of what is found");
    assert_eq!(of(&sphere, 6).difference_to_grow(&own), Some(Difference::Sampling));
    let difference = of(&scenario("cubic"), 5).difference(&own).unwrap();
    let said = RoadmapError::Other { path: "a.roadmap".into(), difference }.to_string();
    assert!(said.contains("`ball`") && said.contains("`cube`") && said.contains("regrasp roadmap"), "{said}");
}

#[test]
fn plans_through_a_roadmap_verify() {
    for (name, nodes, least) in [("sphere", 150, 8), ("cubic", 150, 5)] {
        let scenario = scenario(name);
        let setup = setup(&scenario);
        let roadmap = grown(&setup, &[nodes], 2);
        let pairs = setup.ask(&options(1), |request| pairs(request, 10)).unwrap();
        let standing = judge(&setup, (&roadmap, nodes), &pairs, &options(1)).unwrap();
        let solved = standing.attempts.iter().filter(|attempt| attempt.solved).count();
        assert!(solved >= least, "{name}: {solved} of 10");
        let fewer = judge(&setup, (&roadmap, 10), &pairs, &options(1)).unwrap();
        assert_eq!(fewer.nodes, 10);
        assert_eq!(fewer.components.iter().sum::<usize>(), 10);
    }
}

#[test]
fn a_way_that_is_not_known_is_searched_and_learnt() {
    let scenario = scenario("sphere");
    let setup = setup(&scenario);
    let mut roadmap = Roadmap::new(setup.hand(), 5);
    let goal =
        PoseDescription { position: [0.0, 0.0, 0.085], axis: Some([0.0, 0.0, 1.0]), ..Default::default() };
    let goal = GoalDescription { pose: PoseDescription { angle_deg: Some(170.0), ..goal }, grasp: None };
    let problem = Problem { goal: vec![goal], ..scenario.problem.clone() };
    let plan = |roadmap: &Roadmap, alone| {
        let graph = RoadmapGraph::new(roadmap, usize::MAX, scenario.object.mesh.radius());
        let through = Through { graph: &graph, alone };
        setup
            .run_problem(&problem, &|request: &Request<'_>| solve_through(request, through), &options(1))
            .unwrap()
    };
    assert_eq!(plan(&roadmap, true).outcome.status, Status::NoPlan);
    let searched = plan(&roadmap, false);
    assert!(searched.is_verified() && searched.outcome.warnings.iter().any(|w| w.contains("no way")));
    let learnt = setup.ask(&options(1), |request| learn(request, &mut roadmap, &searched.outcome.motion));
    assert!(learnt.unwrap() > 2 && roadmap.learnt() as usize == roadmap.node_count());
    let known = plan(&roadmap, true);
    assert!(known.outcome.status == Status::Solved && known.is_verified());
}
