//! A whole motion, simulated: does the object arrive?

use crate::fixed::{fixed_shapes, hull};
use crate::force::Friction;
use crate::hold::{Held, Holder};
use crate::simulator::{Knot, Scene, Simulator};
use crate::surface::ball_surface;
use crate::{Bounds, Failure, Happening, Outcome, PhysicsError, SimulationSettings, Stage};
use regrasp_api::{FingerIndex, Pose, Problem, angle_between};
use regrasp_world::World;

/// How a motion is replayed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReplaySettings {
    /// Motors, contacts and time step.
    pub simulation: SimulationSettings,
    /// What ends the replay: by default only an object that is 20 mm or 0.5 rad away from its path, which
    /// counts as dropped.
    pub bounds: Bounds,
    /// What the motion's times are multiplied with, in 0.1 to 100; 2 by default: plans are timed for the
    /// joints' limits, and grips balance the weight alone, not the forces that move it.
    pub slowdown: f64,
    /// Time (s) between two stages in which the forces pass from one set of fingers to the next, and for
    /// which the object is held at the end; 0.01 to 10.
    pub shift: f64,
    /// How near the object must come to arrive: distance (m) and angle (rad) at the end.
    pub arrival: (f64, f64),
}

impl Default for ReplaySettings {
    fn default() -> Self {
        Self {
            simulation: SimulationSettings::default(),
            bounds: Bounds { distance: 0.02, angle: 0.5, slip: f64::INFINITY, gap: f64::INFINITY },
            slowdown: 2.0,
            shift: 0.1,
            arrival: (5e-3, 5_f64.to_radians()),
        }
    }
}

/// Where the object is at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    /// Time from the start of the replay (s).
    pub time: f64,
    /// The object's pose in H.
    pub X_HO: Pose,
}

/// What happened in one stage.
#[derive(Clone, Debug, PartialEq)]
pub struct StageReport {
    /// The finger that moved in a regrasp; `None` in a transfer.
    pub moving: Option<FingerIndex>,
    /// Worst values and, if the replay ended here, why. A contact that loses the object is reported with a
    /// gap of 1 mm at most.
    pub outcome: Outcome,
    /// The least distance of a planned force from its cone's boundary (N). Where it is not positive, no
    /// forces within the cones and the joints' efforts hold the object against gravity: a closed grasp may
    /// need forces that the fingers do not have. The nearest ones are tried.
    pub margin: f64,
    /// Distance of the object's origin from its planned place at the stage's end (m).
    pub end_distance: f64,
    /// Angle of the object from its planned orientation at the stage's end (rad).
    pub end_angle: f64,
    /// When the stage began (s): forces pass over to the fingers that hold in it, then it moves.
    pub begin: f64,
    /// Where the object was as each state was passed, as far as the stage was made; at its last moment where
    /// the replay ended in it, and at the end of the last stage when it was held for a while.
    pub track: Vec<Moment>,
}

/// What a replay found.
#[derive(Clone, Debug, PartialEq)]
pub struct ReplayReport {
    /// The stages in turn, up to the one that ended the replay.
    pub stages: Vec<StageReport>,
    /// Where the object is in the end, in H.
    pub X_HO: Pose,
    /// Whether all stages were made and the object is near its goal.
    pub arrived: bool,
    /// Simulated time (s).
    pub time: f64,
}

impl ReplayReport {
    /// Largest distance of the object's origin from where the plan has it (m).
    pub fn distance(&self) -> f64 {
        self.stages.iter().map(|stage| stage.outcome.distance).fold(0.0, f64::max)
    }

    /// Largest angle of the object from the planned orientation (rad).
    pub fn angle(&self) -> f64 {
        self.stages.iter().map(|stage| stage.outcome.angle).fold(0.0, f64::max)
    }

    /// The stage that ended the replay and why; `None` where all were made.
    pub fn failure(&self) -> Option<(usize, Failure)> {
        let last = self.stages.len().checked_sub(1)?;
        self.stages[last].outcome.failure.map(|failure| (last, failure))
    }
}

/// Replays the stages of a motion that solves the problem: hand and object under gravity, palm and obstacles
/// fixed.
///
/// A regrasp's finger moves freely; the others hold. Between two stages the forces pass over from one grip to
/// the next while everything rests, so that a finger is unloaded before it lifts and pressed on before it
/// carries: any blend of two balanced grips is balanced and within the cones. The problem stands alone: its
/// meshes are in it.
pub fn replay(
    problem: &Problem,
    stages: &[Stage<'_>],
    settings: &ReplaySettings,
) -> Result<ReplayReport, PhysicsError> {
    settings.validate()?;
    if !problem.hand.fingertip.is_ball() {
        return Err(PhysicsError::PointFingertips);
    }
    let world = World::new(problem).map_err(|error| PhysicsError::Problem(error.to_string()))?;
    let surface = ball_surface(&world.object.mesh)?;
    let hull = hull(&world.object.mesh)?;
    let fixed = fixed_shapes(problem)?;
    let scene = Scene {
        hand: &*world.hand,
        object: &world.object,
        shape: &surface,
        fixed: &fixed,
        hull: Some(&hull),
        g_H: world.g_H,
    };
    let mut run = Run { scene, settings, clock: 0.0, last: None, simulator: None };
    let mut reports = Vec::new();
    for (index, stage) in stages.iter().enumerate() {
        let report = run.stage(stage, index + 1 == stages.len());
        let ended = !report.outcome.is_good();
        reports.push(report);
        if ended {
            break;
        }
    }
    Ok(run.report(reports, stages))
}

/// A replay under way.
struct Run<'a> {
    scene: Scene<'a>,
    settings: &'a ReplaySettings,
    clock: f64,
    /// Where the stage before ended.
    last: Option<Knot>,
    simulator: Option<Simulator>,
}

