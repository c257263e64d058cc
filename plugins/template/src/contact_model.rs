//! A contact model: point contact with a friction coefficient that is trusted only in part.

use regrasp_api::{
    Build, Cone, Contact, ContactModel, Entry, FingerIndex, Settings, SettingsError, Slot, check_settings,
};
use serde::{Deserialize, Serialize};

/// Settings of [`ScaledFriction`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ScaledFrictionSettings {
    /// The part of the friction coefficient that counts.
    #[schemars(range(min = 0.1, max = 1.0), extend("x-unit" = "1"))]
    pub factor: f64,
}

impl Default for ScaledFrictionSettings {
    fn default() -> Self {
        Self { factor: 0.9 }
    }
}

impl Settings for ScaledFrictionSettings {}

/// Point contact with friction, `|f_t| ≤ factor · μ · f_n`.
#[derive(Clone, Copy, Debug)]
pub struct ScaledFriction {
    settings: ScaledFrictionSettings,
}

impl ScaledFriction {
    /// A contact model with checked settings.
    pub fn new(settings: ScaledFrictionSettings) -> Result<Self, SettingsError> {
        settings.validate()?;
        Ok(Self { settings })
    }
}

impl ContactModel for ScaledFriction {
    fn cone(&self, _finger: FingerIndex, _contact: &Contact, mu: f64) -> Cone<'_> {
        Cone::Elliptic { mu: self.settings.factor * mu, gamma: 0.0 }
    }

    fn fewest_contacts(&self) -> usize {
        3
    }
}

/// How the plugin presents itself.
pub const ENTRY: Entry = Entry {
    id: "contact-model/template",
    slots: &[Slot::ContactModel],
    summary: "point contact with a part of the object's friction",
    references: &["Coulomb, Théorie des machines simples, 1785"],
    schema: ScaledFrictionSettings::schema,
    check: check_settings::<ScaledFrictionSettings>,
    build: Build::ContactModel(|json, _parts| {
        Ok(Box::new(ScaledFriction::new(ScaledFrictionSettings::from_json(json)?)?))
    }),
};
