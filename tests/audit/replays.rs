//! What `--audit-save` keeps is made again by the conformance kit, as a test of the plugin.

use super::audited;
use regrasp::api::{Entry, Slot, inventory};
use regrasp_conformance::{ReplayError, replay};
use serde_json::Value;

fn entry(id: &str) -> &'static Entry {
    inventory::iter::<Entry>().find(|entry| entry.id == id).unwrap()
}

/// The file of a liar's first breach.
fn case(slot: Slot, lie: &str) -> Value {
    let (_, case) = audited("cubic", slot, lie);
    case.unwrap_or_else(|| panic!("`{lie}` is not caught")).file
}

#[test]
fn a_kept_call_breaks_the_same_law_again() {
    for (slot, lie) in [
        (Slot::ContactModel, "wide"),
        (Slot::ContactModel, "spins-on"),
        (Slot::StabilityTest, "counts-nothing"),
        (Slot::Surface, "inward"),
        (Slot::Surface, "tip-not-centre"),
        (Slot::TransferPlanner, "half-is-whole"),
    ] {
        let kept = case(slot, lie);
        let liar = entry(&format!("{}/liar", slot.role().name()));
        let breach = replay(liar, &kept.to_string()).unwrap();
        let breach = breach.unwrap_or_else(|| panic!("`{lie}` of {} is not caught again", slot.name()));
        assert_eq!(breach.broken.law, kept["breach"]["law"].as_str().unwrap(), "{lie}");
        assert_eq!(breach.call, kept["breach"]["call"].as_str().unwrap(), "{lie}");
    }
}

#[test]
fn a_mended_plugin_keeps_the_law() {
    let mut kept = case(Slot::ContactModel, "wide");
    kept["scenario"]["plugins"]["contact-model"]["settings"]["lie"] = "nothing".into();
    assert_eq!(replay(entry("contact-model/liar"), &kept.to_string()), Ok(None));
}

#[test]
fn what_is_no_case_of_the_plugin_is_refused_with_the_key() {
    let refused = |text: &str| replay(entry("contact-model/liar"), text).unwrap_err().to_string();
    assert!(refused("{").contains("`--audit-save FILE`") || refused("{").contains("--audit-save"));
    assert!(refused("{}").contains("`format`"));
    let mut kept = case(Slot::ContactModel, "wide");
    let other = replay(entry("surface/liar"), &kept.to_string());
    assert!(matches!(other, Err(ReplayError::OtherRole { .. })), "{other:?}");
    kept["breach"]["input"]["contact"] = Value::Null;
    assert!(refused(&kept.to_string()).contains("facet"), "{}", refused(&kept.to_string()));
}
