//! A contact model: point contact with friction on an object that is greasy on one side.

// ANCHOR: uses
use regrasp_api::{
    Build, Cone, Contact, ContactModel, Entry, FingerIndex, Settings, SettingsError, Slot, Vec3,
    check_settings,
};
use serde::{Deserialize, Serialize};
// ANCHOR_END: uses

// ANCHOR: settings
/// Settings of [`Greasy`]: where the grease is, and what it leaves of the friction.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct GreasySettings {
    /// Direction of the greasy side in the object's frame; its length does not count, but must not be 0.
    #[schemars(inner(range(min = -1000.0, max = 1000.0)), extend("x-unit" = "1"))]
    pub side: [f64; 3],
    /// Points at least this far (m) along `side` from the object's origin are greasy.
    #[schemars(range(min = -1.0, max = 1.0), extend("x-unit" = "m"))]
    pub from: f64,
    /// The part of the friction that grease leaves.
    #[schemars(range(min = 0.0, max = 1.0), extend("x-unit" = "1"))]
    pub factor: f64,
}

impl Default for GreasySettings {
    fn default() -> Self {
        Self { side: [1.0, 0.0, 0.0], from: 0.015, factor: 0.25 }
    }
}

impl Settings for GreasySettings {
    fn check_further(&self) -> Result<(), SettingsError> {
        if Vec3::from(self.side).norm() > 1e-9 {
            return Ok(());
        }
        Err(SettingsError::Value {
            key: "side",
            value: format!("{:?}", self.side),
            reason: "is no direction",
            remedy: "give one such as [1.0, 0.0, 0.0]",
        })
    }
}
// ANCHOR_END: settings

// ANCHOR: model
/// Point contact with friction, `|f_t| ≤ μ f_n`, with less μ on the greasy side of the object.
#[derive(Clone, Copy, Debug)]
pub struct Greasy {
    /// Unit vector, in O.
    side_O: Vec3,
    from: f64,
    factor: f64,
}

impl Greasy {
    /// A contact model with checked settings.
    pub fn new(settings: GreasySettings) -> Result<Self, SettingsError> {
        settings.validate()?;
        let GreasySettings { side, from, factor } = settings;
        Ok(Self { side_O: Vec3::from(side).normalize(), from, factor })
    }

    fn is_greasy(&self, contact: &Contact) -> bool {
        contact.p_OC.dot(&self.side_O) >= self.from
    }
}
// ANCHOR_END: model

// ANCHOR: role
impl ContactModel for Greasy {
    fn cone(&self, _finger: FingerIndex, contact: &Contact, mu: f64) -> Cone<'_> {
        let left = if self.is_greasy(contact) { self.factor } else { 1.0 };
        Cone::Elliptic { mu: left * mu, gamma: 0.0 }
    }

    fn fewest_contacts(&self) -> usize {
        3 // as for all point contacts with friction: two leave the turn about their line free
    }
}
// ANCHOR_END: role

// ANCHOR: entry
/// How the plugin presents itself.
pub const ENTRY: Entry = Entry {
    id: "contact-model/greasy",
    slots: &[Slot::ContactModel],
    summary: "point contact with friction, less of it on one side of the object",
    references: &["Coulomb, Théorie des machines simples, 1785"],
    schema: GreasySettings::schema,
    check: check_settings::<GreasySettings>,
    build: Build::ContactModel(|json, _parts| Ok(Box::new(Greasy::new(GreasySettings::from_json(json)?)?))),
};
regrasp_api::inventory::submit! { ENTRY }
// ANCHOR_END: entry

// ANCHOR: tests
#[cfg(test)]
mod tests {
    use super::*;

    /// The friction that is left at a point of a ball.
    fn friction_at(model: &Greasy, p_OC: Vec3) -> f64 {
        let contact = Contact { facet: 0, p_OC, n_O: p_OC.normalize() };
        match model.cone(FingerIndex(0), &contact, 0.8) {
            Cone::Elliptic { mu, gamma: 0.0 } => mu,
            other => panic!("a point contact was expected: {other:?}"),
        }
    }

    #[test]
    fn only_the_greasy_side_is_slippery() {
        let settings = GreasySettings { side: [0.0, 0.0, 2.0], from: 0.02, factor: 0.25 };
        let model = Greasy::new(settings).unwrap();
        assert_eq!(friction_at(&model, Vec3::new(0.0, 0.0, 0.03)), 0.2);
        assert_eq!(friction_at(&model, Vec3::new(0.03, 0.0, 0.0)), 0.8);
        assert_eq!(friction_at(&model, Vec3::new(0.0, 0.0, -0.03)), 0.8);
    }

    #[test]
    fn a_side_without_direction_and_factors_above_one_are_refused() {
        let refused = |settings: GreasySettings| Greasy::new(settings).unwrap_err().to_string();
        let nowhere = GreasySettings { side: [0.0; 3], ..GreasySettings::default() };
        assert!(refused(nowhere).contains("`side` = [0.0, 0.0, 0.0] is no direction"));
        let sticky = GreasySettings { factor: 1.5, ..GreasySettings::default() };
        assert_eq!(refused(sticky), "`factor` = 1.5 is outside 0..=1");
    }
}
// ANCHOR_END: tests
