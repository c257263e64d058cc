//! `regrasp reference`: the pages of the book's reference that are made from the program itself.

mod commands;
mod examples;
mod listings;
mod markdown;
mod plugins;
mod schema;

use crate::args::{Arguments, LibraryArgs};
use crate::{Failure, say};
use clap::{Args, CommandFactory};
use regrasp::run::scenario;
use regrasp::study::compare;
use schema::{Chapter, Page};
use std::path::PathBuf;

/// Write the generated pages of the book's reference (plugins, scenario files, study files, commands), and
/// bring the listings of its other pages up to date.
#[derive(Debug, Args)]
#[command(hide = true, after_help = "Example:\n  regrasp reference book/src/reference")]
pub struct ReferenceArgs {
    /// The folder of the pages; it must exist.
    pub folder: PathBuf,
}

pub fn run(args: &ReferenceArgs) -> Result<(), Failure> {
    let registry = crate::plugins::registry(&LibraryArgs { load: Vec::new() })?;
    let pages = [
        ("plugins.md", plugins::page(&registry)?),
        ("scenario.md", scenario_page()),
        ("study.md", study_page()),
        ("commands.md", commands::page(Arguments::command())),
    ];
    let mut written: Vec<(PathBuf, String)> =
        pages.into_iter().map(|(name, text)| (args.folder.join(name), text)).collect();
    // Beside the reference lie the other pages of the book.
    if let Some(book) = args.folder.parent().filter(|book| book.join("SUMMARY.md").exists()) {
        written.extend(listings::stale(book)?);
    }
    for (path, text) in written {
        regrasp::plan::write_file(&path, |out| out.write_all(text.as_bytes())).map_err(Failure::refused)?;
        say(&format!("{}\n", path.display()))?;
    }
    Ok(())
}

/// Stands at the head of every generated page.
const GENERATED: &str = "<!-- Made by `cargo run -- reference book/src/reference`: change what it \
    describes, not this page. -->\n\n";

fn scenario_page() -> String {
    let scenarios = scenario::SCENARIOS.iter().map(|file| file.text).chain([RARE]);
    let hands = scenario::HANDS.iter().map(|file| file.text).chain([RARE]);
    Page {
        introduction: SCENARIO,
        chapters: &[
            Chapter {
                title: "Scenario files",
                name: "scenario",
                schema: parsed(&scenario::schema()),
                examples: examples::of(scenarios),
            },
            Chapter {
                title: "Hand files",
                name: "hand",
                schema: parsed(&scenario::hand_schema()),
                examples: examples::of(hands),
            },
        ],
    }
    .text()
}

/// Keys that no built-in file uses.
const RARE: &str = "\
references = [\"the maker's drawings, 2025\"]\n\
obstacle = [{ shape = { kind = \"box\", size = [0.2, 0.2, 0.01] } }, { shape = { kind = \"sphere\", radius \
= 0.02 } }]\n\
palm = [{ shape = { kind = \"box\", size = [0.08, 0.08, 0.02] } }, { shape = { kind = \"sphere\", radius = \
0.02 } }]\n";

const SCENARIO: &str = "\
# Scenario files

A scenario is a problem in a TOML or JSON file: hand, object, obstacles, start and goals, and optionally \
the plugins that solve it and the limits they \
keep. `regrasp scenarios sphere > mine.toml` writes one to start from, `regrasp schema > \
scenario.schema.json` the same rules as a JSON schema \
for editors. What is wrong with a file is refused with its line and the allowed values.

Lengths are metres, angles radians (degrees where a key ends with `_deg`), masses kilograms, forces \
newtons; poses are given in the hand's \
frame H unless the table says otherwise ([units and frames](units-and-frames.md)). Every number is finite. \
An unknown key is an error, so that \
a misspelt one is not silently ignored. A *hand file* describes a hand in the same form; its keys are \
[below](#hand-files).
";

fn study_page() -> String {
    let chapter = Chapter {
        title: "Study files",
        name: "study",
        schema: parsed(&compare::study_schema()),
        examples: examples::of(STUDIES),
    };
    Page { introduction: STUDY, chapters: &[chapter] }.text()
}

/// Studies that are kept with the program.
const STUDIES: [&str; 2] =
    [include_str!("../studies/alpha.toml"), include_str!("../studies/alpha-again.toml")];

const STUDY: &str = "\
# Study files

A study file holds what is too long for the command line of `regrasp compare`, or what is to be kept: \
`regrasp compare --study mine.toml -o \
study` makes the study, and the same command goes on with it after an interruption. It is TOML; variants \
are either every combination of the \
levels of `[[vary]]`, or listed one by one as `[[variant]]`. `regrasp schema study` prints the same rules \
as a JSON schema. Options of the \
command line win over the file.
";

fn parsed(schema: &str) -> serde_json::Value {
    serde_json::from_str(schema).expect("the schemas are JSON: they were made from JSON values")
}
