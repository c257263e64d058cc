//! What can go wrong between a choice of plugins and the objects that they become.

use crate::LoadError;
use regrasp_api::did_you_mean;
use regrasp_api::{BuildError, CallError, Refusal, Refuse, SettingsError, Slot};
use thiserror::Error;

/// A plugin cannot be found, configured or built.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum HostError {
    /// Two linked plugins share an id.
    #[error("two plugins have the id `{0}`")]
    Duplicate(String),
    /// An id is not `role/name` with the entry's own role.
    #[error("the plugin id `{id}` should be `{role}/…`")]
    WrongRole {
        /// The id.
        id: String,
        /// The role that its builder fills.
        role: &'static str,
    },
    /// No slot has this name.
    #[error("there is no slot `{name}`; {}", or_all(.near, &slot_names()))]
    UnknownSlot {
        /// The name that was given.
        name: String,
        /// Slots that resemble it.
        near: Vec<String>,
    },
    /// No preset has this name.
    #[error("there is no preset `{name}`; {}", or_all(.near, .known))]
    UnknownPreset {
        /// The name that was given.
        name: String,
        /// Presets that resemble it.
        near: Vec<String>,
        /// Every preset.
        known: Vec<String>,
    },
    /// No plugin has this id in this slot.
    #[error("there is no plugin `{id}` for `{}`; {}{}", .slot.name(), or_all(.near, .known), or_load(.near))]
    UnknownPlugin {
        /// The slot that was to be filled.
        slot: Slot,
        /// The id that was given.
        id: String,
        /// Ids that resemble it.
        near: Vec<String>,
        /// Every id that fits the slot.
        known: Vec<String>,
    },
    /// The plugin exists but fills other slots.
    #[error("`{id}` does not fit `{}`; it fits `{}`", .slot.name(), .fits.join("`, `"))]
    WrongSlot {
        /// The slot that was to be filled.
        slot: Slot,
        /// The plugin.
        id: String,
        /// The slots that it fits.
        fits: Vec<String>,
    },
    /// The plugin refuses its settings.
    #[error("`{id}`: {error}")]
    Settings {
        /// The plugin.
        id: String,
        /// Its word.
        error: SettingsError,
    },
    /// The plugin cannot be built for this hand and object.
    #[error("`{id}`: {error}")]
    Build {
        /// The plugin.
        id: String,
        /// Its word.
        error: BuildError,
    },
    /// A library of plugins is refused.
    #[error(transparent)]
    Load(#[from] LoadError),
    /// A plugin panicked where it could not say so in its answer.
    #[error(transparent)]
    Call(#[from] CallError),
    /// The hand has too few fingers for the contact model.
    #[error(
        "the hand has {fingers} fingers, but under `{contact_model}` a grasp needs {fewest} contacts to be \
         stable, so that {} fingers are \
         needed to let one of them move; use a hand with more fingers or another contact model",
        .fewest + 1
    )]
    TooFewFingers {
        /// How many fingers the hand has.
        fingers: usize,
        /// The contact model.
        contact_model: String,
        /// The fewest contacts that can be stable under it.
        fewest: usize,
    },
}

impl Refuse for HostError {
    fn refusal(&self) -> Refusal {
        match self {
            Self::Duplicate(id) => Refusal::new("duplicate-plugin", self).value(id),
            Self::WrongRole { id, .. } => Refusal::new("wrong-role", self).value(id),
            Self::UnknownSlot { name, near } => Refusal::new("unknown-slot", self)
                .value(name)
                .range(slot_names().join(", "))
                .remedy(did_you_mean(near)),
            Self::UnknownPreset { name, near, known } => Refusal::new("unknown-preset", self)
                .key("preset")
                .value(name)
                .range(known.join(", "))
                .remedy(did_you_mean(near)),
            Self::UnknownPlugin { slot, id, near, known } => Refusal::new("unknown-plugin", self)
                .key(slot.name())
                .value(id)
                .range(known.join(", "))
                .remedy(did_you_mean(near)),
            Self::WrongSlot { slot, id, fits } => {
                Refusal::new("wrong-slot", self).key(slot.name()).value(id).range(fits.join(", "))
            }
            Self::Settings { error, .. } => error.refusal().told(self),
            Self::Build { error, .. } => error.refusal().told(self),
            Self::Load(error) => error.refusal(),
            Self::Call(error) => error.refusal(),
            Self::TooFewFingers { fingers, fewest, .. } => Refusal::new("too-few-fingers", self)
                .key("hand")
                .value(fingers)
                .range(format!("{}..", fewest + 1))
                .remedy("use a hand with more fingers or another contact model"),
        }
    }
}

fn slot_names() -> Vec<String> {
    Slot::ALL.iter().map(|slot| slot.name().to_owned()).collect()
}

/// Where nothing linked resembles a name it may be that of a plugin in a library.
fn or_load(near: &[String]) -> &'static str {
    if near.is_empty() { "; a plugin from a library is there once that is loaded (`--load`)" } else { "" }
}

fn or_all(near: &[String], known: &[String]) -> String {
    match (near, known) {
        ([], []) => "none is linked into this program".into(),
        ([], known) => format!("there are `{}`", known.join("`, `")),
        (near, _) => did_you_mean(near),
    }
}
