//! A stability test: two contacts that press towards each other, and a third that stops the turn about their
//! line.
//!
//! Two point contacts with friction whose joining line lies strictly inside both friction cones balance every
//! wrench but a torque about that line (Nguyen, "Constructing force-closure grasps", IJRR 1988). If the cones
//! of the other contacts give torques of both signs about the line, the grasp is force closure. The condition
//! is sufficient, not necessary: where it fails the verdict is "undecided".

use regrasp_api::{
    Assessment, Build, CallError, Certificate, Cone, Context, Entry, Grasp, GraspContact, Hint, Settings,
    SettingsError, Slot, Stability, StabilityTest, Vec3, check_settings,
};
use serde::{Deserialize, Serialize};

/// Settings of [`PressedPair`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct PressedPairSettings {
    /// The least margin, no unit, that counts as stable.
    #[schemars(range(min = 1e-6, max = 0.5), extend("x-unit" = "1"))]
    pub least_margin: f64,
}

impl Default for PressedPairSettings {
    fn default() -> Self {
        Self { least_margin: 1e-4 }
    }
}

impl Settings for PressedPairSettings {}

/// A grasp is stable if two of its contacts press towards each other and the others stop the turn about their
/// line.
#[derive(Clone, Copy, Debug)]
pub struct PressedPair {
    settings: PressedPairSettings,
}

/// A contact with the slope of its friction cone.
#[derive(Clone, Copy)]
struct Point<'a> {
    contact: &'a GraspContact<'a>,
    mu: f64,
}

impl PressedPair {
    /// A stability test with checked settings.
    pub fn new(settings: PressedPairSettings) -> Result<Self, SettingsError> {
        settings.validate()?;
        Ok(Self { settings })
    }

    /// The best margin over all pairs: how far (no unit) friction cones and torques are from failing; not
    /// positive where every pair fails.
    fn margin(&self, grasp: &Grasp<'_>) -> Result<f64, CallError> {
        let contacts = grasp.contacts();
        for contact in contacts {
            slope(contact)?;
        }
        let point = |i: usize| Point { contact: &contacts[i], mu: slope(&contacts[i]).unwrap_or(0.0) };
        let mut best = f64::NEG_INFINITY;
        for a in 0..contacts.len() {
            for b in 0..a {
                let others = (0..contacts.len()).filter(|&i| i != a && i != b).map(point);
                best = best.max(pair_margin(point(a), point(b), others));
            }
        }
        Ok(best)
    }

    fn verdict(&self, margin: f64) -> Stability {
        if margin >= self.settings.least_margin { Stability::Stable } else { Stability::Undecided }
    }
}

/// The slope of a contact's friction cone. A torque about the normal, where the cone has one, only helps and
/// is left out.
fn slope(contact: &GraspContact<'_>) -> Result<f64, CallError> {
    match &contact.cone {
        Cone::Elliptic { mu, .. } => Ok(*mu),
        Cone::Grained(_) | Cone::Polyhedral(_) => Err(CallError::Unsupported {
            plugin: ENTRY.id.into(),
            reason: "it knows round friction cones only; use another stability test with this contact model"
                .into(),
        }),
    }
}

/// The smallest of the pair's slacks in its two cones and of the torques that the others give about its line,
/// either way.
fn pair_margin<'a>(a: Point<'a>, b: Point<'a>, others: impl Iterator<Item = Point<'a>>) -> f64 {
    let line = b.contact.p_OC - a.contact.p_OC;
    let length = line.norm();
    if length.is_nan() || length <= 0.0 {
        return f64::NEG_INFINITY;
    }
    let along = line / length;
    let (mut left, mut right) = (f64::NEG_INFINITY, f64::NEG_INFINITY);
    for other in others {
        // The torque of a force f about the line is f · lever.
        let lever = along.cross(&(other.contact.p_OC - a.contact.p_OC)) / length;
        left = left.max(reach(other, &lever));
        right = right.max(reach(other, &-lever));
    }
    slack(a, &along).min(slack(b, &-along)).min(left).min(right)
}

/// How far inside the cone the direction lies: positive strictly inside.
fn slack(point: Point<'_>, direction: &Vec3) -> f64 {
    let inward = -point.contact.n_O;
    let normal = direction.dot(&inward);
    point.mu * normal - (direction - inward * normal).norm()
}

/// The largest f · w over the cone's forces of unit normal part.
fn reach(point: Point<'_>, w: &Vec3) -> f64 {
    let inward = -point.contact.n_O;
    let normal = w.dot(&inward);
    normal + point.mu * (w - inward * normal).norm()
}

impl StabilityTest for PressedPair {
    fn test(
        &self,
        grasp: &Grasp<'_>,
        _hint: &mut Hint,
        context: &mut Context<'_>,
    ) -> Result<Stability, CallError> {
        context.count_call(Slot::StabilityTest);
        Ok(self.verdict(self.margin(grasp)?))
    }

    /// The margin is the criterion's own: comparable between grasps under this test only.
    fn assess(
        &self,
        grasp: &Grasp<'_>,
        _length: Option<f64>,
        _center_O: Option<Vec3>,
        _context: &mut Context<'_>,
    ) -> Result<Assessment, CallError> {
        let margin = self.margin(grasp)?;
        let stability = self.verdict(margin);
        let (margin_lower, margin_upper) =
            if stability.is_stable() { (margin, margin) } else { (0.0, f64::INFINITY) };
        Ok(Assessment { stability, margin_lower, margin_upper, certificate: Certificate::None })
    }
}

/// How the plugin presents itself.
pub const ENTRY: Entry = Entry {
    id: "stability-test/template",
    slots: &[Slot::StabilityTest],
    summary: "two contacts that press towards each other, and others that stop the turn about their line",
    references: &["Nguyen, Constructing force-closure grasps, IJRR 1988"],
    schema: PressedPairSettings::schema,
    check: check_settings::<PressedPairSettings>,
    build: Build::StabilityTest(|json, _parts| {
        Ok(Box::new(PressedPair::new(PressedPairSettings::from_json(json)?)?))
    }),
};
