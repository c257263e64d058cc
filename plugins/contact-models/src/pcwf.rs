//! `contact-model/pcwf`: point contact with Coulomb friction, the paper's model.

use regrasp_api::{
    Build, Cone, Contact, ContactModel, Entry, FingerIndex, NoSettings, Settings, Slot, check_settings,
};

/// Point contact with friction: forces inside the cone `|f_t| ≤ μ f_n`, no torque about the normal.
///
/// What the paper assumes (Sahbani, Saut, Perdereau, "An efficient algorithm for dexterous manipulation
/// planning", SSD 2007, section V; section III derives n = 4 from it); the model goes back to Salisbury &
/// Roth, "Kinematic and force analysis of articulated mechanical hands", J. Mechanisms, Transmissions and
/// Automation in Design, 1983. At least three such contacts are needed for force closure in space: two leave
/// the rotation about the line that joins them free.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Pcwf;

impl ContactModel for Pcwf {
    fn cone(&self, _finger: FingerIndex, _contact: &Contact, mu: f64) -> Cone<'_> {
        Cone::Elliptic { mu, gamma: 0.0 }
    }

    fn fewest_contacts(&self) -> usize {
        3
    }
}

regrasp_api::inventory::submit! {
    Entry {
        id: "contact-model/pcwf",
        slots: &[Slot::ContactModel],
        summary: "Point contact with Coulomb friction: forces inside a round cone, no torque about the \
            normal.",
        references: &[
            "Sahbani, Saut, Perdereau, An efficient algorithm for dexterous manipulation planning, SSD 2007",
            "Salisbury, Roth, Kinematic and force analysis of articulated mechanical hands, J. Mechanisms, \
             Transmissions and Automation in Design, 1983",
        ],
        schema: NoSettings::schema,
        check: check_settings::<NoSettings>,
        build: Build::ContactModel(|json, _| {
            NoSettings::from_json(json)?;
            Ok(Box::new(Pcwf))
        }),
    }
}
