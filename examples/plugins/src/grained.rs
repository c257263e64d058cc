//! A contact model with a grain: wood, brushed metal, a woven cover. Friction along the grain differs from
//! friction across it.

use regrasp_api::{
    Build, Cone, Contact, ContactModel, Entry, FingerIndex, Settings, Slot, Vec3, check_settings, inventory,
};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Settings of [`Grained`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct GrainedSettings {
    /// Friction across the grain as a share of that along it (no unit).
    #[schemars(range(min = 0.1, max = 1.0), extend("x-unit" = "1"))]
    pub across: f64,
    /// Torsional friction radius of the patch (m); 0 makes a point of it.
    #[schemars(range(min = 0.0, max = 0.01), extend("x-unit" = "m"))]
    pub gamma: f64,
}

impl Default for GrainedSettings {
    fn default() -> Self {
        Self { across: 0.9, gamma: 0.0 }
    }
}

impl Settings for GrainedSettings {}

/// A patch contact on an object whose grain runs along its z axis.
struct Grained(GrainedSettings);

impl ContactModel for Grained {
    fn cone(&self, _finger: FingerIndex, _contact: &Contact, mu: f64) -> Cone<'_> {
        // On the ends, where the grain meets the surface head on, the smaller coefficient counts all round.
        Cone::grained(&Vec3::z(), [mu, self.0.across * mu], self.0.gamma)
    }

    fn fewest_contacts(&self) -> usize {
        if self.0.gamma > 0.0 { 2 } else { 3 }
    }
}

/// How the plugin presents itself.
pub const ENTRY: Entry = Entry {
    id: "contact-model/grained",
    slots: &[Slot::ContactModel],
    summary: "friction along the object's grain and across it, as an exact elliptic cone",
    references: &["Goyal, Ruina, Papadopoulos, Planar sliding with dry friction, Wear 143, 1991"],
    schema: GrainedSettings::schema,
    check: check_settings::<GrainedSettings>,
    build: Build::ContactModel(|json, _parts| Ok(Box::new(Grained(GrainedSettings::from_json(json)?)))),
};
inventory::submit! { ENTRY }
