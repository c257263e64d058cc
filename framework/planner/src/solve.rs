//! A whole run: start and goals, one search a goal, smoothing, timing.

use crate::admissible::Leavable;
use crate::draft::{Draft, Mark, regrasps};
use crate::endpoints::{self, Finder};
use crate::error::{End, PlanError};
use crate::graph::Graph;
use crate::record::GraphRecord;
use crate::report::{Clock, Outcome, Progress, Status, Stuck};
use crate::search::Search;
use crate::session::{Call, Drivers, Session, leg_task};
use crate::smooth::Smoother;
use regrasp_api::{
    Admissible, CallError, Clearance, Configuration, ContactModel, EdgeId, FingerGrasp, FingerSet,
    GuardedService, Hand, Interrupt, NodeId, ObjectModel, Pose, PoseDescription, Problem, StabilityTest,
    SurfaceParam, Tally, Task, Vec3, unless_fault,
};
use regrasp_plan::{Motion, Segment, Statistics, TimingLimits, assign_times, plugin_statistics};
use std::collections::BTreeSet;

/// How many grasps are looked for at a start given by its pose alone; the search begins in the one from which the object seems to roll farthest
/// towards the first goal.
const FIRST_STARTS: usize = 12;
/// How many grasps are looked for at a goal given by its pose alone before the search starts: a grasp costs a hundredth of a plan,
/// and of the paper's problems all need fewer nodes, regrasps and instructions with six than with two or twelve.
const FIRST_GOALS: usize = 6;

/// Everything a run needs.
#[derive(Clone, Copy)]
pub struct Request<'a> {
    /// Start, goals, gravity, workspace and limits; hand and object are taken from below.
    pub problem: &'a Problem,
    /// The hand.
    pub hand: &'a dyn Hand,
    /// Collision and distance, built with the planner's clearance.
    pub clearance: &'a dyn Clearance,
    /// The object.
    pub object: &'a ObjectModel,
    /// Which wrenches contacts transmit.
    pub contact_model: &'a dyn ContactModel,
    /// Which grasps are stable.
    pub stability: &'a dyn StabilityTest,
    /// The object's surface.
    pub surface: &'a dyn SurfaceParam,
    /// The plugins that drive the search.
    pub drivers: Drivers<'a>,
    /// Seed of all random streams.
    pub seed: u64,
    /// How many threads compute; the result does not depend on it.
    pub threads: usize,
    /// Stops the run from outside.
    pub interrupt: &'a dyn Interrupt,
    /// Times the phases.
    pub clock: &'a dyn Clock,
    /// Told how far the run is.
    pub progress: &'a dyn Progress,
}

/// Plans a motion from the start through all goals.
pub fn solve(request: &Request<'_>) -> Result<Outcome, PlanError> {
    let poses = poses(request.problem)?;
    // A sampler from a library asks for admission in its own binary, which a panic could not leave.
    let admissible = GuardedService(&Leavable as &dyn Admissible);
    let task = Task {
        hand: request.hand,
        clearance: request.clearance,
        contact_model: request.contact_model,
        stability: request.stability,
        surface: request.surface,
        admissible: &admissible,
        object: request.object,
        g_H: Vec3::from(request.problem.gravity),
        tolerances: &request.problem.limits.tolerances,
        resolution: &request.problem.limits.resolution,
        workspace: request.problem.sampling_box(&poses),
        landmarks: &poses,
    };
    let choices = finger_choices(&task)?;
    let session = Session {
        drivers: request.drivers,
        seed: request.seed,
        interrupt: request.interrupt,
        pool: pool(request.threads),
    };
    let mut run = Run {
        request,
        session: &session,
        task,
        poses: &poses,
        choices,
        graph: Graph::new(request.object.mesh.radius()),
        draft: Draft::default(),
        statistics: Statistics::default(),
        tally: Tally::default(),
        warnings: Vec::new(),
        ends: Vec::new(),
        used: BTreeSet::new(),
    };
    let ended = run.legs();
    run.finish(ended)
}

/// Start and goals as poses; two in turn that coincide are refused where no grasp tells them apart.
fn poses(problem: &Problem) -> Result<Vec<Pose>, PlanError> {
    let read = |end, pose: &PoseDescription| pose.pose().map_err(|reason| PlanError::Pose { end, reason });
    let mut poses = vec![read(End::Start, &problem.start.pose)?];
    for (index, goal) in problem.goal.iter().enumerate() {
        let pose = read(End::Goal(index), &goal.pose)?;
        let before = poses[index];
        let apart = (pose.translation.vector - before.translation.vector).norm()
            + regrasp_api::angle_between(&pose.rotation, &before.rotation);
        if apart < 1e-9 && goal.grasp.is_none() {
            return Err(PlanError::Coincide(index));
        }
        poses.push(pose);
    }
    Ok(poses)
}

/// The sets of fingers that may hold the object: GS_n and beyond.
fn finger_choices(task: &Task<'_>) -> Result<Vec<FingerSet>, PlanError> {
    let (fingers, fewest) = (task.hand.finger_count(), task.contact_model.fewest_contacts());
    if fingers < fewest + 1 {
        return Err(PlanError::TooFewFingers { fingers, fewest });
    }
    let all = FingerSet::first(fingers);
    let subsets = (0..=u8::MAX).map(FingerSet::from_bits).filter(|&set| set.intersection(all) == set);
    Ok(subsets.filter(|set| set.len() > fewest).collect())
}

