//! `regrasp grasps`

mod args;
pub mod kept;
mod objects;
mod output;
mod progress;
mod report;

use crate::outputs::{self, Kind};
use crate::watch::Watch;
use crate::{Failure, inputs, overrides, plugins};
pub use args::GraspsArgs;
use output::Output;
use progress::Bar;
use regrasp::grasps::{Ending, GraspSource, Journal, Search, Stopped, Wish, collect};
use regrasp::host::Registry;
use regrasp::plan::StoppedBy;
use regrasp::run::scenario::{self, Scenario};
use regrasp::run::{Setup, Stop};
use report::Report;
use std::path::{Path, PathBuf};

pub fn run(args: &GraspsArgs) -> Result<(), Failure> {
    let output = Output::new(&args.output)?;
    let mut inputs = inputs::of_scenario(&args.scenario);
    inputs.extend(args.choices.libraries.load.iter().cloned());
    let registry = plugins::registry(&args.choices.libraries)?;
    let watch = Watch::start(args.work.time_limit);
    let job = Job { args, registry: &registry, watch: &watch, inputs };
    match &args.objects {
        None => job.one(&output, None),
        Some(folder) => objects::each(&job, folder, &output),
    }
}

/// What all objects share.
struct Job<'a> {
    args: &'a GraspsArgs,
    registry: &'a Registry,
    watch: &'a Watch,
    inputs: Vec<PathBuf>,
}

impl Job<'_> {
    /// The grasps of one object: the scenario's, or a mesh in its place.
    fn one(&self, output: &Output, mesh: Option<&Path>) -> Result<(), Failure> {
        let mut inputs = self.inputs.clone();
        inputs.extend(mesh.map(Path::to_owned));
        self.guard(&inputs, output)?;
        let scenario = self.scenario(mesh)?;
        let setup =
            Setup::without_ends(&scenario, &scenario.choices, self.registry).map_err(Failure::refused)?;
        let source = GraspSource::new(&setup, &self.wish()).map_err(Failure::refused)?;
        let began = std::time::Instant::now();
        let (ending, journal, resumed) = self.search(&source, output)?;
        let report = Report {
            scenario: &scenario,
            source: &source,
            ending: &ending,
            seconds: began.elapsed().as_secs_f64(),
            threads: self.args.work.threads,
            resumed,
        };
        let written = self.save(output, &report, journal)?;
        report.tell(self.args.work.json, written.as_deref())?;
        self.ending(&report, output, written.as_deref())
    }

    /// Refuses what would destroy something, before anything is computed.
    fn guard(&self, inputs: &[PathBuf], output: &Output) -> Result<(), Failure> {
        let (partial, part) = (output.partial(), output.journal());
        let wished: [(&Path, Kind); 3] =
            [(output.path(), Kind::Grasps), (&partial, Kind::Grasps), (&part, Kind::BegunGrasps)];
        let count = if output.is_special() { 1 } else { wished.len() };
        outputs::check(inputs, &wished[..count], self.args.work.overwrite)
    }

    fn scenario(&self, mesh: Option<&Path>) -> Result<Scenario, Failure> {
        let found = scenario::load_for_grasps(&self.args.scenario, mesh, self.registry);
        let mut scenario = found.map_err(Failure::refused)?;
        overrides::apply_choices(&mut scenario.choices, &self.args.choices)?;
        if let Some(stem) = mesh.and_then(Path::file_stem) {
            scenario.problem.object.name = stem.to_string_lossy().into_owned();
        }
        Ok(scenario)
    }

    fn wish(&self) -> Wish {
        let args = self.args;
        Wish {
            count: args.count,
            seed: args.seed,
            spread: args.spread,
            per_pose: args.per_pose,
            per_facets: args.per_facet,
            fingers: args.fingers,
            graph: args.graph,
        }
    }

    /// Searches on from where an earlier run was killed; how many grasps there were already.
    fn search(&self, source: &GraspSource<'_>, output: &Output) -> Result<(Ending, Journal, u64), Failure> {
        let identity = output::identity(source);
        let path = output.journal();
        let opened = Journal::open(&path, &identity, source.layout(), self.args.work.overwrite.force);
        let mut journal = opened.map_err(Failure::refused)?;
        let mut search = Search::new(source);
        journal.resume(&mut search).map_err(Failure::refused)?;
        let resumed = search.grasps();
        let bar = Bar::new(self.args.count as u64, resumed);
        let found = collect(&mut search, usize::from(self.args.work.threads), self.watch, &bar, &mut journal);
        bar.finish();
        Ok((found.map_err(Failure::refused)?, journal, resumed))
    }

    /// Writes what was found: under the wished name only if it is all that was asked for.
    fn save(
        &self,
        output: &Output,
        report: &Report<'_>,
        journal: Journal,
    ) -> Result<Option<PathBuf>, Failure> {
        let (ending, mut path) = (report.ending, output.path().to_owned());
        if ending.stopped != Stopped::Enough {
            path = output.partial();
        }
        let written = match ending.grasps {
            0 => Ok(None),
            _ => output.write(&path, report, &journal, self.args.work.overwrite).map(|()| Some(path)),
        };
        // What was stopped from outside may go on; where nothing could be written, nothing is lost.
        let is_over = written.is_ok() && !matches!(ending.stopped, Stopped::By(_));
        if output.is_special() || is_over {
            journal.delete().map_err(Failure::refused)?;
        }
        written
    }

    /// What the exit code says.
    fn ending(&self, report: &Report<'_>, output: &Output, written: Option<&Path>) -> Result<(), Failure> {
        let kept = written.map_or(String::new(), |path| format!("; they are in {}", path.display()));
        let found = format!("{} of {} grasps{kept}", report.ending.grasps, self.args.count);
        let again = format!("the same command goes on from {}", output.journal().display());
        match report.ending.stopped {
            Stopped::Enough => Ok(()),
            Stopped::Exhausted => Err(Failure::no_plan(report.why_no_more(&found))),
            Stopped::By(StoppedBy::Interrupt) => {
                Err(Failure::interrupted(format!("interrupted: {found}; {again}")))
            }
            Stopped::By(_) => Err(Failure::no_plan(format!("time limit: {found}; {again}"))),
        }
    }

    /// Whether no more objects are to be begun.
    fn is_stopped(&self) -> bool {
        regrasp::api::Interrupt::interrupted(self.watch)
    }

    fn cause(&self) -> StoppedBy {
        self.watch.cause()
    }
}
