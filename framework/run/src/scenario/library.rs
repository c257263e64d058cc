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

/// The paper's three problems with q_init and q_goal given, five pairs each: what the suite `strict` plans.
pub const STRICT: &[BuiltIn] = built_in!(
    "strict/": "sphere-given-1", "sphere-given-2", "sphere-given-3", "sphere-given-4", "sphere-given-5",
    "cubic-given-1", "cubic-given-2", "cubic-given-3", "cubic-given-4", "cubic-given-5", "ellip-obst-given-1",
    "ellip-obst-given-2", "ellip-obst-given-3", "ellip-obst-given-4", "ellip-obst-given-5",
);

/// The paper's problems made harder: what the suite `harder` plans.
pub const HARDER: &[BuiltIn] = built_in!(
    "strict/": "cubic-friction-0.4", "cubic-friction-0.3", "cube-180", "ellip-two-bars", "narrow-abduction",
);

/// The hands.
pub const HANDS: &[BuiltIn] = built_in!(
    "hands/": "four-finger", "five-finger", "three-finger", "free-fingertips", "free-points", "box-points",
    "box-tips", "narrow", "allegro-like", "trifinger-like",
);

/// The built-in file with this name.
pub fn find(files: &'static [BuiltIn], name: &str) -> Option<&'static BuiltIn> {
    files.iter().find(|file| file.name == name)
}

/// The built-in scenario with this name, those of the suites included.
pub fn find_scenario(name: &str) -> Option<&'static BuiltIn> {
    [SCENARIOS, STRICT, HARDER].into_iter().find_map(|files| find(files, name))
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
