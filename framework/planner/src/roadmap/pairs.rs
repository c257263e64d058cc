//! Random pairs of start and goal, by which a roadmap is judged.

use super::grow::Gardener;
use crate::error::PlanError;
use crate::request::Request;
use crate::session::Call;
use crate::solve::{finger_choices, with_task};
use regrasp_api::{Configuration, PoseRequest, Task};

/// Calls of the sampler in turn that look for one grasp.
const CALLS: u64 = 500;

/// A start with its grasp, and a goal at whose pose there is one.
#[derive(Clone, Debug, PartialEq)]
pub struct Pair {
    /// The start.
    pub from: Configuration,
    /// A grasp at the goal's pose; a plan may end in another.
    pub to: Configuration,
}

/// Pairs of grasps as a roadmap's nodes are drawn, in streams of their own: the request's seed tells them
/// apart. Fewer than `count` where the workspace has no grasps.
pub fn pairs(request: &Request<'_>, count: usize) -> Result<Vec<Pair>, PlanError> {
    let poses = request.problem.poses()?;
    with_task(request, &poses, |task, session, policy| {
        let task = Task { landmarks: &[], ..*task };
        let choices = finger_choices(&task, policy.spare_fingers, policy.more_fingers)?;
        let gardener = Gardener { task, session: *session, policy, choices };
        let grasps = session.draw(2 * count, |i| gardener.grasp(i as u64));
        let grasps = grasps.into_iter().collect::<Result<Vec<_>, _>>()?;
        let pair = |two: &[Option<Configuration>]| Some(Pair { from: two[0].clone()?, to: two[1].clone()? });
        Ok(grasps.chunks_exact(2).filter_map(pair).collect())
    })
}

impl Gardener<'_> {
    /// The grasp with this number; `None` where call after call gives none.
    fn grasp(&self, number: u64) -> Result<Option<Configuration>, PlanError> {
        for call in 0..CALLS {
            let key = (Call::RoadmapPair, number, call);
            let found = self.session.counted(&self.task, key, |work| {
                let holding = self.choices[work.context.random.index(self.choices.len())];
                work.plugins.sampler.sample(work.task, PoseRequest::Anywhere, holding, &mut work.context)
            });
            if let Some(q) = found.result? {
                return Ok(Some(q));
            }
        }
        Ok(None)
    }
}
