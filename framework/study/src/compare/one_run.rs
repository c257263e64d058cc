//! One run in figures.

use super::{Certified, Counts, MotionFigures, RunRecord, RunStatus, Times};
use regrasp_api::{CallError, Configuration, Hand, JointKind, angle_between};
use regrasp_plan::{Extreme, Holds, Motion, StoppedBy};
use regrasp_planner::Status;
use regrasp_run::{Run, RunError};
use std::collections::BTreeMap;

/// Which run a record is of.
#[derive(Clone, Copy, Debug)]
pub struct RunName<'a> {
    /// The scenario's name.
    pub scenario: &'a str,
    /// The variant's name.
    pub variant: &'a str,
    /// The seed.
    pub seed: u64,
}

impl RunRecord {
    /// The record of a run that came to an end of its own or to its time limit.
    pub fn of_run(name: RunName<'_>, run: &Run, hand: &dyn Hand, roles_s: BTreeMap<String, f64>) -> Self {
        let (outcome, statistics) = (&run.outcome, &run.outcome.statistics);
        let status = match (outcome.status, run.stopped_by) {
            (Status::Solved, _) => RunStatus::Solved,
            (_, Some(StoppedBy::TimeLimit)) => RunStatus::TimeOut,
            _ => RunStatus::NoPlan,
        };
        let moved = !outcome.goal_ends.is_empty();
        Self {
            status,
            verified: status == RunStatus::Solved && run.is_verified(),
            message: run.why_not_solved(),
            times: Times {
                planning_s: run.planning_s,
                verification_s: run.verification_s,
                phases_s: statistics.time_s.clone(),
                roles_s,
                memory_bytes: None,
            },
            counts: Counts {
                generated_nodes: statistics.generated_nodes,
                graph_nodes: statistics.graph_nodes,
                components: statistics.components,
                roadmap: statistics.roadmap,
                collision_tests: 0,
                goals_reached: outcome.goal_ends.len(),
                plugins: statistics.plugins.clone(),
                notes: regrasp_plan::plugin_notes(&outcome.tally),
            },
            motion: moved.then(|| motion_figures(run, hand)),
            certified: certified(run),
            ..Self::empty(name)
        }
    }

    /// The record of a run without an answer.
    pub fn of_error(name: RunName<'_>, error: &RunError) -> Self {
        let status = match error {
            RunError::Call(CallError::Panicked { .. }) => RunStatus::Panic,
            _ => RunStatus::Error,
        };
        Self { status, message: Some(error.to_string()), ..Self::empty(name) }
    }

    /// The record of a run that a panic of the framework ended.
    pub fn of_panic(name: RunName<'_>, message: &str) -> Self {
        let message = Some(format!("the framework panicked: {message}"));
        Self { status: RunStatus::Panic, message, ..Self::empty(name) }
    }

    /// The record of a run that ended its process.
    pub fn of_crash(name: RunName<'_>, how: &str) -> Self {
        let message = Some(format!("the run ended its process: {how}"));
        Self { status: RunStatus::Crash, message, ..Self::empty(name) }
    }

    fn empty(name: RunName<'_>) -> Self {
        Self {
            scenario: name.scenario.to_owned(),
            variant: name.variant.to_owned(),
            seed: name.seed,
            status: RunStatus::Error,
            verified: false,
            message: None,
            times: Times::default(),
            counts: Counts::default(),
            motion: None,
            certified: None,
        }
    }
}

fn certified(run: &Run) -> Option<Certified> {
    let (plan, verdict) = (run.plan.as_ref()?, run.verdict.as_ref()?);
    let certificate = plan.certificate.as_ref();
    // JSON knows no infinity: a figure that is not finite is as good as none.
    let value = |extreme: &Option<Extreme>| extreme.as_ref().map(|extreme| extreme.value);
    let figure = |of: fn(&regrasp_plan::PlanCertificate) -> &Option<Extreme>| {
        value(of(certificate?)).filter(|x| x.is_finite())
    };
    let holds = certificate.and_then(|certificate| certificate.holds.as_ref());
    let held = |of: fn(&Holds) -> Option<f64>| holds.and_then(of).filter(|x| x.is_finite());
    Some(Certified {
        margin: figure(|certificate| &certificate.closure_margin),
        clearance_m: figure(|certificate| &certificate.clearance),
        slip_m: figure(|certificate| &certificate.slip),
        closure_m: figure(|certificate| &certificate.closure_residual),
        holds_friction: held(|holds| Some(holds.friction.value)),
        holds_mass_kg: held(|holds| Some(holds.mass.value)),
        holds_force_n: held(|holds| Some(holds.disturbance.value)),
        effort_share: held(|holds| holds.effort.as_ref().map(|effort| effort.value)),
        failed_checks: verdict.failures().map(|check| check.name.to_owned()).collect(),
    })
}

fn motion_figures(run: &Run, hand: &dyn Hand) -> MotionFigures {
    let (motion, statistics) = (&run.outcome.motion, &run.outcome.statistics);
    let mut figures = MotionFigures {
        transfers: statistics.transfers,
        regrasps: statistics.regrasps,
        regrasps_before_smoothing: statistics.regrasps_before_smoothing,
        states: motion.segments.iter().map(|segment| segment.states.len()).sum(),
        duration_s: duration(motion),
        ..MotionFigures::default()
    };
    for pair in motion.segments.iter().flat_map(|segment| segment.states.windows(2)) {
        add_step(&mut figures, &pair[0], &pair[1], hand);
    }
    figures
}

fn duration(motion: &Motion) -> f64 {
    motion.segments.last().and_then(|segment| segment.times.last()).copied().unwrap_or(0.0)
}

/// Adds the way from one state to the next.
fn add_step(figures: &mut MotionFigures, a: &Configuration, b: &Configuration, hand: &dyn Hand) {
    figures.object_path_m += (b.X_HO.translation.vector - a.X_HO.translation.vector).norm();
    figures.object_turn_rad += angle_between(&a.X_HO.rotation, &b.X_HO.rotation);
    for (finger, joints) in a.joints.iter() {
        let models = &hand.finger(finger).joints;
        for ((from, to), model) in joints.iter().zip(b.joints[finger].iter()).zip(models) {
            match model.kind {
                JointKind::Revolute => figures.joint_travel_rad += (to - from).abs(),
                JointKind::Prismatic => figures.joint_travel_m += (to - from).abs(),
            }
        }
    }
}
