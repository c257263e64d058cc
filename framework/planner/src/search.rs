//! Algorithm 1: explores GS_n and connects its components until start and goal are joined by an executable path.
//!
//! A search is what is searched ([`Leg`]), how far it is ([`State`]), and what it may spend ([`Budget`]). Its other parts stand in files
//! of their own: Algorithm 2 in `explore`, Algorithm 3 in `connect`, the query in `query`.

use crate::endpoints::Finder;
use crate::graph::Graph;
use crate::session::{Call, Counted, Session};
use crate::view::LegView;
use regrasp_abi::GuardedService;
use regrasp_api::{
    Action, CallError, Configuration, EdgeId, FingerSet, GraphView, NodeId, Slot, Tally, Target, Task,
};
use regrasp_plan::Segment;
use std::collections::VecDeque;

/// What is searched: the way from one node to a goal.
#[derive(Clone, Copy)]
pub(crate) struct Leg<'a> {
    /// Its number, from 0.
    pub number: usize,
    /// The task; its landmarks are the poses of the leg's two ends.
    pub task: Task<'a>,
    /// The node that it begins in.
    pub start: NodeId,
    /// The sets of fingers that may hold the object.
    pub choices: &'a [FingerSet],
}

/// How far a search is.
pub(crate) struct State<'a> {
    /// The manipulation graph, MG.
    pub graph: &'a mut Graph,
    /// The nodes at the goal's pose.
    pub goals: Vec<NodeId>,
    /// Finds more grasps at the goal's pose, if the goal is given by its pose alone.
    pub finder: Option<Finder>,
    /// Samples drawn ahead of their turn.
    pub drawn: VecDeque<Sample>,
    /// What the calls counted that were consumed.
    pub tally: &'a mut Tally,
    /// The edges of the way that was found.
    pub used: Vec<EdgeId>,
}

/// What a search may spend, and has spent.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Budget {
    /// Most samples.
    pub most: usize,
    /// Samples asked for, whether they gave a node or not.
    pub samples: usize,
    /// Those of them that were drawn anywhere; counted apart, for what is drawn ahead must not change its number when nodes are extended
    /// in between.
    pub anywhere: usize,
    /// Nodes that samples gave.
    pub generated: usize,
}

/// The search of one leg.
pub(crate) struct Search<'a> {
    pub session: &'a Session<'a>,
    pub progress: &'a dyn crate::Progress,
    pub leg: Leg<'a>,
    pub state: State<'a>,
    pub budget: Budget,
}

/// A sample that was drawn, and what it counted.
pub(crate) type Sample = Counted<Result<Option<Configuration>, CallError>>;

impl Search<'_> {
    /// Runs until a path is found and decomposed (its segments), or the strategy or the budget ends the search (`None`).
    pub fn run(&mut self) -> Result<Option<Vec<Segment>>, CallError> {
        for step in 0.. {
            self.session.proceed()?;
            let graph = &self.state.graph;
            self.progress.search(self.leg.number, graph.node_count(), graph.components().len());
            match self.decide(step)? {
                Action::Explore(link) => self.explore(link)?,
                Action::Extend(node, link) => self.extend(node, link)?,
                Action::Connect(a, b, kind) => self.connect(a, b, kind)?,
                Action::Check(edge) => self.check(edge)?,
                Action::Query => {
                    if let Some(segments) = self.query()? {
                        return Ok(Some(segments));
                    }
                }
                Action::Stop => return Ok(None),
                unknown => return Err(contract(format!("{unknown:?}, which this planner does not know"))),
            }
        }
        Ok(None)
    }

    fn decide(&mut self, step: u64) -> Result<Action, CallError> {
        let view = LegView {
            graph: self.state.graph,
            start: self.leg.start,
            goals: &self.state.goals,
            generated: (self.budget.samples, self.budget.most),
        };
        let view = GuardedService(&view as &dyn GraphView);
        let key = (Call::Strategy, self.leg.number as u64, step);
        let decided = self
            .session
            .counted(&self.leg.task, key, |work| work.plugins.strategy.next(&view, &mut work.context));
        self.state.tally.add(&decided.tally);
        decided.result.and_then(|action| self.refuse_unknown_nodes(action))
    }

    /// An action on nodes that are in the graph.
    fn refuse_unknown_nodes(&self, action: Action) -> Result<Action, CallError> {
        let nodes = self.state.graph.node_count();
        let known = |node: NodeId| (node.0 as usize) < nodes;
        let sound = match action {
            Action::Extend(node, _) => known(node),
            Action::Connect(a, b, _) => known(a) && known(b) && a != b,
            _ => true,
        };
        if sound { Ok(action) } else { Err(contract(format!("{action:?} with {nodes} nodes in the graph"))) }
    }

    /// Whether two nodes are held by the same fingers: only then can a path in GS_n join them.
    pub fn same_fingers(&self, a: NodeId, b: NodeId) -> bool {
        self.state.graph.node(a).holding() == self.state.graph.node(b).holding()
    }

    /// Whether a path in GS_n joins two nodes.
    pub fn grasp_path(&self, a: NodeId, b: NodeId) -> Counted<Result<bool, CallError>> {
        let (from, to) = (self.state.graph.node(a), self.state.graph.node(b));
        let key = (Call::Grasp, u64::from(a.0), u64::from(b.0));
        self.session.counted(&self.leg.task, key, |work| {
            let target = Target::Grasp(to);
            let reached = work.plugins.grasp.connect(work.task, from, &target, None, &mut work.context)?;
            Ok(reached.is_complete())
        })
    }
}

/// What the strategy asked for cannot be done.
fn contract(reason: String) -> CallError {
    CallError::Contract { plugin: Slot::GraphStrategy.name().into(), reason }
}
