//! The laws hold with other settings than the defaults too.
#![allow(missing_docs)]

// ANCHOR: settings
use greasy_contact_model::ENTRY;
use regrasp_conformance::{Demands, check_with};

#[test]
fn grease_may_be_all_over_a_side_and_leave_nothing() {
    let settings = r#"{ "side": [0.0, 1.0, 1.0], "from": 0.0, "factor": 0.0 }"#.into();
    check_with(&ENTRY, &Demands { settings, ..Demands::default() }).assert_passes();
}
// ANCHOR_END: settings
