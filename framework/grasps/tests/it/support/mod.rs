//! Built-in problems, and searches without ado.

#![allow(dead_code)]

use regrasp_contact_models as _;
use regrasp_graph_strategies as _;
use regrasp_local_planners as _;
use regrasp_samplers as _;
use regrasp_stability_tests as _;
use regrasp_surfaces as _;

use regrasp_grasps::{
    BulkGrasp, Edge, Ending, GraspSource, GraspsError, Kept, Progress, Search, Sink, Wish, collect,
};
use regrasp_host::Registry;
use regrasp_run::scenario::{self, Scenario};
use regrasp_run::{NeverStops, Setup};

pub struct Silent;

impl Progress for Silent {
    fn found(&self, _grasps: u64, _poses: u64) {}
}

/// Keeps everything.
#[derive(Default)]
pub struct Keeps {
    pub grasps: Vec<BulkGrasp>,
    pub edges: Vec<Edge>,
}

impl Sink for Keeps {
    fn take(&mut self, kept: &Kept) -> Result<(), GraspsError> {
        self.grasps.extend(kept.grasps.iter().cloned());
        self.edges.extend(&kept.edges);
        Ok(())
    }
}

pub fn scenario(name: &str) -> Scenario {
    scenario::load_for_grasps(name, None, &Registry::linked().unwrap()).unwrap()
}

pub fn setup(scenario: &Scenario) -> Setup<'_> {
    Setup::without_ends(scenario, &scenario.choices, &Registry::linked().unwrap()).unwrap()
}

/// Does something with the grasps of a built-in problem.
pub fn with(name: &str, wish: &Wish, job: impl FnOnce(&Setup<'_>, &GraspSource<'_>)) {
    let scenario = scenario(name);
    let setup = setup(&scenario);
    let source = GraspSource::new(&setup, wish).unwrap();
    job(&setup, &source);
}

/// All that is found, and how it ended.
pub fn found(source: &GraspSource<'_>, threads: usize) -> (Vec<BulkGrasp>, Ending) {
    let (mut search, mut grasps) = (Search::new(source), Vec::new());
    let ending = collect(&mut search, threads, &NeverStops, &Silent, &mut grasps).unwrap();
    (grasps, ending)
}
