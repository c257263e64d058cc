//! A scenario with its plan.

use regrasp::api::{Configuration, Contact, Pose, Vec3};
use regrasp::plan::Segment;
use regrasp::planner::GraphRecord;
use regrasp::run::scenario::Scenario;
use regrasp::run::{Run, Setup};
use regrasp::view::picture::{Picture, Scene};
use regrasp::world::ChainHand;
use std::error::Error;

/// A solved scenario.
pub struct Example<'a> {
    pub setup: Setup<'a>,
    pub run: Run,
}

impl<'a> Example<'a> {
    /// Plans with this seed.
    pub fn solve(scenario: &'a Scenario, seed: u64) -> Result<Self, Box<dyn Error>> {
        let setup = regrasp::setup(scenario)?;
        let run = setup.run(&regrasp::Stopwatch::start().options(seed))?;
        match run.why_not_solved() {
            Some(why) => Err(format!("`{}`: {why}", scenario.name).into()),
            None => Ok(Self { setup, run }),
        }
    }

    /// The hand with its links.
    pub fn hand(&self) -> &'a ChainHand {
        self.setup.scenario().hand.as_ref()
    }

    /// Hand, object and obstacles at a configuration.
    pub fn picture(&self, q: &Configuration) -> Picture {
        let scenario = self.setup.scenario();
        let scene =
            Scene { hand: self.hand(), mesh: &scenario.object.mesh, obstacles: &scenario.problem.obstacle };
        Picture::of(&scene, q)
    }

    /// The manipulation graph.
    pub fn graph(&self) -> &GraphRecord {
        &self.run.outcome.graph
    }

    /// The segments of the plan.
    pub fn segments(&self) -> &[Segment] {
        &self.run.outcome.motion.segments
    }

    /// All states in turn with their times (s).
    pub fn states(&self) -> Vec<(&Configuration, f64)> {
        let segments = self.segments().iter();
        segments.flat_map(|segment| segment.states.iter().zip(segment.times.iter().copied())).collect()
    }
}

/// Where a contact is in the hand's frame, the object being at `X_HO`: point (m) and outward normal.
pub fn in_hand(X_HO: &Pose, contact: &Contact) -> (Vec3, Vec3) {
    (X_HO.rotation * contact.p_OC + X_HO.translation.vector, X_HO.rotation * contact.n_O)
}
