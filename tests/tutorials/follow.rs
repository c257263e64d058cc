//! What a reader does: `regrasp new-plugin`, the chapter's code in the place of the template's, build, load,
//! plan.

use crate::TUTORIALS;
use crate::workshop::{edited, regrasp};
use std::fs;
use std::path::{Path, PathBuf};

/// The chapter's crate, in the form in which a reader has it.
fn followed(role: &str, name: &str) -> PathBuf {
    let book = Path::new(env!("CARGO_MANIFEST_DIR")).join("book/tutorials").join(format!("{name}-{role}"));
    let in_folder = |folder: &str| {
        let entries = fs::read_dir(book.join(folder)).expect("the crate has sources and tests");
        let files = entries.map(|entry| entry.expect("an entry").path());
        files.map(|file| (file.strip_prefix(&book).expect("it was found there").to_owned(), file)).collect()
    };
    let files: [Vec<(PathBuf, PathBuf)>; 2] = ["src", "tests"].map(in_folder);
    edited(role, name, &files.concat())
}

#[test]
fn every_tutorial_builds_out_of_the_tree_loads_and_plans() {
    for (role, name, slot) in TUTORIALS {
        let library = followed(role, name);
        let library = library.to_str().expect("the target folder is UTF-8");
        let choice = format!("{slot}={name}");
        let planned = regrasp(&["plan", "sphere", "--load", library, "--use", &choice, "--json"]);
        assert_eq!(planned.code, Some(0), "{role}: {}", planned.err);
        let planned: serde_json::Value = serde_json::from_str(&planned.out).expect("JSON");
        assert_eq!((&planned["status"], &planned["verified"]), (&"solved".into(), &true.into()));
        assert!(planned["plugins"].to_string().contains(&format!("{role}/{name}")), "{}", planned["plugins"]);
    }
}

#[test]
fn wrong_settings_are_refused_in_the_words_of_the_chapter() {
    let library = followed("contact-model", "greasy");
    let library = library.to_str().expect("the target folder is UTF-8");
    let chapter = include_str!("../../book/src/tutorials/contact-model.md");
    for setting in ["contact-model.factor=2", "contact-model.fctor=0.5", "contact-model.side=[0,0,0]"] {
        let choice = ["--use", "contact-model=greasy", "--set", setting];
        let said = regrasp(&[["plan", "cubic", "--load", library].as_slice(), &choice].concat());
        let shown = chapter.lines().skip_while(|line| !line.ends_with(setting)).nth(1);
        assert_eq!((said.code, said.err.lines().next()), (Some(2), shown), "{setting}");
    }
}
