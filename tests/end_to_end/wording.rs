//! What a newcomer gets wrong on the command line, and what the program says: what is wrong, what is allowed,
//! what to do.

use crate::desk::{Desk, Said};
use std::process::{Command, Stdio};

/// Each command must be refused as bad input with all of these words.
fn refused(desk: &Desk, cases: &[(&str, &[&str])]) {
    for (arguments, parts) in cases {
        let said = desk.run(arguments);
        assert!(said.err.starts_with("error: "), "{arguments}: {}", said.err);
        said.assert_fails(2, parts);
    }
}

#[test]
fn numbers_of_options() {
    let whole = "it must be a whole number in";
    refused(
        &Desk::new(),
        &[
            ("plan sphere --seed -1", &[whole, "0..=18446744073709551615"]),
            ("plan sphere --seed 1.5", &[whole]),
            ("plan sphere --threads 0", &[whole, "1..=256"]),
            ("plan sphere --max-nodes 1e9", &[whole, "1..=10000000"]),
            ("plan sphere --max-nodes -5", &[whole]),
            ("plan sphere --time-limit nan", &["it must be a number of seconds in 0.001..=10000000"]),
            ("compare sphere -o study --seeds -1", &[whole, "1..=1000000"]),
            ("compare sphere -o study --threads 0", &[whole, "1..=1024"]),
            ("replay plan.json --grip -1", &["it must be a number in 0..=10000"]),
            ("replay plan.json --slowdown nan", &["it must be a number in 0..=100"]),
            ("hand hand.urdf --mesh-pieces x", &[whole, "1..=64"]),
            ("hand hand.urdf --ball -1", &["it must be a number of metres in 0.001..=1"]),
        ],
    );
}

#[test]
fn slots_plugins_and_settings() {
    refused(
        &Desk::new(),
        &[
            (
                "plan sphere --use sampler",
                &["not of the form SLOT=ID", "such as sampler=rlg", "`regrasp plugins`"],
            ),
            ("plan sphere --use sampler=", &["not of the form SLOT=ID"]),
            ("plan sphere --use =rlg", &["not of the form SLOT=ID"]),
            ("plan sphere --use local-planner=rrt", &["did you mean `local-planner.grasp`"]),
            ("plan sphere --set sampler.poses", &["not of the form SLOT.KEY=VALUE", "`regrasp plugins ID`"]),
            ("plan sphere --set sampler.poses=", &["null is not a whole number"]),
            ("plan sphere --set sampler.poses=0", &["`sampler/rlg`: `poses` = 0 is outside 1..=100000"]),
            ("plan sphere --set sampler.poses=1e30", &["1e30 is not a whole number"]),
            ("plan sphere --set sampler.spread_deg=-1", &["`spread_deg` = -1 is outside 0..=180 degrees"]),
            ("compare sphere -o study --vary sampler", &["SLOT=ID,ID…", "such as sampler=rlg,projection"]),
        ],
    );
}

#[test]
fn files_of_the_wrong_kind() {
    let desk = Desk::new();
    std::fs::create_dir(desk.path("folder")).expect("the folder is ours");
    desk.write("empty.json", "");
    desk.write("binary.json", [0xff, 0x00, 0xfe]);
    desk.write("list.json", "[1, 2]");
    desk.write("mine.toml", desk.run("scenarios sphere").out);
    assert_eq!(desk.run("plan mine.toml -o plan.json").code, 0);
    // Without simulation `replay` refuses everything.
    let replay = cfg!(feature = "rapier").then_some("replay");
    for command in ["verify", "view", "export --to csv"].into_iter().chain(replay) {
        let refused =
            |file: &str, parts: &[&str]| desk.run(&format!("{command} {file}")).assert_fails(2, parts);
        refused("none.json", &["`none.json` does not exist", "`plan SCENARIO -o PLAN` makes a plan file"]);
        refused("folder", &["`folder` is a folder; give the plan file in it"]);
        refused("empty.json", &["`empty.json` is empty"]);
        refused("binary.json", &["`binary.json` is not JSON"]);
        refused("list.json", &["`list.json` is not a plan file: `format` is missing"]);
        refused(
            "mine.toml",
            &["`mine.toml` is not JSON", "of a scenario, `plan SCENARIO -o PLAN` makes a plan file"],
        );
    }
    refused(
        &desk,
        &[
            ("plan plan.json", &["it is a plan, not a scenario", "plan files are for `verify`"]),
            ("plan folder", &["it is a folder; name the file in it"]),
            ("plan cubic.toml", &["No such file", "the built-in scenario is called `cubic`"]),
            ("plan mein.toml", &["No such file", "`scenarios sphere` prints a built-in one to start from"]),
            (
                "view plan.json --replay none.json",
                &["`none.json` cannot be read", "`regrasp replay PLAN -o FILE` makes one"],
            ),
            (
                "compare sphere --seeds 1 -o plan.json",
                &["`plan.json` holds no study: it is a file; give a folder"],
            ),
            ("export plan.json --to csv -o mine.toml", &["`mine.toml` cannot take the files: it is a file"]),
        ],
    );
}

#[test]
fn what_is_refused_as_json_is_told_in_fields_too() {
    let desk = Desk::new();
    for arguments in [
        "plan spere --json",
        "verify none.json --json",
        "plugins nope --json",
        "compare spere --json -o study",
    ] {
        let said = desk.run(arguments);
        said.assert_fails(2, &["error: "]);
        let error = &said.json()["error"];
        assert!(error["code"].is_string() && error["message"].is_string(), "{arguments}: {}", said.out);
    }
    assert!(desk.files().is_empty());
}

/// Runs the program with standard output on `out`.
#[cfg(target_os = "linux")]
fn with_output(desk: &Desk, arguments: &str, out: Stdio) -> Said {
    let child = Command::new(env!("CARGO_BIN_EXE_regrasp"))
        .args(arguments.split_whitespace())
        .current_dir(desk.folder())
        .stdout(out)
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program was built for this test");
    Said::of(&child.wait_with_output().expect("the program ends"))
}

#[test]
#[cfg(target_os = "linux")]
fn a_full_disk_is_told() {
    let desk = Desk::new();
    assert_eq!(desk.run("plan sphere -o plan.json").code, 0);
    for arguments in
        ["plan sphere -o /dev/full", "view plan.json -o /dev/full", "replay plan.json -o /dev/full"]
    {
        if arguments.starts_with("replay") && !cfg!(feature = "rapier") {
            continue; // built without simulation
        }
        desk.run(arguments).assert_fails(2, &["`/dev/full` is not written: no space is left there"]);
    }
    for arguments in ["plugins", "schema", "plan sphere", "completions bash", "man"] {
        let full = std::fs::OpenOptions::new().write(true).open("/dev/full").expect("Linux has it");
        with_output(&desk, arguments, full.into())
            .assert_fails(2, &["cannot write to standard output: No space left"]);
    }
}

#[test]
#[cfg(target_os = "linux")]
fn a_reader_that_goes_away_is_no_failure() {
    let desk = Desk::new();
    for arguments in
        ["plugins", "plugins --json", "schema", "completions zsh", "man", "plan sphere --json", "--help"]
    {
        let (reader, writer) = std::io::pipe().expect("pipes are to be had");
        drop(reader);
        let said = with_output(&desk, arguments, writer.into());
        assert_eq!((said.code, said.err.as_str()), (0, ""), "{arguments}");
    }
}
