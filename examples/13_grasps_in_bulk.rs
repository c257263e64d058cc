//! Finds many distinct, verified grasps of a cube by a hand like the Allegro hand, and says how they are.
//!
//! `cargo run --release --example 13_grasps_in_bulk`
//!
//! `regrasp grasps` does the same and writes files. Here the grasps stay in memory: anything that takes them
//! chunk by chunk is a `Sink`, a vector for one.

use regrasp::Stopwatch;
use regrasp::grasps::{BulkGrasp, GraspSource, Progress, Search, Wish, collect};
use regrasp::host::Registry;
use regrasp::run::{Setup, scenario};
use std::collections::BTreeMap;
use std::error::Error;

/// Nobody watches.
struct Silent;

impl Progress for Silent {
    fn found(&self, _grasps: u64, _poses: u64) {}
}

fn main() -> Result<(), Box<dyn Error>> {
    let registry = Registry::linked()?;
    // Start and goals do not count.
    let scenario = scenario::load_for_grasps("allegro-cube", None, &registry)?;
    let setup = Setup::without_ends(&scenario, &scenario.choices, &registry)?;
    let wish = Wish { count: 400, spread: 0.003, ..Wish::default() };
    let source = GraspSource::new(&setup, &wish)?;

    let (mut search, mut grasps) = (Search::new(&source), Vec::new());
    let ending = collect(&mut search, 2, &Stopwatch::start(), &Silent, &mut grasps)?;
    println!("{} grasps after {} poses of the cube", grasps.len(), ending.counts.poses);

    println!("fingers  grasps  of which a finger may be lifted  median friction needed");
    let mut by_fingers: BTreeMap<usize, Vec<&BulkGrasp>> = BTreeMap::new();
    grasps.iter().for_each(|grasp| by_fingers.entry(grasp.q.holding().len()).or_default().push(grasp));
    for (fingers, grasps) in &by_fingers {
        let liftable = grasps.iter().filter(|grasp| !grasp.liftable.is_empty()).count();
        let held = grasps.iter().filter_map(|grasp| grasp.held.as_ref());
        let mut needed: Vec<f64> = held.map(|held| held.friction).collect();
        needed.sort_by(f64::total_cmp);
        let median = needed.get(needed.len() / 2).copied().unwrap_or(f64::NAN);
        println!("{fingers:>7}  {:>6}  {liftable:>32}  {median:>22.2}", grasps.len());
    }
    assert_eq!(grasps.len(), 400);
    assert!(grasps.iter().all(|grasp| grasp.margin > 0.0 && grasp.clearance > 0.0));
    Ok(())
}
