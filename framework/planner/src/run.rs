//! A run from start to last goal: one search a goal, then smoothing and timing of the whole.

use crate::draft::{Draft, Mark};
use crate::endpoints::Finder;
use crate::error::{End, PlanError};
use crate::graph::Graph;
use crate::report::{Phase, Stuck};
use crate::request::Request;
use crate::roadmap::Through;
use crate::search::{Budget, Ended, Leg, Search, State};
use crate::session::{Call, Session};
use regrasp_api::{CallError, EdgeId, FingerSet, NodeId, Pose, Random, SearchPolicy, Tally, Task};
use regrasp_plan::{Segment, Statistics};
use std::collections::BTreeSet;

/// Samples of the graph between the quick relays and the thorough ones. Our choice: most problems that the
/// graph solves sooner than these need fewer.
const FIRST_LOOK: usize = 15;

/// Why the legs ended before the last goal.
pub(crate) enum Halt {
    Stuck(Stuck),
    Failed(PlanError),
}

impl From<CallError> for Halt {
    fn from(error: CallError) -> Self {
        Self::Failed(error.into())
    }
}

impl From<PlanError> for Halt {
    fn from(error: PlanError) -> Self {
        Self::Failed(error)
    }
}

/// A run: what is planned, and how far it is.
pub(crate) struct Run<'a> {
    pub request: &'a Request<'a>,
    /// The roadmap to plan through, if there is one.
    pub through: Option<Through<'a>>,
    pub session: Session<'a>,
    pub task: Task<'a>,
    pub poses: &'a [Pose],
    pub choices: Vec<FingerSet>,
    /// The task, and the sets of fingers, for ends at which no grasp can be left in several ways.
    pub end_task: Task<'a>,
    pub end_choices: Vec<FingerSet>,
    pub policy: SearchPolicy,
    pub graph: Graph,
    pub draft: Draft,
    pub statistics: Statistics,
    pub tally: Tally,
    pub warnings: Vec<String>,
    /// For the record of the graph: the nodes of start and goals, and the edges of the ways found.
    pub ends: Vec<(End, NodeId)>,
    pub used: BTreeSet<EdgeId>,
}

