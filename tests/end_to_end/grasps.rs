//! `regrasp grasps` from outside: files, what is refused, what is kept.

use crate::desk::{Desk, built_in};
use std::fs;

#[test]
fn files_are_the_same_on_any_number_of_threads() {
    let desk = Desk::new();
    for (threads, name) in [(1, "one"), (2, "two")] {
        for end in ["npz", "jsonl", "xml", "reset.npz"] {
            let said = desk.run(&format!("grasps sphere -n 40 --threads {threads} -o {name}.{end}"));
            assert_eq!(said.code, 0, "{}", said.err);
        }
    }
    let bytes = |name: &str| fs::read(desk.path(name)).unwrap();
    for end in ["npz", "jsonl", "xml", "reset.npz"] {
        assert!(bytes(&format!("one.{end}")) == bytes(&format!("two.{end}")), "{end}");
    }
    assert_eq!(desk.read("one.jsonl").lines().count(), 40);
    assert_eq!(desk.read("one.xml").matches("<key ").count(), 40);
    assert!(desk.files().iter().all(|file| !file.ends_with(".part")), "{:?}", desk.files());
    // A file of grasps may take the place of one, and of nothing else.
    assert_eq!(desk.run("grasps sphere -n 5 -o one.npz").code, 0);
    desk.write("mine.npz", "my data");
    desk.run("grasps sphere -n 5 -o mine.npz").assert_fails(2, &["it exists", "--force"]);
    assert_eq!(desk.read("mine.npz"), "my data");
}

#[test]
fn a_hand_and_an_object_are_enough() {
    let desk = Desk::new();
    let text = "[hand]\nbuiltin = \"four-finger\"\n[object]\nfriction = 0.8\nshape = { kind = \"sphere\", \
        radius = 0.03 }\n";
    desk.write("mine.toml", text);
    let said = desk.run("grasps mine.toml -n 10 --graph --json -o g.npz");
    assert_eq!(said.code, 0, "{}", said.err);
    let told = said.json();
    assert_eq!((&told["grasps"], &told["refused_by_verifier"]), (&10.into(), &0.into()));
    desk.run("plan mine.toml").assert_fails(2, &["start"]);
}

#[test]
fn bad_wishes_are_refused_before_any_work() {
    let desk = Desk::new();
    for (words, part) in [
        ("grasps sphere -o g.txt", "must end with"),
        ("grasps sphere -o -", "grasps need a file"),
        ("grasps sphere -o g.npz -n 0", "1..="),
        ("grasps sphere -o g.npz --spread 0", "length in metres"),
        ("grasps sphere -o g.npz --fingers 5", "the hand has 4"),
        ("grasps sphere -o none/g.npz", "none"),
        ("grasps sphere -o g.npz --objects none", "--objects none"),
    ] {
        desk.run(words).assert_fails(2, &[part]);
    }
    assert!(desk.files().is_empty(), "{:?}", desk.files());
}

#[test]
fn where_no_grasp_exists_the_counts_say_why() {
    let desk = Desk::new();
    let far = "[start]\npose = { position = [0.0, 0.0, 0.085] }";
    let changes = [(
        far,
        "[workspace]\nlower = [1.0, 1.0, 1.0]\nupper = [1.1, 1.1, 1.1]\n\n[start]\npose = { position = \
         [0.0, 0.0, 0.085] }",
    )];
    desk.write("far.toml", built_in("sphere", &changes));
    desk.run("grasps far.toml -n 5 -o g.npz").assert_fails(3, &["0 of 5 grasps", "reach", "workspace"]);
    assert_eq!(desk.files(), ["far.toml"]);
}

#[test]
#[cfg(target_os = "linux")]
fn a_full_disk_is_told() {
    let desk = Desk::new();
    desk.run("grasps sphere -n 5 -o /dev/full")
        .assert_fails(2, &["`/dev/full` is not written: no space is left there"]);
}

#[test]
fn what_is_wrong_in_a_folder_of_objects_is_named_and_the_rest_done() {
    let desk = Desk::new();
    fs::create_dir(desk.path("parts")).unwrap();
    let octahedron = "v 0.03 0 0\nv -0.03 0 0\nv 0 0.03 0\nv 0 -0.03 0\nv 0 0 0.03\nv 0 0 -0.03\n\
                      f 1 3 5\nf 3 2 5\nf 2 4 5\nf 4 1 5\nf 3 1 6\nf 2 3 6\nf 4 2 6\nf 1 4 6\n";
    desk.write("parts/a.obj", octahedron);
    desk.write("parts/broken.stl", "no mesh");
    desk.write("parts/notes.txt", "to do");
    desk.write("parts/z.obj", octahedron);
    let said = desk.run("grasps sphere --objects parts -n 5 -o g.npz");
    said.assert_fails(2, &["2 of 4 entries", "broken.stl", "notes.txt", "it is no mesh"]);
    assert!(desk.path("g.a.npz").exists() && desk.path("g.z.npz").exists(), "{:?}", desk.files());
    desk.run("grasps sphere --objects parts -n 5 -o parts/a.obj").assert_fails(2, &["must end with"]);
}

#[test]
fn what_the_clock_stops_goes_on() {
    let desk = Desk::new();
    let words = "grasps allegro-cube -n 300 -o g.jsonl";
    let mut runs = 0;
    while desk.run(&format!("{words} --time-limit 0.3")).code == 3 {
        runs += 1;
        assert!(desk.path("g.jsonl.part").exists() && runs < 200);
    }
    assert!(!desk.path("g.jsonl.part").exists());
    assert_eq!(desk.run("grasps allegro-cube -n 300 -o whole.jsonl").code, 0);
    assert_eq!(desk.read("g.jsonl"), desk.read("whole.jsonl"));
    // Another search does not go on from this one's beginning.
    desk.run("grasps allegro-cube -n 100000 -o h.npz --time-limit 0.3")
        .assert_fails(3, &["time limit", "h.npz.part"]);
    desk.run("grasps allegro-cube -n 5 --seed 1 -o h.npz").assert_fails(2, &["begun search", "--force"]);
}
