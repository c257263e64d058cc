//! For each law of contact models, and for each law of entries, one liar that breaks it and no other.
use crate::support;

use regrasp_api::*;
use regrasp_conformance::{assert_silent, check, checks};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

/// What a liar does wrong.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Lie {
    Nothing,
    NoEdges,
    ShrinksAtHighFriction,
    WiderThanCoulomb,
    TwoAreEnough,
    SpinsOnForEver,
    ForgetsToSpin,
    Millimetres,
    FollowsTheTangents,
    GoesByFacet,
    Counts,
    RemembersTheFirst,
    OtherOnOtherThreads,
    LosesTheGrainAtThePoles,
    KnowsThreeFingers,
    IgnoresTheFriction,
    SquaresTheFriction,
    DrawsEdgesOutside,
    ThinsTorsion,
    ThreeAreNeeded,
    TakesTheNormalInward,
    KeepsConesWhateverTheFriction,
    KeepsConesByPlace,
    Prints,
}

struct Liar {
    lie: Lie,
    calls: AtomicU64,
    home: std::thread::ThreadId,
    kept: Mutex<BTreeMap<[u64; 3], Cone<'static>>>,
}

fn build(lie: Lie) -> Box<dyn ContactModel> {
    Box::new(Liar {
        lie,
        calls: AtomicU64::new(0),
        home: std::thread::current().id(),
        kept: Default::default(),
    })
}

impl Liar {
    /// What was first answered under this key.
    fn first(&self, key: [u64; 3], cone: Cone<'static>) -> Cone<'static> {
        self.kept.lock().unwrap().entry(key).or_insert(cone).clone()
    }
}

/// A grain along z, as one writes it who normalises what is left of the axis in the tangent plane.
fn grain_along_z(contact: &Contact, mu: f64) -> Cone<'static> {
    let along = Vec3::z() - contact.n_O * contact.n_O.z;
    let [x, y] = tangents(&-contact.n_O).map(|t| t.dot(&along) / along.norm());
    let edge = |a: f64, b: f64| ConeEdge { tangential: [x * a - y * b, y * a + x * b], torsion: 0.0 };
    let corners = [edge(0.9 * mu, 0.0), edge(0.0, 0.5 * mu), edge(-0.9 * mu, 0.0), edge(0.0, -0.5 * mu)];
    Cone::Polyhedral(corners.to_vec().into())
}

