//! `regrasp suite`

mod args;
mod files;
mod progress;
mod replayed;

use crate::table::Table;
use crate::watch::Watch;
use crate::{Failure, outputs, say};
pub use args::SuiteArgs;
use files::Files;
use progress::Bar;
use regrasp::host::Registry;
use regrasp::plan::{Plan, StoppedBy};
use regrasp::run::Stop;
use regrasp::suite::{
    Options, Outcome, PROTOCOLS, Protocol, Trial, journal, json, load, markdown, problems, rows,
    run as run_all, scenarios,
};
use std::ops::ControlFlow;
use std::sync::Mutex;

pub fn run(args: &SuiteArgs) -> Result<(), Failure> {
    let (Some(name), Some(folder)) = (&args.protocol, &args.output) else { return list(args) };
    outputs::check_folder(folder)?;
    let (protocol, sources) = load(name).map_err(Failure::refused)?;
    let files = Files::new(folder, args)?;
    let registry = Registry::linked().map_err(Failure::refused)?;
    let scenarios = scenarios(&protocol, &sources, &registry).map_err(Failure::refused)?;
    let opened = journal(files.part(), &protocol, &scenarios, &way(args), args.work.overwrite.force);
    let (part, known) = opened.map_err(Failure::refused)?;
    let watch = Watch::start(args.work.time_limit);
    let all = protocol.series.iter().map(|series| problems(series).len()).sum();
    let bar = Bar::new(all, known.len());
    let state = Mutex::new((part, None));
    let told = |trial: &Trial, plans: &[Plan]| {
        bar.done();
        let Ok(mut state) = state.lock() else { return ControlFlow::Break(()) };
        let (part, failed) = &mut *state;
        let plans_kept = if args.keep_plans { files.keep(&protocol, trial, plans) } else { Ok(()) };
        match plans_kept.and_then(|()| part.append(trial).map_err(Failure::refused)) {
            Ok(()) => ControlFlow::Continue(()),
            Err(failure) => {
                failed.get_or_insert(failure);
                ControlFlow::Break(())
            }
        }
    };
    let options = Options {
        threads: usize::from(args.work.threads),
        stop: &watch,
        clock: &watch,
        judge: replayed::judge(args),
        told: &told,
    };
    let trials = run_all(&protocol, &scenarios, &registry, known, &options);
    bar.finish();
    let trials = trials.map_err(Failure::refused)?;
    if let Ok((_, Some(failure))) = state.into_inner() {
        return Err(failure);
    }
    let outcomes = outcomes(&protocol, &trials);
    let is_whole = trials.len() == all;
    if is_whole {
        files.write(&json(&protocol, &outcomes, &trials), &markdown(name, &protocol, &outcomes))?;
    }
    match args.work.json {
        true => say(&json(&protocol, &outcomes, &trials))?,
        false => say(&text(name, &protocol, &outcomes))?,
    }
    match is_whole {
        true if args.work.json => Ok(()),
        true => say(&format!("\nlike for like, and what is chosen: {}\n", files.summary().display())),
        false => Err(ending(&watch, (trials.len(), all), &files)),
    }
}

/// How trials are run, which those of one journal share.
fn way(args: &SuiteArgs) -> String {
    let yes_or_no = |is: bool| if is { "yes" } else { "no" };
    format!("replayed: {}, plans kept: {}", yes_or_no(!args.no_replay), yes_or_no(args.keep_plans))
}

/// What the exit code says of a run that was stopped.
fn ending(watch: &Watch, (done, all): (usize, usize), files: &Files) -> Failure {
    let kept = format!(
        "{done} of {all} trials have ended, above is what came of them, and {} keeps them: the same command \
         goes on from there",
        files.part().display()
    );
    match watch.cause() {
        StoppedBy::Interrupt => Failure::interrupted(format!("interrupted: {kept}")),
        _ => Failure::no_plan(format!("time limit: {kept}")),
    }
}

/// What came of each series.
fn outcomes(protocol: &Protocol, trials: &[Trial]) -> Vec<Outcome> {
    let of = |(number, series)| {
        let own: Vec<&Trial> = trials.iter().filter(|trial| trial.series == number).collect();
        Outcome::of(series, &own)
    };
    protocol.series.iter().enumerate().map(of).collect()
}

fn text(name: &str, protocol: &Protocol, outcomes: &[Outcome]) -> String {
    let mut text = format!("{name}: {}\n{}\n\n", protocol.title, protocol.paper);
    let rows = rows(protocol, outcomes);
    for figures in rows[1..].chunk_by(|a, b| a[0] == b[0]) {
        let [series, .., model, simulation] = &figures[0];
        let mut table = Table::new("<", &[series.as_str()]);
        for [_, published, method, world, ..] in figures {
            table.row(["published".into(), format!("{published} ({method}; {world})")]);
        }
        table.row(["in the model".into(), model.clone()]);
        table.row(["in simulation".into(), simulation.clone()]);
        text += &table.text();
    }
    text
}

/// The protocols that are built in.
fn list(args: &SuiteArgs) -> Result<(), Failure> {
    if let Some(name) = &args.protocol {
        load(name).map_err(Failure::refused)?;
        return Err(Failure::bad_input("`-o DIR` is missing: the results need a folder"));
    }
    let mut table = Table::new("<", &["protocol", "what it asks"]);
    for built_in in PROTOCOLS {
        let (protocol, _) = load(built_in.name).map_err(Failure::refused)?;
        table.row([built_in.name.to_owned(), protocol.title]);
    }
    say(&table.text())
}
