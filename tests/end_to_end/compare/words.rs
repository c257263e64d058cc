//! What is said: to bad input, of other studies, in study files, in tables.

use super::shelf::runs;
use crate::desk::{Desk, built_in};
use std::collections::BTreeSet;

#[test]
fn bad_input_is_refused_before_any_work() {
    let desk = Desk::new();
    desk.write("file", "something");
    let refused = |words: &str, parts: &[&str]| desk.run(&format!("compare {words}")).assert_fails(2, parts);
    refused("-o out", &["nothing to plan", "--suite"]);
    refused("sphere", &["--output <DIR>"]);
    refused("spere -o out", &["no built-in scenario `spere`", "did you mean", "sphere"]);
    refused("sphere sphere -o out", &["two scenarios are called `sphere`"]);
    refused("sphere --vary sampler=rlg,rlg -o out", &["two variants are called `rlg`"]);
    refused("sphere --vary sampler=rlg --vary sampler=projection -o out", &["fills `sampler` twice"]);
    refused("sphere --vary samler=rlg -o out", &["did you mean `sampler`"]);
    refused("sphere --vary sampler=rgl -o out", &["did you mean `sampler/rlg`"]);
    refused("sphere --vary sampler -o out", &["SLOT=ID,ID"]);
    refused(
        "sphere --vary graph-strategy.end=2 -o out",
        &["variant `end=2`", "`end` = 2", "is outside 0..=1"],
    );
    refused("sphere --vary graph-strategy.edn=0.2 -o out", &["did you mean `end`"]);
    refused("sphere --use sampler=nothing -o out", &["no plugin `nothing`"]);
    refused("sphere --seeds 0 -o out", &["--seeds <N>", "1..="]);
    refused("sphere --first-seed 18446744073709551615 -o out", &["--first-seed <N>"]);
    refused("sphere --threads 0 -o out", &["--threads <N>", "1..="]);
    refused("sphere --time-limit 0 -o out", &["--time-limit <S>", "0.001"]);
    refused("sphere --shard 3/2 -o out", &["I/N with I in 1..=N"]);
    refused("sphere --suite papers -o out", &["`paper`, `strict`, `harder` or `all`"]);
    refused("sphere --study file -o out", &["cannot be used with"]);
    refused("sphere --merge a -o out", &["cannot be used with"]);
    refused("sphere --load file -o out", &["`file`"]);
    refused("sphere --seeds 1 -o file", &["`file`"]);
    refused("sphere --seeds 1 -o .", &["holds no study, but has `file` in it"]);
    assert_eq!(desk.files(), ["file"], "nothing was made");
}

#[test]
fn another_study_in_the_same_folder_is_refused_with_what_differs() {
    let desk = Desk::new();
    assert_eq!(desk.run("compare sphere --vary sampler=rlg,projection --seeds 1 -o study").code, 0);
    let before = desk.read("study/study.json");
    let refused = |words: &str, difference: &str| {
        desk.run(&format!("compare {words} -o study")).assert_fails(2, &["another study", difference]);
        assert_eq!(desk.read("study/study.json"), before);
    };
    let same = "sphere --vary sampler=rlg,projection";
    refused(&format!("{same} --seeds 2"), "`seeds.count` is 1 there and 2 here");
    refused(&format!("{same} --seeds 1 --first-seed 1"), "`seeds.first` is 0 there and 1 here");
    refused(
        "sphere --vary sampler=rlg,grasp-first --seeds 1",
        "`variants[1]` is \"projection\" there and \"grasp-first\" here",
    );
    refused("sphere --seeds 1", "`variants` is `rlg`, `projection` there and `base` here");
    refused(
        "cubic --vary sampler=rlg,projection --seeds 1",
        "`scenarios[0]` is \"sphere\" there and \"cubic\" here",
    );
    refused(&format!("{same} --seeds 1 --time-limit 5"), "time_limit");
    refused(&format!("{same} --seeds 1 --max-nodes 7"), "max_nodes` is 1000 there and 7 here");
    refused(&format!("{same} --seeds 1 --set graph-strategy.end=0.2"), "end` is");
    refused(&format!("{same} --seeds 1 --shard 1/2"), "`shard` is absent there");
    // Another way to say the same is the same study.
    assert_eq!(
        desk.run("compare sphere --vary sampler=sampler/rlg,sampler/projection --seeds 1 -o study").code,
        0
    );
    desk.write("study/study.json", before.replace("\"program\": \"", "\"program\": \"0"));
    desk.run(&format!("compare {same} --seeds 1 -o study"))
        .assert_fails(2, &["versions.program", "same build"]);
    desk.write("study/study.json", "{}");
    desk.run(&format!("compare {same} --seeds 1 -o study")).assert_fails(2, &["`study.json`"]);
}

