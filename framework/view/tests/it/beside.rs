//! Several plans in one page.

use crate::small;

use regrasp_view::{Extras, Shown, ViewError, page, page_beside};
use serde_json::{Value, json};
use small::{data, plan};

#[test]
fn what_plans_share_is_written_once() {
    let (first, mut second) = (plan(), plan());
    second.seed = 8;
    second.scenario.problem.object.mass = 0.3;
    let extras = Extras::default();
    let shown = |plan, label| Shown { plan, extras: &extras, label };
    let page = page_beside(shown(&first, "a.json"), &[shown(&second, "b.json")]).unwrap();
    let data = data(&page);
    assert_eq!([&data["label"], &data["beside"][0]["label"]], ["a.json", "b.json"]);
    assert_eq!([&data["seed"], &data["beside"][0]["seed"]], [7, 8]);
    assert_eq!(data["beside"][0]["hand"], Value::Null, "the same hand");
    assert_eq!(data["beside"][0]["obstacles"], Value::Null);
    assert_eq!(data["beside"][0]["object"]["mass"], 0.3, "another object");
    assert_eq!(data["beside"][0]["motion"], data["motion"]);
}

#[test]
fn one_plan_has_none_beside_it() {
    let data = data(&page(&plan(), &Extras::default()).unwrap());
    assert_eq!(data.get("beside"), None);
    assert_eq!(data["label"], json!("<i>small</i> & \"quoted\""));
}

#[test]
fn the_plan_that_cannot_be_shown_is_named() {
    let (good, mut bad) = (plan(), plan());
    bad.segments[0].states[1].contacts.clear();
    let extras = Extras::default();
    let shown = |plan, label| Shown { plan, extras: &extras, label };
    match page_beside(shown(&good, "a.json"), &[shown(&good, "b.json"), shown(&bad, "c.json")]) {
        Err(ViewError::Beside { label, error }) => {
            assert_eq!(label, "c.json");
            assert!(matches!(*error, ViewError::State { segment: 0, state: 1, .. }), "{error}");
        }
        other => panic!("{other:?}"),
    }
}