fn pool(threads: usize) -> Option<rayon::ThreadPool> {
    // Where the system grants no threads the run goes on with one: the plan is the same.
    (threads > 1).then(|| rayon::ThreadPoolBuilder::new().num_threads(threads).build().ok()).flatten()
}

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

struct Run<'a> {
    request: &'a Request<'a>,
    session: &'a Session<'a>,
    task: Task<'a>,
    poses: &'a [Pose],
    choices: Vec<FingerSet>,
    graph: Graph,
    draft: Draft,
    statistics: Statistics,
    tally: Tally,
    warnings: Vec<String>,
    /// For the record of the graph: the nodes of start and goals, and the edges of the ways found.
    ends: Vec<(End, NodeId)>,
    used: BTreeSet<EdgeId>,
}

impl Run<'_> {
    fn legs(&mut self) -> Result<(), Halt> {
        let grasp = self.request.problem.start.grasp.as_deref();
        let (start, _) = self.timed("endpoints", |run| run.end(End::Start, grasp))?;
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
        let (goals, finder) = self.timed("endpoints", |run| run.end(End::Goal(leg), grasp))?;
        if goals.is_empty() {
            return Err(Halt::Stuck(Stuck::GoalGrasp(leg)));
        }
        let segments = self.timed("search", |run| run.search(leg, start, goals, finder))?;
        let segments = segments.ok_or(Halt::Stuck(Stuck::Search(leg)))?;
        self.draft.segments.extend(segments);
        self.draft.marks.push(Mark { boundary: self.draft.segments.len(), grasp_given: grasp.is_some() });
        let end = self.draft.segments.last().and_then(|segment| segment.states.last());
        let is_end = |node: &NodeId| Some(self.graph.node(*node)) == end;
        Ok((0..self.graph.node_count() as u32).map(NodeId).find(is_end).unwrap_or(start))
    }

    fn search(
        &mut self,
        leg: usize,
        start: NodeId,
        goals: Vec<NodeId>,
        finder: Option<Finder>,
    ) -> Result<Option<Vec<Segment>>, CallError> {
        let mut search = Search {
            session: self.session,
            task: leg_task(&self.task, &self.poses[leg..leg + 2]),
            graph: &mut self.graph,
            tally: &mut self.tally,
            leg: leg as u64,
            start,
            goals,
            finder,
            choices: &self.choices,
            max_nodes: self.request.problem.limits.budget.max_nodes,
            progress: self.request.progress,
            drawn: Default::default(),
            generated: 0,
            explored: 0,
            samples: 0,
            used: Vec::new(),
        };
        let found = search.run();
        self.statistics.generated_nodes += search.generated;
        self.used.extend(search.used);
        self.ends.extend(search.goals.iter().map(|&goal| (End::Goal(leg), goal)));
        found
    }

    /// The nodes of one end of the problem, those that seem easiest to leave first, and what finds more of them; one for the start.
    fn end(
        &mut self,
        end: End,
        grasp: Option<&[FingerGrasp]>,
    ) -> Result<(Vec<NodeId>, Option<Finder>), Halt> {
        let (kind, place, count) = match end {
            End::Start => (Call::Start, 0, FIRST_STARTS),
            End::Goal(index) => (Call::Goal, index + 1, FIRST_GOALS),
        };
        let X_HO = self.poses[place];
        if let Some(grasp) = grasp {
            let q = self.given(end, X_HO, grasp)?;
            return Ok((vec![self.graph.add_node(q)], None));
        }
        let leg = place.saturating_sub(1) as u64;
        let mut finder = Finder { kind, leg, X_HO, calls: 0 };
        let mut found = Vec::new();
        for _ in 0..count {
            found.extend(finder.next(self.session, &self.task, &self.choices, &mut self.tally)?);
        }
        endpoints::sort_by_ease(&self.task, &mut found, neighbours(self.poses, place));
        found.truncate(if end == End::Start { 1 } else { count });
        let nodes = found.into_iter().map(|q| self.graph.add_node(q)).collect();
        Ok((nodes, Some(finder)))
    }

    fn given(&mut self, end: End, X_HO: Pose, grasp: &[FingerGrasp]) -> Result<Configuration, PlanError> {
        let mut context = self.session.context(Call::Start, 1, 0);
        let q = endpoints::given(&self.task, end, X_HO, grasp, &mut context);
        // A plugin that panicked on the way made the verdict on the grasp worthless.
        unless_fault(Ok(()))?;
        let q = q?;
        self.warnings.extend(unless_fault(endpoints::warning(&self.task, end, &q, &mut context))?);
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
        match self.timed("smoothing", Self::smooth) {
            // Interrupted here, the motion is complete, only less smooth than it could be.
            Ok(()) | Err(CallError::Interrupted) => {}
            Err(error) => return Err(error.into()),
        }
        self.draft.align_quaternions();
        let mut motion = Motion { segments: std::mem::take(&mut self.draft.segments) };
        self.timed("timing", |run| assign_times(&mut motion, run.request.hand, &TimingLimits::default()))?;
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
    fn timed<T>(&mut self, phase: &str, work: impl FnOnce(&mut Self) -> T) -> T {
        let begin = self.request.clock.seconds();
        let done = work(self);
        *self.statistics.time_s.entry(phase.into()).or_default() += self.request.clock.seconds() - begin;
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