impl ContactModel for Liar {
    fn cone(&self, finger: FingerIndex, contact: &Contact, mu: f64) -> Cone<'_> {
        let round: Cone<'static> = Cone::Elliptic { mu, gamma: 0.0 };
        match self.lie {
            Lie::NoEdges if mu == 0.0 => Cone::Polyhedral(Vec::new().into()),
            Lie::ShrinksAtHighFriction if mu > 1.0 => Cone::Elliptic { mu: 0.9, gamma: 0.0 },
            Lie::WiderThanCoulomb => Cone::Elliptic { mu: 1.1 * mu, gamma: 0.0 },
            Lie::Counts if self.calls.fetch_add(1, Ordering::Relaxed) % 7 == 6 && mu > 0.1 => {
                Cone::Elliptic { mu: mu - 1e-12, gamma: 0.0 }
            }
            Lie::OtherOnOtherThreads if std::thread::current().id() != self.home => {
                Cone::Elliptic { mu: 0.5 * mu, gamma: 0.0 }
            }
            Lie::Millimetres => Cone::Elliptic { mu, gamma: 2.0 },
            // A grain that is given along the tangents, which are no fact about the object.
            Lie::FollowsTheTangents => {
                let edge = |x: f64, y: f64| ConeEdge { tangential: [x * mu, y * mu], torsion: 0.0 };
                Cone::Polyhedral(
                    vec![edge(1.0, 0.0), edge(-1.0, 0.0), edge(0.0, 0.5), edge(0.0, -0.5)].into(),
                )
            }
            Lie::GoesByFacet if contact.facet.is_multiple_of(2) => {
                Cone::Elliptic { mu: 0.9 * mu, gamma: 0.0 }
            }
            Lie::RemembersTheFirst => {
                let bits = contact.n_O.x.to_bits() | 1;
                let first = self.calls.compare_exchange(0, bits, Ordering::Relaxed, Ordering::Relaxed);
                let part =
                    if first.unwrap_or_else(|first| first) == bits || first.is_ok() { 1.0 } else { 0.99 };
                Cone::Elliptic { mu: part * mu, gamma: 0.0 }
            }
            Lie::LosesTheGrainAtThePoles => grain_along_z(contact, mu),
            Lie::KnowsThreeFingers if finger.0 > 2 => Cone::Polyhedral(Vec::new().into()),
            Lie::IgnoresTheFriction => Cone::Elliptic { mu: 0.5, gamma: 0.0 },
            Lie::SquaresTheFriction => Cone::Elliptic { mu: mu * mu, gamma: 0.0 },
            // Edges that touch the round cone from outside, half a percent beyond it at the corners.
            Lie::DrawsEdgesOutside => {
                let corner = |k: usize| {
                    let (sin, cos) = (std::f64::consts::PI * k as f64 / 16.0).sin_cos();
                    ConeEdge { tangential: [1.005 * mu * cos, 1.005 * mu * sin], torsion: 0.0 }
                };
                Cone::Polyhedral((0..32).map(corner).collect())
            }
            Lie::ThinsTorsion => Cone::Elliptic { mu, gamma: 0.002 / mu.max(0.04) },
            Lie::ThreeAreNeeded => Cone::Elliptic { mu, gamma: 0.004 },
            Lie::TakesTheNormalInward if contact.n_O.z.abs() < 0.99 => {
                grain_along_z(&Contact { n_O: -contact.n_O, ..*contact }, mu)
            }
            Lie::KeepsConesWhateverTheFriction => self.first(contact.p_OC.map(f64::to_bits).into(), round),
            Lie::KeepsConesByPlace => {
                let cell = [contact.p_OC.x, contact.p_OC.y, mu].map(|x| ((x + 1.0) * 1e3).round() as u64);
                self.first(cell, Cone::Elliptic { mu: (0.9 + 0.1 * contact.n_O.x.powi(2)) * mu, gamma: 0.0 })
            }
            Lie::Prints => {
                println!("the friction is {mu}");
                round
            }
            _ => round,
        }
    }

    fn spinning_cone(&self, finger: FingerIndex, contact: &Contact, mu: f64) -> Cone<'_> {
        match self.lie {
            Lie::SpinsOnForEver => Cone::Elliptic { mu, gamma: 1e-3 },
            Lie::ForgetsToSpin => Cone::FRICTIONLESS,
            // Torsion is its one fault, and that only at rest.
            Lie::Millimetres | Lie::ThinsTorsion | Lie::ThreeAreNeeded => Cone::Elliptic { mu, gamma: 0.0 },
            _ => self.cone(finger, contact, mu),
        }
    }

    fn fewest_contacts(&self) -> usize {
        if matches!(self.lie, Lie::TwoAreEnough | Lie::Millimetres | Lie::ThinsTorsion) { 2 } else { 3 }
    }
}

const HONEST: Entry = Entry {
    id: "contact-model/liar",
    slots: &[Slot::ContactModel],
    summary: "says what it likes",
    references: &["nobody"],
    schema: NoSettings::schema,
    check: check_settings::<NoSettings>,
    build: Build::ContactModel(|json, _| {
        NoSettings::from_json(json)?;
        Ok(build(Lie::Nothing))
    }),
};

macro_rules! liar {
    ($lie:expr) => {
        Entry {
            build: Build::ContactModel(|json, _| {
                NoSettings::from_json(json)?;
                Ok(build($lie))
            }),
            ..HONEST
        }
    };
}

