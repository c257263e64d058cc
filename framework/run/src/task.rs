//! The plugins of a run, called by hand.

use crate::scenario::Scenario;
use crate::{RunError, Setup};
use regrasp_api::{Assessment, CallError, Configuration, Context, FingerSet, Pose, Task, Vec3};
use regrasp_host::PluginSet;
use regrasp_planner::Leavable;
use regrasp_world::SceneClearance;

impl Setup<'_> {
    /// The plugin in each slot.
    pub fn plugins(&self) -> &PluginSet {
        &self.plugins
    }

    /// The task that the planner hands the plugins of a run, for calls by hand: tests, experiments,
    /// measurements.
    ///
    /// Its services are the program's own, without the guard that a run puts round them where plugins come
    /// from libraries.
    pub fn task(&self) -> Task<'_> {
        task(self.scenario, &self.clearance, &self.plugins, &self.poses)
    }

    /// The margin that the stability test gives the grasp of all fingers that touch at `q`, at rest and with
    /// the friction that planning relies on: a certified lower bound, in the test's own unit, 0 or less where
    /// the grasp is not stable.
    ///
    /// Torques are taken about the object's centre of mass and divided by its size, so that margins compare.
    pub fn margin(&self, q: &Configuration) -> Result<f64, RunError> {
        assess(&self.task(), q).map(|assessment| assessment.margin_lower).map_err(RunError::Call)
    }
}

/// The task of a scenario with its plugins; `poses` are the object's at the start and at the goals, in turn.
pub(crate) fn task<'a>(
    scenario: &'a Scenario,
    clearance: &'a SceneClearance,
    plugins: &'a PluginSet,
    poses: &'a [Pose],
) -> Task<'a> {
    let problem = &scenario.problem;
    Task {
        hand: scenario.hand.as_ref(),
        clearance,
        contact_model: plugins.contact_model.as_ref(),
        stability: plugins.stability.as_ref(),
        surface: plugins.surface.as_ref(),
        admissible: &Leavable,
        object: &scenario.object,
        g_H: Vec3::from(problem.gravity),
        tolerances: &problem.limits.tolerances,
        resolution: &problem.limits.resolution,
        workspace: problem.sampling_box(poses),
        landmarks: poses,
    }
}

/// What the task's stability test says of the grasp of all fingers that touch at `q`, as [`Setup::margin`]
/// has it.
pub(crate) fn assess(task: &Task<'_>, q: &Configuration) -> Result<Assessment, CallError> {
    let grasp = task.grasp(q, FingerSet::first(q.contacts.len()));
    let frame = regrasp_plan::MarginFrame::of_object(task.object);
    let (length, center_O) = (Some(frame.length), Some(Vec3::from(frame.center_O)));
    task.stability.assess(&grasp, length, center_O, &mut Context::seeded(0))
}
