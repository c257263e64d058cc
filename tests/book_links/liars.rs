//! Small books with one fault each.

use crate::commands::{Help, faults as command_faults};
use crate::outputs::faults as output_faults;
use crate::scenarios::faults as scenario_faults;
use crate::tree::Tree;
use std::fs;
use std::path::Path;

/// A book without a fault: each file with its text.
const GOOD: &[(&str, &str)] = &[
    ("README.md", "# Project\n\n[the book](book/src/one.md#first-steps)\n"),
    ("code.rs", "// ANCHOR: shown\nfn shown() {}\n// ANCHOR_END: shown\n"),
    ("book/src/SUMMARY.md", "# Summary\n\n- [One](one.md)\n- [Two](deep/two.md)\n"),
    (
        "book/src/one.md",
        "# One\n\n## First steps\n\n## First steps\n\n[two](deep/two.md#the---option-of-plan-x) \
         [again](#first-steps-1) \
         [by hand](deep/two.md#by-hand) [by name](deep/two.md#second)\n\n```\n$ regrasp plan ball --seed 7 \
         -o x.json && regrasp verify x.json\n```\n\n\
         <!-- output of: regrasp verify x && regrasp plan ball -->\n```text\nball: solved\n  planning   5 \
         ms\n  ...\n  plan       2 transfers\n```\n",
    ),
    (
        "book/src/deep/two.md",
        "# Two {#second}\n\n## The `--option` of plan (x)\n\n<a \
         id=\"by-hand\"></a>\n\n![ball](../ball.svg)\n\n\
         <!-- listing: ../../../code.rs:shown -->\n```rust\nfn shown() {}\n```\n\n\
         <!-- listing: ../../../code.rs:1:2 -->\n```rust\nfn shown() {}\n```\n\n\
         ```\n$ regrasp plan ball \\\n      --set a.b=-1 --seed=3 > log   # no --such \
         option\n```\n\n[out](https://example.org/x#y)\n\n\
         ```toml\n[object]\nfriction = 0.5\nshape = { kind = \"cuboid\", size = [0.04, 0.04, 0.04] }\n```\n\n\
         ```toml\n[hand]\nurdf = \"mine.urdf\"\n```\n",
    ),
    ("book/src/ball.svg", "<svg/>"),
];

fn help() -> Help {
    let options = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect();
    let plan = ("plan".into(), options(&["-o", "--output", "--seed", "--set"]));
    Help([plan, ("verify".into(), options(&[]))].into())
}

/// What a program might print.
fn printed(words: &[&str]) -> String {
    match words {
        ["plan", name] => {
            format!("{name}: solved\n  planning   3 ms\n  graph      7 nodes\n  plan       2 transfers\n")
        }
        _ => "what else?".into(),
    }
}

/// What is wrong with the good book after `change` was made to it.
fn faults(change: impl FnOnce(&Path)) -> Vec<String> {
    let folder = tempfile::tempdir().unwrap();
    for (file, text) in GOOD {
        let path = folder.path().join(file);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }
    change(folder.path());
    let tree = Tree::read(folder.path(), &["README.md"]);
    let mut faults = tree.faults();
    faults.extend(command_faults(&tree, &help()));
    faults.extend(scenario_faults(&tree));
    faults.extend(output_faults(&tree, &|words: &[&str], _: &Path| printed(words)));
    faults
}

/// The one fault of the good book with `from` replaced in a file.
fn liar(file: &str, from: &str, to: &str) -> String {
    let found = faults(|root| {
        let path = root.join(file);
        let text = fs::read_to_string(&path).unwrap();
        assert!(text.contains(from), "{file} has no {from}");
        fs::write(path, text.replacen(from, to, 1)).unwrap();
    });
    assert_eq!(found.len(), 1, "{found:?}");
    found.into_iter().next().unwrap()
}

#[test]
fn the_good_book_has_no_fault() {
    assert_eq!(faults(|_| ()), Vec::<String>::new());
}

#[test]
fn links_and_anchors_that_lead_nowhere_are_found() {
    assert_eq!(
        liar("README.md", "one.md", "none.md"),
        "README.md:3: `book/src/none.md#first-steps`: there is no book/src/none.md"
    );
    assert!(liar("README.md", "#first-steps", "#last-steps").ends_with("has no heading `last-steps`"));
    assert!(liar("book/src/one.md", "#first-steps-1", "#first-steps-2").contains("one.md:7: "));
    assert!(liar("book/src/one.md", "#the---option", "#the-option").contains("has no heading"));
    assert!(
        liar("book/src/one.md", "[again](#first-steps-1)", "<a href=\"gone.html\">x</a>")
            .contains("gone.html")
    );
    assert!(
        liar("book/src/deep/two.md", "id=\"by-hand\"", "id=\"by-foot\"").contains("has no heading `by-hand`")
    );
}

