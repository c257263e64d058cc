//! How good a roadmap is: how many random problems it solves, how fast, and with how many regrasps.

use regrasp_api::{GoalDescription, PoseDescription, Problem};
use regrasp_planner::roadmap::{Pair, Roadmap, RoadmapGraph, Through};
use regrasp_planner::{Request, Status, solve_through};
use regrasp_run::{Run, RunError, RunOptions, Setup, start_at};

/// What became of one pair of start and goal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Attempt {
    /// Whether the roadmap knew a way and the verifier accepts the plan.
    pub solved: bool,
    /// Time for planning alone (s).
    pub planning_s: f64,
    /// Regrasps of the plan; 0 where there is none.
    pub regrasps: usize,
}

/// How the first nodes of a roadmap do.
#[derive(Clone, Debug, PartialEq)]
pub struct Standing {
    /// How many nodes.
    pub nodes: usize,
    /// Edges between them.
    pub edges: usize,
    /// How many nodes each component has, the largest first.
    pub components: Vec<usize>,
    /// What became of each pair.
    pub attempts: Vec<Attempt>,
}

/// Plans each pair through the first `nodes` of a roadmap, and through nothing else.
pub fn judge(
    setup: &Setup<'_>,
    (roadmap, nodes): (&Roadmap, usize),
    pairs: &[Pair],
    options: &RunOptions<'_>,
) -> Result<Standing, RunError> {
    let graph = RoadmapGraph::new(roadmap, nodes, setup.scenario().object.mesh.radius());
    let through = Through { graph: &graph, alone: true };
    let mut attempts = Vec::new();
    for pair in pairs {
        let problem = between(&setup.scenario().problem, pair);
        let solve = |request: &Request<'_>| solve_through(request, through);
        attempts.push(attempt(&setup.run_problem(&problem, &solve, options)?));
        if options.stop.interrupted() {
            break;
        }
    }
    let components = graph.components();
    Ok(Standing { nodes: graph.node_count(), edges: graph.edge_count(), components, attempts })
}

fn attempt(run: &Run) -> Attempt {
    let solved = run.outcome.status == Status::Solved && run.is_verified();
    let regrasps = if solved { run.outcome.statistics.regrasps } else { 0 };
    Attempt { solved, planning_s: run.planning_s, regrasps }
}

/// The problem with another start, its grasp given, and another goal, which any grasp may reach.
fn between(problem: &Problem, pair: &Pair) -> Problem {
    let goal = vec![GoalDescription { pose: PoseDescription::from(&pair.to.X_HO), grasp: None }];
    Problem { start: start_at(&pair.from), goal, ..problem.clone() }
}
