//! A stability test: every contact pushes towards one common point, and that proves the grasp.

// ANCHOR: uses
use regrasp_api::{
    Assessment, Build, CallError, Certificate, Cone, Context, Entry, Grasp, GraspContact, Hint, Settings,
    SettingsError, Slot, Stability, StabilityTest, Vec3, check_settings,
};
use serde::{Deserialize, Serialize};
// ANCHOR_END: uses

// ANCHOR: settings
/// Settings of [`Concurrent`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ConcurrentSettings {
    /// The least room, no unit, that the forces must leave in their cones.
    #[schemars(range(min = 1e-6, max = 0.5), extend("x-unit" = "1"))]
    pub least_margin: f64,
    /// How many other points than the middle are tried, to each side of it from each contact.
    #[schemars(range(max = 6))]
    pub leans: usize,
}

impl Default for ConcurrentSettings {
    fn default() -> Self {
        Self { least_margin: 1e-4, leans: 3 }
    }
}

impl Settings for ConcurrentSettings {}

/// A grasp is stable if three or more of its contacts can all push towards one point between them.
#[derive(Clone, Copy, Debug)]
pub struct Concurrent {
    settings: ConcurrentSettings,
}

impl Concurrent {
    /// A stability test with checked settings.
    pub fn new(settings: ConcurrentSettings) -> Result<Self, SettingsError> {
        settings.validate()?;
        Ok(Self { settings })
    }
}
// ANCHOR_END: settings

// ANCHOR: part
/// Some contacts of a grasp, and the point that they push towards: their middle, one of them counting more or
/// less than the others.
#[derive(Clone, Copy)]
struct Part<'a> {
    contacts: &'a [GraspContact<'a>],
    /// The contacts whose bits are set belong to it.
    bits: usize,
    /// The contact that counts differently, and its weight; the others' is 1.
    odd: (usize, f64),
}

impl<'a> Part<'a> {
    /// Every part with three contacts or more, with every point.
    fn all(contacts: &'a [GraspContact<'a>], leans: usize) -> impl Iterator<Item = Self> {
        let parts = (0..1_usize << contacts.len()).filter(|bits| bits.count_ones() >= 3);
        parts.flat_map(move |bits| {
            let even = Self { contacts, bits, odd: (0, 1.0) };
            let odd = (0..contacts.len()).filter(move |i| bits >> i & 1 == 1);
            let weights =
                move |i| (1..=leans as i32).flat_map(move |k| [(i, 2_f64.powi(k)), (i, 2_f64.powi(-k))]);
            std::iter::once(even).chain(odd.flat_map(weights).map(move |odd| Self { odd, ..even }))
        })
    }

    /// The contacts with their weights.
    fn iter(self) -> impl Iterator<Item = (&'a GraspContact<'a>, f64)> {
        let (odd, weight) = self.odd;
        let inside = self.contacts.iter().enumerate().filter(move |(i, _)| self.bits >> i & 1 == 1);
        inside.map(move |(i, contact)| (contact, if i == odd { weight } else { 1.0 }))
    }

    /// The point, and the distance of the farthest contact from it (m).
    fn point(self) -> (Vec3, f64) {
        let sum: Vec3 = self.iter().map(|(contact, weight)| contact.p_OC * weight).sum();
        let point = sum / self.iter().map(|(_, weight)| weight).sum::<f64>();
        (point, self.iter().map(|(contact, _)| (contact.p_OC - point).norm()).fold(0.0, f64::max))
    }
}
// ANCHOR_END: part

// ANCHOR: margin
impl Part<'_> {
    /// How far (no unit) these contacts are from failing; not positive where they fail.
    fn margin(self) -> f64 {
        let (point, size) = self.point();
        if size.is_nan() || size <= 0.0 {
            return f64::NEG_INFINITY;
        }
        let push = |contact: &GraspContact<'_>| (point - contact.p_OC) / size;
        let room =
            self.iter().map(|(contact, _)| room(contact, &push(contact))).fold(f64::INFINITY, f64::min);
        // Contacts on one line leave the turn about it free, whatever their forces.
        let spread = self
            .iter()
            .flat_map(|(a, _)| self.iter().map(move |(b, _)| push(a).cross(&push(b)).norm()))
            .fold(0.0, f64::max);
        room.min(spread)
    }
}

/// How far inside the contact's friction cone a force on the object is; negative outside.
fn room(contact: &GraspContact<'_>, force: &Vec3) -> f64 {
    let inward = -contact.n_O;
    let normal = force.dot(&inward);
    slope(contact).unwrap_or(0.0) * normal - (force - inward * normal).norm()
}
// ANCHOR_END: margin

// ANCHOR: cones
/// The slope of a contact's friction cone. A torque about the normal, where the cone has one, only helps and
/// is left out.
fn slope(contact: &GraspContact<'_>) -> Result<f64, CallError> {
    match &contact.cone {
        Cone::Elliptic { mu, .. } => Ok(*mu),
        Cone::Grained(_) | Cone::Polyhedral(_) => {
            let reason = "it knows round friction cones only; use `stability-test/linearised`".into();
            Err(CallError::Unsupported { plugin: ENTRY.id.into(), reason })
        }
    }
}

