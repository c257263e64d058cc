//! `regrasp plan`

use crate::args::PlanArgs;
use crate::grasps::kept;
use crate::outputs::{self, Kind};
use crate::progress::Line;
use crate::roadmap::Known;
use crate::terminal::{printable, remark};
use crate::watch::Watch;
use crate::{Failure, goals, inputs, overrides, plugins, report, say, say_json, view, watchdog};
use regrasp::api::{Level, Tally};
use regrasp::plan::{Plan, StoppedBy};
use regrasp::planner::Status;
use regrasp::run::{Depth, Improved, Run, RunOptions, Setup};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

pub fn run(args: &PlanArgs) -> Result<(), Failure> {
    check_outputs(args)?;
    let registry = plugins::registry(&args.choices.libraries)?;
    let mut scenario = inputs::scenario(&args.scenario, &registry)?;
    remark(&scenario.remarks);
    overrides::apply(&mut scenario, args)?;
    if let Some(name) = &args.choices.preset {
        remark(&[format!("preset `{name}` sets{}", listed(&overrides::preset_lines(name)))]);
    }
    let setup = Setup::new(&scenario, &scenario.choices, &registry).map_err(Failure::refused)?;
    let watch = Watch::start(scenario.problem.limits.budget.time_limit);
    watchdog::watch(scenario.problem.limits.budget.time_limit, &watch.heard, &setup, &registry);
    let line = Line::new();
    let (seed, threads) = (args.seed, usize::from(args.threads));
    let options = RunOptions { seed, threads, stop: &watch, clock: &watch, progress: &line };
    let mut known = args.roadmap.as_deref().map(|path| Known::read(path, &setup)).transpose()?;
    if let Some(list) = &args.goals {
        return goals::run(&goals::Job { args, setup: &setup, options: &options, list }, known.as_mut());
    }
    let ran = if let Some(depth) = depth(args) {
        audited(args, &setup, &options, depth).map(|ran| (ran, None))
    } else if let Some(extent) = args.improve {
        let improved = setup.improve(args.optimise.unwrap_or_default(), extent, &options);
        improved.map(|Improved { run, course }| (run, Some(course))).map_err(Failure::refused)
    } else if let Some(known) = &known {
        known.run(&setup, &options).map(|ran| (ran, None))
    } else {
        setup.run(&options).map(|ran| (ran, None)).map_err(Failure::refused)
    };
    line.finish();
    let (ran, course) = ran?;
    if let Some(known) = known.as_mut().filter(|_| args.roadmap_add) {
        known.learn(&setup, &options, &ran)?;
        remark(&known.keep()?);
    }
    pass_on(&ran.outcome.tally, args.log);
    let saved = save(args.output.as_deref(), &ran)?;
    if let Some(path) = &args.grasps {
        let count = kept::save(path, &scenario, &setup, &ran)?;
        remark(&[format!("{count} stable grasps are in {}", path.display())]);
    }
    let summary = report::Summary {
        scenario: &scenario,
        choices: setup.choices(),
        run: &ran,
        course: course.as_ref(),
        options: &options,
        saved: saved.as_deref(),
    };
    if args.json {
        say_json(&summary.json())?;
    } else if args.output.as_deref().is_some_and(outputs::is_standard) {
        // Standard output is the plan's.
        let _ = io::stderr().write_all(printable(&summary.text()).as_bytes());
    } else {
        say(&summary.text())?;
        if args.rejections && ran.outcome.status == Status::Solved {
            say(&report::rejections(&ran.outcome.statistics))?;
            say(&report::notes(&ran.outcome.tally))?;
        }
    }
    view::show_run(args, &setup, &ran, saved.as_deref())?;
    ending(&ran, &summary)
}

/// How deeply the run is audited, if at all: on demand, as it takes several times as long; a program built
/// for debugging looks at a share of the calls whenever plugins are loaded, which is when somebody writes
/// one.
fn depth(args: &PlanArgs) -> Option<Depth> {
    let asked = args.audit || args.audit_save.is_some();
    let unasked = cfg!(debug_assertions) && !args.choices.libraries.load.is_empty();
    if asked { Some(Depth::Full) } else { unasked.then_some(Depth::Sparse) }
}

/// A run under audit; what broke a law is kept where that was asked for.
fn audited(
    args: &PlanArgs,
    setup: &Setup<'_>,
    options: &RunOptions<'_>,
    depth: Depth,
) -> Result<Run, Failure> {
    let (ran, case) = setup.run_audited(options, depth);
    let saved = match (&args.audit_save, case) {
        (Some(path), Some(case)) => {
            let text = format!("{:#}\n", case.file);
            regrasp::plan::write_file(path, |out| out.write_all(text.as_bytes()))
                .map_err(Failure::refused)?;
            format!("; the call is kept in {}", path.display())
        }
        _ => String::new(),
    };
    ran.map_err(|error| Failure::bad_input(format!("{error}{saved}")))
}

