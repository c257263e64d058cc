//! A leg through a roadmap: its ends are joined to nodes near them, and the way between is made executable.

use super::Through;
use super::graph::RoadmapGraph;
use super::grow::edge_key;
use super::near::{nearest, scan_pose};
use super::nodes::ScanPose;
use super::way::{Access, Way, cheapest};
use crate::error::End;
use crate::foresight::outlook;
use crate::joined::joined;
use crate::run::{Halt, Run};
use crate::segments::{end, moves, reversed};
use crate::session::{Call, Session, Work};
use crate::steps::transfer;
use regrasp_api::{
    CallError, Configuration, EdgeKind, EdgeVerdict, NodeId, Origin, Pose, Reason, SearchPolicy, Slot, Tally,
    Task,
};
use regrasp_plan::Segment;
use std::collections::{BTreeMap, BTreeSet};

/// Nodes that each end may be joined to. Our choice: with more of them ways have fewer regrasps, and more of
/// the rolls fail that are tried.
const NEAR: usize = 48;
/// How many times as much as an edge of its length the way to an end costs: it may fail. Our choice.
const RISK: f32 = 1.6;
/// Edges and ends that may fail before the query is given up.
const FAILURES: usize = 40;
/// How much of the way to an end one must be able to look along for a roll there to be tried.
const HOPE: f64 = 0.7;
/// What the regrasps cost that join a node to an end whose grasp is given, about.
const REGRASPS: f32 = 4.0;

/// An end of a query.
enum Place {
    /// A grasp.
    Grasp(Box<Configuration>),
    /// Any grasp at a pose.
    Pose(Pose),
}

impl Place {
    fn pose(&self) -> &Pose {
        match self {
            Self::Grasp(q) => &q.X_HO,
            Self::Pose(X_HO) => X_HO,
        }
    }
}

impl Run<'_> {
    /// Steps of a leg through the roadmap, and the node that they begin in: `at` where an earlier leg ended
    /// there. They enter the graph. `None` where the roadmap knows no way.
    pub fn through_roadmap(
        &mut self,
        leg: usize,
        at: Option<NodeId>,
        through: Through<'_>,
    ) -> Result<Option<(NodeId, Vec<Segment>)>, Halt> {
        let begins = at.is_some() || self.request.problem.start.grasp.is_some();
        let start = if begins { Some(self.start_of(at)?) } else { None };
        let from = match start {
            Some(node) => Place::Grasp(Box::new(self.graph.node(node).clone())),
            None => Place::Pose(self.poses[leg]),
        };
        let to = match self.goal_given(leg)? {
            Some(q) => Place::Grasp(Box::new(q)),
            None => Place::Pose(self.poses[leg + 1]),
        };
        let query = Query {
            session: self.session,
            task: &self.task,
            policy: &self.policy,
            graph: through.graph,
            ends: [from, to],
            leg: leg as u64,
        };
        let mut known = Known::default();
        let solved = query.solve(&mut known);
        self.tally.add(&known.tally);
        let Some(segments) = solved? else { return Ok(None) };
        let states = segments.first().and_then(|first| first.states.first());
        let Some((first, last)) = states.zip(segments.last().map(end)) else { return Ok(None) };
        let start = start.unwrap_or_else(|| self.graph.add_node(first.clone(), Origin::Start));
        let goal = self.graph.add_node(last.clone(), Origin::Goal);
        let edge = self.graph.add_edge(start, goal, EdgeKind::TransferRegrasp, EdgeVerdict::Executable);
        self.graph.set_steps(edge, segments.clone());
        self.used.insert(edge);
        self.ends.extend((leg == 0).then_some((End::Start, start)));
        self.ends.push((End::Goal(leg), goal));
        Ok(Some((start, segments)))
    }
}

/// A query.
struct Query<'q> {
    session: Session<'q>,
    task: &'q Task<'q>,
    policy: &'q SearchPolicy,
    graph: &'q RoadmapGraph<'q>,
    /// Start and goal.
    ends: [Place; 2],
    leg: u64,
}

/// What is known of a query's parts.
#[derive(Default)]
struct Known {
    /// Steps from a node to start or goal.
    ends: [BTreeMap<u32, Vec<Segment>>; 2],
    /// Steps of edges, from their later nodes to their earlier ones.
    edges: BTreeMap<u32, Vec<Segment>>,
    /// Edges that could not be made again.
    dead: BTreeSet<u32>,
    /// What finding out took.
    tally: Tally,
}

