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
use regrasp::api::Interrupt;
use regrasp::host::Registry;
use regrasp::plan::Plan;
use regrasp::suite::{
    Options, Outcome, PROTOCOLS, Protocol, Trial, json, load, markdown, problems, rows, run as run_all,
};
use std::sync::Mutex;

pub fn run(args: &SuiteArgs) -> Result<(), Failure> {
    let (Some(name), Some(folder)) = (&args.protocol, &args.output) else { return list(args) };
    outputs::check_folder(folder)?;
    let (protocol, sources) = load(name).map_err(Failure::refused)?;
    let files = Files::new(folder, args)?;
    let registry = Registry::linked().map_err(Failure::refused)?;
    let watch = Watch::start(args.work.time_limit);
    let bar = Bar::new(protocol.series.iter().map(|series| problems(series).len()).sum());
    let failed = Mutex::new(None);
    let told = |trial: &Trial, plans: &[Plan]| {
        bar.done();
        if args.keep_plans
            && let Err(failure) = files.keep(&protocol, trial, plans)
            && let Ok(mut failed) = failed.lock()
        {
            failed.get_or_insert(failure);
        }
    };
    let options = Options {
        threads: usize::from(args.work.threads),
        stop: &watch,
        clock: &watch,
        judge: replayed::judge(args),
        told: &told,
    };
    let trials = run_all(&protocol, &sources, &registry, &options);
    bar.finish();
    let trials = trials.map_err(Failure::refused)?;
    if let Some(failure) = failed.into_inner().unwrap_or_default() {
        return Err(failure);
    }
    if watch.interrupted() {
        return Err(Failure::interrupted(format!(
            "interrupted after {} trials: nothing is written, since a part would be a share of other \
             problems",
            trials.len()
        )));
    }
    let outcomes = outcomes(&protocol, &trials);
    files.write(&json(&protocol, &outcomes, &trials), &markdown(name, &protocol, &outcomes))?;
    match args.work.json {
        true => say(&json(&protocol, &outcomes, &trials)),
        false => say(&text(name, &protocol, &outcomes, &files)),
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

fn text(name: &str, protocol: &Protocol, outcomes: &[Outcome], files: &Files) -> String {
    let mut text = format!("{name}: {}\n{}\n\n", protocol.title, protocol.paper);
    for row in rows(protocol, outcomes).iter().skip(1) {
        let [series, published, method, world, model, simulation] = row;
        let mut table = Table::new("<", &[series.as_str()]);
        table.row(["published".into(), format!("{published} ({method}; {world})")]);
        table.row(["in the model".into(), model.clone()]);
        table.row(["in simulation".into(), simulation.clone()]);
        text += &table.text();
    }
    text + &format!("\nlike for like, and what is chosen: {}\n", files.summary().display())
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
