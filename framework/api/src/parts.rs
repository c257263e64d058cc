//! What is known when a plugin is built, and where it finds other plugins.

use crate::{
    BuildError, ClosedChainSampler, ContactModel, GraphStrategy, Hand, LocalPlanner, ObjectModel, Pose,
    Resolution, Slot, StabilityTest, SurfaceParam, Tolerances, Vec3,
};

/// What a plugin may prepare itself for when it is built.
#[derive(Clone, Copy)]
pub struct Parts<'a> {
    /// The object.
    pub object: &'a ObjectModel,
    /// The hand.
    pub hand: &'a dyn Hand,
    /// Acceleration of gravity in H (m/s²).
    pub g_H: Vec3,
    /// What a plan must keep.
    pub tolerances: Tolerances,
    /// How finely the planner works, and how far it keeps bodies apart.
    pub resolution: Resolution,
    /// The object's poses at the start and the goals, in turn; empty where they are not known.
    pub landmarks: &'a [Pose],
    /// Other plugins, to be wrapped.
    pub plugins: &'a dyn Shelf,
}

impl<'a> Parts<'a> {
    /// An object and a hand on earth, with default limits, nowhere to go, and no other plugins: for tests.
    pub fn new(object: &'a ObjectModel, hand: &'a dyn Hand) -> Self {
        Self {
            object,
            hand,
            g_H: Vec3::new(0.0, 0.0, -9.81),
            tolerances: Tolerances::default(),
            resolution: Resolution::default(),
            landmarks: &[],
            plugins: &EmptyShelf,
        }
    }
}

/// A plugin object, or why it cannot be built.
pub type Built<T> = Result<Box<T>, BuildError>;

/// Builds other plugins, for one that wraps them.
///
/// `id` is a plugin's id, with or without its role, and `None` the one that fills the slot by default;
/// `settings` is JSON text, empty for the
/// defaults. A wrapper that hands a call on leaves its counting ([`crate::Context::count_call`],
/// [`crate::Context::reject`]) to the plugin
/// that it wraps.
pub trait Shelf {
    /// A contact model.
    fn contact_model(&self, id: Option<&str>, settings: &str, parts: &Parts<'_>) -> Built<dyn ContactModel>;
    /// A stability test.
    fn stability_test(&self, id: Option<&str>, settings: &str, parts: &Parts<'_>)
    -> Built<dyn StabilityTest>;
    /// A surface.
    fn surface(&self, id: Option<&str>, settings: &str, parts: &Parts<'_>) -> Built<dyn SurfaceParam>;
    /// A sampler.
    fn sampler(&self, id: Option<&str>, settings: &str, parts: &Parts<'_>) -> Built<dyn ClosedChainSampler>;
    /// A local planner for one of its three slots.
    fn local_planner(
        &self,
        slot: Slot,
        id: Option<&str>,
        settings: &str,
        parts: &Parts<'_>,
    ) -> Built<dyn LocalPlanner>;
    /// A graph strategy.
    fn graph_strategy(&self, id: Option<&str>, settings: &str, parts: &Parts<'_>)
    -> Built<dyn GraphStrategy>;
}
const _: Option<&dyn Shelf> = None; // must stay object safe

/// Where there are no other plugins.
#[derive(Clone, Copy, Debug, Default)]
pub struct EmptyShelf;

/// Says so.
fn none<T: ?Sized>() -> Built<T> {
    Err(BuildError::Unsupported("there are no other plugins here to wrap".into()))
}

impl Shelf for EmptyShelf {
    fn contact_model(&self, _: Option<&str>, _: &str, _: &Parts<'_>) -> Built<dyn ContactModel> {
        none()
    }
    fn stability_test(&self, _: Option<&str>, _: &str, _: &Parts<'_>) -> Built<dyn StabilityTest> {
        none()
    }
    fn surface(&self, _: Option<&str>, _: &str, _: &Parts<'_>) -> Built<dyn SurfaceParam> {
        none()
    }
    fn sampler(&self, _: Option<&str>, _: &str, _: &Parts<'_>) -> Built<dyn ClosedChainSampler> {
        none()
    }
    fn local_planner(&self, _: Slot, _: Option<&str>, _: &str, _: &Parts<'_>) -> Built<dyn LocalPlanner> {
        none()
    }
    fn graph_strategy(&self, _: Option<&str>, _: &str, _: &Parts<'_>) -> Built<dyn GraphStrategy> {
        none()
    }
}