#[test]
fn each_liar_fails_its_check_and_no_other() {
    let liars = [
        (liar!(Lie::NoEdges), "cone-valid"),
        (liar!(Lie::ShrinksAtHighFriction), "cone-monotone"),
        (liar!(Lie::WiderThanCoulomb), "cone-within-friction"),
        (liar!(Lie::TwoAreEnough), "fewest-contacts"),
        (liar!(Lie::SpinsOnForEver), "spinning-cone"),
        (liar!(Lie::ForgetsToSpin), "spinning-cone"),
        (liar!(Lie::Millimetres), "torsion-bounded"),
        (liar!(Lie::FollowsTheTangents), "tangent-frames"),
        (liar!(Lie::GoesByFacet), "facet-numbers"),
        (liar!(Lie::RemembersTheFirst), "contact-model-pure"),
        (liar!(Lie::Counts), "contact-model-pure"),
        (liar!(Lie::OtherOnOtherThreads), "contact-model-pure"),
        (liar!(Lie::LosesTheGrainAtThePoles), "cone-valid"),
        (liar!(Lie::KnowsThreeFingers), "cone-valid"),
        (liar!(Lie::IgnoresTheFriction), "cone-within-friction"),
        (liar!(Lie::SquaresTheFriction), "cone-within-friction"),
        (liar!(Lie::DrawsEdgesOutside), "cone-within-friction"),
        (liar!(Lie::ThinsTorsion), "cone-monotone"),
        (liar!(Lie::ThreeAreNeeded), "fewest-contacts"),
        (liar!(Lie::TakesTheNormalInward), "tangent-frames"),
        (liar!(Lie::KeepsConesWhateverTheFriction), "contact-model-pure"),
        (liar!(Lie::KeepsConesByPlace), "contact-model-pure"),
    ];
    support::judge(Slot::ContactModel, &HONEST, &liars, &[]);
}

/// Settings with one number of each kind.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
struct Numbers {
    /// A length (m).
    #[schemars(range(min = 0.001, max = 0.1), extend("x-unit" = "m"))]
    length: f64,
    /// A count.
    #[schemars(range(min = 3, max = 64))]
    edges: usize,
}

impl Default for Numbers {
    fn default() -> Self {
        Self { length: 0.01, edges: 8 }
    }
}

impl Settings for Numbers {}

/// Settings that say one range and keep another.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
struct Loose {
    /// A length (m), or so it says.
    #[schemars(range(min = 0.001, max = 0.1), extend("x-unit" = "m"))]
    length: f64,
}

impl Default for Loose {
    fn default() -> Self {
        Self { length: 0.01 }
    }
}

impl Settings for Loose {
    fn from_json(text: &str) -> Result<Self, SettingsError> {
        let text = if text.trim().is_empty() { "{}" } else { text };
        let form = |error: serde_json::Error| SettingsError::Form(error.to_string());
        let given: Self = serde_json::from_str(text).map_err(form)?;
        let kept = if given.length <= 0.2 { given.length.min(0.1) } else { given.length };
        Self { length: kept }.validate()?;
        Ok(given)
    }
}

/// Settings without a word about them.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
struct Undescribed {
    on: bool,
}

impl Settings for Undescribed {}

/// Settings that a default does not satisfy.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
struct NoDefault {
    /// A length (m).
    #[schemars(range(min = 0.001, max = 0.1), extend("x-unit" = "m"))]
    length: f64,
}

impl Settings for NoDefault {}

/// Settings that ignore what they do not know.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default)]
struct Lenient {}

impl Settings for Lenient {}

/// Settings within settings, of which the inner ones are lenient.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
struct OuterLenient {
    /// What is inside.
    inner: LenientInside,
}

/// Settings within settings, of which the inner ones keep no range.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
struct OuterLoose {
    /// What is inside.
    inner: LooseInside,
}

