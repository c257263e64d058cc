//! Benchmark logs as OMPL writes them: read by its `ompl_benchmark_statistics`, shown by Planner Arena.
//!
//! M. Moll, I. A. Şucan, L. E. Kavraki, "Benchmarking motion planning algorithms: an extensible
//! infrastructure for analysis and visualization", IEEE Robotics & Automation Magazine 2015. A log is one
//! experiment, here a scenario; a planner is a variant. There is no progress: a run gives one plan at its
//! end. A limit of 0 (seconds, MB) means that there is none.

mod property;
mod time;

use super::{Cell, Study, StudyScenario};
use property::{STATUSES, properties};
use regrasp_plan::PluginChoice;
use serde_json::Value;
use std::fmt::Write;

/// The logs of a study, one a scenario: the file's name and its text.
pub fn logs(study: &Study, rows: &[Vec<Cell<'_>>]) -> Vec<(String, String)> {
    let scenarios = study.scenarios.iter().zip(rows).enumerate();
    let log = |(k, (scenario, row)): (usize, (&StudyScenario, &Vec<Cell<'_>>))| {
        (format!("{}.log", study.file_stem(k)), log(study, scenario, row))
    };
    scenarios.map(log).collect()
}

/// One word: the reader splits lines at blanks and takes the last word.
fn token(text: &str) -> String {
    let keep = |letter: char| letter.is_ascii_alphanumeric() || "-._".contains(letter);
    let word: String = text.chars().map(|letter| if keep(letter) { letter } else { '_' }).collect();
    if word.is_empty() { "unknown".into() } else { word }
}

/// One line, without blanks at its ends.
fn line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

fn log(study: &Study, scenario: &StudyScenario, row: &[Cell<'_>]) -> String {
    let mut text = head(study, scenario, row);
    writeln!(text, "1 enum type\nstatus|{}", STATUSES.join("|")).expect("a text takes everything");
    writeln!(text, "{} planners", row.len()).expect("a text takes everything");
    row.iter().for_each(|cell| text += &planner(cell));
    text
}

fn head(study: &Study, scenario: &StudyScenario, row: &[Cell<'_>]) -> String {
    let version = study.versions.get("regrasp").map_or("0.0.0".into(), |version| token(version));
    let machine = study.machines.first();
    let host = machine.map_or("unknown".into(), |machine| token(&machine.host));
    let cpu = machine.map_or_else(String::new, |m| {
        format!("{} ({} threads, {} runs at once)", line(&m.cpu), m.cores, m.threads)
    });
    let runs = row.iter().flat_map(|cell| &cell.runs);
    let total: f64 = runs.map(|run| run.times.planning_s + run.times.verification_s).sum();
    format!(
        "Regrasp version {version}\nExperiment {}\nRunning on {host}\nStarting at {}\n<<<|\n{}|>>>\n<<<|\n \
            {cpu}\n|>>>\n\
         {} is the random seed\n{} seconds per run\n0 MB per run\n{} runs per planner\n{total} seconds \
         spent to collect the data\n",
        token(&scenario.name),
        time::utc(study.started_s),
        setup(study, scenario),
        study.seeds.first,
        study.time_limit_s.unwrap_or(0.0),
        study.seeds.count,
    )
}

/// What was done, each line indented so that none can look like the end of the block.
fn setup(study: &Study, scenario: &StudyScenario) -> String {
    let facts = [
        ("command", line(&study.command.join(" "))),
        ("scenario", line(&scenario.name)),
        ("summary", line(&scenario.summary)),
        ("source", line(&scenario.source)),
    ];
    facts.iter().map(|(name, value)| format!("  {name}: {value}\n")).collect()
}

/// A planner: its settings, the names of its properties, a row for each run, a full stop.
fn planner(cell: &Cell<'_>) -> String {
    let settings = settings(cell);
    let properties = properties();
    let mut text = format!("{}\n{} common properties\n", line(&cell.variant.name), settings.len());
    settings.iter().for_each(|setting| text += &format!("{setting}\n"));
    text += &format!("{} properties for each run\n", properties.len());
    properties.iter().for_each(|property| text += &format!("{} {}\n", property.name, property.kind));
    text += &format!("{} runs\n", cell.runs.len());
    for run in &cell.runs {
        let values = properties.iter().map(|property| (property.value)(run));
        // The reader drops what follows the last separator: every value needs one.
        text.extend(values.map(|value| value.map(|value| value.to_string()).unwrap_or_default() + "; "));
        text.push('\n');
    }
    text + ".\n"
}

/// Every slot's plugin and settings, one a line.
fn settings(cell: &Cell<'_>) -> Vec<String> {
    let mut lines = Vec::new();
    for (slot, PluginChoice { id, settings }) in cell.scenario.plugins.get(cell.index).into_iter().flatten() {
        lines.push(format!("{} = {}", slot.name(), line(id)));
        let Value::Object(settings) = settings else { continue };
        lines.extend(settings.iter().map(|(key, value)| format!("{}.{} = {value}", slot.name(), line(key))));
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::fixture::{runs, study};
    use crate::compare::{RunKey, analyse};

    #[test]
    fn a_log_has_a_planner_for_each_variant_and_ends_every_value() {
        let study = study(&["rlg", "two words"]);
        let time = |key: RunKey| (key.seed != 3).then_some(0.25);
        let records = runs(&study, time);
        let logs = logs(&study, &analyse(&study, &records));
        assert!(logs[0].0.ends_with(".log") && logs[0].0 != logs[1].0);
        let lines: Vec<&str> = logs[0].1.lines().collect();
        assert_eq!(lines[0..2], ["Regrasp version 0.1.0", "Experiment sphere"]);
        assert_eq!(lines[2..4], ["Running on a_host", "Starting at 2026-11-22 03:00:00"]);
        assert_eq!(lines.iter().filter(|line| **line == ".").count(), 2);
        let at = lines.iter().position(|line| *line == "two words").unwrap();
        assert_eq!(
            lines[at + 1..at + 4],
            ["2 common properties", "sampler = sampler/two words", "sampler.note = \"a, \\\"b\\\" <i>\""]
        );
        let number = |line: &str| line.split(' ').next().unwrap().parse::<usize>().unwrap();
        let properties = number(lines[at + 4]);
        let runs = at + 5 + properties;
        assert_eq!(number(lines[runs]), 12);
        for row in &lines[runs + 1..runs + 13] {
            assert!(row.ends_with("; "), "{row:?}");
            assert_eq!(row.matches("; ").count(), properties);
        }
        assert!(lines[runs + 1].starts_with("1; 6; 0.25; 2.5; 1; 0; "));
        assert!(
            lines[runs + 4].starts_with("0; 10; 0.5; 2.5; 0; 3; ") && lines[runs + 4].ends_with("; ; ; ; ")
        );
    }

    #[test]
    fn names_become_single_words() {
        assert_eq!(token("my cube/ü 1.toml"), "my_cube___1.toml");
        assert_eq!(token(""), "unknown");
        assert_eq!(line(" a\n|>>>  b "), "a |>>> b");
    }
}
