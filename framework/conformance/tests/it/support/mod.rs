//! How the liars' tests judge the kit.
#![allow(dead_code)] // every test file takes what it needs

pub mod blind;
pub mod slide;

use regrasp_api::{Entry, Slot};
use regrasp_conformance::{check, checks};

/// Breaks unless the honest entry passes, each liar fails exactly the check that it is paired with, and every
/// check of the slot that applies to `of_slot` has a liar.
pub fn judge(slot: Slot, honest: &Entry, liars: &[(Entry, &str)], elsewhere: &[&str]) {
    check(honest).assert_passes();
    let mut missed = String::new();
    for (liar, expected) in liars {
        let report = check(liar);
        if report.failed() != [*expected] {
            missed += &format!("the liar for `{expected}` fails {:?}: {report}\n", report.failed());
        }
    }
    assert!(missed.is_empty(), "{missed}");
    let caught = |name: &str| liars.iter().any(|(_, n)| *n == name) || elsewhere.contains(&name);
    for (name, _) in checks(slot) {
        assert!(caught(name) || name.starts_with("entry-"), "no liar shows that `{name}` catches anything");
    }
}