/// Inner settings that ignore what they do not know.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default)]
struct LenientInside {
    /// A flag.
    on: bool,
}

impl Settings for OuterLenient {}

/// Settings whose optional number and whose list are not looked at.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
struct Unlooked {
    /// A share, or none.
    #[schemars(range(min = 0.0, max = 1.0), extend("x-unit" = "1"))]
    share: Option<f64>,
    /// Two lengths (m), 0..=1 as only this line says.
    #[schemars(extend("x-unit" = "m"))]
    lengths: [f64; 2],
}

impl Default for Unlooked {
    fn default() -> Self {
        Self { share: None, lengths: [0.1, 0.2] }
    }
}

impl Settings for Unlooked {}

/// Settings within settings whose range is not looked at.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
struct LooseInside {
    /// A share, 0..=1 as only this line says.
    #[schemars(extend("x-unit" = "1"))]
    share: f64,
}

impl Default for LooseInside {
    fn default() -> Self {
        Self { share: 0.5 }
    }
}

impl Settings for OuterLoose {}

macro_rules! with_settings {
    ($settings:ty) => {
        Entry {
            schema: <$settings>::schema,
            check: check_settings::<$settings>,
            build: Build::ContactModel(|json, _| {
                <$settings>::from_json(json)?;
                Ok(build(Lie::Nothing))
            }),
            ..HONEST
        }
    };
}

#[test]
fn each_lying_entry_fails_its_check_and_no_other() {
    check(&with_settings!(Numbers)).assert_passes();
    let careless = Entry { build: Build::ContactModel(|_, _| Ok(build(Lie::Nothing))), ..HONEST };
    let liars = [
        (Entry { id: "surface/liar", ..HONEST }, "entry-identity"),
        (Entry { id: "contact-model/Liar", ..HONEST }, "entry-identity"),
        (Entry { slots: &[], ..HONEST }, "entry-identity"),
        (Entry { references: &[], ..HONEST }, "entry-description"),
        (Entry { summary: " ", ..HONEST }, "entry-description"),
        (with_settings!(Undescribed), "entry-schema"),
        (with_settings!(Lenient), "entry-unknown-key"),
        (with_settings!(OuterLenient), "entry-unknown-key"),
        (with_settings!(OuterLoose), "entry-ranges"),
        (with_settings!(Unlooked), "entry-ranges"),
        (with_settings!(Loose), "entry-ranges"),
        (careless, "entry-build-agrees"),
    ];
    for (liar, expected) in &liars {
        let report = check(liar);
        assert_eq!(report.failed(), [*expected], "{report}");
    }
    // Where even the defaults are refused no plugin can be built, and nothing else can be said of it.
    let report = check(&with_settings!(NoDefault));
    assert!(report.failed().contains(&"entry-defaults"), "{report}");
    for (name, _) in checks(Slot::ContactModel).into_iter().filter(|(name, _)| name.starts_with("entry-")) {
        assert!(name == "entry-defaults" || liars.iter().any(|(_, caught)| *caught == name), "{name}");
    }
}

#[test]
fn a_silent_plugin_is_found_silent() {
    assert_silent(concat!(module_path!(), "::a_silent_plugin_is_found_silent"), &[&HONEST]);
}

#[test]
fn a_plugin_that_prints_is_caught() {
    let name = concat!(module_path!(), "::a_plugin_that_prints_is_caught");
    let caught = std::panic::catch_unwind(|| assert_silent(name, &[&liar!(Lie::Prints)]));
    if let Err(payload) = caught {
        let text = payload.downcast_ref::<String>().expect("an assertion's message");
        assert!(text.contains("wrote to standard output") && text.contains("the friction is"), "{text}");
    } else {
        assert!(std::env::var_os("REGRASP_CONFORMANCE_CHILD").is_some(), "nothing was caught");
    }
}
