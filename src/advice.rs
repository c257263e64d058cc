//! What to try where a run found no plan.

use crate::api::{Reason, Slot};
use crate::plan::{Statistics, StoppedBy};
use crate::planner::{Status, Stuck};
use crate::run::Run;
use crate::run::scenario::Scenario;

/// What is worth trying after a run that is not solved, from where it got stuck and what it rejected most;
/// options of the command line stand in backquotes.
pub fn advice(run: &Run) -> String {
    let outcome = &run.outcome;
    let cause = most_frequent(&outcome.statistics);
    let place = match outcome.stuck {
        Some(Stuck::StartGrasp) => "the start pose",
        _ => "the goal pose",
    };
    match (outcome.stuck, cause) {
        (Some(Stuck::StartGrasp | Stuck::GoalGrasp(_)), Some(Reason::Reach | Reason::Limits)) => {
            format!("most grasps are out of reach: move {place} closer to the hand")
        }
        (Some(Stuck::StartGrasp | Stuck::GoalGrasp(_)), Some(Reason::Collision | Reason::Retreat)) => {
            format!(
                "most grasps collide: move {place} away from palm and obstacles, or lower \
                `limits.resolution.clearance`"
            )
        }
        (Some(Stuck::StartGrasp | Stuck::GoalGrasp(_)), _) => {
            format!("change {place}, or raise the friction")
        }
        _ if run.stopped_by == Some(StoppedBy::MaxNodes) && mostly_collides(&outcome.statistics) => {
            "most motions collide: look whether palm, obstacles and fingers leave a way; if they do, raise \
                `--max-nodes` or add a goal \
             half way"
                .into()
        }
        _ => format!("{}, try another `--seed`, or add a goal half way", more_budget(run.stopped_by)),
    }
}

/// Coefficients of friction that [`needed_friction`] tries.
const FRICTIONS: [f64; 11] = [0.1, 0.15, 0.2, 0.25, 0.3, 0.4, 0.5, 0.6, 0.8, 1.0, 1.5];
/// The nodes that each of them may generate.
const NODES_OF_A_TRY: usize = 64;
/// The time (s) that each of them may take.
const TIME_OF_A_TRY: f64 = 2.0;

/// What more friction would bring.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Needed {
    /// At this coefficient grasps are found at start and goal.
    ForGrasps(f64),
    /// At this coefficient there is a plan.
    ForPlan(f64),
}

/// Where a run found no grasp at start or goal, or no way between them, and most of what it rejected was not
/// stable: the least of some coefficients of friction that would do, the rest of the problem being as it is;
/// `None` where stability is not what most grasps lack, or no friction helps.
///
/// It tries them, in a second or two each at most.
pub fn needed_friction(scenario: &Scenario, run: &Run) -> Option<Needed> {
    let lacks_grasps = |run: &Run| matches!(run.outcome.stuck, Some(Stuck::StartGrasp | Stuck::GoalGrasp(_)));
    let cause = most_frequent(&run.outcome.statistics);
    if !matches!(cause, Some(Reason::Stability | Reason::Liftable)) {
        return None;
    }
    let mut other = scenario.clone();
    let budget = &mut other.problem.limits.budget;
    budget.max_nodes = budget.max_nodes.min(NODES_OF_A_TRY);
    budget.time_limit = Some(TIME_OF_A_TRY);
    let mut tried = |friction: f64| {
        (other.problem.object.friction, other.object.friction) = (friction, friction);
        crate::solve(&other, 0).ok()
    };
    let given = scenario.problem.object.friction;
    let mut greater = FRICTIONS.into_iter().filter(|friction| *friction > given);
    if lacks_grasps(run) {
        return greater.find(|&mu| tried(mu).is_some_and(|run| !lacks_grasps(&run))).map(Needed::ForGrasps);
    }
    let mut is_solved = |friction: f64| {
        tried(friction).is_some_and(|run| run.outcome.status == Status::Solved && run.is_verified())
    };
    // Where the most friction does not help, none does, and nothing is tried in vain.
    if !mostly_unstable(&run.outcome.statistics) || !is_solved(FRICTIONS[FRICTIONS.len() - 1]) {
        return None;
    }
    greater.find(|&friction| is_solved(friction)).map(Needed::ForPlan)
}

/// How to raise the budget that ended the run.
fn more_budget(stopped_by: Option<StoppedBy>) -> &'static str {
    match stopped_by {
        Some(StoppedBy::MaxNodes) => "raise `--max-nodes`",
        Some(StoppedBy::TimeLimit) => "raise `--time-limit`",
        _ => "give it more time",
    }
}

fn most_frequent(statistics: &Statistics) -> Option<Reason> {
    let sampler = statistics.plugins.get(&Slot::Sampler)?;
    sampler.rejections.iter().max_by_key(|&(_, count)| count).map(|(&reason, _)| reason)
}

/// Whether nine of ten grasps that the sampler refused were not stable enough.
fn mostly_unstable(statistics: &Statistics) -> bool {
    let Some(sampler) = statistics.plugins.get(&Slot::Sampler) else { return false };
    let count = |reason: Reason| sampler.rejections.get(&reason).copied().unwrap_or(0);
    let unstable = count(Reason::Stability) + count(Reason::Liftable);
    10 * unstable >= 9 * sampler.rejections.values().sum::<u64>()
}

/// Whether more than half of what the local planners refused collided.
fn mostly_collides(statistics: &Statistics) -> bool {
    let planners = [Slot::GraspPlanner, Slot::TransferPlanner, Slot::RegraspPlanner];
    let refused = planners.iter().filter_map(|slot| statistics.plugins.get(slot)).map(|p| &p.rejections);
    let (all, collided) = refused.fold((0, 0), |(all, collided), counts| {
        (all + counts.values().sum::<u64>(), collided + counts.get(&Reason::Collision).copied().unwrap_or(0))
    });
    2 * collided > all
}
