//! The laws of the contact model's role: pure, monotone in the friction, elliptic cones of the right family.

use proptest::prelude::*;
use regrasp_api::{Build, Cone, Contact, ContactModel, Entry, FingerIndex, Vec3, inventory};
use regrasp_contact_models::{Frictionless, Pcwf, SoftFinger, SoftFingerSettings};

fn models() -> [Box<dyn ContactModel>; 3] {
    let soft = SoftFinger::new(SoftFingerSettings { gamma: 0.004 }).unwrap();
    [Box::new(Frictionless), Box::new(Pcwf), Box::new(soft)]
}

fn radii(cone: Cone<'_>) -> (f64, f64) {
    match cone {
        Cone::Elliptic { mu, gamma } => (mu, gamma),
        Cone::Grained(_) | Cone::Polyhedral(_) => panic!("the built-in contact models are elliptic"),
    }
}

/// Whether force `f_t`, `m` at unit normal force lies in the cone, by the definition of [`Cone::Elliptic`].
fn transmits(cone: Cone<'_>, f_t: f64, m: f64) -> bool {
    let (mu, gamma) = radii(cone);
    let part = |x: f64, radius: f64| if x == 0.0 { 0.0 } else { (x / radius).powi(2) };
    part(f_t, mu) + part(m, gamma) <= 1.0
}

proptest! {
    #[test]
    fn more_friction_transmits_all_that_less_does(
        mu in 0.0..2.0_f64, more in 0.0..2.0_f64, f_t in 0.0..2.0_f64, m in 0.0..0.01_f64,
        p in prop::array::uniform3(-0.1..0.1_f64),
    ) {
        let contact = Contact { facet: 3, p_OC: Vec3::from(p), n_O: Vec3::x() };
        for model in models() {
            let less = transmits(model.cone(FingerIndex(0), &contact, mu), f_t, m);
            prop_assert!(!less || transmits(model.cone(FingerIndex(0), &contact, mu + more), f_t, m));
        }
    }

    #[test]
    fn the_cone_depends_on_friction_alone(mu in 0.0..2.0_f64, p in prop::array::uniform3(-0.1..0.1_f64)) {
        let here = Contact { facet: 0, p_OC: Vec3::zeros(), n_O: Vec3::z() };
        let there = Contact { facet: 9, p_OC: Vec3::from(p), n_O: Vec3::y() };
        for model in models() {
            prop_assert_eq!(model.cone(FingerIndex(0), &here, mu), model.cone(FingerIndex(0), &there, mu));
        }
    }
}

#[test]
fn families_and_fewest_contacts_are_those_of_theory() {
    let contact = Contact { facet: 0, p_OC: Vec3::zeros(), n_O: Vec3::z() };
    let found =
        models().map(|model| (radii(model.cone(FingerIndex(0), &contact, 0.7)), model.fewest_contacts()));
    assert_eq!(found, [((0.0, 0.0), 7), ((0.7, 0.0), 3), ((0.7, 0.004), 2)]);
}

#[test]
fn all_three_are_registered_with_sources_and_a_schema() {
    let mut entries: Vec<_> = inventory::iter::<Entry>.into_iter().collect();
    entries.sort_by_key(|entry| entry.id);
    let ids: Vec<_> = entries.iter().map(|entry| entry.id).collect();
    assert_eq!(ids, ["contact-model/frictionless", "contact-model/pcwf", "contact-model/soft-finger"]);
    for entry in entries {
        assert!(matches!(entry.build, Build::ContactModel(_)));
        assert!(!entry.references.is_empty() && (entry.schema)().starts_with('{'));
        assert!((entry.check)("").is_ok() && (entry.check)(r#"{"nonsense": 1}"#).is_err());
    }
}
