//! Atlases made: the same on any number of threads and after a kill, and what cannot be held is told.

use regrasp_atlas::{
    AtlasError, AtlasHand, Cell, Ended, Found, Journal, Shape, Summary, Told, Wish, explore, json,
};
use regrasp_contact_models as _;
use regrasp_graph_strategies as _;
use regrasp_host::Registry;
use regrasp_local_planners as _;
use regrasp_plan::JournalError;
use regrasp_planner::Clock;
use regrasp_run::NeverStops;
use regrasp_samplers as _;
use regrasp_stability_tests as _;
use regrasp_surfaces as _;
use std::path::Path;

/// Time stands still.
struct Still;

impl Clock for Still {
    fn seconds(&self) -> f64 {
        0.0
    }
}

/// A ball of 50 mm and one of half a metre, which no hand of ours holds.
fn wish() -> Wish {
    Wish {
        shapes: vec![Shape::Sphere],
        sizes: vec![0.05, 0.5],
        goals: 3,
        tries: 1,
        nodes: 2,
        ..Wish::default()
    }
}

fn hands() -> Vec<AtlasHand> {
    vec![AtlasHand::load("four-finger").unwrap(), AtlasHand::load("free-fingertips").unwrap()]
}

/// The cells of an atlas in a folder, begun or gone on with.
fn made(folder: &Path, wish: &Wish, threads: usize) -> Vec<Cell> {
    let hands = hands();
    let mut journal = Journal::open(&folder.join("atlas.part"), wish, &hands, false).unwrap();
    let known: Vec<usize> = journal.cells().iter().map(|cell| cell.number).collect();
    let registry = Registry::linked().unwrap();
    let ended = explore(wish, &hands, &known, &registry, (threads, &NeverStops, &Still), &mut journal);
    assert_eq!(ended.unwrap(), Ended::Whole);
    journal.cells()
}

#[test]
fn an_atlas_is_the_same_on_two_threads_and_after_a_kill() {
    let (one, two) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let cells = made(one.path(), &wish(), 1);
    assert_eq!(cells, made(two.path(), &wish(), 2));
    // A kill in the middle of the last line.
    let path = one.path().join("atlas.part");
    let bytes = std::fs::read(&path).unwrap();
    std::fs::write(&path, &bytes[..bytes.len() - 40]).unwrap();
    assert_eq!(made(one.path(), &wish(), 1), cells);
    let summary = Summary::of(&cells);
    assert!(json(&wish(), &hands(), &cells, &summary).starts_with("{\n  \"format\": \"regrasp-atlas\""));
}

#[test]
fn what_is_held_has_attempts_and_what_is_not_has_a_cause() {
    let folder = tempfile::tempdir().unwrap();
    let cells = made(folder.path(), &wish(), 1);
    assert_eq!(cells.len(), 4);
    for cell in &cells {
        let is_huge = cell.member.size > 0.1;
        assert_eq!(cell.cause.is_some(), is_huge, "{cell:?}");
        assert_eq!(cell.attempts.len(), if is_huge { 0 } else { 3 });
        for attempt in &cell.attempts {
            assert_eq!(attempt.regrasps.is_some(), attempt.found == Found::Reached);
            assert!((0.0..=180.0).contains(&attempt.angle_deg));
        }
    }
    // The same turns for all hands.
    let turns = |cell: &Cell| cell.attempts.iter().map(|a| a.angle_deg).collect::<Vec<_>>();
    assert_eq!(turns(&cells[0]), turns(&cells[2]));
    assert!(cells.iter().flat_map(|cell| &cell.attempts).any(|attempt| attempt.found == Found::Reached));
}

#[test]
fn the_journal_of_another_atlas_is_refused_and_kept() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("atlas.part");
    drop(Journal::open(&path, &wish(), &hands(), false).unwrap());
    let other = Wish { seed: 1, ..wish() };
    let Err(error) = Journal::open(&path, &other, &hands(), false) else { panic!("another seed") };
    assert!(matches!(error, AtlasError::Journal(JournalError::Other { .. })), "{error}");
    assert!(Journal::open(&path, &other, &hands(), true).unwrap().cells().is_empty());
}

/// A journal that fails, as one on a full disk does.
struct Full;

impl Told for Full {
    fn done(&mut self, _: &Cell) -> Result<(), AtlasError> {
        Err(AtlasError::Nothing { key: "disk" })
    }
}

#[test]
fn a_full_disk_ends_the_work() {
    let registry = Registry::linked().unwrap();
    let how = (2, &NeverStops as _, &Still as _);
    let ended = explore(&wish(), &hands(), &[], &registry, how, &mut Full);
    assert!(matches!(ended, Err(AtlasError::Nothing { key: "disk" })));
}