impl Run<'_> {
    /// Plans through all goals, as far as it gets.
    pub fn legs(&mut self) -> Result<(), Halt> {
        let mut at = None;
        for leg in 0..self.request.problem.goal.len() {
            at = Some(self.leg(leg, at)?);
        }
        Ok(())
    }

    /// One leg, from the node `at` or, for the first, from the start: the node in which it ends.
    ///
    /// Where a search grows long without a plan it is begun anew in streams of its own, with other grasps at
    /// its ends: what was drawn first may be a dead end, and nobody knows. All rounds together spend the
    /// leg's budget.
    fn leg(&mut self, leg: usize, at: Option<NodeId>) -> Result<NodeId, Halt> {
        if let Some(through) = self.through
            && let Some((start, segments)) =
                self.timed(Phase::Roadmap, |run| run.through_roadmap(leg, at, through))?
        {
            return Ok(self.reached(leg, start, segments));
        } else if let Some(through) = self.through {
            self.roadmap_failed(leg, through)?;
        }
        let mut budget = Budget { most: self.request.problem.limits.budget.max_nodes, ..Default::default() };
        let ended = self.rounds(leg, at, &mut budget);
        self.count(&budget);
        ended
    }

    /// What is done where the roadmap knows no way.
    fn roadmap_failed(&mut self, leg: usize, through: Through<'_>) -> Result<(), Halt> {
        if through.alone {
            return Err(Halt::Stuck(Stuck::Search(leg)));
        }
        self.warnings.push(format!(
            "the roadmap of {} nodes knows no way to `goal[{leg}]`, which was searched as without it; a \
             larger roadmap knows more",
            through.graph.node_count()
        ));
        Ok(())
    }

    fn rounds(&mut self, leg: usize, at: Option<NodeId>, budget: &mut Budget) -> Result<NodeId, Halt> {
        let before = self.graph.node_count();
        loop {
            self.session.seed = seed_of_round(self.request.seed, budget.rounds);
            let first = if self.relays(leg) > 0 { FIRST_LOOK } else { 0 };
            budget.begin_round(self.policy.restart_samples, first);
            let start = self.timed(Phase::Endpoints, |run| run.start_of(at))?;
            if let Some(segments) = self.timed(Phase::Relay, |run| run.relayed(leg, start, budget.rounds))? {
                return Ok(self.reached(leg, start, segments));
            }
            let (goals, finder) = self.timed(Phase::Endpoints, |run| run.goals_of(leg, start))?;
            let ended = self.timed(Phase::Search, |run| run.search((leg, start), goals, finder, budget))?;
            match ended {
                Ended::Found(segments) => {
                    let segments =
                        self.timed(Phase::Relay, |run| run.with_relayed_end(leg, start, segments))?;
                    return Ok(self.reached(leg, start, segments));
                }
                Ended::Stopped => return Err(Halt::Stuck(Stuck::Search(leg))),
                Ended::Anew => self.graph.truncate(before),
            }
        }
    }

    /// Takes a leg's segments into the motion: the node in which they end.
    fn reached(&mut self, leg: usize, start: NodeId, segments: Vec<Segment>) -> NodeId {
        let grasp_given = self.request.problem.goal[leg].grasp.is_some();
        self.draft.segments.extend(segments);
        self.draft.marks.push(Mark { boundary: self.draft.segments.len(), grasp_given });
        let end = self.draft.segments.last().and_then(|segment| segment.states.last());
        let is_end = |node: &NodeId| Some(self.graph.node(*node)) == end;
        self.graph.ids().find(is_end).unwrap_or(start)
    }

    fn search(
        &mut self,
        (leg, start): (usize, NodeId),
        goals: Vec<NodeId>,
        finder: Option<Finder>,
        budget: &mut Budget,
    ) -> Result<Ended, CallError> {
        let landmarks = &self.poses[leg..leg + 2];
        let task = Task { landmarks, ..self.task };
        let mut search = Search {
            session: &self.session,
            progress: self.request.progress,
            leg: Leg { number: leg, task, start, choices: &self.choices, policy: self.policy },
            state: State {
                graph: &mut self.graph,
                goals,
                finder,
                drawn: Default::default(),
                tally: &mut self.tally,
                history: Vec::new(),
                warnings: &mut self.warnings,
                used: Vec::new(),
            },
            budget,
        };
        let ended = search.run();
        let State { used, goals, .. } = search.state;
        if !matches!(ended, Ok(Ended::Anew)) {
            self.used.extend(used);
            self.ends.extend((leg == 0).then_some((End::Start, start)));
            self.ends.extend(goals.into_iter().map(|goal| (End::Goal(leg), goal)));
        }
        ended
    }

    fn count(&mut self, budget: &Budget) {
        self.statistics.generated_nodes += budget.generated;
        let roadmap = &mut self.statistics.roadmap;
        roadmap.kept_nodes += budget.kept;
        roadmap.decompositions += budget.decompositions.0;
        roadmap.failed_decompositions += budget.decompositions.1;
        roadmap.restarts += budget.rounds.saturating_sub(1) as usize;
    }

    /// Does `work`, and adds the time it takes to the phase.
    pub fn timed<T>(&mut self, phase: Phase, work: impl FnOnce(&mut Self) -> T) -> T {
        let begin = self.request.clock.seconds();
        let done = work(self);
        *self.statistics.time_s.entry(phase.name().into()).or_default() +=
            self.request.clock.seconds() - begin;
        done
    }
}

/// The seed of all streams of a round: the run's own for the first.
fn seed_of_round(seed: u64, round: u64) -> u64 {
    if round == 0 { seed } else { Random::from_key(seed, Call::Round as u64, round, 0).word() }
}
