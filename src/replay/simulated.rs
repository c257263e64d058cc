//! What `regrasp replay` does where the simulation is built in.

use super::ReplayArgs;
use crate::outputs::{self, Kind};
use crate::table::Table;
use crate::{Failure, say, say_json};
use regrasp::api::{FingerIndex, Problem};
use regrasp::physics::{
    Happening, Moment, PhysicsError, ReplayReport, ReplaySettings, SimulationSettings, Stage, StageReport,
    replay,
};
use regrasp::plan::{Claims, Criterion, Motion, Plan, Segment, SegmentKind};
use serde_json::{Value, json};

/// Slip of a contact (m) and gap between a holding fingertip and the object (m) that are worth a word.
const SLIP: f64 = 1e-3;
const GAP: f64 = 5e-4;

pub fn run(args: &ReplayArgs) -> Result<(), Failure> {
    let wished = args.output.as_deref().map(|path| (path, Kind::Replay));
    outputs::check(std::slice::from_ref(&args.plan), wished.as_slice(), args.overwrite)?;
    let standard = args.output.as_deref().is_some_and(outputs::is_standard);
    let plan = regrasp::plan::read(&args.plan).map_err(Failure::refused)?;
    let told = Told::new(args, &plan)?;
    if let Some(path) = args.output.as_ref().filter(|_| !standard) {
        let json = told.json(true);
        regrasp::plan::write_file(path, |writer| regrasp::plan::write_json(&json, writer))
            .map_err(Failure::bad_input)?;
    }
    if standard {
        say_json(&told.json(true))?
    } else if args.json {
        say_json(&told.json(false))?
    } else {
        say(&told.text())?
    }
    if told.report.arrived { Ok(()) } else { Err(Failure::not_arrived(told.why())) }
}

/// What comes of a plan that is replayed as without options.
pub fn by_default(plan: &Plan) -> Result<ReplayReport, Failure> {
    let args = ReplayArgs {
        plan: "the plan".into(),
        json: false,
        output: None,
        overwrite: outputs::OverwriteArgs { force: false },
        friction_scale: 1.0,
        mass_scale: 1.0,
        stiffness_scale: 1.0,
        slowdown: 2.0,
        grip: None,
        sweep: false,
        gravity: None,
    };
    Ok(Told::new(&args, plan)?.report)
}

/// A replay with what a report about it mentions.
pub(super) struct Told<'a> {
    args: &'a ReplayArgs,
    plan: &'a Plan,
    motion: Motion,
    problem: Problem,
    settings: ReplaySettings,
    pub(super) report: ReplayReport,
}

impl<'a> Told<'a> {
    pub(super) fn new(args: &'a ReplayArgs, plan: &'a Plan) -> Result<Self, Failure> {
        if plan.claims.contact.cone.is_some_and(|cone| cone.gamma > 0.0) {
            return Err(Failure::bad_input(format!("{}: {}", args.plan.display(), PhysicsError::Torsion)));
        }
        let motion = regrasp::plan::motion(plan).map_err(Failure::bad_input)?;
        let mut problem = plan.scenario.problem.clone();
        problem.gravity = args.gravity.unwrap_or(problem.gravity);
        let settings = settings(args, &problem, &plan.claims);
        // A plan's meshes are given in place: there is no file to look for.
        let report = replay(&problem, &stages(&motion, args.keeps_forces()), &settings);
        let report =
            report.map_err(|error| Failure::bad_input(format!("{}: {error}", args.plan.display())))?;
        Ok(Self { args, plan, motion, problem, settings, report })
    }

    fn finger(&self, finger: FingerIndex) -> &str {
        self.problem.hand.finger.get(finger.index()).map_or("?", |finger| finger.name.as_str())
    }

    /// What went wrong in a stage, in words; empty where nothing did.
    fn events(&self, stage: &StageReport) -> Vec<String> {
        let outcome = &stage.outcome;
        let slips = outcome.slip.iter().filter(|(_, slip)| **slip > SLIP);
        let slips = slips.map(|(finger, slip)| format!("{} slips {:.1} mm", self.finger(finger), slip * 1e3));
        let gaps = outcome.gap.iter().filter(|(_, gap)| **gap > GAP);
        let gaps = gaps.map(|(finger, _)| format!("{} loses the object", self.finger(finger)));
        let weak = (stage.margin <= 0.0).then(|| "no allowed forces hold the weight".to_owned());
        let end = outcome.failure.map(|failure| match failure.what {
            Happening::Stray => "dropped".to_owned(),
            Happening::Slip(finger) => format!("{} slipped", self.finger(finger)),
            Happening::Lift(finger) => format!("{} lost the object", self.finger(finger)),
            what => what.to_string(),
        });
        end.into_iter().chain(weak).chain(slips).chain(gaps).collect()
    }

