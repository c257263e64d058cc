//! `search.md`: what the searches did, in the meanings of the paper's Table 1 and with the paper's rows.

use super::statistics::median;
use super::summary::{aligned, code, plain, three_digits};
use super::{Cell, RunRecord};
use regrasp_api::Slot;

/// What the table's columns mean.
const NOTES: &str = include_str!("search.md");

/// The head of the table.
const HEAD: [&str; 15] = [
    "problem",
    "variant",
    "solved",
    "s, median",
    "s, slowest",
    "generated",
    "kept",
    "components of GS_n",
    "in the largest",
    "paths in GS_n used",
    "transfer edges used",
    "decompositions failed",
    "stability tests",
    "collision tests",
    "with a path in GS_n",
];

/// What stands in the place of a variant in the paper's rows.
const PUBLISHED: &str = "the paper, means";

/// Counts of a run that are summed up by mean and median.
const COUNTS: [fn(&RunRecord) -> f64; 2] =
    [|run| run.counts.generated_nodes as f64, |run| run.counts.roadmap.kept_nodes as f64];

/// The problem that a scenario is an instance of: pairs of given grasps, `NAME-given-K`, count as one.
pub fn problem_of(scenario: &str) -> &str {
    let digits = scenario.trim_end_matches(|c: char| c.is_ascii_digit());
    match digits.strip_suffix("-given-") {
        Some(problem) if digits.len() < scenario.len() => problem,
        _ => scenario,
    }
}

