//! How plugins present themselves: entries.

use crate::{Build, Settings, SettingsError, Slot};

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
