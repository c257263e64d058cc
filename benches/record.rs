//! A record of speed to set beside another: every built-in scenario with many seeds, planning, verification
//! and whole processes, and how near planning is to the least that it could cost.
//!
//! `cargo bench --bench record -- [--seeds N] [-o FILE] [SCENARIO…]` prints a table and writes JSON;
//! `tests/outside/bench_compare.py OLD NEW` sets two records side by side. Leave the machine alone meanwhile.

use regrasp::Stopwatch;
use regrasp::api::{Context, FingerSet, Hint, Random, Uninterrupted};
use regrasp::plan::{Plan, configuration};
use regrasp::planner::Status;
use regrasp::run::Setup;
use regrasp::run::scenario::SCENARIOS;
use serde_json::{Map, Value, json};
use std::error::Error;
use std::process::{Command, Stdio};
use std::time::Instant;

/// What is measured with each seed, in seconds.
const MEASURES: [&str; 4] = ["planning_s", "verification_s", "process_s", "floor_s"];

struct Arguments {
    seeds: u64,
    output: String,
    scenarios: Vec<String>,
}

impl Arguments {
    fn read() -> Result<Self, Box<dyn Error>> {
        let mut read = Self { seeds: 20, output: "target/record.json".into(), scenarios: Vec::new() };
        let mut words = std::env::args().skip(1);
        while let Some(word) = words.next() {
            match word.as_str() {
                // Cargo's own.
                "--bench" => {}
                "--seeds" => read.seeds = words.next().ok_or("`--seeds` wants a number")?.parse()?,
                "-o" => read.output = words.next().ok_or("`-o` wants a file")?,
                _ => read.scenarios.push(word),
            }
        }
        if read.scenarios.is_empty() {
            read.scenarios = SCENARIOS.iter().map(|file| file.name.to_owned()).collect();
        }
        Ok(read)
    }
}

/// The least that any planner pays that finds this plan: each of its states asked once whether it is free of
/// collisions and stable.
fn floor(setup: &Setup<'_>, plan: &Plan) -> Result<f64, Box<dyn Error>> {
    let states = plan.segments.iter().flat_map(|segment| &segment.states);
    let states = states.map(configuration).collect::<Result<Vec<_>, _>>()?;
    let task = setup.task();
    let mut context = Context::new(Random::from_key(0, 0, 0, 0), &Uninterrupted);
    let all = FingerSet::first(task.hand.finger_count());
    let begin = Instant::now();
    let mut hint = Hint::default();
    for q in &states {
        std::hint::black_box(task.clearance.configuration_free(q, all, true).is_ok());
        let grasp = task.grasp(q, q.holding());
        std::hint::black_box(task.stability.test(&grasp, &mut hint, &mut context)?.is_stable());
    }
    Ok(begin.elapsed().as_secs_f64())
}

/// Wall time of a fresh process that reads, plans, verifies and writes.
fn process(scenario: &str, seed: u64) -> Result<f64, Box<dyn Error>> {
    let (folder, seed) = (std::env::temp_dir(), seed.to_string());
    let file = folder.join(format!("regrasp-record-{}.json", std::process::id()));
    let begin = Instant::now();
    let status = Command::new(env!("CARGO_BIN_EXE_regrasp"))
        .args(["plan", scenario, "--seed", &seed, "--force", "-o"])
        .arg(&file)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status()?;
    let seconds = begin.elapsed().as_secs_f64();
    std::fs::remove_file(&file)?;
    if status.success() { Ok(seconds) } else { Err(format!("{scenario}, seed {seed}: {status}").into()) }
}

/// The figures of one scenario: a list of seconds for each measure, and the seeds that were not solved.
fn scenario(name: &str, seeds: u64) -> Result<Value, Box<dyn Error>> {
    let scenario = regrasp::load(name)?;
    let setup = regrasp::setup(&scenario)?;
    let mut figures: [Vec<f64>; MEASURES.len()] = Default::default();
    let mut unsolved = Vec::new();
    for seed in 0..seeds {
        let run = setup.run(&Stopwatch::start().options(seed))?;
        let (Status::Solved, true, Some(plan)) = (run.outcome.status, run.is_verified(), &run.plan) else {
            unsolved.push(seed);
            continue;
        };
        let seconds = [run.planning_s, run.verification_s, process(name, seed)?, floor(&setup, plan)?];
        figures.iter_mut().zip(seconds).for_each(|(all, one)| all.push(one));
    }
    let mut entry = Map::new();
    entry.insert("unsolved".into(), json!(unsolved));
    MEASURES.iter().zip(figures).for_each(|(name, all)| drop(entry.insert((*name).into(), json!(all))));
    Ok(entry.into())
}

/// A quantile of the seconds, in ms.
fn ms(seconds: &Value, q: f64) -> String {
    let mut all: Vec<f64> = seconds.as_array().into_iter().flatten().filter_map(Value::as_f64).collect();
    all.sort_by(f64::total_cmp);
    let place = (q * all.len().saturating_sub(1) as f64).round() as usize;
    all.get(place).map_or("-".into(), |s| format!("{:.1}", 1e3 * s))
}

fn row(name: &str, entry: &Value) -> String {
    let [planning, verification, process, floor] = MEASURES.map(|measure| &entry[measure]);
    format!(
        "{name:<24}{:>9}{:>9}{:>9}{:>10}{:>10}{:>10}{:>10}",
        ms(planning, 0.5),
        ms(planning, 0.9),
        ms(planning, 1.0),
        ms(verification, 0.5),
        ms(process, 0.5),
        ms(floor, 0.5),
        entry["unsolved"].as_array().map_or(0, Vec::len),
    )
}

/// The first line that a program prints; nothing where it is not there.
fn said(program: &str, words: &[&str]) -> Option<String> {
    let out = Command::new(program).args(words).output().ok().filter(|out| out.status.success())?;
    Some(String::from_utf8_lossy(&out.stdout).lines().next()?.to_owned())
}

/// Where and of what the record is.
fn origin() -> Value {
    let cpuinfo = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = cpuinfo.lines().find_map(|line| line.strip_prefix("model name")?.split_once(": "));
    json!({
        "processor": model.map(|(_, model)| model.trim()),
        "cores": std::thread::available_parallelism().ok().map(|n| n.get()),
        "compiler": said("rustc", &["--version"]),
        "commit": said("git", &["rev-parse", "HEAD"]),
        "changed": said("git", &["status", "--porcelain", "--untracked-files=no"]).is_some(),
        "regrasp": env!("CARGO_PKG_VERSION"),
    })
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments = Arguments::read()?;
    println!(
        "{:<24}{:>9}{:>9}{:>9}{:>10}{:>10}{:>10}{:>10}",
        "ms", "planning", "90 %", "worst", "verifying", "process", "floor", "unsolved"
    );
    let mut scenarios = Map::new();
    for name in &arguments.scenarios {
        let entry = scenario(name, arguments.seeds)?;
        println!("{}", row(name, &entry));
        scenarios.insert(name.clone(), entry);
    }
    let record = json!({
        "format": "regrasp-record",
        "version": 1,
        "seeds": arguments.seeds,
        "origin": origin(),
        "scenarios": scenarios,
    });
    let text = serde_json::to_string_pretty(&record)? + "\n";
    regrasp::plan::write_file(arguments.output.as_ref(), |out| out.write_all(text.as_bytes()))?;
    println!("\nwritten to {}", arguments.output);
    Ok(())
}
