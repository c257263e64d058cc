//! What may be said of a scenario's runs: no more than the tests show.

use super::number::{milliseconds, p_text, ratio_text};
use crate::compare::statistics::{ALPHA, Estimate};
use crate::compare::{Cell, Compared, Figure, RunStatus};
use std::collections::BTreeSet;
use std::iter;

/// Fewer pairs than this cannot reach 5 %, whatever they show: even if all point one way, p is `tests` · 2 /
/// 2ⁿ after the correction for as many tests.
fn fewest_pairs(tests: usize) -> usize {
    (1..64).find(|n| tests as f64 * 2.0 / 2_f64.powi(*n) < ALPHA).map_or(64, |n| n as usize)
}

/// Up to so many variants are named one by one.
const FEW: usize = 4;

/// The result of a scenario in a sentence or two; `name` marks the names of variants. Plans that do not
/// verify come first: what took how long says nothing before that.
pub fn finding(row: &[Cell<'_>], name: &dyn Fn(&str) -> String) -> String {
    let rejected = row.iter().filter_map(|cell| unverified(cell, name));
    rejected.chain([times_and_shares(row, name)]).collect::<Vec<_>>().join(" ")
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

fn times_and_shares(row: &[Cell<'_>], name: &dyn Fn(&str) -> String) -> String {
    let Some((first, others)) = row.split_first() else { return "There are no runs yet.".into() };
    let compared: Vec<(&Cell<'_>, &Compared)> =
        others.iter().filter_map(|cell| Some((cell, cell.compared.as_ref()?))).collect();
    if compared.is_empty() {
        return row.iter().map(|cell| alone(cell, name)).collect::<Vec<_>>().join(" ");
    }
    let fewest = fewest_pairs(compared.len());
    let times = match compared
        .iter()
        .any(|(_, compared)| is_shown(compared) || compared.paired.both >= fewest)
    {
        false => format!(
            "no difference in time could show, whatever it is: at least {fewest} seeds must be solved by both"
        ),
        true if compared.len() <= FEW => one_by_one(&compared, name),
        true => counted(&compared, name),
    };
    let sentence = format!("Against {} ({}), {times}.", name(&first.variant.name), brief(first));
    iter::once(sentence).chain(solving(first, &compared, name)).collect::<Vec<_>>().join(" ")
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
    let solved = format!("{} of {} solved", cell.successes().count(), cell.runs.len());
    match cell.median(Figure::Planning) {
        Some(time) => format!("{solved}, median {} ms", milliseconds(time)),
        None => solved,
    }
}

fn is_shown(compared: &Compared) -> bool {
    compared.time_p < ALPHA
}

fn one_by_one(compared: &[(&Cell<'_>, &Compared)], name: &dyn Fn(&str) -> String) -> String {
    let shown = compared.iter().filter(|(_, compared)| is_shown(compared));
    let mut parts: Vec<String> = shown.map(|pair| took(pair, name)).collect();
    let rest = |is_wanted: &dyn Fn(usize) -> bool| {
        let wanted = compared.iter().filter(|(_, c)| !is_shown(c) && is_wanted(c.paired.both));
        wanted.map(|(cell, _)| name(&cell.variant.name)).collect::<Vec<_>>()
    };
    let fewest = fewest_pairs(compared.len());
    let unclear = rest(&|both| both >= fewest);
    if !unclear.is_empty() {
        parts.push(format!("no difference in time could be shown for {}", unclear.join(", ")));
    }
    let few = rest(&|both| both < fewest);
    if !few.is_empty() {
        parts.push(format!("too few seeds were solved by both to compare times with {}", few.join(", ")));
    }
    parts.join("; ")
}

/// How much longer or shorter one variant took.
fn took((cell, compared): &(&Cell<'_>, &Compared), name: &dyn Fn(&str) -> String) -> String {
    let ratio = compared.paired.ratio.map(ratio_text).unwrap_or_default();
    format!("{} took {ratio} times as long, {}", name(&cell.variant.name), p_text(compared.time_p))
}

/// How many variants are faster and slower, and the extreme of each side.
fn counted(compared: &[(&Cell<'_>, &Compared)], name: &dyn Fn(&str) -> String) -> String {
    let ratio = |compared: &Compared| compared.paired.ratio.map_or(1.0, |ratio| ratio.value);
    let mut shown: Vec<_> = compared.iter().filter(|(_, c)| is_shown(c)).collect();
    shown.sort_by(|a, b| ratio(a.1).total_cmp(&ratio(b.1)));
    if shown.is_empty() {
        return format!(
            "for none of the {} other variants could a difference in time be shown",
            compared.len()
        );
    }
    let (faster, slower) = shown.split_at(shown.partition_point(|(_, compared)| ratio(compared) < 1.0));
    let most = |pair: Option<&&(&Cell<'_>, &Compared)>| {
        pair.map(|pair| format!(" (most of all {})", took(pair, name))).unwrap_or_default()
    };
    format!(
        "of {} other variants {} are shown to be faster{}, {} to be slower{}; for {} no difference in time \
            could be shown",
        compared.len(),
        faster.len(),
        most(faster.first()),
        slower.len(),
        most(slower.last()),
        compared.len() - shown.len()
    )
}

/// Whether some variant solves more or fewer; nothing where all solved everything.
fn solving(
    baseline: &Cell<'_>,
    compared: &[(&Cell<'_>, &Compared)],
    name: &dyn Fn(&str) -> String,
) -> Option<String> {
    let mut all = compared.iter().map(|(cell, _)| *cell).chain(iter::once(baseline));
    if all.all(|cell| cell.successes().count() == cell.runs.len()) {
        return Some("All solved every run.".into());
    }
    let shown = compared.iter().filter(|(_, compared)| compared.solved_p < ALPHA);
    let says = |(cell, compared): &(&Cell<'_>, &Compared)| {
        let more = compared.paired.only_variant > compared.paired.only_baseline;
        let (solved, runs) = (cell.successes().count(), cell.runs.len());
        let which = if more { "more" } else { "fewer" };
        format!(
            "{} solved {which}: {solved} of {runs}, {}",
            name(&cell.variant.name),
            p_text(compared.solved_p)
        )
    };
    let shown: Vec<String> = shown.map(says).collect();
    match shown.as_slice() {
        [] => Some("No difference in the share of solved runs could be shown.".into()),
        shown => Some(shown.join("; ") + "."),
    }
}