impl Run<'_> {
    fn stage(&mut self, stage: &Stage<'_>, is_last: bool) -> StageReport {
        let mut outcome = Outcome::new(self.scene.hand.finger_count());
        let (knots, margin) = self.knots(stage, is_last);
        let (begin, mut track) = (self.clock, Vec::with_capacity(knots.len()));
        if let Some(first) = knots.first() {
            let (scene, settings) = (&self.scene, &self.settings.simulation);
            let simulator = self.simulator.get_or_insert_with(|| Simulator::new(scene, settings, first));
            let note = &mut |time, X_HO| track.push(Moment { time, X_HO });
            simulator.run(&knots, &self.settings.bounds, &mut outcome, note);
            // The first knot is where the stage before ended.
            if let Some(failure) = &mut outcome.failure {
                failure.state = failure.state.saturating_sub(1);
            }
            self.last = knots.last().cloned();
            self.clock = track.last().map_or(self.clock, |moment| moment.time);
        }
        if knots.len() <= stage.states.len() && outcome.is_good() {
            let failure =
                Failure { what: Happening::NoGrip, time: self.clock, state: knots.len().saturating_sub(1) };
            outcome.failure = Some(failure);
        }
        let (end_distance, end_angle) = self.off(stage);
        StageReport { moving: stage.moving, outcome, margin, end_distance, end_angle, begin, track }
    }

    /// The stage's schedule, forces passing over first, up to where no forces hold the object; and the least
    /// margin of a grip (N).
    fn knots(&mut self, stage: &Stage<'_>, is_last: bool) -> (Vec<Knot>, f64) {
        let Scene { hand, object, g_H, .. } = self.scene;
        let holder =
            Holder::new((hand, object, g_H), Friction::point(object.friction), &self.settings.simulation);
        let start = self.clock + self.settings.shift;
        let first = stage.times.first().copied().unwrap_or(0.0);
        let mut least = f64::INFINITY;
        let held = holder.stage(stage);
        let made = stage.states.iter().zip(held).zip(stage.times).map_while(|((q, held), time)| {
            let holding = stage.holding(q);
            let Held { efforts: feed, margin, .. } = held?;
            least = least.min(margin);
            let time = start + (time - first) * self.settings.slowdown;
            Some(Knot { time, X_HO: q.X_HO, joints: q.joints, feed, holding })
        });
        let mut knots: Vec<Knot> = made.collect();
        if let Some(first) = knots.first() {
            let before = self.last.as_ref().unwrap_or(first);
            let holding = before.holding.intersection(first.holding);
            let passing = Knot { time: self.clock, holding, ..before.clone() };
            knots.insert(0, passing);
        }
        if let (true, Some(last)) = (is_last, knots.last()) {
            knots.push(Knot { time: last.time + self.settings.shift, ..last.clone() });
        }
        (knots, least)
    }

    /// How far the object is from where the stage is to end: distance (m) and angle (rad).
    fn off(&self, stage: &Stage<'_>) -> (f64, f64) {
        let (Some(simulator), Some(end)) = (&self.simulator, stage.states.last()) else { return (0.0, 0.0) };
        let X_HO = simulator.pose();
        let distance = (X_HO.translation.vector - end.X_HO.translation.vector).norm();
        (distance, angle_between(&X_HO.rotation, &end.X_HO.rotation))
    }

    fn report(&self, reports: Vec<StageReport>, stages: &[Stage<'_>]) -> ReplayReport {
        let (near, turned) = self.settings.arrival;
        let made = reports.len() == stages.len() && reports.iter().all(|report| report.outcome.is_good());
        let close = reports.last().is_none_or(|last| last.end_distance <= near && last.end_angle <= turned);
        let X_HO = self.simulator.as_ref().map_or_else(Pose::identity, Simulator::pose);
        ReplayReport { stages: reports, X_HO, arrived: made && close, time: self.clock }
    }
}

impl ReplaySettings {
    /// Refuses the first value outside its range.
    pub fn validate(&self) -> Result<(), PhysicsError> {
        self.simulation.validate()?;
        crate::settings::check("slowdown", self.slowdown, 0.1, 100.0)?;
        crate::settings::check("shift", self.shift, 0.01, 10.0)
    }
}
