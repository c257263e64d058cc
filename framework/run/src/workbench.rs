//! A scenario with its plugins, owned: for callers that cannot borrow, such as other languages.

use crate::scenario::Scenario;
use crate::task::{assess, task};
use crate::{RunError, Setup};
use regrasp_api::{Assessment, CallError, ClosedChainSampler, Configuration, Pose, Task};
use regrasp_host::{PluginSet, Registry};
use regrasp_world::SceneClearance;
use std::sync::Arc;

/// A scenario with the plugins that it names, built; what [`Setup`] is, without the planning, for as long as
/// one likes.
pub struct Workbench {
    scenario: Arc<Scenario>,
    clearance: SceneClearance,
    poses: Vec<Pose>,
    plugins: PluginSet,
}

impl Workbench {
    /// Builds collision and plugins.
    pub fn new(scenario: Arc<Scenario>, registry: &Registry) -> Result<Self, RunError> {
        let Setup { clearance, poses, plugins, .. } = Setup::new(&scenario, &scenario.choices, registry)?;
        Ok(Self { scenario, clearance, poses, plugins })
    }

    /// The task that the planner would hand the plugins.
    pub fn task(&self) -> Task<'_> {
        task(&self.scenario, &self.clearance, &self.plugins, &self.poses)
    }

    /// The sampler.
    pub fn sampler(&self) -> &dyn ClosedChainSampler {
        self.plugins.sampler.as_ref()
    }

    /// The plugin in each slot.
    pub fn plugins(&self) -> &PluginSet {
        &self.plugins
    }

    /// What the stability test says of the grasp at `q`; see [`Setup::margin`].
    pub fn assess(&self, q: &Configuration) -> Result<Assessment, CallError> {
        assess(&self.task(), q)
    }
}
