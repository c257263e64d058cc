//! The plugins of a run, called by hand.

use crate::{RunError, Setup};
use regrasp_api::{Configuration, Context, FingerSet, Task, Vec3};
use regrasp_host::PluginSet;
use regrasp_planner::Leavable;

impl Setup<'_> {
    /// The plugin in each slot.
    pub fn plugins(&self) -> &PluginSet {
        &self.plugins
    }

    /// The task that the planner hands the plugins of a run, for calls by hand: tests, experiments, measurements.
    ///
    /// Its services are the program's own, without the guard that a run puts round them where plugins come from libraries.
    pub fn task(&self) -> Task<'_> {
        let problem = &self.scenario.problem;
        let PluginSet { contact_model, stability, surface, .. } = &self.plugins;
        Task {
            hand: self.hand(),
            clearance: &self.clearance,
            contact_model: contact_model.as_ref(),
            stability: stability.as_ref(),
            surface: surface.as_ref(),
            admissible: &Leavable,
            object: &self.scenario.object,
            g_H: Vec3::from(problem.gravity),
            tolerances: &problem.limits.tolerances,
            resolution: &problem.limits.resolution,
            workspace: problem.sampling_box(&self.poses),
            landmarks: &self.poses,
        }
    }

    /// The margin that the stability test gives the grasp of all fingers that touch at `q`, at rest and with the friction that planning
    /// relies on: a certified lower bound, in the test's own unit, 0 or less where the grasp is not stable.
    ///
    /// Torques are taken about the object's centre of mass and divided by its size, so that margins compare.
    pub fn margin(&self, q: &Configuration) -> Result<f64, RunError> {
        let task = self.task();
        let grasp = task.grasp(q, FingerSet::first(q.contacts.len()));
        let frame = regrasp_plan::MarginFrame::of_object(task.object);
        let (length, center_O) = (Some(frame.length), Some(Vec3::from(frame.center_O)));
        let assessed = task.stability.assess(&grasp, length, center_O, &mut Context::seeded(0));
        assessed.map(|assessment| assessment.margin_lower).map_err(RunError::Call)
    }
}