    /// Where and why the object does not arrive.
    fn why(&self) -> String {
        let off = |stage: &StageReport| {
            format!("{:.1} mm and {:.1}° off", stage.end_distance * 1e3, stage.end_angle.to_degrees())
        };
        let Some((index, first)) = self.first_bad() else {
            return "the object does not arrive".into();
        };
        let events = self.events(first);
        let reason = if events.is_empty() { "it drifts".to_owned() } else { events.join(", ") };
        match self.report.failure() {
            Some((at, failure)) => format!(
                "the object does not arrive: dropped in segment {}, state {}, at {:.2} s; first off its \
                 path in segment {}: {reason}",
                at + 1,
                failure.state + 1,
                failure.time,
                index + 1
            ),
            None => {
                let end = self.report.stages.last().map(off).unwrap_or_default();
                format!(
                    "the object does not arrive: in the end {end}; first off its path in segment {}: {reason}",
                    index + 1
                )
            }
        }
    }

    /// The first stage in which the object is off its path by more than the bounds of arrival.
    fn first_bad(&self) -> Option<(usize, &StageReport)> {
        let (distance, angle) = self.settings.arrival;
        let bad = |stage: &StageReport| {
            stage.outcome.distance > distance || stage.outcome.angle > angle || !stage.outcome.is_good()
        };
        self.report.stages.iter().enumerate().find(|(_, stage)| bad(stage))
    }

    fn text(&self) -> String {
        let word = if self.report.arrived { "the object arrives" } else { "the object does not arrive" };
        let mut table = Table::new(
            ">< >",
            &[
                "segment",
                "",
                "begins",
                "off by",
                "turned by",
                "slip",
                "margin",
                "end off by",
                "turned by",
                "",
            ],
        );
        for (index, stage) in self.report.stages.iter().enumerate() {
            table.row(self.row(index, stage));
        }
        format!(
            "{}: {word} ({} of {} segments, {:.1} s simulated)\n  largest deviation {:.2} mm, {:.2}°; in \
             the end {}\n{}",
            self.args.plan.display(),
            self.report.stages.len(),
            self.motion.segments.len(),
            self.report.time,
            self.report.distance() * 1e3,
            self.report.angle().to_degrees(),
            self.report.stages.last().map_or("nothing moved".into(), |last| format!(
                "{:.2} mm, {:.2}°",
                last.end_distance * 1e3,
                last.end_angle.to_degrees()
            )),
            table.text()
        )
    }

    fn row(&self, index: usize, stage: &StageReport) -> Vec<String> {
        let outcome = &stage.outcome;
        let kind = match stage.moving {
            None => "transfer".to_owned(),
            Some(finger) => format!("regrasp {}", self.finger(finger)),
        };
        let mm = |metres: f64| format!("{:.2} mm", metres * 1e3);
        let degrees = |angle: f64| format!("{:.2}°", angle.to_degrees());
        vec![
            (index + 1).to_string(),
            kind,
            format!("{:.2} s", stage.begin),
            mm(outcome.distance),
            degrees(outcome.angle),
            mm(largest_slip(stage)),
            format!("{:.2} N", stage.margin),
            mm(stage.end_distance),
            degrees(stage.end_angle),
            self.events(stage).join(", "),
        ]
    }

    /// The one JSON object of `replay --json`; with `track` the object's poses too.
    fn json(&self, track: bool) -> Value {
        let report = &self.report;
        let segments = report.stages.iter().enumerate();
        let segments: Vec<Value> = segments.map(|(index, stage)| self.segment(index, stage, track)).collect();
        let last = report.stages.last();
        json!({
            "format": "regrasp-replay",
            "version": 1,
            "scenario": self.plan.scenario.name,
            "seed": self.plan.seed,
            "arrived": report.arrived,
            "reason": (!report.arrived).then(|| self.why()),
            "segments_in_plan": self.motion.segments.len(),
            "duration_s": report.time,
            "distance_m": report.distance(),
            "angle_rad": report.angle(),
            "end_distance_m": last.map_or(0.0, |last| last.end_distance),
            "end_angle_rad": last.map_or(0.0, |last| last.end_angle),
            "assumed": self.assumed(),
            "segments": segments,
        })
    }