#[test]
fn links_out_of_the_book_or_the_project_are_found() {
    assert!(
        liar("book/src/one.md", "#first-steps-1", "../../README.md")
            .ends_with("leads out of the book, which is published alone")
    );
    assert!(
        liar("README.md", "book/src/one.md#first-steps", "../x.md").ends_with("leads out of the project")
    );
}

#[test]
fn included_code_that_is_not_there_is_found() {
    assert!(
        liar("book/src/deep/two.md", "code.rs:shown", "core.rs:shown").ends_with("there is no such file")
    );
    assert!(liar("book/src/deep/two.md", "code.rs:shown", "code.rs:hidden").contains("no `ANCHOR: hidden`"));
    assert!(liar("code.rs", "// ANCHOR_END: shown", "").contains("no `ANCHOR: shown` with its end"));
    let (link, include) = ("[out](https", "{{#include ../../../code.rs:shown}}\n\n[out](https");
    assert!(liar("book/src/deep/two.md", link, include).contains("mdBook alone"));
}

#[test]
fn a_listing_that_is_not_its_file_is_found() {
    let shown = "code.rs:shown -->\n```rust\nfn shown() {}";
    let other = shown.replace("shown() {}", "other() {}");
    assert!(liar("book/src/deep/two.md", shown, &other).contains("is listed as it was"));
}

#[test]
fn pages_that_are_forgotten_or_named_twice_are_found() {
    assert_eq!(
        liar("book/src/SUMMARY.md", "- [Two](deep/two.md)\n", ""),
        "book/src/deep/two.md: not in SUMMARY.md"
    );
    assert_eq!(
        liar("book/src/SUMMARY.md", "- [Two]", "- [One](one.md)\n- [Two]"),
        "book/src/one.md: twice in SUMMARY.md"
    );
}

#[test]
fn a_first_page_in_a_folder_is_found() {
    let moved = "- [Two](deep/two.md)\n- [One](one.md)\n";
    let fault = liar("book/src/SUMMARY.md", "- [One](one.md)\n- [Two](deep/two.md)\n", moved);
    assert_eq!(fault, "deep/two.md: the first page must lie beside SUMMARY.md");
}

#[test]
fn pictures_that_are_missing_or_not_used_are_found() {
    assert_eq!(
        faults(|root| fs::write(root.join("book/src/cube.svg"), "").unwrap()),
        ["book/src/cube.svg: no page uses it"]
    );
    let found = faults(|root| fs::remove_file(root.join("book/src/ball.svg")).unwrap());
    assert_eq!(found, ["book/src/deep/two.md:7: `../ball.svg`: there is no book/src/ball.svg"]);
}

#[test]
fn commands_and_options_that_do_not_exist_are_found() {
    assert!(
        liar("book/src/one.md", "regrasp plan", "regrasp plane").ends_with("there is no subcommand `plane`")
    );
    assert!(liar("book/src/one.md", "--seed", "--speed").ends_with("it has no option `--speed`"));
    assert!(liar("book/src/one.md", "verify x.json", "verify --seed 1 x.json").contains("`regrasp verify"));
    assert!(liar("book/src/deep/two.md", "--set", "--sett").ends_with("it has no option `--sett`"));
}

#[test]
fn pieces_of_scenarios_that_are_none_are_found() {
    assert!(liar("book/src/deep/two.md", "friction = 0.5", "friction : 0.5").contains("not TOML"));
    assert!(
        liar("book/src/deep/two.md", "friction = 0.5", "fricton = 0.5").contains("did you mean `friction`")
    );
    assert!(liar("book/src/deep/two.md", "friction = 0.5", "friction = -0.5").contains("outside"));
}

#[test]
fn outputs_that_the_program_does_not_print_are_found() {
    let fault = liar("book/src/one.md", "2 transfers", "3 transfers");
    assert!(fault.ends_with("does not print here:   plan       3 transfers"), "{fault}");
    assert!(
        liar(
            "book/src/one.md",
            "ball: solved\n  planning",
            "  planning   5 ms\n  graph      8 nodes\n  planning"
        )
        .contains("8 nodes")
    );
    // The right lines in the wrong order.
    assert!(
        liar(
            "book/src/one.md",
            "  ...\n  plan       2 transfers",
            "  plan       2 transfers\n  graph      7 nodes"
        )
        .contains("7 nodes")
    );
}
