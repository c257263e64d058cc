//! Killed at any moment and begun again, a study ends with the files of an undisturbed one.

use super::shelf::{runs, timeless};
use crate::desk::{Desk, Said};
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::Duration;

const STUDY: &str = "compare sphere cubic --vary graph-strategy=interleaved,lazy --seeds 8 -o";

fn spawn(desk: &Desk, folder: &str) -> Child {
    let mut command = Command::new(env!("CARGO_BIN_EXE_regrasp"));
    command.args(STUDY.split_whitespace()).arg(folder).current_dir(desk.folder());
    command.stdout(Stdio::piped()).stderr(Stdio::piped());
    command.spawn().expect("the program was built for this test")
}

/// When the program is killed.
enum Moment {
    /// As soon as this file of the study is there.
    Written(&'static str),
    /// As soon as the journal has this many lines.
    Runs(usize),
}

impl Moment {
    fn has_come(&self, desk: &Desk) -> bool {
        match self {
            Self::Written(name) => desk.path("killed").join(name).exists(),
            Self::Runs(count) => kept(desk).len() >= *count,
        }
    }
}

/// The whole lines of the journal; with their times, so that a run that was made twice would be noticed.
fn kept(desk: &Desk) -> Vec<String> {
    let text = std::fs::read_to_string(desk.path("killed/runs.jsonl")).unwrap_or_default();
    text.split_inclusive('\n').filter(|line| line.ends_with('\n')).map(str::to_owned).collect()
}

#[test]
fn killed_again_and_again_it_ends_as_if_undisturbed() {
    let desk = Desk::new();
    let undisturbed = desk.run(&format!("{STUDY} whole"));
    assert_eq!(undisturbed.code, 0, "{}", undisturbed.err);
    let runs = [1, 2, 5, 12, 20, 31, 32].map(Moment::Runs);
    let files = ["", "runs.jsonl", "study.json"].map(Moment::Written);
    let results = ["runs.csv", "summary.csv", "summary.md", "report.html"].map(Moment::Written);
    let mut before = Vec::new();
    for moment in files.iter().chain(&runs).chain(&results) {
        let mut child = spawn(&desk, "killed");
        while !moment.has_come(&desk) && child.try_wait().expect("the child is ours").is_none() {
            sleep(Duration::from_micros(200));
        }
        // SIGKILL on Unix: nothing of the program gets to say or do anything.
        child.kill().expect("the child is ours");
        let said = Said::of(&child.wait_with_output().expect("it has ended"));
        assert!([-1, 0].contains(&said.code), "neither killed nor done: {}", said.err);
        let after = kept(&desk);
        assert!(before.iter().all(|line| after.contains(line)), "a finished run was lost or made again");
        before = after;
    }
    tear(&desk);
    let said = desk.run(&format!("{STUDY} killed"));
    assert_eq!(said.code, 0, "{}", said.err);
    assert_eq!(timeless(&desk.path("killed")), timeless(&desk.path("whole")));
}

/// Leaves the journal as a kill in the middle of writing a line does, which happens too seldom to wait for.
fn tear(desk: &Desk) {
    let journal = desk.read("killed/runs.jsonl");
    desk.write("killed/runs.jsonl", &journal[..journal.len() - 100]);
    desk.write("killed/.regrasp-torn.tmp", "half a file");
}

#[test]
fn what_is_finished_is_not_made_again() {
    let desk = Desk::new();
    let study = "compare sphere --seeds 3 -o study --json";
    assert_eq!(desk.run(study).json()["runs"], 3);
    let before = desk.read("study/runs.jsonl");
    let again = desk.run(study);
    assert_eq!((again.code, desk.read("study/runs.jsonl") == before), (0, true));
}

#[test]
#[cfg(unix)]
fn ctrl_c_keeps_what_is_finished_and_says_so() {
    let desk = Desk::new();
    let child = spawn(&desk, "study");
    while std::fs::metadata(desk.path("study/runs.jsonl")).map_or(0, |file| file.len()) == 0 {
        sleep(Duration::from_millis(5));
    }
    let signalled = Command::new("kill").args(["-INT", &child.id().to_string()]).status().expect("kill runs");
    assert!(signalled.success());
    let said = Said::of(&child.wait_with_output().expect("the program ends"));
    said.assert_fails(130, &["interrupted", "of 32 runs are kept in `study`", "the same command goes on"]);
    // The table of what is finished, in the words of a finished study; one run of either variant may be all.
    let named = ["interleaved", "lazy"].iter().any(|variant| said.out.contains(variant));
    assert!(said.out.contains("Of the runs that are finished") && named, "{}", said.out);
    let there = runs(&desk.path("study")).len();
    assert!((1..32).contains(&there), "{there} runs");
    assert_eq!(super::shelf::csv(&desk.read("study/runs.csv")).len(), 1 + there);
    assert!(!desk.path("study/report.html").exists(), "a study that is not complete has no results yet");
}

#[test]
fn two_do_not_work_on_one_study() {
    let desk = Desk::new();
    let mut child = spawn(&desk, "study");
    while !desk.path("study/study.json").exists() {
        sleep(Duration::from_millis(2));
    }
    desk.run(&format!("{STUDY} study")).assert_fails(2, &["is being worked on by process"]);
    child.kill().expect("the child is ours");
    child.wait().expect("it was killed");
}