    /// Whether all forces are the plan's own.
    fn brings_forces(&self) -> bool {
        let segments = &self.motion.segments;
        self.args.keeps_forces()
            && segments
                .iter()
                .all(|s| s.forces.len() == s.states.len() && s.forces.iter().all(Option::is_some))
    }

    fn assumed(&self) -> Value {
        let SimulationSettings { stiffness, linear_stiffness, damping_time, time_step, effort_share, .. } =
            self.settings.simulation;
        let object = &self.problem.object;
        json!({
            "gravity_m_s2": self.problem.gravity,
            "friction": self.settings.simulation.friction,
            "mass_kg": self.settings.simulation.mass,
            "planned_friction": object.friction,
            "planned_mass_kg": object.mass,
            "grip_n": self.settings.simulation.grip,
            "forces_of_plan": self.brings_forces(),
            "stiffness_nm_rad": stiffness,
            "linear_stiffness_n_m": linear_stiffness,
            "damping_time_s": damping_time,
            "effort_share": effort_share,
            "time_step_s": time_step,
            "slowdown": self.settings.slowdown,
            "shift_s": self.settings.shift,
        })
    }

    fn segment(&self, index: usize, stage: &StageReport, track: bool) -> Value {
        let outcome = &stage.outcome;
        let mut segment = json!({
            "segment": index,
            "kind": if stage.moving.is_some() { "regrasp" } else { "transfer" },
            "finger": stage.moving.map(|finger| self.finger(finger)),
            "begin_s": stage.begin,
            "distance_m": outcome.distance,
            "angle_rad": outcome.angle,
            "end_distance_m": stage.end_distance,
            "end_angle_rad": stage.end_angle,
            // Without a single state that can be held there is no least margin.
            "margin_n": stage.margin.is_finite().then_some(stage.margin),
            "slip_m": outcome.slip.iter().map(|(_, slip)| *slip).collect::<Vec<f64>>(),
            "gap_m": outcome.gap.iter().map(|(_, gap)| *gap).collect::<Vec<f64>>(),
            "events": self.events(stage),
            "failure": outcome.failure.map(|failure| json!({
                "what": failure.what.to_string(),
                "time_s": failure.time,
                "state": failure.state,
            })),
        });
        if track {
            segment["object"] = stage.track.iter().map(moment).collect();
        }
        segment
    }
}

fn largest_slip(stage: &StageReport) -> f64 {
    stage.outcome.slip.iter().map(|(_, slip)| *slip).fold(0.0, f64::max)
}

fn moment(moment: &Moment) -> Value {
    let q = moment.X_HO.rotation.quaternion();
    json!({
        "time_s": moment.time,
        "position": <[f64; 3]>::from(moment.X_HO.translation.vector),
        "orientation": [q.w, q.i, q.j, q.k],
    })
}

fn settings(args: &ReplayArgs, problem: &Problem, claims: &Claims) -> ReplaySettings {
    let default = SimulationSettings::default();
    let simulation = SimulationSettings {
        friction: Some(problem.object.friction * args.friction_scale),
        mass: Some(problem.object.mass * args.mass_scale),
        stiffness: default.stiffness * args.stiffness_scale,
        linear_stiffness: default.linear_stiffness * args.stiffness_scale,
        grip: args.grip,
        ..default
    };
    let simulation = match claims.criterion {
        Criterion::Holding(load) => SimulationSettings {
            relied: load.friction_factor,
            grip: args.grip.or(load.max_normal_force),
            ..simulation
        },
        _ => simulation,
    };
    ReplaySettings { simulation, slowdown: args.slowdown, ..Default::default() }
}

/// The motion's segments, with the forces that the plan brings where they are `wanted`.
fn stages(motion: &Motion, wanted: bool) -> Vec<Stage<'_>> {
    motion.segments.iter().map(|segment| stage(segment, wanted)).collect()
}

fn stage(segment: &Segment, wanted: bool) -> Stage<'_> {
    let moving = match segment.kind {
        SegmentKind::Transfer => None,
        SegmentKind::Regrasp(finger) => Some(finger),
    };
    let forces = if wanted { &segment.forces[..] } else { &[] };
    Stage { states: &segment.states, times: &segment.times, moving, forces }
}
