//! `contact-model/frictionless`: a point that pushes along the normal only.

use regrasp_api::{
    Build, Cone, Contact, ContactModel, Entry, FingerIndex, NoSettings, Settings, Slot, check_settings,
};

/// Frictionless point contact: a force along the inward normal and nothing else, whatever the friction
/// coefficient.
///
/// Closure then is form closure of first order; seven contacts are the fewest in space (Somov 1897;
/// Markenscoff, Ni, Papadimitriou, "The geometry of grasping", IJRR 1990), and a sphere or any other surface
/// of revolution has none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Frictionless;

impl ContactModel for Frictionless {
    fn cone(&self, _finger: FingerIndex, _contact: &Contact, _mu: f64) -> Cone<'_> {
        Cone::Elliptic { mu: 0.0, gamma: 0.0 }
    }

    fn fewest_contacts(&self) -> usize {
        7
    }
}

regrasp_api::inventory::submit! {
    Entry {
        id: "contact-model/frictionless",
        slots: &[Slot::ContactModel],
        summary: "Frictionless point contact: a force along the normal only; seven contacts are the fewest \
            that hold.",
        references: &[
            "Markenscoff, Ni, Papadimitriou, The geometry of grasping, IJRR 1990",
        ],
        schema: NoSettings::schema,
        check: check_settings::<NoSettings>,
        build: Build::ContactModel(|json, _| {
            NoSettings::from_json(json)?;
            Ok(Box::new(Frictionless))
        }),
    }
}