/// Whether scenarios of a study are instances of the same problem.
pub fn has_families(rows: &[Vec<Cell<'_>>]) -> bool {
    rows.iter().flatten().any(|cell| problem_of(&cell.scenario.name) != cell.scenario.name)
}

/// The text of `search.md`.
pub fn search_markdown(rows: &[Vec<Cell<'_>>]) -> String {
    let mut lines = search_lines(rows);
    for line in &mut lines {
        line[0] = plain(&line[0]);
        line[1] = if line[1] == PUBLISHED { plain(PUBLISHED) } else { code(&line[1]) };
    }
    let head = HEAD.map(plain).to_vec();
    lines.insert(0, head);
    format!("# What the searches did\n\n{}\n{NOTES}", aligned(&lines))
}

/// The table without its head ([`search_head`]): for each problem what was published, then each variant.
pub fn search_lines(rows: &[Vec<Cell<'_>>]) -> Vec<Vec<String>> {
    let mut families: Vec<(&str, Vec<&Cell<'_>>)> = Vec::new();
    for cell in rows.iter().flatten() {
        let problem = problem_of(&cell.scenario.name);
        match families.iter_mut().find(|(name, _)| *name == problem) {
            Some((_, cells)) => cells.push(cell),
            None => families.push((problem, vec![cell])),
        }
    }
    families.iter().flat_map(|(problem, cells)| family(problem, cells)).collect()
}

/// The head of [`search_lines`].
pub fn search_head() -> [&'static str; 15] {
    HEAD
}

/// A problem's lines.
fn family(problem: &str, cells: &[&Cell<'_>]) -> Vec<Vec<String>> {
    let published = cells[0].scenario.paper.as_ref().map(|paper| {
        let counts = [paper.generated_nodes, paper.graph_nodes].map(|count| count.to_string());
        let mut line = vec![problem.to_owned(), PUBLISHED.into(), "-".into()];
        line.extend([format!("{} (mean)", paper.time_s), "-".into()]);
        line.extend(counts);
        line.resize(HEAD.len(), "-".into());
        line
    });
    let mut variants: Vec<usize> = cells.iter().map(|cell| cell.index).collect();
    variants.sort_unstable();
    variants.dedup();
    let lines = variants.into_iter().map(|index| {
        let own = cells.iter().filter(|cell| cell.index == index);
        line(problem, &own.copied().collect::<Vec<_>>())
    });
    published.into_iter().chain(lines).collect()
}

/// The line of a variant, over all instances of the problem.
fn line(problem: &str, cells: &[&Cell<'_>]) -> Vec<String> {
    let all: usize = cells.iter().map(|cell| cell.runs.len()).sum();
    let good: Vec<&RunRecord> = cells.iter().flat_map(|cell| cell.successes()).collect();
    let times = || good.iter().map(|run| run.times.planning_s);
    let second = |s: Option<f64>| s.map_or("-".to_owned(), three_digits);
    let mut line =
        vec![problem.to_owned(), cells[0].variant.name.clone(), format!("{} of {all}", good.len())];
    line.push(second(median(times())));
    line.push(second(times().max_by(f64::total_cmp)));
    line.extend(COUNTS.map(|count| summed(&good, count)));
    line.push(summed(&good, |run| run.counts.roadmap.grasp_components as f64));
    line.push(percent(&good, |run| (run.counts.roadmap.largest_grasp_component, run.counts.graph_nodes)));
    line.push(summed(&good, |run| run.counts.roadmap.used_grasp_edges as f64));
    line.push(summed(&good, |run| run.counts.roadmap.used_transfer_edges as f64));
    line.push(percent(&good, |run| {
        let roadmap = &run.counts.roadmap;
        (roadmap.failed_decompositions, roadmap.decompositions)
    }));
    line.push(summed(&good, |run| {
        run.counts.plugins.get(&Slot::StabilityTest).map_or(0.0, |plugin| plugin.calls as f64)
    }));
    line.push(summed(&good, |run| run.counts.collision_tests as f64));
    let through = good.iter().filter(|run| run.counts.roadmap.used_grasp_edges > 0).count();
    line.push(format!("{through} of {}", good.len()));
    line
}

/// Mean, and median in brackets.
fn summed(runs: &[&RunRecord], count: impl Fn(&RunRecord) -> f64) -> String {
    let Some(middle) = median(runs.iter().map(|run| count(run))) else { return "-".into() };
    let mean = runs.iter().map(|run| count(run)).sum::<f64>() / runs.len() as f64;
    let digits = usize::from(mean < 1000.0);
    format!("{mean:.digits$} ({middle:.0})")
}

/// The share that parts make of wholes, each summed over the runs.
fn percent(runs: &[&RunRecord], of: impl Fn(&RunRecord) -> (usize, usize)) -> String {
    let sum = |(a, b): (usize, usize), (c, d): (usize, usize)| (a + c, b + d);
    match runs.iter().map(|run| of(run)).fold((0, 0), sum) {
        (_, 0) => "-".into(),
        (part, whole) => format!("{:.0} %", 1e2 * part as f64 / whole as f64),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::fixture::{runs, study};
    use crate::compare::{RunKey, analyse};

    #[test]
    fn pairs_of_given_grasps_are_one_problem() {
        for (scenario, problem) in
            [("cubic-given-12", "cubic"), ("cubic-given-", "cubic-given-"), ("cube-180", "cube-180")]
        {
            assert_eq!(problem_of(scenario), problem);
        }
    }

    #[test]
    fn the_papers_row_comes_first_and_instances_are_summed_up() {
        let mut study = study(&["rlg", "new"]);
        study.scenarios[1] = study.scenarios[0].clone();
        for (k, scenario) in study.scenarios.iter_mut().enumerate() {
            scenario.name = format!("ball-given-{}", k + 1);
        }
        let time = |key: RunKey| (key.variant == 0 || key.seed < 4).then_some(0.25 + key.scenario as f64);
        let mut records = runs(&study, time);
        records[0].counts.generated_nodes = 880;
        let roadmap = &mut records[0].counts.roadmap;
        (roadmap.used_grasp_edges, roadmap.decompositions, roadmap.failed_decompositions) = (2, 8, 3);
        let rows = analyse(&study, &records);
        assert!(has_families(&rows));
        let lines = search_lines(&rows);
        let part = |k: usize, columns: std::ops::Range<usize>| lines[k][columns].join("|");
        assert_eq!(lines.len(), 3);
        assert_eq!(part(0, 0..7), "ball|the paper, means|-|17.5 (mean)|-|196|23");
        // 24 runs: 23 of 40 nodes and one of 880.
        assert_eq!(part(1, 0..6), "ball|rlg|24 of 24|0.750|1.25|75.0 (40)");
        assert_eq!((lines[1][11].as_str(), lines[1][14].as_str()), ("38 %", "1 of 24"));
        assert_eq!(part(2, 0..3), "ball|new|8 of 24");
        let text = search_markdown(&rows);
        assert!(
            text.contains("`rlg` |") && text.contains("| the paper, means |") && text.contains("GS\\_n"),
            "{text}"
        );
    }
}
