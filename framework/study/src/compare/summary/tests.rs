use super::*;
use crate::compare::fixture::{runs, study};
use crate::compare::{RunKey, RunRecord, Study, analyse, judge_all};

mod agreement;

fn seconds(key: RunKey) -> f64 {
    0.01 * (1.0 + 0.1 * key.seed as f64)
}

fn findings(study: &Study, records: &[RunRecord]) -> Vec<Finding> {
    let rows = analyse(study, records);
    let family = judge_all(study, &rows);
    rows.iter().enumerate().map(|(k, row)| finding(study, k, row, &family, &|name| name.to_owned())).collect()
}

#[test]
fn only_what_is_shown_is_said() {
    let study = study(&["rlg", "slow", "same"]);
    let noise = |key: RunKey| if key.seed.is_multiple_of(2) { 1.01 } else { 0.99 };
    let factor = |key: RunKey| [1.0, 3.0, noise(key)][key.variant];
    let found = findings(&study, &runs(&study, |key| Some(seconds(key) * factor(key))));
    let lead = "Against rlg, which solved 12 of 12, at the median in 15.5 (12.5 to 18.5) ms:";
    let equal = "the same within 10 %: verification, collision tests, memory, regrasps, motion, margin";
    assert_eq!(found[0].lead, lead);
    assert!(
        found[0].lines[0].starts_with("slow: planning 31 ms slower (24 to 38), p = 0.002; the same"),
        "{found:?}"
    );
    assert!(found[0].lines[0].ends_with(&format!("{equal}; no difference shown: solved.")), "{found:?}");
    assert!(found[0].lines[1].contains("the same within 10 %: planning, verification"), "{found:?}");
    // The second scenario's test met another step of the correction: its interval is no wider.
    assert!(found[1].lines[0].starts_with("slow: planning 31 ms slower (25 to 37), p = 0.002"), "{found:?}");
    assert_eq!(found[0].lines[1], found[1].lines[1]);
}

#[test]
fn who_solves_less_is_not_called_fast() {
    let mut study = study(&["rlg", "lucky"]);
    study.scenarios.iter_mut().for_each(|one| one.problem.limits.budget.time_limit = Some(1.0));
    let time = |key: RunKey| (key.variant == 0 || key.seed < 2).then(|| 0.5 * seconds(key));
    let found = findings(&study, &runs(&study, time)).remove(0);
    assert!(found.lines[0].contains("solved 83.3 points fewer"), "{found:?}");
    assert!(!found.lines[0].contains("faster"), "{found:?}");
    // Where both solve, the two are as fast; the failures count as the whole second.
    assert!(found.lines[0].contains(" ms slower"), "{found:?}");
}

#[test]
fn many_variants_are_counted_and_one_alone_is_described() {
    let many = study(&["rlg", "a", "b", "c", "d", "e", "f", "g"]);
    let factor = |key: RunKey| [1.0, 0.25, 0.5, 1.0, 2.0, 4.0, 5.0, 6.0][key.variant];
    let found = findings(&many, &runs(&many, |key| Some(seconds(key) * factor(key)))).remove(0);
    assert!(
        found.lines.contains(&"planning, of 7 comparisons: 4 slower, 2 faster, 1 the same.".to_owned()),
        "{found:?}"
    );
    let one = study(&["rlg"]);
    let found = findings(&one, &runs(&one, |key| Some(seconds(key)))).remove(0);
    let said = "rlg solved 12 of 12 (76 to 100 %), at the median in 15.5 (12.5 to 18.5) ms.";
    assert_eq!((found.lead.as_str(), found.lines.len()), (said, 0));
}

#[test]
fn too_few_seeds_are_not_taken_for_no_difference() {
    let study = study(&["rlg", "slow"]);
    let mut records = runs(&study, |key| Some(seconds(key) * [1.0, 9.0][key.variant]));
    records.retain(|run| run.seed < 5);
    let found = findings(&study, &records).remove(0);
    assert!(
        found.lines[0].starts_with("slow: too few seeds in common, of 10 needed: solved, planning"),
        "{found:?}"
    );
    // Seven seeds are enough for the time of two scenarios, all else being equal: 2 · 2/2⁷ < 0.05.
    let mut records = runs(&study, |key| Some(seconds(key) * [1.0, 9.0][key.variant]));
    records.retain(|run| run.seed < 7);
    let found = findings(&study, &records).remove(0);
    assert!(found.lines[0].starts_with("slow: planning 104 ms slower"), "{found:?}");
}

#[test]
fn tables_have_a_row_for_each_scenario_and_variant_and_as_many_cells_as_the_head() {
    let study = study(&["rlg", "a|b`"]);
    let records = runs(&study, |key| (key.seed != 3).then(|| seconds(key)));
    let rows = analyse(&study, &records);
    let family = judge_all(&study, &rows);
    let text = csv(&rows);
    let head = text.lines().next().unwrap().split(',').count();
    assert_eq!(text.lines().count(), 1 + 2 * 2);
    // The hostile scenario's name is quoted and holds no comma, so that splitting is enough.
    assert!(text.lines().all(|line| line.split(',').count() == head), "{text}");
    assert!(text.lines().nth(1).unwrap().ends_with(",17.5,196,23"));

    let page = markdown(&study, &rows, &family);
    let tables: Vec<&str> = page.lines().filter(|line| line.starts_with('|')).collect();
    let measures = 8;
    assert_eq!(tables.len(), 2 * (2 + 2) + 1 + 2 * (2 + measures), "a row for the paper too: {page}");
    let widths: Vec<usize> = tables[..5].iter().map(|line| line.chars().count()).collect();
    assert!(widths.iter().all(|width| *width == widths[0]), "{page}");
    assert!(page.contains("*published: Sphere, averages*") && page.contains("17500"));
    assert!(
        page.contains("`a'b'`")
            && page.contains("\\</script\\>\\<b\\>")
            && page.contains("a ball \\| turned")
    );
}

#[test]
fn runs_of_unequal_seeds_are_paired_by_seed() {
    let study = study(&["rlg", "other"]);
    let mut records = runs(&study, |key| Some(seconds(key)));
    records.retain(|run| !(run.variant == "rlg" && run.seed == 0 || run.variant == "other" && run.seed > 8));
    records.reverse();
    let rows = analyse(&study, &records);
    let family = judge_all(&study, &rows);
    assert!(family.comparisons.iter().all(|found| (found.pairs, found.sides) == (8, [0, 0])), "{family:?}");
}

#[test]
fn plans_that_do_not_verify_are_told_first() {
    let study = study(&["rlg", "hasty"]);
    let mut records = runs(&study, |key| Some(seconds(key)));
    for run in records.iter_mut().filter(|run| run.variant == "hasty" && run.seed < 3) {
        run.verified = false;
        if let Some(figures) = &mut run.certified {
            figures.failed_checks = vec!["slip".into(), "closure".into()];
        }
    }
    let found = findings(&study, &records).remove(0).lead;
    assert!(
        found.starts_with("3 of the 12 plans of hasty do not verify (closure, slip). Against"),
        "{found}"
    );
    let sound = findings(&study, &runs(&study, |key| Some(seconds(key)))).remove(0).lead;
    assert!(!sound.contains("do not verify"), "{sound}");
}
