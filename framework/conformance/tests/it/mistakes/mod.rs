//! Mistakes that authors of plugins really make, each caught by the kit.
//!
//! Unlike the liars beside this file, which break one law each, a mistake may break several: the law that is
//! meant is among those that fail.
mod regrasp;
mod sampler;
mod strategy;
mod surface;
mod transfer;

use regrasp_api::{Entry, Settings};
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
