//! `regrasp view`, and the page that `regrasp plan --view` opens.

pub mod open;
mod pages;
mod replay;

pub use pages::PageArgs;

use crate::args::PlanArgs;
use crate::outputs::{self, Kind, OverwriteArgs};
use crate::{Failure, say};
use regrasp::page;
use regrasp::plan::Plan;
use regrasp::run::{Run, Setup};
use regrasp::view::{Extras, Shown, ViewError};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Write a page that plays a plan, or several in step, in a browser.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
The page is one file that needs no network: hand, object and obstacles in 3-D, contacts, forces, friction \
cones and rolled traces, every segment; closure margin, clearance, friction needed, efforts and speeds over \
time; and what the verifier says. Press ? in it for its keys. \
Several plans share one page: overlaid, side by side or one alone, in step by time or by the share of the \
motion that is done.\n\n\
Examples:\n  regrasp view plan.json\n  regrasp view a.json b.json -o both.html\n  \
regrasp replay plan.json -o replay.json; regrasp view plan.json \
--replay replay.json -o motion.html")]
pub struct ViewArgs {
    /// Plan files; the first gives the page its name.
    #[arg(required = true, value_name = "PLAN")]
    pub plans: Vec<PathBuf>,
    /// Write the page to this file, `-` for standard output; by default the first plan's name with `.html`.
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    #[command(flatten)]
    pub overwrite: OverwriteArgs,
    /// Show beside the first plan where a simulation took the object: a file of `regrasp replay PLAN -o
    /// FILE`.
    #[arg(long, value_name = "FILE")]
    pub replay: Option<PathBuf>,
}

/// More plans than this nobody tells apart.
const MOST_PLANS: usize = 6;

pub fn run(args: &ViewArgs) -> Result<(), Failure> {
    let [first, others @ ..] = &args.plans[..] else {
        return Err(Failure::bad_input("name a plan file"));
    };
    if others.len() >= MOST_PLANS {
        let count = args.plans.len();
        return Err(Failure::bad_input(format!("{count} plans in one page; 1 to {MOST_PLANS} can be shown")));
    }
    let output = args.output.clone().unwrap_or_else(|| first.with_extension("html"));
    let inputs: Vec<PathBuf> = args.plans.iter().chain(&args.replay).cloned().collect();
    outputs::check(&inputs, &[(&output, Kind::Page)], args.overwrite)?;
    let mut read = args.plans.iter().map(|path| known(path)).collect::<Result<Vec<_>, _>>()?;
    if let Some(path) = &args.replay {
        let replay = replay::read(path, &read[0].0)?;
        read[0].1.replay = Some(replay);
    }
    let labels = labels(&args.plans);
    let named = read.iter().zip(&labels);
    let all: Vec<Shown<'_>> = named.map(|((plan, extras), label)| Shown { plan, extras, label }).collect();
    let page = regrasp::view::page_beside(all[0], &all[1..]).map_err(|reason| refused(&reason, first))?;
    put(&page, &output).map_err(Failure::bad_input)?;
    if outputs::is_standard(&output) {
        return Ok(());
    }
    say(&format!("{}: {:.1} MB; open it in a browser\n", output.display(), page.len() as f64 / 1e6))
}

fn refused(reason: &ViewError, first: &Path) -> Failure {
    match reason {
        ViewError::Beside { .. } => Failure::bad_input(reason),
        _ => Failure::bad_input(format!("`{}` cannot be shown: {reason}", first.display())),
    }
}

/// A plan and what the verifier knows of it.
fn known(path: &Path) -> Result<(Plan, Extras), Failure> {
    let plan = regrasp::plan::read(path).map_err(Failure::refused)?;
    let extras = page::of_plan(&plan);
    Ok((plan, extras))
}

/// What tells the plans apart: their files' names, whole paths where these are the same.
fn labels(paths: &[PathBuf]) -> Vec<String> {
    let short = |path: &PathBuf| path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let names: Vec<String> = paths.iter().map(short).collect();
    let alone = |name: &String| names.iter().filter(|other| *other == name).count() == 1;
    let named = paths.iter().zip(&names);
    named.map(|(path, name)| if alone(name) { name.clone() } else { path.display().to_string() }).collect()
}

/// Writes a page.
fn put(page: &str, output: &Path) -> Result<(), String> {
    if outputs::is_standard(output) {
        return crate::output::standard().write_all(page.as_bytes()).map_err(|error| error.to_string());
    }
    let put = |writer: &mut dyn Write| writer.write_all(page.as_bytes());
    regrasp::plan::write_file(output, put).map_err(|error| error.to_string())
}

/// What `plan --view` and `--view-graph` do after a run: a page beside the plan file, else in a folder for
/// temporary files, opened where there is a browser. Where it is goes to standard error: standard output is
/// the report's.
pub fn show_run(args: &PlanArgs, setup: &Setup<'_>, run: &Run, saved: Option<&Path>) -> Result<(), Failure> {
    if !(args.view || args.view_graph) {
        return Ok(());
    }
    let plan = match &run.plan {
        Some(plan) => plan.clone(),
        None if args.view_graph => setup
            .plan_file(&setup.scenario().problem, &run.outcome, args.seed, run.stopped_by)
            .map_err(Failure::refused)?,
        None => return tell("there is no motion to show; `--view-graph` shows what was tried"),
    };
    let mut extras = page::of_plan(&plan);
    if args.view_graph {
        extras.graph = Some(page::graph(&run.outcome.graph, setup.hand()));
    }
    let output = match saved {
        Some(path) => path.with_extension("html"),
        None => open::temporary_folder().map_err(Failure::bad_input)?.join("plan.html"),
    };
    let page = regrasp::view::page(&plan, &extras).map_err(Failure::bad_input)?;
    put(&page, &output).map_err(Failure::bad_input)?;
    let shown = if open::in_browser(&output) { "the page is opened" } else { "open the page in a browser" };
    tell(&format!("{shown}: {}", output.display()))
}

fn tell(text: &str) -> Result<(), Failure> {
    // A reader of standard error that has gone away is no failure.
    let _ = writeln!(io::stderr(), "{text}");
    Ok(())
}
