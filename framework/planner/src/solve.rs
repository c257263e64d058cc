//! A whole run: start and goals, one search a goal, smoothing, timing.

use crate::admissible::{Holdable, admission};
use crate::draft::Draft;
use crate::error::{End, PlanError};
use crate::graph::Graph;
use crate::report::Outcome;
use crate::request::Request;
use crate::roadmap::Through;
use crate::run::Run;
use crate::session::{Drivers, Session};
use regrasp_abi::GuardedService;
use regrasp_api::{Admissible, FingerSet, Pose, PoseDescription, Problem, SearchPolicy, Tally, Task, Vec3};
use regrasp_plan::Statistics;
use std::collections::BTreeSet;

/// Plans a motion from the start through all goals.
pub fn solve(request: &Request<'_>) -> Result<Outcome, PlanError> {
    solve_with(request, None)
}

/// The same through a roadmap, which takes the place of samples that are drawn for this problem alone.
pub fn solve_through(request: &Request<'_>, through: Through<'_>) -> Result<Outcome, PlanError> {
    solve_with(request, Some(through))
}

fn solve_with(request: &Request<'_>, through: Option<Through<'_>>) -> Result<Outcome, PlanError> {
    let poses = poses(request.problem)?;
    with_task(request, &poses, |task, session, policy| {
        let holdable = GuardedService::guarding("service/admissible", &Holdable as &dyn Admissible);
        let choices = finger_choices(task, policy.spare_fingers, policy.more_fingers)?;
        let end_choices = finger_choices(task, 0, true)?;
        let mut run = Run {
            request,
            through,
            session: *session,
            task: *task,
            poses: &poses,
            choices,
            end_task: Task { admissible: &holdable, ..*task },
            end_choices,
            policy,
            graph: Graph::new(request.object.mesh.radius()),
            draft: Draft::default(),
            statistics: Statistics::default(),
            tally: Tally::default(),
            warnings: Vec::new(),
            ends: Vec::new(),
            used: BTreeSet::new(),
        };
        session.within(|| {
            let ended = run.legs();
            run.finish(ended)
        })
    })
}

/// Does `work` with the task of a request, what its calls share, and the strategy's wishes.
pub(crate) fn with_task<T>(
    request: &Request<'_>,
    poses: &[Pose],
    work: impl FnOnce(&Task<'_>, &Session<'_>, SearchPolicy) -> Result<T, PlanError>,
) -> Result<T, PlanError> {
    // A sampler from a library asks for admission in its own binary, which a panic could not leave.
    let policy = request.plugins.strategy.policy();
    let admissible = GuardedService::guarding("service/admissible", admission(policy.admission));
    let task = Task {
        hand: request.hand,
        clearance: request.clearance,
        contact_model: request.plugins.contact_model,
        stability: request.plugins.stability,
        surface: request.plugins.surface,
        admissible: &admissible,
        object: request.object,
        g_H: Vec3::from(request.problem.gravity),
        tolerances: &request.problem.limits.tolerances,
        resolution: &request.problem.limits.resolution,
        workspace: request.problem.sampling_box(poses),
        landmarks: poses,
    };
    let pool = pool(request.threads);
    let session = Session {
        plugins: Drivers::of(&request.plugins),
        seed: request.seed,
        interrupt: request.interrupt,
        pool: pool.as_ref(),
    };
    work(&task, &session, policy)
}

/// Start and goals as poses; two in turn that coincide are refused where no grasp tells them apart.
pub(crate) fn poses(problem: &Problem) -> Result<Vec<Pose>, PlanError> {
    let read = |end, pose: &PoseDescription| pose.pose().map_err(|error| PlanError::Pose { end, error });
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

/// The sets of fingers that may hold the object, with `spare` more than the fewest that can be stable: 1
/// gives GS_n; larger ones where `more` says so.
pub(crate) fn finger_choices(task: &Task<'_>, spare: usize, more: bool) -> Result<Vec<FingerSet>, PlanError> {
    let (fingers, fewest) = (task.hand.finger_count(), task.contact_model.fewest_contacts());
    if fingers < fewest + spare.max(1) {
        return Err(PlanError::TooFewFingers { fingers, fewest });
    }
    let least = fewest + spare;
    let most = if more { fingers } else { least };
    let all = FingerSet::first(fingers);
    let subsets = (0..=u8::MAX).map(FingerSet::from_bits).filter(|&set| set.intersection(all) == set);
    Ok(subsets.filter(|set| (least..=most).contains(&set.len())).collect())
}

fn pool(threads: usize) -> Option<rayon::ThreadPool> {
    // Where the system grants no threads the run goes on with one: the plan is the same.
    (threads > 1).then(|| rayon::ThreadPoolBuilder::new().num_threads(threads).build().ok()).flatten()
}
