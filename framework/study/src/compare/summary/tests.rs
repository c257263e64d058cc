use super::*;
use crate::compare::fixture::{runs, study};
use crate::compare::{RunKey, RunRecord, Study, analyse};

fn seconds(key: RunKey) -> f64 {
    0.01 * (1.0 + 0.1 * key.seed as f64)
}

fn findings(study: &Study, records: &[RunRecord]) -> Vec<String> {
    analyse(study, records).iter().map(|row| finding(row, &|name| name.to_owned())).collect()
}

#[test]
fn only_what_is_shown_is_said() {
    let study = study(&["rlg", "slow", "same"]);
    let noise = |key: RunKey| if key.seed.is_multiple_of(2) { 1.01 } else { 0.99 };
    let factor = |key: RunKey| [1.0, 3.0, noise(key)][key.variant];
    let found = findings(&study, &runs(&study, |key| Some(seconds(key) * factor(key))));
    let expected = "Against rlg (12 of 12 solved, median 15.5 (12.5 to 18.5) ms), slow took 3.00 (3.00 to \
        3.00) times as long, p < 0.001; no \
                    difference in time could be shown for same. All solved every run.";
    assert_eq!(found, [expected, expected]);
}

#[test]
fn who_solves_less_is_not_called_fast() {
    let study = study(&["rlg", "lucky"]);
    let time = |key: RunKey| (key.variant == 0 || key.seed < 2).then(|| seconds(key));
    let found = findings(&study, &runs(&study, time)).remove(0);
    assert!(
        found.contains(
            "no difference in time could show, whatever it is: at least 6 seeds must be solved by both"
        ),
        "{found}"
    );
    assert!(found.contains("lucky solved fewer: 2 of 12, p = 0.002"), "{found}");
}

#[test]
fn many_variants_are_counted_and_one_alone_is_described() {
    let many = study(&["rlg", "a", "b", "c", "d", "e"]);
    let factor = |key: RunKey| [1.0, 0.25, 0.5, 1.0, 2.0, 4.0][key.variant];
    let found = findings(&many, &runs(&many, |key| Some(seconds(key) * factor(key)))).remove(0);
    let begin = "of 5 other variants 2 are shown to be faster (most of all a took 0.250 (0.250 to 0.250) \
        times as long, p = 0.002), 2 to be slower \
                 (most of all e took 4.00 ";
    assert!(
        found.contains(begin) && found.contains("; for 1 no difference in time could be shown"),
        "{found}"
    );
    let one = study(&["rlg"]);
    let found = findings(&one, &runs(&one, |key| Some(seconds(key)))).remove(0);
    assert_eq!(found, "rlg solved 12 of 12 (76 to 100 %), at the median in 15.5 (12.5 to 18.5) ms.");
}

#[test]
fn too_few_seeds_are_not_taken_for_no_difference() {
    let study = study(&["rlg", "slow"]);
    let mut records = runs(&study, |key| Some(seconds(key) * [1.0, 9.0][key.variant]));
    records.retain(|run| run.seed < 5);
    let found = findings(&study, &records).remove(0);
    assert!(found.contains("no difference in time could show, whatever it is: at least 6 seeds"), "{found}");
    // The sixth seed is enough: 2/2⁶ < 0.05.
    let mut records = runs(&study, |key| Some(seconds(key) * [1.0, 9.0][key.variant]));
    records.retain(|run| run.seed < 6);
    let found = findings(&study, &records).remove(0);
    assert!(found.contains("slow took 9.00"), "{found}");
}

#[test]
fn tables_have_a_row_for_each_scenario_and_variant_and_as_many_cells_as_the_head() {
    let study = study(&["rlg", "a|b`"]);
    let records = runs(&study, |key| (key.seed != 3).then(|| seconds(key)));
    let rows = analyse(&study, &records);
    let text = csv(&rows);
    let head = text.lines().next().unwrap().split(',').count();
    assert_eq!(text.lines().count(), 1 + 2 * 2);
    // The hostile scenario's name is quoted and holds no comma, so that splitting is enough.
    assert!(text.lines().all(|line| line.split(',').count() == head), "{text}");
    assert!(text.lines().nth(1).unwrap().ends_with(",17.5,196,23"));

    let page = markdown(&study, &rows);
    let table: Vec<&str> = page.lines().filter(|line| line.starts_with('|')).collect();
    assert_eq!(table.len(), 2 * (2 + 2) + 1, "a row for the paper too: {page}");
    let widths: Vec<usize> = table[..5].iter().map(|line| line.chars().count()).collect();
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
    let paired = &rows[0][1].compared.as_ref().unwrap().paired;
    assert_eq!((paired.both, paired.time_test.pairs), (8, 0));
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
    let found = findings(&study, &records).remove(0);
    assert!(
        found.starts_with("3 of the 12 plans of hasty do not verify (closure, slip). Against"),
        "{found}"
    );
    let sound = findings(&study, &runs(&study, |key| Some(seconds(key)))).remove(0);
    assert!(!sound.contains("do not verify"), "{sound}");
}
