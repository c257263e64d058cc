//! `regrasp gallery`: plans side by side, as pictures, as pages that play, and in figures.

mod entry;
mod figures;
mod index;
mod picture;

use crate::numbers::whole;
use crate::outputs::{self, Kind, OverwriteArgs};
use crate::watch::Watch;
use crate::{Failure, say};
use entry::Entry;
use regrasp::host::Registry;
use regrasp::plan::write_file;
use std::fs;
use std::path::{Path, PathBuf};

/// Plan a dozen problems of different hands and objects, and show the plans side by side.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
DIR gets `index.html`, which shows all plans and leads to a page that plays each, `NAME.html`; each page is \
one file that needs no network. `README.md` shows the same on a forge: a picture of each plan, `NAME.svg`, \
its command and its figures. Every plan is verified; one that is not ends the command.\n\n\
Examples:\n  regrasp gallery -o gallery\n  regrasp gallery sphere mine.toml --seed 3 -o mine\n  \
regrasp gallery --no-pages -o book/src/gallery     # what the book shows")]
pub struct GalleryArgs {
    /// Scenario files, or names of built-in scenarios; by default twelve of these.
    #[arg(value_name = "SCENARIO")]
    pub scenarios: Vec<String>,
    /// Write to this folder.
    #[arg(short, long, value_name = "DIR")]
    pub output: PathBuf,
    /// The seed of all random streams.
    #[arg(long, default_value_t = 0, value_name = "N", allow_negative_numbers = true,
          value_parser = whole::<u64, 0, { u64::MAX }>)]
    pub seed: u64,
    /// Leave out the pages: pictures and `README.md` alone.
    #[arg(long)]
    pub no_pages: bool,
    #[command(flatten)]
    pub overwrite: OverwriteArgs,
}

/// What is shown where nothing is named: every kind of hand, of object and of motion once.
const SHOWN: [&str; 12] = [
    "cubic",
    "ellip-obst",
    "bracket",
    "ring",
    "baton",
    "rgmc-a1-60",
    "sphere-five",
    "sphere-soft",
    "cube-free",
    "free-box-ellipsoid-rolling",
    "allegro-cube",
    "three-finger-soft",
];

pub fn run(args: &GalleryArgs) -> Result<(), Failure> {
    outputs::check_folder(&args.output)?;
    let shown = SHOWN.map(str::to_owned);
    let names = if args.scenarios.is_empty() { &shown[..] } else { &args.scenarios };
    let registry = Registry::linked().map_err(Failure::refused)?;
    let watch = Watch::start(None);
    fs::create_dir_all(&args.output)
        .map_err(|error| Failure::bad_input(format!("`{}`: {error}", args.output.display())))?;
    let mut entries: Vec<Entry> = Vec::new();
    for name in names {
        let entry = Entry::plan(name, args.seed, &registry, &watch)?;
        if entries.iter().any(|other| other.name == entry.name) {
            let twice = format!("`{name}`: two scenarios have the name `{}`, and so their files", entry.name);
            return Err(Failure::bad_input(twice));
        }
        say(&format!("{}: {}\n", entry.name, entry.figures.motion()))?;
        entry.write(args)?;
        entries.push(entry);
    }
    put(args, "README.md", &index::markdown(&entries, args))?;
    if !args.no_pages {
        put(args, "index.html", &index::html(&entries))?;
    }
    let first = if args.no_pages { "README.md" } else { "index.html" };
    say(&format!("{}: {} plans\n", args.output.join(first).display(), entries.len()))
}

/// Writes a file of the gallery, unless it would replace what is none.
fn put(args: &GalleryArgs, name: &str, text: &str) -> Result<(), Failure> {
    let path = args.output.join(name);
    let kind =
        if Path::new(name).extension().is_some_and(|is| is == "html") { Kind::Page } else { Kind::Gallery };
    outputs::check(&[], &[(&path, kind)], args.overwrite)?;
    write_file(&path, |out| out.write_all(text.as_bytes())).map_err(Failure::refused)
}
