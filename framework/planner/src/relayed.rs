//! A leg by a relay, before its graph is begun.

use crate::error::End;
use crate::relay::{QUICK, Route, THOROUGH, relay};
use crate::run::Run;
use crate::segments::end;
use crate::session::Call;
use regrasp_api::{
    CallError, Configuration, EdgeKind, EdgeVerdict, NodeId, Origin, Pose, Random, Rotation, Vec3,
    angle_between, interpolate,
};
use regrasp_plan::Segment;
use std::f64::consts::PI;

/// How many threads one relay keeps busy, more or less.
const BUSY: usize = 4;
/// How far (rad) a way round may turn away from the straight one half-way. Our choice.
const ASIDE: f64 = 0.8;

impl Run<'_> {
    /// How many relays the strategy wants on a leg: none where a grasp is given at the goal.
    pub fn relays(&self, leg: usize) -> usize {
        if self.request.problem.goal[leg].grasp.is_some() { 0 } else { self.policy.relays }
    }

    /// Steps from the node `start` to the goal of a leg by the first relay that gets there: of each round's
    /// relays the first goes along the straight motion, the others by ways round. They enter the graph.
    pub fn relayed(
        &mut self,
        leg: usize,
        start: NodeId,
        round: u64,
    ) -> Result<Option<Vec<Segment>>, CallError> {
        let steps = self.first_relay(leg, start, round)?;
        if let Some((steps, last)) = steps.as_deref().and_then(|steps| Some((steps, steps.last()?))) {
            let goal = self.enter_way(start, end(last).clone(), steps);
            self.ends.extend((leg == 0).then_some((End::Start, start)));
            self.ends.push((End::Goal(leg), goal));
        }
        Ok(steps)
    }

    /// Steps from a node to a goal enter the graph.
    pub fn enter_way(&mut self, start: NodeId, end: Configuration, steps: &[Segment]) -> NodeId {
        let goal = self.graph.add_node(end, Origin::Goal);
        let edge = self.graph.add_edge(start, goal, EdgeKind::TransferRegrasp, EdgeVerdict::Executable);
        self.graph.set_steps(edge, steps.to_vec());
        self.used.insert(edge);
        goal
    }

    fn first_relay(
        &mut self,
        leg: usize,
        start: NodeId,
        round: u64,
    ) -> Result<Option<Vec<Segment>>, CallError> {
        // Quick ones before the first look at the graph; where that was not enough twice as many thorough
        // ones; later the graph has the most of the time.
        let (count, effort) = match round {
            1 => (self.relays(leg), QUICK),
            2 => (2 * self.relays(leg), THOROUGH),
            _ => (self.relays(leg).div_ceil(2), THOROUGH),
        };
        let (session, task, from) = (&self.session, &self.task, self.graph.node(start));
        let (poses, turn_length) = (&self.poses[leg..], self.request.object.mesh.radius());
        let many = session.threads().div_ceil(BUSY);
        let tried = session.until_found(many, count, |session, number| {
            session.counted(task, (Call::Relay, leg as u64, number as u64), |work| {
                let route = route(poses, number, task.workspace, turn_length, &mut work.context.random);
                relay(work, from, &route, &effort)
            })
        });
        for found in tried {
            self.tally.add(&found.tally);
            if let Some(steps) = found.result? {
                return Ok(Some(steps));
            }
        }
        Ok(None)
    }
}

/// The route of the relay with this number: straight to the second of `poses`, or by a way round.
fn route(
    poses: &[Pose],
    number: usize,
    (lower, upper): (Vec3, Vec3),
    turn_length: f64,
    random: &mut Random,
) -> Route {
    if number == 0 {
        return Route::new(poses.to_vec(), 1, turn_length);
    }
    let mut half = interpolate(&poses[0], &poses[1], 0.5);
    let turn = angle_between(&poses[0].rotation, &poses[1].rotation);
    if number.is_multiple_of(3) && turn > 0.5 * PI {
        let axis = (poses[1].rotation * poses[0].rotation.inverse()).scaled_axis();
        half.rotation = Rotation::from_scaled_axis(axis.normalize() * PI) * half.rotation;
    }
    let aside = random.direction() * (ASIDE * random.unit().cbrt());
    half.rotation = Rotation::from_scaled_axis(aside) * half.rotation;
    let p = Vec3::from_fn(|i, _| random.range(lower[i], upper[i]));
    half.translation.vector = half.translation.vector.lerp(&p, 0.5);
    let through = [poses[0], half].into_iter().chain(poses[1..].iter().copied());
    Route::new(through.collect(), 2, turn_length)
}
