//! How plugins present themselves: roles, slots, entries.

use crate::{
    BuildError, ClosedChainSampler, ContactModel, GraphStrategy, Hand, LocalPlanner, ObjectModel, Settings,
    SettingsError, StabilityTest, SurfaceParam,
};
use serde::{Deserialize, Serialize};

/// The six roles.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Role {
    /// Which wrenches a contact can transmit.
    ContactModel,
    /// Whether a grasp is stable.
    StabilityTest,
    /// The object's surface.
    Surface,
    /// Random closed chains.
    Sampler,
    /// Connecting two configurations.
    LocalPlanner,
    /// What to do next.
    GraphStrategy,
}

impl Role {
    /// Every role.
    pub const ALL: [Self; 6] = [
        Self::ContactModel,
        Self::StabilityTest,
        Self::Surface,
        Self::Sampler,
        Self::LocalPlanner,
        Self::GraphStrategy,
    ];

    /// The name in files and ids.
    pub fn name(self) -> &'static str {
        match self {
            Self::ContactModel => "contact-model",
            Self::StabilityTest => "stability-test",
            Self::Surface => "surface",
            Self::Sampler => "sampler",
            Self::LocalPlanner => "local-planner",
            Self::GraphStrategy => "graph-strategy",
        }
    }
}

/// The eight places that plugins fill; a local planner has three.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub enum Slot {
    /// `contact-model`
    #[serde(rename = "contact-model")]
    ContactModel,
    /// `stability-test`
    #[serde(rename = "stability-test")]
    StabilityTest,
    /// `surface`
    #[serde(rename = "surface")]
    Surface,
    /// `sampler`
    #[serde(rename = "sampler")]
    Sampler,
    /// `local-planner.grasp`
    #[serde(rename = "local-planner.grasp")]
    GraspPlanner,
    /// `local-planner.transfer`
    #[serde(rename = "local-planner.transfer")]
    TransferPlanner,
    /// `local-planner.regrasp`
    #[serde(rename = "local-planner.regrasp")]
    RegraspPlanner,
    /// `graph-strategy`
    #[serde(rename = "graph-strategy")]
    GraphStrategy,
}

impl Slot {
    /// Every slot, in the order of their numbers.
    pub const ALL: [Self; 8] = [
        Self::ContactModel,
        Self::StabilityTest,
        Self::Surface,
        Self::Sampler,
        Self::GraspPlanner,
        Self::TransferPlanner,
        Self::RegraspPlanner,
        Self::GraphStrategy,
    ];

    /// The name in files and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::ContactModel => "contact-model",
            Self::StabilityTest => "stability-test",
            Self::Surface => "surface",
            Self::Sampler => "sampler",
            Self::GraspPlanner => "local-planner.grasp",
            Self::TransferPlanner => "local-planner.transfer",
            Self::RegraspPlanner => "local-planner.regrasp",
            Self::GraphStrategy => "graph-strategy",
        }
    }

    /// The role that fills the slot.
    pub fn role(self) -> Role {
        match self {
            Self::ContactModel => Role::ContactModel,
            Self::StabilityTest => Role::StabilityTest,
            Self::Surface => Role::Surface,
            Self::Sampler => Role::Sampler,
            Self::GraspPlanner | Self::TransferPlanner | Self::RegraspPlanner => Role::LocalPlanner,
            Self::GraphStrategy => Role::GraphStrategy,
        }
    }
}

/// What a plugin may prepare itself for when it is built.
#[derive(Clone, Copy)]
pub struct Parts<'a> {
    /// The object.
    pub object: &'a ObjectModel,
    /// The hand.
    pub hand: &'a dyn Hand,
}

/// A plugin object, or why it cannot be built.
pub type Built<T> = Result<Box<T>, BuildError>;

/// How a plugin is built from JSON settings and parts.
#[derive(Clone, Copy)]
pub enum Build {
    /// Builds a contact model.
    ContactModel(fn(&str, &Parts<'_>) -> Built<dyn ContactModel>),
    /// Builds a stability test.
    StabilityTest(fn(&str, &Parts<'_>) -> Built<dyn StabilityTest>),
    /// Builds a surface.
    Surface(fn(&str, &Parts<'_>) -> Built<dyn SurfaceParam>),
    /// Builds a sampler.
    Sampler(fn(&str, &Parts<'_>) -> Built<dyn ClosedChainSampler>),
    /// Builds a local planner for one of its slots.
    LocalPlanner(fn(&str, &Parts<'_>) -> Built<dyn LocalPlanner>),
    /// Builds a graph strategy.
    GraphStrategy(fn(&str, &Parts<'_>) -> Built<dyn GraphStrategy>),
}

/// A plugin's entry in the registry.
#[derive(Clone, Copy)]
pub struct Entry {
    /// `role/name` in kebab case, such as `stability-test/force-closure`.
    pub id: &'static str,
    /// The slots that it can fill.
    pub slots: &'static [Slot],
    /// What it is, in one line.
    pub summary: &'static str,
    /// Its sources: authors, title, venue, year.
    pub references: &'static [&'static str],
    /// The JSON schema of its settings.
    pub schema: fn() -> String,
    /// Checks settings given as JSON text; the empty text stands for the defaults.
    pub check: fn(&str) -> Result<(), SettingsError>,
    /// Builds the plugin.
    pub build: Build,
}
inventory::collect!(Entry);

impl Entry {
    /// The role, as the builder says.
    pub fn role(&self) -> Role {
        match self.build {
            Build::ContactModel(_) => Role::ContactModel,
            Build::StabilityTest(_) => Role::StabilityTest,
            Build::Surface(_) => Role::Surface,
            Build::Sampler(_) => Role::Sampler,
            Build::LocalPlanner(_) => Role::LocalPlanner,
            Build::GraphStrategy(_) => Role::GraphStrategy,
        }
    }
}

/// Checks settings of type `S`; what an entry's `check` points to.
pub fn check_settings<S: Settings>(json: &str) -> Result<(), SettingsError> {
    S::from_json(json).map(drop)
}
