//! `regrasp serve`: a page that follows its file.

mod files;
mod http;
mod live;

pub use http::Server;
pub use live::Live;

use crate::args::ChoiceArgs;
use crate::numbers::{seconds, whole};
use crate::view::open;
use crate::watch::Watch;
use crate::{Failure, hand, inputs, overrides, plugins, say};
use clap::Args;
use files::Files;
use regrasp::Stopwatch;
use regrasp::api::Interrupt;
use regrasp::host::Registry;
use regrasp::page;
use regrasp::run::{Setup, scenario};
use std::path::PathBuf;
use std::thread;
use std::time::Duration;

/// Show a scenario or a robot's file as a live page, which plans again whenever the file, or one that it
/// names, is saved.
#[derive(Debug, Args)]
#[command(after_help = "\
The page shows the plan as `regrasp view` does, of a robot's file the hand as `regrasp hand --view` does. \
Where the file cannot be read or planned, it says so with file, line and key, over what it showed last. \
The server answers on the loopback address of this machine alone, and only to who knows the token in the \
address that it prints; Ctrl-C ends it.\n\n\
Examples:\n  regrasp serve mine.toml\n  regrasp serve my_hand.urdf")]
pub struct ServeArgs {
    /// A scenario file, the name of a built-in scenario, or a robot's file (URDF, MJCF, xacro).
    pub file: String,
    /// Seed of all random choices: the same seed gives the same plan.
    #[arg(long, default_value_t = 0, value_name = "N", allow_negative_numbers = true,
          value_parser = whole::<u64, 0, { u64::MAX }>)]
    pub seed: u64,
    #[command(flatten)]
    pub choices: ChoiceArgs,
    /// Stop each search after this many seconds, 0.001 to 1e7.
    #[arg(long, default_value_t = 60.0, value_name = "S", allow_negative_numbers = true,
          value_parser = seconds)]
    pub time_limit: f64,
    /// The port to listen on, 0 to 65535; 0 takes any that is free.
    #[arg(long, default_value_t = 0, value_name = "PORT", allow_negative_numbers = true,
          value_parser = whole::<u16, 0, 65535>)]
    pub port: u16,
    /// Print the address, and open no browser.
    #[arg(long)]
    pub no_open: bool,
}

/// Between two looks at the files.
const STEP: Duration = Duration::from_millis(100);

pub fn run(args: &ServeArgs) -> Result<(), Failure> {
    let registry = plugins::registry(&args.choices.libraries)?;
    let server = Server::bind(args.port)?;
    say(&format!("{}\n", server.url()))?;
    let (watch, live) = (Watch::start(None), Live::default());
    if !args.no_open {
        open::address_in_browser(&server.url());
    }
    thread::scope(|scope| {
        scope.spawn(|| server.serve(&live, &watch));
        follow(args, &registry, &live, &watch);
    });
    Ok(())
}

/// Makes a page now and after every change, until the program is asked to end.
fn follow(args: &ServeArgs, registry: &Registry, live: &Live, watch: &Watch) {
    let mut files = Files::default();
    while !watch.interrupted() {
        // Looked at before they are read: what is saved meanwhile is read next time.
        files.watch(watched(args));
        live.doing("planning");
        match made(args, registry, watch) {
            Ok(page) => live.show(page),
            Err(failure) => live.fail(failure.json()["error"].take()),
        }
        while !files.changed() && !watch.interrupted() {
            thread::sleep(STEP);
        }
    }
}

fn is_robot(file: &str) -> bool {
    [".urdf", ".xml", ".mjcf", ".xacro"].iter().any(|ending| file.to_ascii_lowercase().ends_with(ending))
}

/// The file and all that it names.
fn watched(args: &ServeArgs) -> Vec<PathBuf> {
    match is_robot(&args.file) {
        true => inputs::of_robot(args.file.as_ref(), &[]),
        false => inputs::of_scenario(&args.file),
    }
}

/// The page of what the file says now.
fn made(args: &ServeArgs, registry: &Registry, watch: &Watch) -> Result<String, Failure> {
    if is_robot(&args.file) {
        return hand::page_of(&args.file);
    }
    let mut scenario = scenario::load(&args.file, registry).map_err(Failure::refused)?;
    overrides::apply_preset(&mut scenario.choices, args.choices.preset.as_deref())?;
    overrides::apply_plugins(&mut scenario.choices, &args.choices.uses, &args.choices.sets)?;
    let setup = Setup::new(&scenario, &scenario.choices, registry).map_err(Failure::refused)?;
    let stopwatch = Stopwatch::limited(Duration::from_secs_f64(args.time_limit));
    let stop = Both { stopwatch, watch };
    let options = regrasp::run::RunOptions { stop: &stop, ..stopwatch.options(args.seed) };
    let run = setup.run(&options).map_err(Failure::refused)?;
    let Some(plan) = &run.plan else {
        let why = run.why_not_solved().unwrap_or_else(|| "no motion was found".into());
        return Err(Failure::no_plan(format!("{}: {why}", args.file)));
    };
    regrasp::view::page(plan, &page::of_plan(plan)).map_err(Failure::bad_input)
}

/// The time limit of one search, and the end of the program.
struct Both<'a> {
    stopwatch: Stopwatch,
    watch: &'a Watch,
}

impl Interrupt for Both<'_> {
    fn interrupted(&self) -> bool {
        self.stopwatch.interrupted() || self.watch.interrupted()
    }
}

impl regrasp::run::Stop for Both<'_> {
    fn cause(&self) -> regrasp::plan::StoppedBy {
        self.stopwatch.cause()
    }
}
