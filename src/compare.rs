//! `regrasp compare`

mod args;
mod growing;
mod isolate;
mod progress;
mod surroundings;
mod table;
mod vary;

pub use args::CompareArgs;

use crate::memory;
use crate::serve::{Live, Server};
use crate::terminal::remark;
use crate::watch::Watch;
use crate::{Failure, outputs, overrides, plugins, say, say_json};
use growing::Growing;
use progress::Bar;
use regrasp::api::Interrupt;
use regrasp::host::Registry;
use regrasp::run::scenario::{self, Scenario};
use regrasp::study::compare::{
    self, Execution, Folder, Hypotheses, Level, Pairs, RUN_THREAD, RunRecord, Seeds, Study, StudyWish,
    VariantWish,
};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::{panic, thread};

pub fn run(args: &CompareArgs) -> Result<(), Failure> {
    outputs::check_folder(&args.output)?;
    if !args.merge.is_empty() {
        let study = compare::merge(&args.merge, &args.output).map_err(Failure::refused)?;
        let (_, records) = compare::read_study(&args.output).map_err(Failure::refused)?;
        return report(args, &study, &records);
    }
    if let Some(older) = &args.against {
        return beside(args, older);
    }
    let registry = plugins::registry(&args.libraries)?;
    let (scenarios, wish) = request(args, &registry)?;
    if wish.hypotheses.pairs == Pairs::All && wish.variants.len() > MOST_IN_PAIRS {
        return Err(Failure::bad_input(format!(
            "`--pairs all` compares at most {MOST_IN_PAIRS} variants, and there are {}; vary less, or \
             compare each with the first",
            wish.variants.len()
        )));
    }
    let prepared = compare::prepare(wish, &scenarios, &registry).map_err(Failure::refused)?;
    match args.only {
        Some(key) => isolate::make_one(args, &prepared, key),
        None => make(args, prepared),
    }
}

/// Sets the study in the output folder beside an older one.
fn beside(args: &CompareArgs, older: &Path) -> Result<(), Failure> {
    let against = compare::Against::of(&args.output, older).map_err(Failure::refused)?;
    against.write(&args.output).map_err(Failure::refused)?;
    if args.json {
        return say_json(&table::against(&against, &args.output, older));
    }
    let [table, text] = compare::AGAINST_FILES.map(|name| args.output.join(name));
    let (table, text) = (table.display(), text.display());
    say(&format!("{}\n  written to `{text}` and `{table}`\n", against.markdown()))
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
        memory: Some(&memory::Counted),
        interrupt: &watch,
        progress: &bar,
        audit: args.audit,
        keep_plans: args.keep_plans,
        isolate: Some(&processes),
        isolate_all: args.isolate,
    };
    let complete = match args.watch {
        true => watched(&prepared, &mut folder, &execution, &bar)?,
        false => compare::execute(&prepared, &mut folder, &execution),
    };
    bar.finish();
    let complete = complete.map_err(Failure::refused)?;
    folder.finish(&prepared.study).map_err(Failure::refused)?;
    let records = folder.records();
    if complete {
        return report(args, &prepared.study, &records);
    }
    let (there, all) = (records.len(), prepared.study.keys().len());
    if there > 0 && !args.json {
        say(&format!("Of the runs that are finished:\n{}\n", table::text(&prepared.study, &records)))?;
    }
    let kept = format!("{there} of {all} runs are kept in `{}`", args.output.display());
    match watch.interrupted() {
        true => {
            Err(Failure::interrupted(format!("interrupted: {kept}; the same command goes on from there")))
        }
        false => Err(Failure::bad_input(format!("the system starts no more threads: {kept}"))),
    }
}

/// Makes the runs while a page shows the report of those that have ended.
fn watched(
    prepared: &compare::Prepared<'_>,
    folder: &mut Folder,
    execution: &Execution<'_>,
    bar: &Bar,
) -> Result<Result<bool, compare::StudyError>, Failure> {
    let (server, live, done) = (Server::bind(0)?, Live::default(), Done::default());
    remark(&[format!("the growing report: {}", server.url())]);
    let growing = Growing::new(bar, &prepared.study, &live, folder.records());
    let complete = thread::scope(|scope| {
        scope.spawn(|| server.serve(&live, &done));
        let complete = compare::execute(prepared, folder, &Execution { progress: &growing, ..*execution });
        done.0.store(true, Ordering::Relaxed);
        complete
    });
    Ok(complete)
}

/// Set once the study is at its end.
#[derive(Default)]
struct Done(AtomicBool);

impl Interrupt for Done {
    fn interrupted(&self) -> bool {
        self.0.load(Ordering::Relaxed)
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
fn request(args: &CompareArgs, registry: &Registry) -> Result<(Vec<Scenario>, StudyWish), Failure> {
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
    let wish = StudyWish {
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
        hypotheses: hypotheses(args, asked.hypotheses),
    };
    Ok((asked.scenarios, wish))
}

/// Those of the study file, changed by the command line.
fn hypotheses(args: &CompareArgs, asked: Hypotheses) -> Hypotheses {
    Hypotheses {
        pairs: args.pairs.unwrap_or(asked.pairs),
        measures: if args.measures.is_empty() { asked.measures } else { args.measures.clone() },
        band: args.equivalence.map_or(asked.band, |percent| 1e-2 * percent),
    }
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

fn variants(args: &CompareArgs, registry: &Registry) -> Result<Vec<VariantWish>, Failure> {
    let factors = args.vary.iter().map(|text| vary::factor(text, registry));
    let factors: Vec<Vec<Level>> = factors.collect::<Result<_, _>>()?;
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

/// So many variants are five thousand pairs.
const MOST_IN_PAIRS: usize = 100;

fn report(args: &CompareArgs, study: &Study, records: &[RunRecord]) -> Result<(), Failure> {
    if args.json {
        return say_json(&table::json(study, records, &args.output));
    }
    say(&format!("{}\n  written to `{}`\n", table::text(study, records), args.output.display()))
}
