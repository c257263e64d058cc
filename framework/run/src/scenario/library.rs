//! The scenarios and hands that are built into the program, so that it works from any folder.

use super::{Place, ScenarioError, ScenarioFile};

/// A built-in file.
#[derive(Clone, Copy, Debug)]
pub struct BuiltIn {
    /// Its name.
    pub name: &'static str,
    /// Its text.
    pub text: &'static str,
}

macro_rules! built_in {
    ($folder:literal: $($name:literal),+ $(,)?) => {
        &[$(BuiltIn { name: $name, text: include_str!(concat!("../../scenarios/", $folder, $name, ".toml")) }),+]
    };
}

/// The scenarios, the paper's three problems first.
pub const SCENARIOS: &[BuiltIn] = built_in!(
    "": "sphere", "cubic", "ellip-obst", "sphere-tilt", "sphere-free", "cube-free", "ellipsoid-free",
    "sphere-points", "free-box-sphere", "free-box-ellipsoid", "free-box-cube", "free-box-sphere-rolling",
    "free-box-ellipsoid-rolling", "free-box-cube-rolling", "sphere-soft", "sphere-five", "ring", "bracket",
    "baton",
    "allegro-ball", "allegro-cube", "three-finger-soft",
    "rgmc-a1-60", "rgmc-a1-80", "rgmc-a1-100", "rgmc-b1",
);

/// The hands.
pub const HANDS: &[BuiltIn] = built_in!(
    "hands/": "four-finger", "five-finger", "three-finger", "free-fingertips", "free-points", "box-points",
    "box-tips", "allegro-like", "trifinger-like",
);

/// The built-in file with this name.
pub fn find(files: &'static [BuiltIn], name: &str) -> Option<&'static BuiltIn> {
    files.iter().find(|file| file.name == name)
}

impl BuiltIn {
    /// The scenario as its file has it: nothing is looked up, built or checked beyond its form.
    pub fn read(&self) -> Result<ScenarioFile, ScenarioError> {
        toml::from_str(self.text).map_err(|error| ScenarioError::Syntax {
            place: Place::file(self.name),
            language: "TOML",
            message: error.message().to_owned(),
        })
    }
}
