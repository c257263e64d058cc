//! What the plugins say of themselves.

use regrasp_api::{Build, Entry, inventory};
use regrasp_stability_tests as _;

#[test]
fn every_stability_test_is_registered_with_sources_and_a_schema() {
    let mut entries: Vec<_> = inventory::iter::<Entry>.into_iter().collect();
    entries.sort_by_key(|entry| entry.id);
    let ids: Vec<_> = entries.iter().map(|entry| entry.id).collect();
    let known = [
        "stability-test/equilibrium",
        "stability-test/force-closure",
        "stability-test/holding",
        "stability-test/linearised",
        "stability-test/socp",
        "stability-test/wrench-ball",
    ];
    assert_eq!(ids, known);
    for entry in entries {
        assert!(matches!(entry.build, Build::StabilityTest(_)));
        assert!(!entry.references.is_empty() && (entry.schema)().contains("default"));
        assert!((entry.check)("").is_ok() && (entry.check)(r#"{"nonsense": 1}"#).is_err());
    }
}
