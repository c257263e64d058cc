//! `regrasp compare`

mod args;
mod isolate;
mod progress;
mod surroundings;
mod table;
mod vary;

pub use args::CompareArgs;

use crate::watch::Watch;
use crate::{Failure, outputs, overrides, plugins, say, say_json};
use progress::Bar;
use regrasp::api::Interrupt;
use regrasp::host::Registry;
use regrasp::run::scenario::{self, Scenario};
use regrasp::study::compare::{
    self, Change, Draft, Execution, Folder, RUN_THREAD, RunRecord, Seeds, Study, VariantDraft,
};
use std::{panic, thread};

pub fn run(args: &CompareArgs) -> Result<(), Failure> {
    outputs::check_folder(&args.output)?;
    if !args.merge.is_empty() {
        let study = compare::merge(&args.merge, &args.output).map_err(Failure::refused)?;
        let (_, records) = compare::read_study(&args.output).map_err(Failure::refused)?;
        return report(args, &study, &records);
    }
    let registry = plugins::registry(&args.libraries)?;
    let (scenarios, draft) = request(args, &registry)?;
    let prepared = compare::prepare(draft, &scenarios, &registry).map_err(Failure::refused)?;
    match args.only {
        Some(key) => isolate::make_one(args, &prepared, key),
        None => make(args, prepared),
    }
}

/// Makes what is missing of the study, writes its results, and reports.
fn make(args: &CompareArgs, mut prepared: compare::Prepared<'_>) -> Result<(), Failure> {
    let mut folder = Folder::open(&args.output, &mut prepared.study).map_err(Failure::refused)?;
    hush_runs();
    let (watch, bar) = (Watch::start(None), Bar::new());
    let threads = threads(args);
    let processes = isolate::Processes::new(&watch);
    let execution = Execution {
        threads,
        clock: &watch,
        cancel: &watch,
        progress: &bar,
        audit: args.audit,
        keep_plans: args.keep_plans,
        isolate: Some(&processes),
        isolate_all: args.isolate,
    };
    let complete = compare::execute(&prepared, &mut folder, &execution);
    bar.finish();
    let complete = complete.map_err(Failure::refused)?;
    folder.finish(&prepared.study).map_err(Failure::refused)?;
    let records = folder.records();
    if complete {
        return report(args, &prepared.study, &records);
    }
    let (there, all) = (records.len(), prepared.study.keys().len());
    let kept = format!("{there} of {all} runs are kept in `{}`", args.output.display());
    match watch.interrupted() {
        true => {
            Err(Failure::interrupted(format!("interrupted: {kept}; the same command goes on from there")))
        }
        false => Err(Failure::bad_input(format!("the system starts no more threads: {kept}"))),
    }
}

fn threads(args: &CompareArgs) -> usize {
    args.threads.map_or_else(surroundings::cores, usize::from)
}

/// Keeps the messages of panics in runs off the terminal: they become rows of the study.
fn hush_runs() {
    let usual = panic::take_hook();
    panic::set_hook(Box::new(move |info| {
        if thread::current().name() != Some(RUN_THREAD) {
            usual(info);
        }
    }));
}

/// What is asked for: the scenarios with the changes for all variants made, and the study of them.
fn request(args: &CompareArgs, registry: &Registry) -> Result<(Vec<Scenario>, Draft), Failure> {
    let mut asked = match &args.study {
        Some(path) => compare::load_study(path, registry).map_err(Failure::refused)?,
        None => compare::StudyRequest {
            scenarios: scenarios(args, registry)?,
            variants: variants(args, registry)?,
            ..Default::default()
        },
    };
    for scenario in &mut asked.scenarios {
        overrides::apply_preset(&mut scenario.choices, args.preset.as_deref())?;
        overrides::apply_plugins(&mut scenario.choices, &args.uses, &args.sets)?;
        overrides::limit_nodes(scenario, args.max_nodes.or(asked.max_nodes));
    }
    let draft = Draft {
        command: args.command(),
        versions: surroundings::versions(&args.libraries.load)?,
        machine: surroundings::machine(threads(args)),
        started_s: surroundings::now_s(),
        shard: args.shard,
        variants: asked.variants,
        seeds: Seeds {
            first: args.first_seed.or(asked.first_seed).unwrap_or(0),
            count: args.seeds.or(asked.seeds).unwrap_or(compare::DEFAULT_SEEDS),
        },
        time_limit_s: args.time_limit.or(asked.time_limit_s),
        skip_unsupported: args.skip_unsupported,
    };
    Ok((asked.scenarios, draft))
}

fn scenarios(args: &CompareArgs, registry: &Registry) -> Result<Vec<Scenario>, Failure> {
    let suite = args.suite.map(compare::Suite::scenarios).unwrap_or_default();
    let names = suite.into_iter().chain(args.scenarios.iter().map(String::as_str));
    let scenarios = names.map(|name| scenario::load(name, registry).map_err(Failure::refused));
    let scenarios: Vec<Scenario> = scenarios.collect::<Result<_, _>>()?;
    match scenarios.is_empty() {
        true => Err(Failure::bad_input(
            "nothing to plan: name scenarios, such as `regrasp compare sphere cubic …`, or give `--suite` \
             or `--study`",
        )),
        false => Ok(scenarios),
    }
}

fn variants(args: &CompareArgs, registry: &Registry) -> Result<Vec<VariantDraft>, Failure> {
    let factors = args.vary.iter().map(|text| vary::factor(text, registry));
    let factors: Vec<Vec<Change>> = factors.collect::<Result<_, _>>()?;
    let count = factors.iter().try_fold(1usize, |count, factor| count.checked_mul(factor.len()));
    match count {
        Some(count) if count <= MOST_VARIANTS => Ok(compare::factorial(&factors)),
        _ => Err(Failure::bad_input(format!(
            "there are more than {MOST_VARIANTS} combinations to compare; vary less at once"
        ))),
    }
}

/// More would not fit into memory, nor would anybody read them.
const MOST_VARIANTS: usize = 1000;

fn report(args: &CompareArgs, study: &Study, records: &[RunRecord]) -> Result<(), Failure> {
    if args.json {
        return say_json(&table::json(study, records, &args.output));
    }
    say(&format!("{}\n  written to `{}`\n", table::text(study, records), args.output.display()))
}