#[test]
fn study_files_hold_what_a_command_line_cannot() {
    let desk = Desk::new();
    desk.write("mine.toml", desk.run("scenarios sphere").out.replace("name = \"sphere\"", "name = \"mine\""));
    let head = "scenarios = [\"mine.toml\", \"sphere-tilt\"]\nseeds = 1\n";
    let levels = "[[vary]]\nslot = \"graph-strategy\"\nlevels = [{ use = \"interleaved\", start = 0.2, end \
        = 0.4 }, { use = \"lazy\" }]\n";
    desk.write("vary.toml", format!("{head}{levels}[plugins.sampler]\nuse = \"projection\"\n"));
    let said = desk.run("compare --study vary.toml -o vary --json");
    assert_eq!(said.code, 0, "{}", said.err);
    let names: BTreeSet<String> = runs(&desk.path("vary"))
        .iter()
        .map(|run| format!("{} {}", run["scenario"], run["variant"]))
        .collect();
    assert_eq!(names.len(), 4);
    assert!(names.contains("\"mine\" \"interleaved end=0.4 start=0.2\""), "{names:?}");
    assert!(desk.read("vary/runs.csv").contains("sampler/projection"));

    let variants = "[[variant]]\nname = \"paper\"\n[[variant]]\nname = \"calm\"\nplugins.graph-strategy = { \
        end = 0.2 }\n";
    desk.write("list.toml", format!("{head}{variants}"));
    let rows = desk.run("compare --study list.toml --seeds 2 -o list --json").json();
    assert_eq!((&rows["runs"], &rows["rows"][1]["variant"]), (&8.into(), &"calm".into()));
    assert!(desk.run("schema study").json()["properties"].get("vary").is_some());

    let refused = |text: &str, parts: &[&str]| {
        desk.write("bad.toml", text);
        desk.run("compare --study bad.toml -o bad").assert_fails(2, parts);
    };
    refused("seeds = 2\n", &["`scenarios`", "suite"]);
    refused(&format!("{head}{levels}{variants}"), &["either `vary`", "bad.toml"]);
    refused("scenario = [\"sphere\"]\n", &["bad.toml:1", "did you mean `scenarios`"]);
    refused(
        "scenarios = [\"sphere\"]\nseeds = 0\n",
        &["bad.toml:2", "key `seeds`", "0 is outside 1..=1000000"],
    );
    refused(
        &format!("{head}[[vary]]\nslot = \"samper\"\nlevels = []\n"),
        &["vary[0].slot", "did you mean `sampler`"],
    );
    refused(&format!("{head}[[vary]]\nslot = \"sampler\"\nlevels = []\n"), &["`vary[0].levels` is empty"]);
    refused(
        &format!("{head}[[vary]]\nslot = \"sampler\"\nlevels = [{{ use = \"rgl\" }}]\n"),
        &["vary[0].levels[0].use", "did you mean"],
    );
    refused("scenarios = [\"nowhere.toml\"]\n", &["nowhere.toml"]);
    desk.run("compare --study none.toml -o bad").assert_fails(2, &["none.toml"]);
}

#[test]
fn the_papers_table_is_printed() {
    let desk = Desk::new();
    let said = desk.run("compare --suite paper --seeds 2 -o table");
    assert_eq!(said.code, 0, "{}", said.err);
    for row in [
        "sphere          17.5 s    196     23  |      2        2",
        "cubic             27 s",
        "ellip-obst       128 s",
    ] {
        assert!(said.out.contains(row), "{row}\n{}", said.out);
    }
    assert!(said.err.is_empty(), "nobody watches: {}", said.err);
}

#[test]
fn what_users_write_is_text_and_no_mark() {
    let desk = Desk::new();
    let words =
        [("name = \"sphere\"", "name = \"o`d|d\""), ("summary = \"a ball", "summary = \"a `ball` *of* <b>")];
    desk.write("odd.toml", built_in("sphere", &words));
    assert_eq!(desk.run("compare odd.toml --seeds 1 -o study").code, 0);
    let summary = desk.read("study/summary.md");
    assert!(summary.contains("\n## o\\`d\\|d\n"), "{summary}");
    assert!(summary.contains("a \\`ball\\` \\*of\\* \\<b\\>"), "{summary}");
}
