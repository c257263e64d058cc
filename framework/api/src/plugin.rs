//! How plugins present themselves: entries.

use crate::{
    Built, ClosedChainSampler, ContactModel, GraphStrategy, LocalPlanner, Parts, Role, Settings,
    SettingsError, Slot, StabilityTest, SurfaceParam, with_roles, with_slots,
};

macro_rules! build {
    ($([$role:ident $name:ident $trait:ident] ($id:tt, $doc:tt))+) => {
        /// How a plugin is built from JSON settings and parts: one way for each role.
        #[derive(Clone, Copy)]
        pub enum Build {
            $(#[doc = $doc] $role(fn(&str, &Parts<'_>) -> Built<dyn $trait>),)+
        }

        impl Entry {
            /// The role, as the builder says.
            pub fn role(&self) -> Role {
                match self.build {
                    $(Build::$role(_) => Role::$role,)+
                }
            }
        }
    };
}
with_roles!(build);

macro_rules! plugins {
    ($([$slot:ident $field:ident $trait:ident] ($role:ident, $id:tt, $default:tt, $doc:tt))+) => {
        /// The plugin in each slot.
        #[derive(Clone, Copy)]
        pub struct Plugins<'a> {
            $(#[doc = $doc] pub $field: &'a dyn $trait,)+
        }
    };
}
with_slots!(plugins);

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

/// Checks settings of type `S`; what an entry's `check` points to.
pub fn check_settings<S: Settings>(json: &str) -> Result<(), SettingsError> {
    S::from_json(json).map(drop)
}
