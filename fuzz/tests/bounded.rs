//! A bounded number of damaged inputs for every reader: none may panic. The same on every machine.

use regrasp::api::Random;
use regrasp_fuzz::{TARGETS, Target, mutate};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::{Duration, Instant};

/// Inputs for each target here; `REGRASP_FUZZ=N` asks for more.
const COUNT: u64 = 150;

#[test]
fn no_reader_panics() {
    let count = std::env::var("REGRASP_FUZZ").ok().and_then(|n| n.parse().ok()).unwrap_or(COUNT);
    let faults: Vec<String> = TARGETS.iter().filter_map(|target| fault(target, count)).collect();
    assert!(faults.is_empty(), "{faults:#?}");
}

/// The first input that makes this reader panic, kept in a file to look at. Prints how often it understood
/// what it was given, and how long the slowest took.
fn fault(target: &Target, count: u64) -> Option<String> {
    let seeds = (target.seeds)();
    assert!(!seeds.is_empty(), "`{}` has no seeds", target.name);
    let (mut understood, mut slowest) = (0, (Duration::ZERO, 0));
    let fault = (0..count).find_map(|number| {
        let kind = target.name.bytes().fold(0, |kind, byte| 31 * kind + u64::from(byte));
        let mut random = Random::from_key(1, kind, number, 0);
        let [first, second] = [0; 2].map(|_| random.index(seeds.len()));
        let bytes = mutate(&seeds[first], &seeds[second], &mut random);
        let folder = tempfile::tempdir().expect("a temporary folder");
        let start = Instant::now();
        let found = catch_unwind(AssertUnwindSafe(|| (target.read)(&bytes, folder.path())));
        slowest = slowest.max((start.elapsed(), number));
        understood += u64::from(*found.as_ref().unwrap_or(&false));
        found.is_err().then(|| {
            let kept = std::env::temp_dir().join(format!("regrasp-fuzz-{}-{number}", target.name));
            std::fs::write(&kept, &bytes).expect("the folder of temporary files can be written to");
            format!("`{}` panics at `{}`", target.name, kept.display())
        })
    });
    let (time, number) = slowest;
    println!(
        "{}: {count} inputs, {understood} understood, at most {time:.1?} (number {number})",
        target.name
    );
    fault
}

#[test]
fn the_seeds_are_whole() {
    // Of libraries none is a plugin: nothing may be built here.
    for target in TARGETS.iter().filter(|target| target.name != "library") {
        for (number, seed) in (target.seeds)().iter().enumerate() {
            let folder = tempfile::tempdir().expect("a temporary folder");
            assert!((target.read)(seed, folder.path()), "{}: seed {number}", target.name);
        }
    }
}