fn supported<'a>(grasp: &'a Grasp<'_>) -> Result<&'a [GraspContact<'a>], CallError> {
    let contacts = grasp.contacts();
    contacts.iter().try_for_each(|contact| slope(contact).map(drop))?;
    Ok(contacts)
}
// ANCHOR_END: cones

// ANCHOR: role
impl StabilityTest for Concurrent {
    fn test(
        &self,
        grasp: &Grasp<'_>,
        _hint: &mut Hint,
        context: &mut Context<'_>,
    ) -> Result<Stability, CallError> {
        context.count_call(Slot::StabilityTest);
        let holds = |part: Part<'_>| part.margin() >= self.settings.least_margin;
        // "Undecided" and not "unstable": that no part is concurrent proves nothing.
        Ok(if Part::all(supported(grasp)?, self.settings.leans).any(holds) {
            Stability::Stable
        } else {
            Stability::Undecided
        })
    }

    /// The margin is the test's own: comparable between grasps under this test only.
    fn assess(
        &self,
        grasp: &Grasp<'_>,
        _length: Option<f64>,
        _center_O: Option<Vec3>,
        _context: &mut Context<'_>,
    ) -> Result<Assessment, CallError> {
        let contacts = supported(grasp)?;
        let parts = || Part::all(contacts, self.settings.leans);
        let margin = parts().map(Part::margin).fold(f64::NEG_INFINITY, f64::max);
        if margin < self.settings.least_margin {
            let (stability, certificate) = (Stability::Undecided, Certificate::None);
            return Ok(Assessment { stability, margin_lower: 0.0, margin_upper: f64::INFINITY, certificate });
        }
        let all = (1 << contacts.len()) - 1;
        let whole = parts().find(|part| part.bits == all && part.margin() >= self.settings.least_margin);
        let certificate = whole.map_or(Certificate::None, forces);
        Ok(Assessment {
            stability: Stability::Stable,
            margin_lower: margin,
            margin_upper: margin,
            certificate,
        })
    }
}

/// The proof, where all contacts push: anybody can add these forces up and look whether they lie in their
/// cones.
fn forces(whole: Part<'_>) -> Certificate {
    let (point, size) = whole.point();
    let force = |(contact, weight): (&GraspContact<'_>, f64)| (point - contact.p_OC) * (weight / size);
    let forces_O: Vec<Vec3> = whole.iter().map(force).collect();
    Certificate::InternalForce { torsions: vec![0.0; forces_O.len()], forces_O }
}
// ANCHOR_END: role

// ANCHOR: entry
/// How the plugin presents itself.
pub const ENTRY: Entry = Entry {
    id: "stability-test/concurrent",
    slots: &[Slot::StabilityTest],
    summary: "three or more contacts push towards one point between them; sufficient, not necessary",
    references: &["Ponce, Sullivan, Sudsang, Boissonnat, Merlet, On computing four-finger equilibrium and \
            force-closure grasps of polyhedral objects, IJRR 1997"],
    schema: ConcurrentSettings::schema,
    check: check_settings::<ConcurrentSettings>,
    build: Build::StabilityTest(|json, _parts| {
        Ok(Box::new(Concurrent::new(ConcurrentSettings::from_json(json)?)?))
    }),
};
regrasp_api::inventory::submit! { ENTRY }
// ANCHOR_END: entry

// ANCHOR: tests
#[cfg(test)]
mod tests {
    use super::*;
    use regrasp_api::FingerIndex;

    /// The margin of the best part of contacts on the equator of a ball, at these angles (degrees).
    fn margin(angles: &[f64], mu: f64, leans: usize) -> f64 {
        let mut grasp = Grasp::new(Vec3::zeros());
        for (i, angle) in angles.iter().enumerate() {
            let n_O = Vec3::new(angle.to_radians().cos(), angle.to_radians().sin(), 0.0);
            let cone = Cone::Elliptic { mu, gamma: 0.0 };
            grasp.push(GraspContact { finger: FingerIndex(i as u8), p_OC: n_O * 0.03, n_O, cone });
        }
        Part::all(grasp.contacts(), leans).map(Part::margin).fold(f64::NEG_INFINITY, f64::max)
    }

    #[test]
    fn even_contacts_push_straight_in_and_have_all_their_friction_left() {
        assert!((margin(&[0.0, 120.0, 240.0], 0.5, 0) - 0.5).abs() < 1e-12);
        assert!((margin(&[0.0, 120.0, 240.0], 0.05, 0) - 0.05).abs() < 1e-12);
    }

    #[test]
    fn contacts_on_one_side_fail_and_a_fourth_that_is_not_needed_does_not_hurt() {
        assert!(margin(&[0.0, 20.0, 40.0], 0.8, 6) < 0.0);
        assert!(margin(&[0.0, 120.0, 240.0, 250.0], 0.3, 0) >= margin(&[0.0, 120.0, 240.0], 0.3, 0));
    }

    #[test]
    fn leaning_finds_what_the_middle_misses() {
        let uneven = [0.0, 95.0, 190.0];
        assert!(margin(&uneven, 0.2, 0) < 0.0 && margin(&uneven, 0.2, 3) > 0.0);
    }
}
// ANCHOR_END: tests
