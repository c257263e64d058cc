//! A run from start to last goal: one search a goal, then smoothing and timing of the whole.

use crate::draft::{Draft, Mark, regrasps};
use crate::endpoints::{self, Finder};
use crate::error::{End, PlanError};
use crate::graph::Graph;
use crate::record::GraphRecord;
use crate::report::{Outcome, Phase, Status, Stuck};
use crate::request::Request;
use crate::search::{Budget, Leg, Search, State};
use crate::session::{Call, Session};
use crate::smooth::Smoother;
use regrasp_api::{
    CallError, Configuration, EdgeId, FingerGrasp, FingerSet, NodeId, Origin, Pose, Tally, Task, unless_fault,
};
use regrasp_plan::{Motion, Segment, Statistics, TimingLimits, assign_times, plugin_statistics};
use std::collections::BTreeSet;

/// How many grasps are looked for at a start given by its pose alone; the search begins in the one from which the object seems to roll farthest
/// towards the first goal.
const FIRST_STARTS: usize = 12;
/// How many grasps are looked for at a goal given by its pose alone before the search starts: a grasp costs a hundredth of a plan,
/// and of the paper's problems all need fewer nodes, regrasps and instructions with six than with two or twelve.
const FIRST_GOALS: usize = 6;

/// The poses before and after the one at `place`.
fn neighbours(poses: &[Pose], place: usize) -> impl Iterator<Item = &Pose> + Clone {
    let around = place.saturating_sub(1)..poses.len().min(place + 2);
    around.filter(move |&k| k != place).map(|k| &poses[k])
}

/// Why the legs ended before the last goal.
enum Halt {
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
    pub session: &'a Session<'a>,
    pub task: Task<'a>,
    pub poses: &'a [Pose],
    pub choices: Vec<FingerSet>,
    /// The task, and the sets of fingers, for ends at which no grasp can be left in several ways.
    pub end_task: Task<'a>,
    pub end_choices: Vec<FingerSet>,
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
    /// Plans through all goals, as far as it gets; smooths and times what was found.
    pub fn to_the_end(mut self) -> Result<Outcome, PlanError> {
        let ended = self.legs();
        self.finish(ended)
    }

    fn legs(&mut self) -> Result<(), Halt> {
        let grasp = self.request.problem.start.grasp.as_deref();
        let (start, _) = self.timed(Phase::Endpoints, |run| run.end(End::Start, grasp))?;
        let mut node = *start.first().ok_or(Halt::Stuck(Stuck::StartGrasp))?;
        self.ends.push((End::Start, node));
        for leg in 0..self.request.problem.goal.len() {
            node = self.leg(leg, node)?;
        }
        Ok(())
    }

    /// One leg: the goal's grasps, the search, and the node in which it ends.
    fn leg(&mut self, leg: usize, start: NodeId) -> Result<NodeId, Halt> {
        let grasp = self.request.problem.goal[leg].grasp.as_deref();
        let (goals, finder) = self.timed(Phase::Endpoints, |run| run.end(End::Goal(leg), grasp))?;
        if goals.is_empty() {
            return Err(Halt::Stuck(Stuck::GoalGrasp(leg)));
        }
        let segments = self.timed(Phase::Search, |run| run.search(leg, start, goals, finder))?;
        let segments = segments.ok_or(Halt::Stuck(Stuck::Search(leg)))?;
        self.draft.segments.extend(segments);
        self.draft.marks.push(Mark { boundary: self.draft.segments.len(), grasp_given: grasp.is_some() });
        let end = self.draft.segments.last().and_then(|segment| segment.states.last());
        let is_end = |node: &NodeId| Some(self.graph.node(*node)) == end;
        Ok(self.graph.ids().find(is_end).unwrap_or(start))
    }

    fn search(
        &mut self,
        leg: usize,
        start: NodeId,
        goals: Vec<NodeId>,
        finder: Option<Finder>,
    ) -> Result<Option<Vec<Segment>>, CallError> {
        let landmarks = &self.poses[leg..leg + 2];
        let task = Task { landmarks, ..self.task };
        let mut search = Search {
            session: self.session,
            progress: self.request.progress,
            leg: Leg { number: leg, task, start, choices: &self.choices },
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
            budget: Budget { most: self.request.problem.limits.budget.max_nodes, ..Default::default() },
        };
        let found = search.run();
        self.statistics.generated_nodes += search.budget.generated;
        self.used.extend(search.state.used);
        self.ends.extend(search.state.goals.iter().map(|&goal| (End::Goal(leg), goal)));
        found
    }

