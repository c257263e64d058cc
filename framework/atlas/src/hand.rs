//! A hand of an atlas.

use crate::AtlasError;
use regrasp_api::HandDescription;
use regrasp_run::scenario::load_hand;
use serde_json::{Value, json};
use std::path::Path;

/// Fingers that hard fingertips need: three hold, the fourth moves (A. Sahbani, J.-P. Saut, V. Perdereau, SSD
/// 2007, section III).
const HARD: usize = 4;

/// A hand, built and checked.
#[derive(Clone, Debug)]
pub struct AtlasHand {
    /// What it is called in the atlas.
    pub name: String,
    /// How a scenario names it.
    pub(crate) choice: Value,
    /// What it is.
    pub(crate) description: HandDescription,
}

impl AtlasHand {
    /// The built-in hand of this name, or the file: a hand file, a URDF or an MJCF.
    pub fn load(text: &str) -> Result<Self, AtlasError> {
        let path = Path::new(text);
        let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase());
        let key = match ending.as_deref() {
            None => "builtin",
            Some("urdf") => "urdf",
            Some("xml" | "mjcf") => "mjcf",
            Some(_) => "file",
        };
        let choice = json!({ key: text });
        let loaded = load_hand(&json!({ "hand": choice }).to_string(), Path::new(""));
        let description = loaded.map_err(AtlasError::Hand)?.description;
        let name =
            path.file_stem().map_or_else(|| text.to_owned(), |stem| stem.to_string_lossy().into_owned());
        Ok(Self { name, choice, description })
    }

    /// Whether its fingertips are taken to be soft: with fewer than four fingers hard ones cannot regrasp.
    pub fn is_soft(&self) -> bool {
        self.description.finger.len() < HARD
    }

    /// Whether its fingertips roll; points stay where they are set down.
    pub fn rolls(&self) -> bool {
        self.description.fingertip.is_ball()
    }

    /// How many fingers it has.
    pub fn fingers(&self) -> usize {
        self.description.finger.len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_unknown_hand_is_refused_with_the_nearest_name() {
        let text = AtlasHand::load("alegro-like").unwrap_err().to_string();
        assert!(text.contains("allegro-like"), "{text}");
        assert!(AtlasHand::load("no/such/hand.toml").is_err());
    }

    #[test]
    fn points_do_not_roll() {
        assert!(!AtlasHand::load("free-points").unwrap().rolls());
        assert!(AtlasHand::load("four-finger").unwrap().rolls());
    }

    #[test]
    fn hands_of_three_fingers_have_soft_tips() {
        assert!(AtlasHand::load("three-finger").unwrap().is_soft());
        let four = AtlasHand::load("four-finger").unwrap();
        assert!(!four.is_soft() && four.fingers() == 4);
    }
}
