//! The roadmap that `plan` plans through.

use crate::Failure;
use regrasp::planner::roadmap::{Roadmap, RoadmapGraph, Through, learn};
use regrasp::planner::{Request, Status, solve_through};
use regrasp::roadmap::{Identity, RoadmapError, load, save};
use regrasp::run::{Run, RunOptions, Setup};
use std::path::{Path, PathBuf};

/// A roadmap, and the file that it is from.
pub struct Known {
    path: PathBuf,
    roadmap: Roadmap,
    identity: Identity,
    /// What a turn by one radian counts (m).
    turn_length: f64,
    /// Nodes that were added.
    added: usize,
}

impl Known {
    /// Reads a roadmap; refuses one of another problem.
    pub fn read(path: &Path, setup: &Setup<'_>) -> Result<Self, Failure> {
        let (roadmap, identity) = load(path).map_err(Failure::refused)?;
        let here = Identity::of(setup, roadmap.seed());
        if let Some(difference) = here.difference(&identity) {
            return Err(Failure::refused(RoadmapError::Other { path: path.to_owned(), difference }));
        }
        let turn_length = setup.scenario().object.mesh.radius();
        Ok(Self { path: path.to_owned(), roadmap, identity, turn_length, added: 0 })
    }

    /// Made ready for plans.
    pub fn graph(&self) -> RoadmapGraph<'_> {
        RoadmapGraph::new(&self.roadmap, self.roadmap.node_count(), self.turn_length)
    }

    /// Plans and verifies the scenario: through the roadmap, and without it where it knows no way.
    pub fn run(&self, setup: &Setup<'_>, options: &RunOptions<'_>) -> Result<Run, Failure> {
        let graph = self.graph();
        let through = Through { graph: &graph, alone: false };
        setup
            .run_by(&|request: &Request<'_>| solve_through(request, through), options)
            .map_err(Failure::refused)
    }

    /// Adds the grasps of a plan that was found without the roadmap.
    pub fn learn(&mut self, setup: &Setup<'_>, options: &RunOptions<'_>, run: &Run) -> Result<(), Failure> {
        if run.outcome.status == Status::Solved && run.is_verified() && !is_by_roadmap(run) {
            let motion = &run.outcome.motion;
            let added = setup.ask(options, |request| learn(request, &mut self.roadmap, motion));
            self.added += added.map_err(Failure::refused)?;
        }
        Ok(())
    }

    /// Writes the roadmap if something was added to it; what there is to tell of it.
    pub fn keep(&mut self) -> Result<Vec<String>, Failure> {
        if self.added == 0 {
            return Ok(Vec::new());
        }
        save(&self.path, &self.roadmap, &self.identity).map_err(Failure::refused)?;
        let told = format!("{} grasps were added to {}", self.added, self.path.display());
        Ok(vec![told])
    }
}

/// Whether nothing but the roadmap was asked for a plan: other phases did not occur.
pub fn is_by_roadmap(run: &Run) -> bool {
    let phases = &run.outcome.statistics.time_s;
    phases.contains_key("roadmap") && !phases.contains_key("relay") && !phases.contains_key("search")
}
