//! `regrasp view`, and the page that `regrasp plan --view` opens.

pub mod open;
mod replay;

use crate::args::PlanArgs;
use crate::outputs::{self, Kind, OverwriteArgs};
use crate::{Failure, say};
use regrasp::page;
use regrasp::plan::Plan;
use regrasp::run::{Run, Setup};
use regrasp::view::Extras;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Write a page that plays a plan in a browser.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
The page is one file that needs no network: hand, object and obstacles in 3-D, contacts, friction cones and \
rolled traces, every segment, closure \
margin and clearance over time, and what the verifier says. Press ? in it for its keys.\n\n\
Examples:\n  regrasp view plan.json\n  regrasp replay plan.json -o replay.json; regrasp view plan.json \
--replay replay.json -o motion.html")]
pub struct ViewArgs {
    /// A plan file.
    pub plan: PathBuf,
    /// Write the page to this file, `-` for standard output; by default the plan's name with `.html`.
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    #[command(flatten)]
    pub overwrite: OverwriteArgs,
    /// Show beside it where a simulation took the object: a file of `regrasp replay PLAN -o FILE`.
    #[arg(long, value_name = "FILE")]
    pub replay: Option<PathBuf>,
}

pub fn run(args: &ViewArgs) -> Result<(), Failure> {
    let output = args.output.clone().unwrap_or_else(|| args.plan.with_extension("html"));
    let inputs: Vec<PathBuf> = [&args.plan].into_iter().chain(&args.replay).cloned().collect();
    outputs::check(&inputs, &[(&output, Kind::Page)], args.overwrite)?;
    let plan = regrasp::plan::read(&args.plan).map_err(Failure::refused)?;
    let replay = args.replay.as_deref().map(|path| replay::read(path, &plan)).transpose()?;
    let extras = Extras { replay, ..page::of_plan(&plan) };
    let bytes = write_page(&plan, &extras, &output).map_err(|reason| {
        Failure::bad_input(format!("`{}` cannot be shown: {reason}", args.plan.display()))
    })?;
    if outputs::is_standard(&output) {
        return Ok(());
    }
    say(&format!("{}: {:.1} MB; open it in a browser\n", output.display(), bytes as f64 / 1e6))
}

/// Writes the page and says how many bytes it has.
fn write_page(plan: &Plan, extras: &Extras, output: &Path) -> Result<usize, String> {
    let page = regrasp::view::page(plan, extras).map_err(|error| error.to_string())?;
    if outputs::is_standard(output) {
        crate::output::standard().write_all(page.as_bytes()).map_err(|error| error.to_string())?;
        return Ok(page.len());
    }
    let put = |writer: &mut dyn Write| writer.write_all(page.as_bytes());
    regrasp::plan::write_file(output, put).map_err(|error| error.to_string())?;
    Ok(page.len())
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
    write_page(&plan, &extras, &output).map_err(Failure::bad_input)?;
    let shown = if open::in_browser(&output) { "the page is opened" } else { "open the page in a browser" };
    tell(&format!("{shown}: {}", output.display()))
}

fn tell(text: &str) -> Result<(), Failure> {
    // A reader of standard error that has gone away is no failure.
    let _ = writeln!(io::stderr(), "{text}");
    Ok(())
}
