//! Files of `regrasp replay`, as far as a page shows them.

use crate::Failure;
use regrasp::plan::Plan;
use regrasp::view::ReplayTrack;
use serde::Deserialize;
use std::path::Path;

/// What tells a file of `regrasp replay`.
const FORMAT: &str = "regrasp-replay";

#[derive(Deserialize)]
struct Replay {
    format: String,
    version: u32,
    scenario: String,
    seed: u64,
    arrived: bool,
    distance_m: f64,
    angle_rad: f64,
    segments: Vec<Segment>,
}

#[derive(Deserialize)]
struct Segment {
    /// The object at each of the plan's states, and in the end once more, when it has come to rest; absent
    /// from what `replay --json` prints.
    object: Option<Vec<Moment>>,
}

#[derive(Deserialize)]
struct Moment {
    position: [f64; 3],
    orientation: [f64; 4],
}

/// The largest file of a replay that is read (bytes).
const MAX_BYTES: u64 = 512 << 20;

/// Reads where a simulation of `plan` took the object.
pub fn read(path: &Path, plan: &Plan) -> Result<ReplayTrack, Failure> {
    let refuse = |reason: String| Failure::bad_input(format!("`{}` {reason}", path.display()));
    let made = "; `regrasp replay PLAN -o FILE` makes one";
    let bytes = regrasp::api::read_at_most(path, MAX_BYTES)
        .map_err(|error| refuse(format!("cannot be read: {error}{made}")))?;
    let replay: Replay = serde_json::from_slice(&bytes)
        .map_err(|error| refuse(format!("is not a file of `regrasp replay`: {error}{made}")))?;
    track(&replay, plan).map_err(|reason| refuse(format!("{reason}{made}")))
}

/// The object's poses on the plan's clock: the simulation may have been slower.
fn track(replay: &Replay, plan: &Plan) -> Result<ReplayTrack, String> {
    if replay.format != FORMAT || replay.version != 1 {
        return Err(format!(
            "has format `{}` version {}, not `{FORMAT}` version 1",
            replay.format, replay.version
        ));
    }
    let fits = |(simulated, planned): (&Segment, &regrasp::plan::SegmentRecord)| {
        simulated.object.as_ref().is_none_or(|object| object.len() <= planned.states.len() + 1)
    };
    let same_plan = replay.scenario == plan.scenario.name
        && replay.seed == plan.seed
        && replay.segments.len() <= plan.segments.len()
        && replay.segments.iter().zip(&plan.segments).all(fits);
    if !same_plan {
        return Err(format!("is of another plan (scenario `{}`, seed {})", replay.scenario, replay.seed));
    }
    let mut track = ReplayTrack { caption: caption(replay), ..ReplayTrack::default() };
    for (simulated, planned) in replay.segments.iter().zip(&plan.segments) {
        let object = simulated.object.as_ref().ok_or("holds no poses")?;
        let times = planned.states.iter().map(|state| state.time);
        let rest = planned.states.last().map(|state| state.time);
        for (moment, time) in object.iter().zip(times.chain(rest)) {
            let ([x, y, z], [w, i, j, k]) = (moment.position, moment.orientation);
            track.times.push(time);
            track.poses.push([x, y, z, w, i, j, k]);
        }
    }
    if track.times.is_empty() { Err("holds no poses".into()) } else { Ok(track) }
}

fn caption(replay: &Replay) -> String {
    let end = if replay.arrived { "the object arrives" } else { "the object does not arrive" };
    let (millimetres, degrees) = (replay.distance_m * 1e3, replay.angle_rad.to_degrees());
    format!("{end}; at most {millimetres:.1} mm and {degrees:.1}° off the plan")
}
