//! Mistakes of contact models.

use regrasp::api::{Cone, ConeEdge, Contact, ContactModel, FingerIndex, Slot};

struct Liar(String);

impl ContactModel for Liar {
    fn cone(&self, finger: FingerIndex, _: &Contact, mu: f64) -> Cone<'_> {
        let edge = |x: f64, y: f64| ConeEdge { tangential: [x * mu, y * mu], torsion: 0.0 };
        match self.0.as_str() {
            "nan" => Cone::Elliptic { mu: f64::NAN, gamma: 0.0 },
            "wide" => Cone::Elliptic { mu: 1.2 * mu, gamma: 0.0 },
            // Wide at the corners of the square that was to hold the circle.
            "corners" => Cone::Polyhedral(
                vec![edge(1.0, 1.0), edge(-1.0, 1.0), edge(-1.0, -1.0), edge(1.0, -1.0)].into(),
            ),
            "one-sided" => Cone::Polyhedral(vec![edge(0.9, 0.1), edge(0.5, 0.5), edge(0.6, -0.4)].into()),
            "less-with-more" => Cone::Elliptic { mu: (0.5 - 0.3 * mu).max(0.0), gamma: 0.0 },
            "impure" if super::odd() => Cone::Elliptic { mu: 0.9 * mu, gamma: 0.0 },
            "only-one-finger" if finger == FingerIndex(2) => Cone::Polyhedral(Vec::new().into()),
            _ => Cone::Elliptic { mu, gamma: 0.0 },
        }
    }

    fn spinning_cone(&self, finger: FingerIndex, contact: &Contact, mu: f64) -> Cone<'_> {
        match self.0.as_str() {
            "spins-on" => Cone::Elliptic { mu, gamma: 0.002 },
            "spins-wider" => Cone::Elliptic { mu: mu + 0.01, gamma: 0.0 },
            _ => self.cone(finger, contact, mu),
        }
    }

    fn fewest_contacts(&self) -> usize {
        if self.0 == "none-needed" { 0 } else { 3 }
    }
}

crate::liar!(ContactModel, "contact-model", &[Slot::ContactModel], |lie, _: &_| Ok(Liar(lie)));

#[test]
fn caught() {
    super::judge(
        Slot::ContactModel,
        &[
            ("nan", "cone-valid"),
            ("wide", "cone-within-friction"),
            ("corners", "cone-within-friction"),
            ("one-sided", "cone-valid"),
            ("less-with-more", "cone-monotone"),
            ("impure", "pure|cone-monotone"),
            ("only-one-finger", "cone-valid"),
            ("spins-on", "spinning-cone"),
            ("spins-wider", "spinning-cone|cone-within-friction"),
        ],
    );
}
