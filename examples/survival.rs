//! Plans of many random problems with their margins, and in which worlds each arrives: the data of the book's
//! study "Which margin tells?".
//!
//! `cargo run --release --example survival OUT.csv [SECONDS [PER_SERIES [THREADS [PLANS]]]]`
//!
//! The problems are those of `studies/survival`, taken in turn from all series. Rows that the table has
//! already are kept; after SECONDS nothing new is begun. Every sixteenth plan is written to the folder PLANS,
//! for the replay in MuJoCo.

use regrasp::Stopwatch;
use regrasp::api::{Configuration, FingerIndex, Interrupt, Slot};
use regrasp::host::Registry;
use regrasp::physics::{ReplaySettings, SimulationSettings, Stage, replay};
use regrasp::plan::{Motion, Plan, SegmentKind, motion};
use regrasp::run::scenario::Scenario;
use regrasp::run::{RunError, Setup};
use regrasp::suite::{Options, Problems, Protocol, Trial, load, run, scenarios};
use std::error::Error;
use std::fmt::Write as _;
use std::fs::{self, File, OpenOptions};
use std::io::Write;
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::Mutex;
use std::time::Duration;

/// Shares of the planned friction, and multiples of the planned mass.
const WORLDS: [(f64, f64); 6] = [(1.0, 1.0), (0.8, 1.0), (0.6, 1.0), (1.0, 2.0), (0.8, 2.0), (0.6, 2.0)];
/// The tests whose margins are taken at states.
const TESTS: [&str; 2] = ["wrench-ball", "equilibrium"];
/// At most so many states of a transfer are asked for their margins, its ends among them.
const STATES: usize = 5;
const HEAD: &str = "series,problem,solved,regrasps,segments,duration_s,closure,wrench_ball,equilibrium,\
                    friction,effort,f1m1,f08m1,f06m1,f1m2,f08m2,f06m2";

fn main() -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let path = words.first().ok_or("the table's name is missing")?;
    let number = |k: usize, otherwise: f64| words.get(k).map_or(Ok(otherwise), |word| word.parse::<f64>());
    let (seconds, most, threads) = (number(1, 1e9)?, number(2, 340.0)?, number(3, 1.0)?);
    let plans = words.get(4).map(PathBuf::from);
    let registry = Registry::linked()?;
    let (protocol, files) = load(concat!(env!("CARGO_MANIFEST_DIR"), "/studies/survival"))?;
    let scenarios = scenarios(&protocol, &files, &registry)?;
    let job = Job::new(&protocol, &scenarios, &registry, plans)?;
    let (table, mut known) = open(path, &protocol)?;
    let (table, watch) = (Mutex::new(table), Stopwatch::limited(Duration::from_secs_f64(seconds)));
    let told = |trial: &Trial, plans: &[Plan]| {
        let row = job.row(trial, plans.first()).map_err(|error| error.to_string());
        let mut table = table.lock().expect("nobody panics with the table");
        match row.and_then(|row| writeln!(table, "{row}").map_err(|error| error.to_string())) {
            Ok(()) => ControlFlow::Continue(()),
            Err(error) => {
                eprintln!("{error}");
                ControlFlow::Break(())
            }
        }
    };
    let options =
        Options { threads: threads as usize, stop: &watch, clock: &watch, judge: None, told: &told };
    let mut asked = protocol.clone();
    // Block by block, so that all series have as many problems whenever it ends.
    for count in (10..=most as usize).step_by(10) {
        for series in &mut asked.series {
            if let Problems::Random { count: here, .. } = &mut series.problems {
                *here = count;
            }
        }
        known = run(&asked, &scenarios, &registry, known, &options)?;
        if watch.interrupted() {
            break;
        }
    }
    Ok(())
}

/// The table, and the trials that are in it.
fn open(path: &str, protocol: &Protocol) -> Result<(File, Vec<Trial>), Box<dyn Error>> {
    let text = fs::read_to_string(path).unwrap_or_default();
    let mut known = Vec::new();
    for row in text.lines().skip(1) {
        let mut cells = row.split(',');
        let (name, problem) = (cells.next().unwrap_or_default(), cells.next().unwrap_or_default());
        let series = protocol.series.iter().position(|series| series.name == name);
        let series = series.ok_or_else(|| format!("{path}: no series `{name}`"))?;
        known.push(Trial { series, problem: problem.parse()?, attempts: Vec::new() });
    }
    let mut table = OpenOptions::new().create(true).append(true).open(path)?;
    if text.is_empty() {
        writeln!(table, "{HEAD}")?;
    }
    Ok((table, known))
}

