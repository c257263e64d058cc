//! Where an object is put so that it can be planned with: places that look good, tried by planning.

use crate::Failure;
use regrasp::Stopwatch;
use regrasp::api::Vec3;
use regrasp::host::Registry;
use regrasp::planner::Status;
use regrasp::run::{Run, Setup, scenario};
use regrasp::world::ObjectPlace;
use std::path::Path;
use std::time::Duration;

/// Places that are tried.
const TRIES: usize = 12;
/// How far (m) they lie from each other.
const APART: f64 = 8e-3;
/// How long one of them may take.
const EACH: Duration = Duration::from_millis(1500);

/// The first text that is planned, of those that `text` makes for each place, the best place first. `name` is
/// what messages call the scenario; `folder` is where its files are.
pub fn that_plans(
    (name, folder): (&str, &Path),
    registry: &Registry,
    places: &[ObjectPlace],
    text: impl Fn(Vec3) -> String,
) -> Result<Option<String>, Failure> {
    for place in spread(places) {
        let text = text(place);
        let scenario = scenario::from_text(name, &text, folder, registry).map_err(Failure::refused)?;
        // A start that collides is refused here: the next place may do better.
        let Ok(setup) = Setup::new(&scenario, &scenario.choices, registry) else { continue };
        let solved = |run: Run| run.outcome.status == Status::Solved && run.is_verified();
        if setup.run(&Stopwatch::limited(EACH).options(0)).is_ok_and(solved) {
            return Ok(Some(text));
        }
    }
    Ok(None)
}

/// A few of the places that lie apart from each other.
fn spread(places: &[ObjectPlace]) -> Vec<Vec3> {
    let mut kept: Vec<Vec3> = Vec::new();
    for place in places {
        if kept.len() < TRIES && kept.iter().all(|other| (other - place.p_HO).norm() > APART) {
            kept.push(place.p_HO);
        }
    }
    kept
}
