//! What may be said of a scenario's runs: no more than the tests show.

use super::number::milliseconds;
use super::words::{line, subject};
use crate::compare::statistics::Estimate;
use crate::compare::{Cell, Comparison, Family, Figure, Measure, Pairs, Question, RunStatus, Study, Verdict};
use serde::Serialize;
use std::collections::BTreeSet;

/// Up to so many pairs are told one by one.
const FEW: usize = 6;

/// The result of a scenario: a paragraph, and a line for each question.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Finding {
    /// Plans that do not verify, how the first variant did, and how many differ from it where there are many.
    pub lead: String,
    /// The answers to each question.
    pub lines: Vec<String>,
}

/// The result of a scenario; `name` marks the names of variants. Plans that do not verify come first: what
/// took how long says nothing before that.
pub fn finding(
    study: &Study,
    scenario: usize,
    row: &[Cell<'_>],
    family: &Family,
    name: &dyn Fn(&str) -> String,
) -> Finding {
    let mut lead: Vec<String> = row.iter().filter_map(|cell| unverified(cell, name)).collect();
    let questions = family.questions(scenario);
    let told = |(question, answers): (&Question, &[Comparison])| {
        format!("{}: {}.", subject(study, question, name), line(answers, study.hypotheses.band))
    };
    let (pairs, effects): (Vec<_>, Vec<_>) =
        questions.into_iter().partition(|(question, _)| matches!(question, Question::Pair { .. }));
    let mut lines = Vec::new();
    match row.split_first() {
        None => lead.push("There are no runs yet.".into()),
        Some(_) if pairs.is_empty() => lead.extend(row.iter().map(|cell| alone(cell, name))),
        Some((first, _)) => {
            lead.push(match study.hypotheses.pairs {
                Pairs::Baseline => format!("Against {}, which {}:", name(&first.variant.name), brief(first)),
                Pairs::All => "Each against each:".into(),
            });
            match pairs.len() <= FEW {
                true => lines.extend(pairs.into_iter().map(told)),
                false => lines.extend(counted(family, scenario)),
            }
        }
    }
    lines.extend(effects.into_iter().map(told));
    Finding { lead: lead.join(" "), lines }
}

/// That not all plans of a variant verify, and by which checks; `None` where all do.
fn unverified(cell: &Cell<'_>, name: &dyn Fn(&str) -> String) -> Option<String> {
    let all = cell.count(RunStatus::Solved);
    let wrong: Vec<_> =
        cell.runs.iter().filter(|run| run.status == RunStatus::Solved && !run.verified).collect();
    if wrong.is_empty() {
        return None;
    }
    let checks =
        wrong.iter().filter_map(|run| run.certified.as_ref()).flat_map(|figures| &figures.failed_checks);
    let checks: BTreeSet<&str> = checks.map(String::as_str).collect();
    let by = match checks.is_empty() {
        true => String::new(),
        false => format!(" ({})", checks.into_iter().collect::<Vec<_>>().join(", ")),
    };
    let (wrong, name) = (wrong.len(), name(&cell.variant.name));
    Some(format!("{wrong} of the {all} plans of {name} do not verify{by}."))
}

/// What one variant did, with nothing to compare it with.
fn alone(cell: &Cell<'_>, name: &dyn Fn(&str) -> String) -> String {
    let solved =
        format!("{} solved {} of {}", name(&cell.variant.name), cell.successes().count(), cell.runs.len());
    let ends = |share: Estimate| format!(" ({:.0} to {:.0} %)", 1e2 * share.low, 1e2 * share.high);
    let share = cell.success().map(ends).unwrap_or_default();
    let time = cell.median(Figure::Planning).map(milliseconds);
    let time = time.map(|time| format!(", at the median in {time} ms")).unwrap_or_default();
    format!("{solved}{share}{time}.")
}

fn brief(cell: &Cell<'_>) -> String {
    let solved = format!("solved {} of {}", cell.successes().count(), cell.runs.len());
    match cell.median(Figure::Planning) {
        Some(time) => format!("{solved}, at the median in {} ms", milliseconds(time)),
        None => solved,
    }
}

/// For each measure how many pairs have which verdict, where there are too many to tell each.
fn counted(family: &Family, scenario: usize) -> Vec<String> {
    let pairs = || family.on(scenario).iter().filter(|found| matches!(found.question, Question::Pair { .. }));
    let mut measures: Vec<&Measure> = Vec::new();
    for found in pairs() {
        if !measures.contains(&&found.measure) {
            measures.push(&found.measure);
        }
    }
    let line = |measure: &Measure| {
        let count = |verdict: Verdict| {
            pairs().filter(|found| found.measure == *measure && found.verdict == verdict).count()
        };
        let [more, less] = measure.words();
        let texts = [
            (Verdict::More, more.to_owned()),
            (Verdict::Less, less.to_owned()),
            (Verdict::Same, "the same".to_owned()),
            (Verdict::NotShown, "not shown to differ".to_owned()),
            (Verdict::TooFew, "on too few seeds to tell".to_owned()),
        ];
        let parts = texts.into_iter().map(|(verdict, text)| (count(verdict), text)).filter(|(n, _)| *n > 0);
        let parts: Vec<String> = parts.map(|(n, text)| format!("{n} {text}")).collect();
        let all: usize = Verdict::ALL.map(count).iter().sum();
        format!("{}, of {all} comparisons: {}.", measure.noun(), parts.join(", "))
    };
    measures.into_iter().map(line).collect()
}