impl Query<'_> {
    /// Steps from start to goal: straight, or else through the roadmap; `None` if it knows no way.
    fn solve(&self, known: &mut Known) -> Result<Option<Vec<Segment>>, CallError> {
        if let Some(steps) = self.straight(known)? {
            return Ok(Some(steps));
        }
        let goal = scan_pose(self.ends[1].pose());
        let mut access = [self.access(0), self.access(1)];
        for _ in 0..FAILURES {
            self.session.proceed()?;
            let ways = (&access[0][..], &access[1][..]);
            let Some(way) = cheapest(self.graph, ways, &goal, &known.dead) else { return Ok(None) };
            if self.is_made(&way, &mut access, known)? {
                return Ok(Some(self.assembled(&way, known)));
            }
        }
        Ok(None)
    }

    /// One roll, with the regrasps at its end where the goal's grasp is given.
    fn straight(&self, known: &mut Known) -> Result<Option<Vec<Segment>>, CallError> {
        let Place::Grasp(from) = &self.ends[0] else { return Ok(None) };
        let steps = self.steps_to(from, (u64::MAX, 1), known)?.unwrap_or_default();
        let steps: Vec<Segment> = steps.into_iter().filter(moves).collect();
        Ok(Some(steps).filter(|steps| !steps.is_empty()))
    }

    /// The nodes near to one end, and what it seems to cost to come from there.
    fn access(&self, side: usize) -> Vec<Access> {
        let pose: ScanPose = scan_pose(self.ends[side].pose());
        let poses = &self.graph.roadmap.nodes.poses()[..self.graph.node_count()];
        let regrasps = if matches!(self.ends[side], Place::Grasp(_)) { REGRASPS } else { 0.0 };
        let near = nearest(poses, &pose, self.graph.turn_length, NEAR);
        let access = |(node, length)| Access { node, cost: regrasps + RISK * self.graph.cost_of(length) };
        near.into_iter().map(access).collect()
    }

    /// Whether the steps of all parts of a way are known now; a part that cannot be made is struck off.
    fn is_made(
        &self,
        way: &Way,
        access: &mut [Vec<Access>; 2],
        known: &mut Known,
    ) -> Result<bool, CallError> {
        for (side, node) in [(0, way.first), (1, way.last())] {
            if !known.ends[side].contains_key(&node) {
                let Some(steps) = self.end(side, node, known)? else {
                    access[side].retain(|access| access.node != node);
                    return Ok(false);
                };
                known.ends[side].insert(node, steps);
            }
        }
        for &(edge, _) in &way.edges {
            if !known.edges.contains_key(&edge) {
                let Some(steps) = self.edge(edge, known)? else {
                    known.dead.insert(edge);
                    return Ok(false);
                };
                known.edges.insert(edge, steps);
            }
        }
        Ok(true)
    }

    fn assembled(&self, way: &Way, known: &Known) -> Vec<Segment> {
        let mut all = reversed(known.ends[0][&way.first].clone());
        for (edge, node) in &way.edges {
            let steps = known.edges[edge].clone();
            let is_forward = self.graph.roadmap.links[*edge as usize].to == *node;
            all.extend(if is_forward { steps } else { reversed(steps) });
        }
        all.extend(known.ends[1][&way.last()].iter().cloned());
        all.into_iter().filter(moves).collect()
    }

    /// Steps from a node to an end.
    fn end(&self, side: usize, node: u32, known: &mut Known) -> Result<Option<Vec<Segment>>, CallError> {
        let Some(q) = self.graph.roadmap.nodes.get(self.task, node) else { return Ok(None) };
        self.steps_to(&q, (u64::from(node), side), known)
    }

    /// Steps of an edge, made as they were when it was found.
    fn edge(&self, edge: u32, known: &mut Known) -> Result<Option<Vec<Segment>>, CallError> {
        let roadmap = self.graph.roadmap;
        let link = roadmap.links[edge as usize];
        let ends = [link.from, link.to].map(|node| roadmap.nodes.get(self.task, node));
        let [Some(from), Some(to)] = ends else { return Ok(None) };
        let session = Session { seed: roadmap.seed, ..self.session };
        let found = session.counted(self.task, edge_key(link.from, link.to), |work| {
            joined(work, (link.kind, self.policy), &from, &to)
        });
        known.tally.add(&found.tally);
        found.result
    }

    /// Steps from `q`, the grasp of `node`, to an end.
    fn steps_to(
        &self,
        q: &Configuration,
        (node, side): (u64, usize),
        known: &mut Known,
    ) -> Result<Option<Vec<Segment>>, CallError> {
        let key = (Call::RoadmapEnd, node, self.leg << 1 | side as u64);
        let found = self.session.counted(self.task, key, |work| match &self.ends[side] {
            Place::Grasp(to) => joined(work, (EdgeKind::TransferRegrasp, self.policy), q, to),
            Place::Pose(X_HO) => rolled(work, q, X_HO),
        });
        known.tally.add(&found.tally);
        found.result
    }
}

/// One roll to a pose, which any grasp may end.
fn rolled(work: &mut Work<'_>, q: &Configuration, X_HO: &Pose) -> Result<Option<Vec<Segment>>, CallError> {
    let look = outlook(work.task, q, X_HO);
    if look.fraction < HOPE {
        work.context.reject(Slot::TransferPlanner, look.barred.unwrap_or(Reason::Reach));
        return Ok(None);
    }
    let (reached, segment) = transfer(work, q, X_HO)?;
    Ok(reached.is_complete().then(|| vec![segment]))
}
