//! `regrasp roadmap`

mod args;
mod known;
mod progress;
mod report;

use crate::outputs::{self, Kind};
use crate::watch::Watch;
use crate::{Failure, inputs, overrides, plugins};
pub use args::RoadmapArgs;
pub use known::{Known, is_by_roadmap};
use progress::Bar;
use regrasp::api::Interrupt;
use regrasp::plan::StoppedBy;
use regrasp::planner::roadmap::{Grown, Roadmap, RoadmapGraph, grow, pairs};
use regrasp::planner::{Clock, Silent};
use regrasp::roadmap::{Identity, RoadmapError, Standing, judge, load, save};
use regrasp::run::{RunOptions, Setup, Stop};
use report::Report;
use std::fs;

/// So long (s) at least what was grown is not on the disk.
const UNSAVED_S: f64 = 10.0;

pub fn run(args: &RoadmapArgs) -> Result<(), Failure> {
    let mut inputs = inputs::of_scenario(&args.scenario);
    inputs.extend(args.choices.libraries.load.iter().cloned());
    outputs::check(&inputs, &[(&args.output, Kind::Roadmap)], args.overwrite)?;
    if outputs::is_standard(&args.output) {
        return Err(Failure::bad_input("`-o -`: a roadmap needs a file; name one"));
    }
    let registry = plugins::registry(&args.choices.libraries)?;
    let mut scenario = inputs::scenario(&args.scenario, &registry)?;
    overrides::apply_choices(&mut scenario.choices, &args.choices)?;
    let setup = Setup::new(&scenario, &scenario.choices, &registry).map_err(Failure::refused)?;
    let identity = Identity::of(&setup, args.seed);
    let watch = Watch::start(args.seconds);
    let mut roadmap = begun(args, &setup, &identity)?;
    let before = roadmap.node_count();
    let job = Job { args, setup: &setup, identity: &identity, watch: &watch };
    let (ended, seconds) = job.grow(&mut roadmap)?;
    let is_interrupted = || watch.interrupted() && watch.cause() == StoppedBy::Interrupt;
    let standings = if is_interrupted() { Vec::new() } else { job.judge(&roadmap)? };
    let graph = RoadmapGraph::new(&roadmap, roadmap.node_count(), scenario.object.mesh.radius());
    let report = Report {
        args,
        scenario: &scenario.name,
        graph: &graph,
        roadmap: &roadmap,
        before,
        seconds,
        bytes: fs::metadata(&args.output).map_or(0, |found| found.len()),
        standings: &standings,
    };
    report.tell()?;
    let kept = format!("{} has {} nodes", args.output.display(), roadmap.node_count());
    match ended {
        _ if is_interrupted() => {
            Err(Failure::interrupted(format!("interrupted: {kept}; the same command goes on from there")))
        }
        Grown::Barren => Err(Failure::no_plan(format!(
            "no more grasps are found in the workspace; {kept}; widen `workspace`, or look at what \
             `regrasp plan {} --rejections` says",
            args.scenario
        ))),
        _ => Ok(()),
    }
}

/// The roadmap that is to grow: the file's, or an empty one.
fn begun(args: &RoadmapArgs, setup: &Setup<'_>, identity: &Identity) -> Result<Roadmap, Failure> {
    let is_there = fs::metadata(&args.output).is_ok_and(|found| found.is_file() && found.len() > 0);
    if !is_there || args.overwrite.force {
        return Ok(Roadmap::new(setup.hand(), args.seed));
    }
    let (roadmap, of) = load(&args.output).map_err(Failure::refused)?;
    match identity.difference_to_grow(&of) {
        None => Ok(roadmap),
        Some(difference) => {
            Err(Failure::refused(RoadmapError::Other { path: args.output.clone(), difference }))
        }
    }
}

struct Job<'a> {
    args: &'a RoadmapArgs,
    setup: &'a Setup<'a>,
    identity: &'a Identity,
    watch: &'a Watch,
}

impl Job<'_> {
    fn options<'s>(&'s self, stop: &'s dyn Stop) -> RunOptions<'s> {
        let threads = usize::from(self.args.threads);
        RunOptions { seed: self.args.seed, threads, stop, clock: self.watch, progress: &Silent }
    }

    /// Grows the roadmap and keeps it: every few seconds what there is, and all at the end. How growing
    /// ended, and how long it took (s).
    fn grow(&self, roadmap: &mut Roadmap) -> Result<(Grown, f64), Failure> {
        let (before, begin) = (roadmap.node_count(), self.watch.seconds());
        let bar = Bar::new(self.args.nodes(), before);
        let (mut saved_at, mut failed) = (begin, None);
        let mut told = |roadmap: &Roadmap| {
            bar.show(roadmap.node_count());
            if self.watch.seconds() - saved_at > UNSAVED_S {
                failed = self.save(roadmap).err();
                saved_at = self.watch.seconds();
            }
            failed.is_none()
        };
        let nodes = self.args.nodes();
        let options = self.options(self.watch);
        let ended = self.setup.ask(&options, |request| grow(request, roadmap, nodes, &mut told));
        bar.finish();
        let seconds = self.watch.seconds() - begin;
        if let Some(failure) = failed {
            return Err(failure);
        }
        let ended = ended.map_err(Failure::refused)?;
        if roadmap.node_count() > before {
            self.save(roadmap)?;
        }
        Ok((ended, seconds))
    }

    fn save(&self, roadmap: &Roadmap) -> Result<(), Failure> {
        save(&self.args.output, roadmap, self.identity).map_err(Failure::refused)
    }

    /// How the roadmap does, and how it did with fewer nodes; nothing where that was not asked for.
    fn judge(&self, roadmap: &Roadmap) -> Result<Vec<Standing>, Failure> {
        let Some(count) = self.args.report else { return Ok(Vec::new()) };
        let watch = Watch::start(None);
        let options = RunOptions { threads: 1, ..self.options(&watch) };
        let pairs = self.setup.ask(&options, |request| pairs(request, count)).map_err(Failure::refused)?;
        let mut standings = Vec::new();
        for nodes in report::sizes(roadmap.node_count()) {
            if watch.interrupted() {
                break;
            }
            let standing = judge(self.setup, (roadmap, nodes), &pairs, &options).map_err(Failure::refused)?;
            // A row that was cut short would be a share of other pairs.
            if standing.attempts.len() == pairs.len() {
                standings.push(standing);
            }
        }
        Ok(standings)
    }
}