struct Job<'a> {
    protocol: &'a Protocol,
    /// For each series the problem with each of [`TESTS`].
    judges: Vec<[Setup<'a>; 2]>,
    plans: Option<PathBuf>,
}

impl<'a> Job<'a> {
    fn new(
        protocol: &'a Protocol,
        scenarios: &'a [Scenario],
        registry: &Registry,
        plans: Option<PathBuf>,
    ) -> Result<Self, RunError> {
        let judge = |scenario: &'a Scenario, test: &str| {
            let mut choices = scenario.choices.clone();
            choices.use_plugin(Slot::StabilityTest, test);
            Setup::new(scenario, &choices, registry)
        };
        let both = |scenario| Ok([judge(scenario, TESTS[0])?, judge(scenario, TESTS[1])?]);
        Ok(Self { protocol, judges: scenarios.iter().map(both).collect::<Result<_, RunError>>()?, plans })
    }

    /// The row of a trial.
    fn row(&self, trial: &Trial, plan: Option<&Plan>) -> Result<String, Box<dyn Error>> {
        let mut row = format!("{},{}", self.protocol.series[trial.series].name, trial.problem);
        let (Some(plan), Some(attempt)) = (plan, trial.attempts.first().filter(|a| a.solved)) else {
            return Ok(row + ",0" + &",".repeat(14));
        };
        if let Some(folder) = self.plans.as_ref().filter(|_| trial.problem.is_multiple_of(16)) {
            fs::create_dir_all(folder)?;
            let name = row.replace([' ', ','], "-");
            regrasp::plan::write(&folder.join(format!("{name}.json")), plan)?;
        }
        let motion = motion(plan)?;
        let certificate = plan.certificate.as_ref().ok_or("a plan without certificate")?;
        let holds = certificate.holds.as_ref();
        let duration = motion.segments.iter().filter_map(|segment| segment.times.last()).copied();
        let figures = [
            certificate.closure_margin.as_ref().map(|margin| margin.value),
            Some(self.margin(&self.judges[trial.series][0], &motion)?),
            Some(self.margin(&self.judges[trial.series][1], &motion)?),
            holds.map(|holds| holds.friction.value),
            holds.and_then(|holds| holds.effort.as_ref()).map(|effort| effort.value),
        ];
        write!(row, ",1,{},{},{:.2}", attempt.regrasps, motion.segments.len(), duration.fold(0.0, f64::max))?;
        for figure in figures {
            row += &figure.map_or(",".into(), |figure| format!(",{figure:.4}"));
        }
        for world in WORLDS {
            row += if arrives(plan, &motion, world)? { ",1" } else { ",0" };
        }
        Ok(row)
    }

    /// The least margin over states of the motion, of the fingers that hold.
    fn margin(&self, judge: &Setup<'_>, motion: &Motion) -> Result<f64, RunError> {
        let mut least = f64::INFINITY;
        for segment in &motion.segments {
            let last = segment.states.len() - 1;
            let (moving, count) = match segment.kind {
                SegmentKind::Transfer => (None, STATES.min(last + 1)),
                // The object rests, and so do the fingers that hold it.
                SegmentKind::Regrasp(finger) => (Some(finger), 1),
            };
            for k in 0..count {
                let state = &segment.states[k * last / (count - 1).max(1)];
                least = least.min(judge.margin(&without(state, moving))?);
            }
        }
        Ok(least)
    }
}

/// The configuration in which the moving finger does not touch.
fn without(q: &Configuration, moving: Option<FingerIndex>) -> Configuration {
    let mut q = q.clone();
    if let Some(finger) = moving {
        q.contacts[finger] = None;
    }
    q
}

/// Whether the object arrives in rapier, the forces and everything else as planned.
fn arrives(plan: &Plan, motion: &Motion, (friction, mass): (f64, f64)) -> Result<bool, Box<dyn Error>> {
    let problem = &plan.scenario.problem;
    let simulation = SimulationSettings {
        friction: Some(problem.object.friction * friction),
        mass: Some(problem.object.mass * mass),
        ..SimulationSettings::default()
    };
    let stages = motion.segments.iter().map(|segment| Stage {
        states: &segment.states,
        times: &segment.times,
        moving: match segment.kind {
            SegmentKind::Transfer => None,
            SegmentKind::Regrasp(finger) => Some(finger),
        },
        forces: &segment.forces,
    });
    let settings = ReplaySettings { simulation, ..ReplaySettings::default() };
    Ok(replay(problem, &stages.collect::<Vec<_>>(), &settings)?.arrived)
}