/// The lines of a list, one below the other.
fn listed(lines: &[String]) -> String {
    match lines.is_empty() {
        true => " nothing".into(),
        false => lines.iter().map(|line| format!("\n  {line}")).collect(),
    }
}

/// Prints on standard error what plugins said, up to a level.
fn pass_on(tally: &Tally, most: Level) {
    for message in tally.messages().iter().filter(|message| message.level <= most) {
        let line = format!("{} ({}): {}", message.level.name(), message.slot.name(), message.text);
        // A reader of standard error that has gone away is no failure.
        let _ = writeln!(io::stderr(), "{}", printable(&line));
    }
}

/// Refuses what could not be written, or would destroy something, before any work is done.
fn check_outputs(args: &PlanArgs) -> Result<(), Failure> {
    let standard = args.output.as_deref().is_some_and(outputs::is_standard);
    if standard && args.json {
        return Err(Failure::bad_input(
            "`-o -` and `--json` both want standard output; name a file with `-o`",
        ));
    }
    kept::check(args.grasps.as_deref())?;
    let mut inputs = inputs::of_scenario(&args.scenario);
    inputs.extend(args.choices.libraries.load.iter().chain(&args.roadmap).chain(&args.goals).cloned());
    if args.goals.is_some() {
        return goals::check(args, &inputs);
    }
    let plan = args.output.as_deref().filter(|_| !standard);
    let others = plan.map(|path| [beside(path, "partial"), beside(path, "rejected")]).into_iter().flatten();
    let page = plan.filter(|_| args.view || args.view_graph).map(|path| path.with_extension("html"));
    let (others, page): (Vec<PathBuf>, Option<PathBuf>) = (others.collect(), page);
    let mut wished: Vec<(&Path, Kind)> = Vec::new();
    wished.extend(plan.map(|path| (path, Kind::Plan)));
    wished.extend(others.iter().map(|path| (path.as_path(), Kind::Plan)));
    wished.extend(args.grasps.as_deref().map(|path| (path, Kind::Grasps)));
    wished.extend(page.as_deref().map(|path| (path, Kind::Page)));
    wished.extend(args.audit_save.as_deref().map(|path| (path, Kind::Case)));
    outputs::check(&inputs, &wished, args.overwrite)
}

/// Writes the plan: under the wished name only if it is complete and verified.
fn save(output: Option<&Path>, run: &Run) -> Result<Option<PathBuf>, Failure> {
    let (Some(wished), Some(plan)) = (output, &run.plan) else { return Ok(None) };
    let path = match (run.outcome.status, run.is_verified()) {
        (Status::Solved, true) if outputs::is_standard(wished) => {
            let mut out = crate::output::standard();
            regrasp::plan::write_json(plan, &mut out).map_err(Failure::bad_input)?;
            return Ok(None);
        }
        _ if outputs::is_standard(wished) => return Ok(None),
        (Status::Solved, true) => wished.to_owned(),
        (_, true) => beside(wished, "partial"),
        (_, false) => beside(wished, "rejected"),
    };
    write(&path, plan)?;
    Ok(Some(path))
}

fn write(path: &Path, plan: &Plan) -> Result<(), Failure> {
    regrasp::plan::write(path, plan).map_err(Failure::refused)
}

/// `plan.json` becomes `plan.partial.json`.
fn beside(path: &Path, word: &str) -> PathBuf {
    match path.extension() {
        Some(extension) => path.with_extension(format!("{word}.{}", extension.to_string_lossy())),
        None => path.with_extension(word),
    }
}

/// What the exit code says.
fn ending(run: &Run, summary: &report::Summary<'_>) -> Result<(), Failure> {
    if run.plan.is_some() && !run.is_verified() {
        return Err(Failure::not_verified(summary.why_not_verified()));
    }
    match (run.outcome.status, run.stopped_by) {
        (Status::Solved, _) => Ok(()),
        (_, Some(StoppedBy::Interrupt)) => Err(Failure::interrupted(summary.why_no_plan())),
        _ => Err(Failure::no_plan(summary.why_no_plan())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn plans_that_are_not_what_was_wished_get_another_name() {
        assert_eq!(beside(Path::new("a/plan.json"), "partial"), Path::new("a/plan.partial.json"));
        assert_eq!(beside(Path::new("plan"), "rejected"), Path::new("plan.rejected"));
    }
}
