//! An audit of a real problem catches realistic mistakes, six and more of each role, and leaves what is right
//! alone.
#![allow(missing_docs)]

mod contact_models;
mod dents;
mod examples;
mod local_planners;
mod pyramids;
mod replays;
mod samplers;
mod stability_tests;
mod strategies;
mod surfaces;

use regrasp::api::Slot;
use regrasp::run::{AuditCase, Depth, NeverStops, Run, RunError, RunOptions};
use regrasp::{Stopwatch, load, setup};
use serde_json::json;

/// Plans `scenario` under audit with the liar of a slot that tells this lie.
fn audited(scenario: &str, slot: Slot, lie: &str) -> (Result<Run, RunError>, Option<AuditCase>) {
    let mut scenario = load(scenario).unwrap();
    scenario.choices.use_plugin(slot, "liar");
    scenario.choices.set(slot, "lie", json!(lie));
    if slot == Slot::Surface {
        // Relays hardly ever ask for shortest paths.
        scenario.choices.set(Slot::GraphStrategy, "relays", json!(0));
    }
    let watch = Stopwatch::start();
    let options = RunOptions { stop: &NeverStops, ..watch.options(1) };
    setup(&scenario).unwrap().run_audited(&options, Depth::Full)
}

/// Breaks unless the audit catches each lie by the law beside it, or by one of them where two are.
fn judge(slot: Slot, lies: &[(&str, &str)]) {
    let mut missed = String::new();
    for (lie, laws) in lies {
        let (run, case) = audited("cubic", slot, lie);
        let caught =
            case.as_ref().is_some_and(|case| laws.split('|').any(|law| law == case.breach.broken.law));
        let named = case.as_ref().is_some_and(|case| case.breach.slot == slot);
        if !caught || !named || run.is_ok() {
            let found = case.map(|case| case.breach);
            missed += &format!("`{lie}` should break `{laws}`: {found:?}, {:?}\n", run.err());
        }
    }
    assert!(missed.is_empty(), "{missed}");
    let (run, case) = audited("cubic", slot, "nothing");
    assert!(case.is_none(), "an honest plugin is accused: {:?}", case.map(|case| case.breach));
    assert!(run.unwrap().is_verified());
}

/// A role's liar: an entry, its settings with the lie, and how it is built from them.
#[macro_export]
macro_rules! liar {
    ($role:ident, $prefix:literal, $slots:expr, $build:expr) => {
        regrasp::api::inventory::submit! {
            regrasp::api::Entry {
                id: concat!($prefix, "/liar"),
                slots: $slots,
                summary: "says what it likes",
                references: &["nobody"],
                schema: <$crate::Lie as regrasp::api::Settings>::schema,
                check: regrasp::api::check_settings::<$crate::Lie>,
                build: regrasp::api::Build::$role(|json, parts| {
                    let lie = <$crate::Lie as regrasp::api::Settings>::from_json(json)?.lie;
                    let built: Result<_, regrasp::api::BuildError> = $build(lie, parts);
                    Ok(Box::new(built?))
                }),
            }
        }
    };
}

/// The settings of a liar.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Lie {
    /// What it does wrong.
    pub lie: String,
}

impl regrasp::api::Settings for Lie {}

/// Every second call is another one: what an impure plugin goes by.
fn odd() -> bool {
    use std::sync::atomic::{AtomicU64, Ordering};
    static CALLS: AtomicU64 = AtomicU64::new(0);
    CALLS.fetch_add(1, Ordering::Relaxed) % 2 == 1
}

#[test]
fn an_audit_changes_no_plan() {
    for name in ["sphere", "cubic", "ellip-obst"] {
        let scenario = load(name).unwrap();
        let (plain, watch) = (setup(&scenario).unwrap(), Stopwatch::start());
        let options = watch.options(2);
        let (under_audit, case) = plain.run_audited(&options, Depth::Full);
        assert!(case.is_none(), "{name}: {:?}", case.map(|case| case.breach));
        let (a, b) = (plain.run(&options).unwrap(), under_audit.unwrap());
        assert!(b.is_verified());
        assert_eq!(a.outcome.motion, b.outcome.motion, "{name}");
        assert_eq!(a.outcome.tally, b.outcome.tally, "{name}");
    }
}

#[test]
fn a_case_holds_the_problem_and_the_call() {
    let (_, case) = audited("cubic", Slot::ContactModel, "nan");
    let case = case.unwrap();
    let text = case.breach.error().to_string();
    assert!(text.contains("`contact-model/liar`") && text.contains("`cone-valid`"), "{text}");
    assert_eq!(case.file["format"], "regrasp-audit-case");
    assert_eq!(case.file["breach"]["call"], "cone");
    assert!(case.file["breach"]["input"]["contact"]["normal_O"].is_array());
    assert_eq!(case.file["scenario"]["plugins"]["contact-model"]["settings"]["lie"], "nan");
}
