//! A study in parts, and the parts joined.

use super::shelf::{runs, timeless};
use crate::desk::Desk;

const STUDY: &str = "compare sphere cubic --vary stability-test=force-closure,wrench-ball --seeds 3";

#[test]
fn parts_join_to_what_a_whole_study_gives() {
    let desk = Desk::new();
    assert_eq!(desk.run(&format!("{STUDY} -o whole")).code, 0);
    let mut sizes = Vec::new();
    for part in 1..=4 {
        let said = desk.run(&format!("{STUDY} --shard {part}/4 -o part{part}"));
        assert_eq!(said.code, 0, "{}", said.err);
        sizes.push(runs(&desk.path(&format!("part{part}"))).len());
    }
    // Six pairs of scenario and seed, each with two variants.
    assert_eq!(sizes, [4, 4, 2, 2]);
    let said = desk.run("compare --merge part3 part1 part4 part2 -o joined --json");
    assert_eq!((said.code, &said.json()["runs"]), (0, &12.into()), "{}", said.err);
    assert_eq!(timeless(&desk.path("joined")), timeless(&desk.path("whole")));
    // Joining again changes nothing; going on with the whole study finds nothing to do.
    let before = desk.read("joined/runs.jsonl");
    assert_eq!(desk.run("compare --merge part1 part2 part3 part4 -o joined").code, 0);
    assert_eq!(desk.run(&format!("{STUDY} -o joined")).code, 0);
    assert_eq!(desk.read("joined/runs.jsonl"), before);
}

#[test]
fn parts_that_make_no_whole_are_refused() {
    let desk = Desk::new();
    let make = |words: &str| assert_eq!(desk.run(&format!("compare sphere {words}")).code, 0, "{words}");
    make("--seeds 2 --shard 1/2 -o a1");
    make("--seeds 2 --shard 2/2 -o a2");
    make("--seeds 3 --shard 2/2 -o other");
    make("--seeds 2 -o whole");
    let refused = |folders: &str, parts: &[&str]| {
        desk.run(&format!("compare --merge {folders} -o out")).assert_fails(2, parts);
        assert!(!desk.path("out").exists(), "nothing is written");
    };
    refused("a1", &["parts are missing: 2/2"]);
    refused("a1 a2 a1", &["part 1 of 2", "the same part is in `a1`"]);
    refused("a1 other", &["another study", "`seeds.count` is 2 there and 3 here"]);
    refused("a1 whole", &["`whole`", "not a part"]);
    refused("a1 nowhere", &["`nowhere`", "no `study.json`"]);
    let journal = desk.read("a2/runs.jsonl");
    desk.write("a2/runs.jsonl", &journal[..journal.len() / 2]);
    refused("a1 a2", &["part 2 of 2", "0 of its 1 runs are there"]);
    desk.write("a2/runs.jsonl", "{\"scenario\": 1}\n{}\n");
    refused("a1 a2", &["a2/runs.jsonl", "line 1"]);
}
