//! The laws of each role.

pub(crate) mod contact_model;
mod graph_strategy;
mod local_planner;
mod sampler;
mod stability;
mod surface;

pub(crate) use local_planner::Journey;

use crate::law::Law;
use regrasp_api::Slot;

/// The laws of the plugins for a slot.
pub(crate) fn laws(slot: Slot) -> &'static [Law] {
    match slot {
        Slot::ContactModel => contact_model::LAWS,
        Slot::StabilityTest => stability::LAWS,
        Slot::Surface => surface::LAWS,
        Slot::GraspPlanner => local_planner::GRASP,
        Slot::TransferPlanner => local_planner::TRANSFER,
        Slot::RegraspPlanner => local_planner::REGRASP,
        Slot::Sampler => sampler::LAWS,
        Slot::GraphStrategy => graph_strategy::LAWS,
    }
}
