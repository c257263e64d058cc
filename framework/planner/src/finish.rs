//! The end of a run: what was found is smoothed, timed and counted.

use crate::draft::regrasps;
use crate::error::PlanError;
use crate::glide::glide;
use crate::record::GraphRecord;
use crate::report::{Outcome, Phase, Status};
use crate::run::{Halt, Run};
use crate::smooth::Smoother;
use regrasp_api::{CallError, EdgeKind};
use regrasp_plan::{Motion, TimingLimits, assign_times, plugin_statistics};

impl Run<'_> {
    /// Smooths and times what was found, and reports how the run ended.
    pub fn finish(mut self, ended: Result<(), Halt>) -> Result<Outcome, PlanError> {
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
        glide(&self.session, &self.task, &mut self.draft.segments)?;
        self.draft.align_quaternions();
        let mut motion = Motion { segments: std::mem::take(&mut self.draft.segments) };
        self.timed(Phase::Timing, |run| {
            assign_times(
                &mut motion,
                run.request.hand,
                &TimingLimits::within(&run.request.problem.limits.tolerances),
            )
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
        let kinds = |kind| {
            self.used.iter().filter(|&&id| self.graph.edge(id).is_some_and(|e| e.kind == kind)).count()
        };
        let roadmap = &mut self.statistics.roadmap;
        (roadmap.grasp_components, roadmap.largest_grasp_component) = self.graph.grasp_components();
        roadmap.used_grasp_edges = kinds(EdgeKind::Grasp);
        roadmap.used_transfer_edges = kinds(EdgeKind::TransferRegrasp);
        self.statistics.regrasps_before_smoothing = regrasps(&self.draft.segments);
    }

    fn smooth(&mut self) -> Result<(), CallError> {
        if self.draft.segments.is_empty() {
            return Ok(());
        }
        self.request.progress.smoothing(self.draft.segments.len());
        let tries = self.request.problem.limits.budget.smoothing * self.draft.segments.len();
        let mut smoother = Smoother {
            session: &self.session,
            task: &self.task,
            draft: std::mem::take(&mut self.draft),
            failed: Default::default(),
        };
        let smoothed = smoother.run(tries, &mut self.tally);
        self.draft = smoother.draft;
        smoothed
    }
}
