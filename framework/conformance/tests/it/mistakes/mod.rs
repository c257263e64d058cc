//! Mistakes that authors of plugins really make, each caught by the kit.
//!
//! Unlike the liars beside this file, which break one law each, a mistake may break several: the law that is
//! meant is among those that fail.
mod regrasp;
mod sampler;
mod strategy;
mod surface;
mod transfer;

use regrasp_api::{BodyPair, Clearance, Configuration, Entry, FingerIndex, FingerJoints, FingerSet};
use regrasp_api::{PairDistance, Pose, Settings, TipRule};
use regrasp_conformance::{Demands, check_with};

/// The settings of a plugin with a mistake.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Mistake {
    /// What it does wrong; nothing by default.
    pub mistake: String,
}

impl Settings for Mistake {}

/// An entry whose plugins make the mistake that their settings name.
#[macro_export]
macro_rules! mistaken {
    ($role:ident, $prefix:literal, $slots:expr, $build:expr) => {
        regrasp_api::Entry {
            id: concat!($prefix, "/mistaken"),
            slots: $slots,
            summary: "does what its author did not mean",
            references: &["nobody"],
            schema: <$crate::mistakes::Mistake as regrasp_api::Settings>::schema,
            check: regrasp_api::check_settings::<$crate::mistakes::Mistake>,
            build: regrasp_api::Build::$role(|json, parts| {
                let settings = <$crate::mistakes::Mistake as regrasp_api::Settings>::from_json(json)?;
                Ok(Box::new($build(settings.mistake, parts)))
            }),
        }
    };
}

/// Breaks unless the kit catches each mistake by the law beside it, or by one of them where several are.
fn judge(entry: &Entry, mistakes: &[(&str, &str)]) {
    let mut missed = String::new();
    for (mistake, laws) in mistakes {
        let settings = serde_json::json!({ "mistake": mistake }).to_string();
        let failed = check_with(entry, &Demands { settings, ..Demands::default() }).failed();
        if !laws.split('|').any(|law| failed.contains(&law)) {
            missed += &format!("`{mistake}` should break `{laws}`; it breaks {failed:?}\n");
        }
    }
    assert!(missed.is_empty(), "{missed}");
    check_with(entry, &Demands::default()).assert_passes();
}

/// A clearance that looks at some pairs of bodies alone.
struct Blinkered<'a> {
    all: &'a dyn Clearance,
    sees: fn(&BodyPair) -> bool,
}

impl Blinkered<'_> {
    fn judge(&self, found: Result<(), BodyPair>) -> Result<(), BodyPair> {
        found.or_else(|pair| if (self.sees)(&pair) { Err(pair) } else { Ok(()) })
    }
}

impl Clearance for Blinkered<'_> {
    fn object_free(&self, X_HO: &Pose) -> Result<(), BodyPair> {
        self.judge(self.all.object_free(X_HO))
    }
    fn finger_free(
        &self,
        finger: FingerIndex,
        joints: &FingerJoints,
        X_HO: &Pose,
        tip: TipRule,
    ) -> Result<(), BodyPair> {
        self.judge(self.all.finger_free(finger, joints, X_HO, tip))
    }
    fn fingers_free(
        &self,
        a: (FingerIndex, &FingerJoints),
        b: (FingerIndex, &FingerJoints),
    ) -> Result<(), BodyPair> {
        self.judge(self.all.fingers_free(a, b))
    }
    fn configuration_free(
        &self,
        q: &Configuration,
        moved: FingerSet,
        object_moved: bool,
    ) -> Result<(), BodyPair> {
        self.judge(self.all.configuration_free(q, moved, object_moved))
    }
    fn distances(&self, q: &Configuration, limit: f64) -> Vec<PairDistance> {
        self.all.distances(q, limit).into_iter().filter(|found| (self.sees)(&found.pair)).collect()
    }
}
