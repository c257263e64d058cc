//! The replay of a plan, where the simulation is built in.

use super::SuiteArgs;
#[cfg(feature = "rapier")]
use crate::Failure;
use regrasp::suite::Judge;

/// Who replays; nobody where that was not wished, or the program has no simulation.
#[cfg(not(feature = "rapier"))]
pub fn judge(_: &SuiteArgs) -> Option<Judge<'static>> {
    None
}

/// Who replays; nobody where that was not wished.
#[cfg(feature = "rapier")]
pub fn judge(args: &SuiteArgs) -> Option<Judge<'static>> {
    (!args.no_replay).then_some(&replayed)
}

/// As `regrasp replay` does by default.
#[cfg(feature = "rapier")]
fn replayed(plan: &regrasp::plan::Plan) -> Result<regrasp::suite::Replayed, regrasp::suite::Unreplayable> {
    let why = |failure: Failure| regrasp::suite::Unreplayable(failure.message().to_owned());
    let report = crate::replay::by_default(plan).map_err(why)?;
    let last = report.stages.last();
    Ok(regrasp::suite::Replayed {
        arrived: report.arrived,
        distance: last.map_or(0.0, |stage| stage.end_distance),
        angle: last.map_or(0.0, |stage| stage.end_angle),
    })
}
