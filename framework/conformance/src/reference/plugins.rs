//! The references as plugins that others may wrap.

use super::{
    EdgeClosure, FacetSurface, FineRolling, GraspLine, Interleaving, LiftOver, RejectionSampler, RoundCones,
};
use regrasp_api::{
    Built, ClosedChainSampler, ContactModel, GraphStrategy, LocalPlanner, Parts, Shelf, Slot, StabilityTest,
    SurfaceParam,
};

/// Gives the reference of a role, whatever plugin is asked for.
#[derive(Clone, Copy, Debug, Default)]
pub struct ReferencePlugins;

impl Shelf for ReferencePlugins {
    fn contact_model(&self, _: Option<&str>, _: &str, _: &Parts<'_>) -> Built<dyn ContactModel> {
        Ok(Box::new(RoundCones))
    }

    fn stability_test(&self, _: Option<&str>, _: &str, _: &Parts<'_>) -> Built<dyn StabilityTest> {
        Ok(Box::new(EdgeClosure))
    }

    fn surface(&self, _: Option<&str>, _: &str, parts: &Parts<'_>) -> Built<dyn SurfaceParam> {
        Ok(Box::new(FacetSurface::new(&parts.object.mesh, parts.hand.fingertip_radius())))
    }

    fn sampler(&self, _: Option<&str>, _: &str, _: &Parts<'_>) -> Built<dyn ClosedChainSampler> {
        Ok(Box::new(RejectionSampler))
    }

    fn local_planner(&self, slot: Slot, _: Option<&str>, _: &str, _: &Parts<'_>) -> Built<dyn LocalPlanner> {
        Ok(match slot {
            Slot::GraspPlanner => Box::new(GraspLine),
            Slot::TransferPlanner => Box::new(FineRolling),
            _ => Box::new(LiftOver),
        })
    }

    fn graph_strategy(&self, _: Option<&str>, _: &str, _: &Parts<'_>) -> Built<dyn GraphStrategy> {
        Ok(Box::new(Interleaving))
    }
}