    /// The nodes of one end of the problem, those that seem easiest to leave first, and what finds more of them; one for the start.
    fn end(
        &mut self,
        end: End,
        grasp: Option<&[FingerGrasp]>,
    ) -> Result<(Vec<NodeId>, Option<Finder>), Halt> {
        let (kind, place, count, origin) = match end {
            End::Start => (Call::Start, 0, FIRST_STARTS, Origin::Start),
            End::Goal(index) => (Call::Goal, index + 1, FIRST_GOALS, Origin::Goal),
        };
        let X_HO = self.poses[place];
        if let Some(grasp) = grasp {
            let q = self.given(end, X_HO, grasp)?;
            return Ok((vec![self.graph.add_node(q, origin)], None));
        }
        let leg = place.saturating_sub(1) as u64;
        let mut finder = Finder { kind, leg, X_HO, calls: 0 };
        let mut found = Vec::new();
        for _ in 0..count {
            found.extend(finder.next(self.session, &self.task, &self.choices, &mut self.tally)?);
        }
        if found.is_empty() {
            found = self.weaker_grasps(&mut finder, count)?;
        }
        endpoints::sort_by_ease(&self.task, &mut found, neighbours(self.poses, place));
        found.truncate(if end == End::Start { 1 } else { count });
        let nodes = found.into_iter().map(|q| self.graph.add_node(q, origin)).collect();
        Ok((nodes, Some(finder)))
    }

    /// Grasps in which a motion may begin or end, of n - 1 fingers too: where none was found that could be a node anywhere.
    fn weaker_grasps(&mut self, finder: &mut Finder, count: usize) -> Result<Vec<Configuration>, CallError> {
        let mut found = Vec::new();
        for _ in 0..count {
            found.extend(finder.next(self.session, &self.end_task, &self.end_choices, &mut self.tally)?);
        }
        Ok(found)
    }

    fn given(&mut self, end: End, X_HO: Pose, grasp: &[FingerGrasp]) -> Result<Configuration, PlanError> {
        let mut work = self.session.work(&self.task, (Call::Start, 1, 0));
        let q = endpoints::given(&mut work, end, X_HO, grasp);
        // A plugin that panicked on the way made the verdict on the grasp worthless.
        unless_fault(Ok(()))?;
        let q = q?;
        self.warnings.extend(unless_fault(endpoints::warning(&mut work, end, &q))?);
        Ok(q)
    }

    /// Smooths and times what was found, and reports how the run ended.
    fn finish(mut self, ended: Result<(), Halt>) -> Result<Outcome, PlanError> {
        let (status, stuck) = match ended {
            Ok(()) => (Status::Solved, None),
            Err(Halt::Stuck(stuck)) => (Status::NoPlan, Some(stuck)),
            Err(Halt::Failed(PlanError::Call(CallError::Interrupted))) => (Status::Interrupted, None),
            Err(Halt::Failed(error)) => return Err(error),
        };
        self.count_graph();
        match self.timed(Phase::Smoothing, Self::smooth) {
            // Interrupted here, the motion is complete, only less smooth than it could be.
            Ok(()) | Err(CallError::Interrupted) => {}
            Err(error) => return Err(error.into()),
        }
        self.draft.align_quaternions();
        let mut motion = Motion { segments: std::mem::take(&mut self.draft.segments) };
        self.timed(Phase::Timing, |run| {
            assign_times(&mut motion, run.request.hand, &TimingLimits::default())
        })?;
        self.statistics.regrasps = regrasps(&motion.segments);
        self.statistics.transfers = motion.segments.len() - self.statistics.regrasps;
        self.statistics.plugins = plugin_statistics(&self.tally);
        let goal_ends = self.draft.marks.iter().map(|mark| mark.boundary).collect();
        let Self { statistics, tally, warnings, graph, ends, used, .. } = self;
        let graph = GraphRecord::new(graph, ends, used);
        Ok(Outcome { status, stuck, motion, goal_ends, statistics, tally, graph, warnings })
    }

    fn count_graph(&mut self) {
        self.statistics.graph_nodes = self.graph.node_count();
        self.statistics.components = self.graph.components().len();
        self.statistics.regrasps_before_smoothing = regrasps(&self.draft.segments);
    }

    /// Does `work`, and adds the time it takes to the phase.
    fn timed<T>(&mut self, phase: Phase, work: impl FnOnce(&mut Self) -> T) -> T {
        let begin = self.request.clock.seconds();
        let done = work(self);
        *self.statistics.time_s.entry(phase.name().into()).or_default() +=
            self.request.clock.seconds() - begin;
        done
    }

    fn smooth(&mut self) -> Result<(), CallError> {
        if self.draft.segments.is_empty() {
            return Ok(());
        }
        self.request.progress.smoothing(self.draft.segments.len());
        let tries = self.request.problem.limits.budget.smoothing * self.draft.segments.len();
        let mut smoother = Smoother {
            session: self.session,
            task: &self.task,
            draft: std::mem::take(&mut self.draft),
            failed: Default::default(),
        };
        let smoothed = smoother.run(tries, &mut self.tally);
        self.draft = smoother.draft;
        smoothed
    }
}
