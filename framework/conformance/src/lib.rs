//! The conformance kit: the laws that make plugins of one role interchangeable, as checks that any plugin can
//! be put through.
//!
//! An author calls it from one test file of the plugin's crate:
//!
//! ```text
//! use my_plugin as _; // links the crate, so that its entries are registered
//! regrasp_conformance::registered_plugins_conform!();
//! ```
//!
//! or looks at the report of one entry: `regrasp_conformance::check(&ENTRY).assert_passes()`.
//!
//! The kit names no plugin. What a role needs of the others it has in [`reference`](mod@reference): small,
//! slow implementations that share no code with the built-in plugins. [`checks`] lists every check of a role
//! with the reason for it; the names are stable. Each check has a *liar* among the kit's own tests: a plugin
//! with one deliberate fault, which that check and no other catches.

mod calls;
mod entry;
pub mod fixtures;
mod in_a_run;
mod law;
mod leaves;
pub mod reference;
mod replay;
mod report;
mod roles;
mod silence;

pub use in_a_run::{Trial, assert_registered_keep_the_laws_in_a_run, audit_in_a_run};
pub use replay::{ReplayError, assert_replay_keeps, replay};
pub use report::{Check, Outcome, Report};
pub use silence::{assert_silent, registered_are_silent};

use law::{Law, Subject, try_laws};
use regrasp_api::{Build, Entry, Slot};

/// What is demanded of a plugin beyond its role's laws.
#[derive(Clone, Debug, PartialEq)]
pub struct Demands {
    /// The settings to build it with, as JSON text; empty for the defaults.
    pub settings: String,
    /// By how much (relative, no unit) a surface's paths may be longer than the shortest ones.
    pub geodesic_tolerance: f64,
}

impl Default for Demands {
    /// Default settings; paths within 1e-3 of the shortest.
    fn default() -> Self {
        Self { settings: String::new(), geodesic_tolerance: 1e-3 }
    }
}

/// Puts a plugin through every check of its entry and of its role, with its default settings.
pub fn check(entry: &Entry) -> Report {
    check_with(entry, &Demands::default())
}

/// Puts a plugin through every check of its entry and of its role.
pub fn check_with(entry: &Entry, demands: &Demands) -> Report {
    let subject = Subject { entry, demands, journeys: Default::default() };
    let groups = laws_of(entry);
    let checks = groups.into_iter().flat_map(|laws| try_laws(laws, &subject)).collect();
    Report { plugin: entry.id.into(), checks }
}

/// The checks that a plugin for `slot` goes through: name, and why the law matters.
pub fn checks(slot: Slot) -> Vec<(&'static str, &'static str)> {
    entry::LAWS.iter().chain(roles::laws(slot)).map(|law| (law.name, law.why)).collect()
}

/// The entries that this binary's plugin crates registered, by id.
pub fn registered() -> Vec<&'static Entry> {
    let mut entries: Vec<&Entry> = regrasp_api::inventory::iter::<Entry>().collect();
    entries.sort_by_key(|entry| entry.id);
    entries
}

/// Checks every registered plugin, and says in a line each how many checks were made and which were not;
/// panics with the reports of those that fail, or if none is registered.
pub fn assert_registered_conform() -> String {
    let reports: Vec<Report> = registered().into_iter().map(check).collect();
    assert!(!reports.is_empty(), "no plugin is registered: write `use the_crate as _;`");
    let failed: Vec<String> = reports.iter().filter(|r| !r.passes()).map(ToString::to_string).collect();
    assert!(failed.is_empty(), "{}", failed.join("\n"));
    reports.iter().map(|report| report.summary() + "\n").collect()
}

/// The tests of a plugin crate: every registered plugin passes every check, keeps the laws where the planner
/// calls it, and prints nothing.
///
/// What they say goes straight to standard error: a test that passes shows nothing of what it prints. A call
/// that breaks a law in a run is kept in the target folder.
#[macro_export]
macro_rules! registered_plugins_conform {
    () => {
        #[test]
        fn registered_plugins_conform() {
            let summary = $crate::assert_registered_conform();
            let _ = std::io::Write::write_all(&mut std::io::stderr(), summary.as_bytes());
        }

        $crate::registered_plugins_keep_the_laws_in_a_run!($crate::Demands::default());

        #[test]
        fn registered_plugins_print_nothing() {
            $crate::registered_are_silent(concat!(module_path!(), "::registered_plugins_print_nothing"));
        }
    };
}

/// The test that plans with every registered plugin under audit; part of [`registered_plugins_conform`].
#[macro_export]
macro_rules! registered_plugins_keep_the_laws_in_a_run {
    ($demands:expr) => {
        #[test]
        fn registered_plugins_keep_the_laws_in_a_run() {
            let folder = option_env!("CARGO_TARGET_TMPDIR");
            let summary = $crate::assert_registered_keep_the_laws_in_a_run(&$demands, folder);
            let _ = std::io::Write::write_all(&mut std::io::stderr(), summary.as_bytes());
        }
    };
}

/// The laws for an entry: those of all entries, then those of each slot that it fills.
fn laws_of(entry: &Entry) -> Vec<&'static [Law]> {
    let mut groups = vec![entry::LAWS];
    match entry.build {
        // One builder serves up to three slots.
        Build::LocalPlanner(_) => groups.extend(entry.slots.iter().map(|&slot| roles::laws(slot))),
        Build::ContactModel(_) => groups.push(roles::laws(Slot::ContactModel)),
        Build::StabilityTest(_) => groups.push(roles::laws(Slot::StabilityTest)),
        Build::Surface(_) => groups.push(roles::laws(Slot::Surface)),
        Build::Sampler(_) => groups.push(roles::laws(Slot::Sampler)),
        Build::GraphStrategy(_) => groups.push(roles::laws(Slot::GraphStrategy)),
    }
    groups
}
