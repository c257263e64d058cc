//! `regrasp atlas`

mod args;
mod progress;
mod report;
mod sizes;

use crate::outputs::{self, Kind};
use crate::watch::Watch;
use crate::{Failure, say};
pub use args::AtlasArgs;
use progress::Bar;
use regrasp::atlas::{
    AtlasError, AtlasHand, Cell, Ended, Journal, Summary, Wish, attempts_csv, cells_csv, explore, json, page,
};
use regrasp::host::Registry;
use regrasp::plan::{StoppedBy, write_file};
use regrasp::run::Stop;
use report::text;
use std::fs;
use std::path::{Path, PathBuf};

pub fn run(args: &AtlasArgs) -> Result<(), Failure> {
    let wish = args.wish().map_err(Failure::bad_input)?;
    wish.validate().map_err(Failure::refused)?;
    let hands = hands(&args.hands)?;
    let files = Files::of(&args.output);
    files.check(args)?;
    let registry = Registry::linked().map_err(Failure::refused)?;
    let watch = Watch::start(args.work.time_limit);
    let journal =
        Journal::open(&files.journal, &wish, &hands, args.work.overwrite.force).map_err(Failure::refused)?;
    let known: Vec<usize> = journal.cells().iter().map(|cell| cell.number).collect();
    let mut bar = Bar::new(journal);
    let how = (usize::from(args.work.threads), &watch as &dyn Stop, &watch as _);
    let ended = explore(&wish, &hands, &known, &registry, how, &mut bar);
    let journal = bar.finish();
    let (ended, cells) = (ended.map_err(Failure::refused)?, journal.cells());
    let atlas = Atlas { wish: &wish, hands: &hands, summary: Summary::of(&cells), cells };
    atlas.write(&files)?;
    if args.work.json {
        say(&atlas.json())?;
    } else {
        say(&text(&atlas.cells, &atlas.summary, &files.page))?;
    }
    ending(ended, &watch, &atlas, journal.members(), &args.output)
}

/// The hands, each once.
fn hands(names: &[String]) -> Result<Vec<AtlasHand>, Failure> {
    let mut hands: Vec<AtlasHand> = Vec::new();
    for name in names {
        let hand = AtlasHand::load(name.trim()).map_err(Failure::refused)?;
        if hands.iter().any(|other| other.name == hand.name) {
            return Err(Failure::refused(AtlasError::Twice { name: hand.name }));
        }
        hands.push(hand);
    }
    Ok(hands)
}

/// What the exit code says.
fn ending(
    ended: Ended,
    watch: &Watch,
    atlas: &Atlas<'_>,
    members: usize,
    output: &Path,
) -> Result<(), Failure> {
    let done = atlas.cells.len();
    let kept = format!(
        "{done} of {members} hands and objects are in {}; the same command goes on from there",
        output.display()
    );
    match ended {
        Ended::Stopped if watch.cause() == StoppedBy::Interrupt => {
            Err(Failure::interrupted(format!("interrupted: {kept}")))
        }
        Ended::Stopped => Err(Failure::no_plan(format!("time limit: {kept}"))),
        Ended::Whole if atlas.cells.iter().all(|cell| cell.attempts.is_empty()) => {
            let cause =
                atlas.cells.iter().find_map(|cell| cell.cause.as_deref()).unwrap_or("nothing was asked");
            Err(Failure::no_plan(format!("no hand can hold any of the objects; the first: {cause}")))
        }
        Ended::Whole => Ok(()),
    }
}

/// What was found.
struct Atlas<'a> {
    wish: &'a Wish,
    hands: &'a [AtlasHand],
    cells: Vec<Cell>,
    summary: Summary,
}

impl Atlas<'_> {
    fn json(&self) -> String {
        json(self.wish, self.hands, &self.cells, &self.summary)
    }

    fn write(&self, files: &Files) -> Result<(), Failure> {
        let contents = [
            (&files.json, self.json()),
            (&files.cells, cells_csv(&self.cells, &self.summary)),
            (&files.attempts, attempts_csv(&self.cells)),
            (&files.page, page(self.wish, self.hands, &self.cells, &self.summary)),
        ];
        for (path, content) in contents {
            write_file(path, |out| out.write_all(content.as_bytes())).map_err(Failure::refused)?;
        }
        Ok(())
    }
}

/// The files of an atlas.
struct Files {
    page: PathBuf,
    json: PathBuf,
    cells: PathBuf,
    attempts: PathBuf,
    journal: PathBuf,
}

impl Files {
    fn of(folder: &Path) -> Self {
        let [page, json, cells, attempts, journal] =
            ["atlas.html", "atlas.json", "cells.csv", "attempts.csv", "atlas.part"]
                .map(|name| folder.join(name));
        Self { page, json, cells, attempts, journal }
    }

    /// Makes the folder; refuses what would destroy something.
    fn check(&self, args: &AtlasArgs) -> Result<(), Failure> {
        outputs::check_folder(&args.output)?;
        fs::create_dir_all(&args.output)
            .map_err(|error| Failure::bad_input(format!("`-o {}`: {error}", args.output.display())))?;
        let inputs: Vec<PathBuf> = args.hands.iter().map(PathBuf::from).collect();
        let all = [&self.page, &self.json, &self.cells, &self.attempts, &self.journal];
        let wished: Vec<(&Path, Kind)> = all.map(|path| (path.as_path(), Kind::Atlas)).to_vec();
        outputs::check(&inputs, &wished, args.work.overwrite)
    }
}
