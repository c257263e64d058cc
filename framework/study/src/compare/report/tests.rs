use super::*;
use crate::compare::fixture::{runs, study};
use crate::compare::{RunKey, analyse, judge_all};
use serde_json::Value;

fn page(study: &Study, time: impl Fn(RunKey) -> Option<f64>) -> String {
    let records = runs(study, time);
    let rows = analyse(study, &records);
    html(study, &rows, &judge_all(study, &rows), &[Some("<svg></svg>".into()), None])
}

fn data(page: &str) -> Value {
    let (_, rest) = page.split_once("<script type=\"application/json\" id=\"data\">").unwrap();
    serde_json::from_str(rest.split_once("</script>").unwrap().0).unwrap()
}

/// What a hostile user would call a variant.
const HOSTILE: &str = "</script><script>alert(1)</script><!--";

#[test]
fn names_of_users_end_no_script_and_keep_their_letters() {
    let study = study(&["rlg", HOSTILE, "/*SCRIPT*/"]);
    let page = page(&study, |key| Some(0.1 + key.seed as f64));
    assert_eq!(page.matches("</script>").count(), 2, "the page's own two");
    assert!(!page.contains("alert(1)</script") && !page.contains("<!--\""));
    let data = data(&page);
    assert_eq!(data["variants"][1]["name"], HOSTILE);
    assert_eq!(data["scenarios"][1]["name"], "</script><b>&\"");
    assert!(data["variants"][2]["name"] == "/*SCRIPT*/" && !page.contains("/*DATA*/"));
}

#[test]
fn the_page_asks_for_nothing() {
    let study = study(&["rlg"]);
    let page = page(&study, |_| Some(0.1));
    let own = page.replace("http://www.w3.org/2000/svg", "");
    assert!(
        !own.contains("http://")
            && !own.contains("src=")
            && !own.contains("@import")
            && !own.contains("url(")
    );
}

#[test]
fn figures_are_those_of_the_runs() {
    let study = study(&["rlg", "half", "never"]);
    let time = |key: RunKey| match key.variant {
        0 => Some(0.1 + 0.01 * key.seed as f64),
        1 => (key.seed.is_multiple_of(3)).then_some(0.05),
        _ => None,
    };
    let data = data(&page(&study, time));
    let scenario = &data["scenarios"][0];
    let cells = &scenario["cells"];
    assert_eq!((cells[0]["successes"].as_u64(), cells[1]["successes"].as_u64()), (Some(12), Some(4)));
    assert!((cells[0]["median_of_all_s"].as_f64().unwrap() - 0.155).abs() < 1e-12);
    assert_eq!(cells[1]["median_of_all_s"], Value::Null, "a third of the runs is less than half");
    assert_eq!(cells[2]["failures"]["no-plan"], 12);
    assert_eq!(cells[1]["ecdf"], serde_json::json!([[0.05, 4.0 / 12.0]]));
    assert_eq!(scenario["best"], serde_json::json!([0]), "who fails is not best, however fast");
    let matrix = &scenario["matrix"];
    assert_eq!(
        (matrix["rows"].as_array().unwrap().len(), &matrix["rows"][0]["variants"]),
        (2, &serde_json::json!([1, 0]))
    );
    let measures: Vec<&str> =
        matrix["measures"].as_array().unwrap().iter().filter_map(Value::as_str).collect();
    assert_eq!(measures[..3], ["solved", "planning", "verification"]);
    // `clearance` takes half and nothing was measured for stability tests: not more than half.
    assert_eq!(
        (data["remark"]["collision"].as_f64(), data["remark"]["holds"].as_u64()),
        (Some(0.5), Some(0))
    );
}

#[test]
fn equals_share_the_first_place() {
    let mut study = study(&["rlg", "same", "slow"]);
    study.hypotheses.pairs = crate::compare::Pairs::All;
    let noise = |seed: u64| if seed.is_multiple_of(2) { 1.02 } else { 0.99 };
    let time = |key: RunKey| Some([1.0, noise(key.seed), 5.0][key.variant] * (1.0 + 0.1 * key.seed as f64));
    let data = data(&page(&study, time));
    let mut best: Vec<u64> =
        data["scenarios"][0]["best"].as_array().unwrap().iter().filter_map(Value::as_u64).collect();
    best.sort_unstable();
    assert_eq!(best, [0, 1]);
}

#[test]
fn what_plugins_note_has_boxes_and_a_test() {
    let study = study(&["rlg", "noting"]);
    let mut records = runs(&study, |key| Some(0.1 + 0.01 * key.seed as f64));
    for run in &mut records {
        let grip = if run.variant == "noting" { 5.0 } else { 2.0 } + 0.1 * run.seed as f64;
        let note = [("grip".to_owned(), regrasp_api::Figure::one(grip))].into();
        run.counts.notes.insert(regrasp_api::Slot::Sampler, note);
    }
    let rows = analyse(&study, &records);
    let page = html(&study, &rows, &judge_all(&study, &rows), &[None, None]);
    let scenario = &data(&page)["scenarios"][0];
    let boxes = scenario["boxes"].as_array().unwrap();
    let noted = boxes.iter().find(|boxes| boxes["measure"] == "grip (sampler)").unwrap();
    assert_eq!(noted["boxes"].as_array().unwrap().len(), 2);
    assert!((noted["boxes"][1][1]["quartiles"][1].as_f64().unwrap() - 5.55).abs() < 1e-9);
    let answers = scenario["matrix"]["rows"][0]["answers"].as_array().unwrap();
    let found = answers.last().unwrap();
    assert_eq!((&found["text"], &found["shown"], &found["better"]), (&"+3".into(), &true.into(), &0.into()));
}
