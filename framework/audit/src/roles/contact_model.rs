//! Contact models under audit.

use crate::auditor::{Key, bits};
use crate::laws::{self, Kept, ensure};
use crate::{Audited, input};
use regrasp_api::{Cone, Contact, ContactModel, FingerIndex, MAX_FINGERS, Vec3};
use serde_json::json;

/// A friction a little smaller, whose cone must lie inside.
const LESS: f64 = 0.9;

/// What a contact's cone is known by.
fn key(contact: &Contact) -> Key {
    Key::Short(bits(contact.p_OC.iter()))
}

/// The laws of one cone, however it was asked for.
fn cone_kept(cone: &Cone<'_>, n_O: &Vec3, again: &Cone<'_>, mu: f64) -> Kept {
    laws::cone_valid(cone, n_O)?;
    laws::cone_within_friction(cone, mu)?;
    ensure("pure", format!("{cone:?}") == format!("{again:?}"), || {
        format!("the same call again answers otherwise: {cone:?} then {again:?}")
    })
}

impl ContactModel for Audited<'_, dyn ContactModel + '_> {
    fn cone(&self, finger: FingerIndex, contact: &Contact, mu: f64) -> Cone<'_> {
        self.value(
            ("cone", key(contact)),
            |model| model.cone(finger, contact, mu),
            || json!({ "finger": finger.0, "contact": input::contact(contact), "mu": mu }),
            |model, cone| {
                cone_kept(cone, &contact.n_O, &model.cone(finger, contact, mu), mu)?;
                laws::cone_inside(
                    "cone-monotone",
                    &contact.n_O,
                    &model.cone(finger, contact, LESS * mu),
                    cone,
                )
            },
        )
    }

    fn spinning_cone(&self, finger: FingerIndex, contact: &Contact, mu: f64) -> Cone<'_> {
        self.value(
            ("spinning_cone", key(contact)),
            |model| model.spinning_cone(finger, contact, mu),
            || json!({ "finger": finger.0, "contact": input::contact(contact), "mu": mu }),
            |model, cone| {
                cone_kept(cone, &contact.n_O, &model.spinning_cone(finger, contact, mu), mu)?;
                ensure("spinning-cone", !cone.carries_torsion(), || format!("{cone:?} carries torsion"))?;
                laws::cone_inside("spinning-cone", &contact.n_O, cone, &model.cone(finger, contact, mu))
            },
        )
    }

    fn fewest_contacts(&self) -> usize {
        self.value(
            ("fewest_contacts", Key::Always),
            |model| model.fewest_contacts(),
            || json!({}),
            |_, fewest| {
                ensure("fewest-contacts", (1..=MAX_FINGERS).contains(fewest), || {
                    format!("{fewest} contacts are not in 1..={MAX_FINGERS}")
                })
            },
        )
    }
}
