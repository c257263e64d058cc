//! The two ends of a leg: the nodes that it begins and ends in.

use crate::endpoints::{self, Finder};
use crate::error::{End, PlanError};
use crate::report::Stuck;
use crate::run::{Halt, Run};
use crate::session::Call;
use regrasp_api::{CallError, Configuration, FingerGrasp, NodeId, Origin, Pose, unless_fault};

/// The poses before and after the one at `place`.
fn neighbours(poses: &[Pose], place: usize) -> impl Iterator<Item = &Pose> + Clone {
    let around = place.saturating_sub(1)..poses.len().min(place + 2);
    around.filter(move |&k| k != place).map(|k| &poses[k])
}

impl Run<'_> {
    /// The node that a leg begins in: `at` where an earlier leg ended there.
    pub fn start_of(&mut self, at: Option<NodeId>) -> Result<NodeId, Halt> {
        if let Some(node) = at {
            return Ok(node);
        }
        let (found, _) = self.end(End::Start, self.request.problem.start.grasp.as_deref(), false)?;
        found.first().copied().ok_or(Halt::Stuck(Stuck::StartGrasp))
    }

    /// The goals of a leg, and what finds more of them.
    pub fn goals_of(&mut self, leg: usize, start: NodeId) -> Result<(Vec<NodeId>, Option<Finder>), Halt> {
        let grasp = self.request.problem.goal[leg].grasp.as_deref();
        let mut goals = Vec::new();
        if grasp.is_none() {
            goals.extend(self.same_grasp(start, leg)?);
        }
        let (found, finder) = self.end(End::Goal(leg), grasp, !goals.is_empty())?;
        goals.extend(found);
        if goals.is_empty() {
            return Err(Halt::Stuck(Stuck::GoalGrasp(leg)));
        }
        Ok((goals, finder))
    }

    /// The goal's own grasp, where the problem gives one.
    pub fn goal_given(&mut self, leg: usize) -> Result<Option<Configuration>, PlanError> {
        let grasp = self.request.problem.goal[leg].grasp.as_deref();
        grasp.map(|grasp| self.given(End::Goal(leg), self.poses[leg + 1], grasp)).transpose()
    }

    /// The contacts of the leg's start at its goal, if the object can be held there by them: the shortest of
    /// all plans may be one roll.
    fn same_grasp(&mut self, start: NodeId, leg: usize) -> Result<Option<NodeId>, Halt> {
        let X_HO = self.poses[leg + 1];
        let from = self.graph.node(start);
        let found = self.session.counted(&self.task, (Call::Goal, leg as u64, 1), |work| {
            endpoints::same_grasp(work, from, &X_HO)
        });
        self.tally.add(&found.tally);
        Ok(found.result?.map(|q| self.graph.add_node(q, Origin::Goal)))
    }

    /// The nodes of one end of the problem, those that seem easiest to leave first, and what finds more of
    /// them; one for the start.
    fn end(
        &mut self,
        end: End,
        grasp: Option<&[FingerGrasp]>,
        has_one: bool,
    ) -> Result<(Vec<NodeId>, Option<Finder>), Halt> {
        let (kind, place, count, origin) = match end {
            End::Start => (Call::Start, 0, self.policy.start_grasps, Origin::Start),
            End::Goal(index) => (Call::Goal, index + 1, self.policy.goal_grasps, Origin::Goal),
        };
        let X_HO = self.poses[place];
        if let Some(grasp) = grasp {
            let q = self.given(end, X_HO, grasp)?;
            return Ok((vec![self.graph.add_node(q, origin)], None));
        }
        let leg = place.saturating_sub(1) as u64;
        let mut finder = Finder::new(kind, leg, X_HO);
        let mut found = Vec::new();
        for _ in 0..count {
            match finder.next(&self.session, &self.task, &self.choices, &mut self.tally)? {
                Some(q) => found.push(q),
                // There is a grasp, and others are rare; or they are so rare that weaker ones must do.
                None if has_one || found.is_empty() => break,
                None => {}
            }
        }
        if found.is_empty() && !has_one {
            found = self.weaker_grasps(&mut finder, count)?;
        }
        endpoints::sort_by_ease(&self.task, &mut found, neighbours(self.poses, place));
        found.truncate(if end == End::Start { 1 } else { count });
        let nodes = found.into_iter().map(|q| self.graph.add_node(q, origin)).collect();
        Ok((nodes, Some(finder)))
    }

    /// Grasps in which a motion may begin or end, of n - 1 fingers too: where none was found that could be a
    /// node anywhere. Where there is none yet, one is looked for as long as the budget of samples lasts.
    fn weaker_grasps(&mut self, finder: &mut Finder, count: usize) -> Result<Vec<Configuration>, CallError> {
        let most = self.request.problem.limits.budget.max_nodes as u64;
        let (mut found, mut tries) = (Vec::new(), 0);
        finder.turn();
        while tries < count || (found.is_empty() && finder.calls < most) {
            found.extend(finder.next(&self.session, &self.end_task, &self.end_choices, &mut self.tally)?);
            tries += 1;
        }
        finder.turn();
        Ok(found)
    }

    fn given(&mut self, end: End, X_HO: Pose, grasp: &[FingerGrasp]) -> Result<Configuration, PlanError> {
        let mut work = self.session.work(&self.task, (Call::Start, 1, 0));
        let q = endpoints::given(&mut work, end, X_HO, grasp);
        // A plugin that panicked on the way made the verdict on the grasp worthless.
        unless_fault(Ok(()))?;
        let q = q?;
        let warning = unless_fault(endpoints::warning(&mut work, end, &q))?;
        // Each round asks anew.
        self.warnings.extend(warning.filter(|warning| !self.warnings.contains(warning)));
        Ok(q)
    }
}
