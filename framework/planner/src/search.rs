//! Algorithm 1: explores GS_n and connects its components until start and goal are joined by an executable
//! path.
//!
//! A search is what is searched ([`Leg`]), how far it is ([`State`]), and what it may spend ([`Budget`]). Its
//! other parts stand in files of their own: Algorithm 2 in `explore`, Algorithm 3 in `connect`, the query in
//! `query`.

use crate::endpoints::Finder;
use crate::graph::Graph;
use crate::history::Before;
use crate::session::{Call, Counted, Session};
use crate::view::LegView;
use regrasp_abi::GuardedService;
use regrasp_api::{
    Action, CallError, Configuration, EdgeId, EdgeVerdict, Effect, FingerSet, GraphView, NodeId, PastAction,
    SearchPolicy, Slot, Tally, Target, Task, Vicinity,
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
    /// How the strategy wants its actions carried out.
    pub policy: SearchPolicy,
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
    /// What was done on this leg.
    pub history: Vec<PastAction>,
    /// What the user should know.
    pub warnings: &'a mut Vec<String>,
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
    /// Those of them that were drawn anywhere; counted apart, for what is drawn ahead must not change its
    /// number when nodes are extended in between.
    pub anywhere: usize,
    /// Nodes that samples gave, kept or not.
    pub generated: usize,
    /// Those of them that were kept.
    pub kept: usize,
    /// Actions that could change nothing.
    pub futile: usize,
    /// Decompositions of paths in GS_n, and how many of them failed.
    pub decompositions: (usize, usize),
    /// Rounds that were begun.
    pub rounds: u64,
    /// The number of samples at which the round is over; none where rounds have no end.
    pub round_end: Option<usize>,
}

impl Budget {
    /// Begins the next round: its length in units of `unit` samples follows the sequence 1, 1, 2, 1, 1, 2, 4,
    /// … of M. Luby, A. Sinclair, D. Zuckerman, "Optimal speedup of Las Vegas algorithms", IPL 1993: whatever
    /// the distribution of a search's length, no schedule is better by more than a logarithm. `unit` = 0
    /// means one round without an end. Before the sequence there is a round of `first` samples, unless that
    /// is 0.
    pub fn begin_round(&mut self, unit: usize, first: usize) {
        self.rounds += 1;
        let length = match self.rounds - u64::from(first > 0) {
            0 => first,
            place => unit * luby(place) as usize,
        };
        self.round_end = (unit > 0).then_some(self.samples + length);
    }

    fn round_is_over(&self) -> bool {
        self.samples < self.most && self.round_end.is_some_and(|end| self.samples >= end)
    }
}

/// The `i`-th number, from 1, of Luby's sequence.
fn luby(i: u64) -> u64 {
    let next_power = (i + 1).next_power_of_two();
    if next_power == i + 1 { next_power / 2 } else { luby(i + 1 - next_power / 2) }
}

/// The search of one leg.
pub(crate) struct Search<'a> {
    pub session: &'a Session<'a>,
    pub progress: &'a dyn crate::Progress,
    pub leg: Leg<'a>,
    pub state: State<'a>,
    pub budget: &'a mut Budget,
}

/// How a round of a search ended.
pub(crate) enum Ended {
    /// With an executable way.
    Found(Vec<Segment>),
    /// The strategy gave up, or the budget is spent.
    Stopped,
    /// It has grown long enough: another round may have better luck.
    Anew,
}

/// A sample that was drawn, and what it counted.
pub(crate) type Sample = Counted<Result<Option<Configuration>, CallError>>;

impl Search<'_> {
    /// Runs until a path is found and decomposed, the strategy or the budget ends the search, or the round is
    /// over.
    pub fn run(&mut self) -> Result<Ended, CallError> {
        for step in 0.. {
            if self.budget.round_is_over() {
                break;
            }
            self.session.proceed()?;
            let graph = &self.state.graph;
            self.progress.search(self.leg.number, graph.node_count(), graph.components().len());
            let action = self.decide(step)?;
            if self.is_over(action) {
                return Ok(Ended::Stopped);
            }
            let before = Before::of(self.state.graph, self.state.tally);
            let (effect, found) = self.act(action)?;
            if let Some(segments) = found {
                return Ok(Ended::Found(segments));
            }
            self.budget.futile += usize::from(effect == Effect::Futile);
            let past = before.past(self.state.graph, self.state.tally, action, effect);
            self.state.history.push(past);
        }
        Ok(Ended::Anew)
    }

    /// Whether the search ends before this action: the strategy gives up, or its budget is spent.
    fn is_over(&mut self, action: Action) -> bool {
        let Budget { most, samples, futile, .. } = *self.budget;
        let why = match action {
            Action::Stop => return true,
            Action::Explore(_) | Action::Extend(..) if samples >= most => {
                format!("it goes on sampling after {most} samples, the budget of nodes")
            }
            _ if futile > most => format!("{futile} of its actions could change nothing, at last {action:?}"),
            _ => return false,
        };
        let goal = self.leg.number;
        self.state
            .warnings
            .push(format!("the graph strategy was stopped on the way to `goal[{goal}]`: {why}"));
        true
    }

    /// Does what the strategy wants; the segments of the way where a query found one.
    fn act(&mut self, action: Action) -> Result<(Effect, Option<Vec<Segment>>), CallError> {
        if self.is_futile(action) {
            return Ok((Effect::Futile, None));
        }
        let effect = match action {
            Action::Explore(link) => self.explore(link)?,
            Action::Extend(node, within, link) => self.extend(node, within, link)?,
            Action::Connect(a, b, kind) => self.connect(a, b, kind)?,
            Action::ConnectAll(node, kind) => self.connect_all(node, kind)?,
            Action::Check(edge) => self.check(edge)?,
            Action::Query => {
                let found = self.query()?;
                return Ok((if found.is_some() { Effect::Done } else { Effect::Failed }, found));
            }
            unknown => return Err(contract(format!("{unknown:?}, which this planner does not know"))),
        };
        Ok((effect, None))
    }

    /// Whether an action can change nothing: the same call gives the same answer for ever.
    fn is_futile(&self, action: Action) -> bool {
        let graph = &self.state.graph;
        match action {
            Action::Connect(a, b, kind) => graph.was_tried(a, b, kind),
            Action::ConnectAll(node, kind) => self.nearest_untried(node, kind).is_empty(),
            Action::Check(id) => graph.edge(id).is_none_or(|edge| edge.verdict != EdgeVerdict::Unchecked),
            Action::Query => !self.view().joined(),
            _ => false,
        }
    }

    fn view(&self) -> LegView<'_> {
        LegView {
            graph: self.state.graph,
            start: self.leg.start,
            goals: &self.state.goals,
            samples: (self.budget.samples, self.budget.most),
            history: &self.state.history,
        }
    }

    fn decide(&mut self, step: u64) -> Result<Action, CallError> {
        let view = self.view();
        let view = GuardedService::guarding("service/graph", &view as &dyn GraphView);
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
            Action::Extend(node, Vicinity { radius, angle }, _) => {
                let sound = |size: f64| size.is_finite() && size > 0.0;
                known(node) && sound(radius) && sound(angle)
            }
            Action::ConnectAll(node, _) => known(node),
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounds_follow_lubys_sequence() {
        let first: Vec<u64> = (1..=15).map(luby).collect();
        assert_eq!(first, [1, 1, 2, 1, 1, 2, 4, 1, 1, 2, 1, 1, 2, 4, 8]);
    }

    #[test]
    fn a_round_ends_at_its_samples_and_the_budget_ends_the_last() {
        let mut budget = Budget { most: 100, ..Default::default() };
        budget.begin_round(40, 0);
        budget.samples = 39;
        assert!(!budget.round_is_over());
        budget.samples = 40;
        assert!(budget.round_is_over());
        budget.begin_round(40, 0);
        budget.begin_round(40, 0);
        budget.samples = 119;
        assert!(!budget.round_is_over(), "the strategy stops at the budget of all rounds");
        budget.begin_round(0, 0);
        budget.samples = 99;
        assert!(!budget.round_is_over());
        let ends = [15, 55, 95, 175].map(Some);
        let mut budget = Budget { most: 1000, ..Default::default() };
        for end in ends {
            budget.begin_round(40, 15);
            assert_eq!(budget.round_end, end);
            budget.samples = end.unwrap_or_default();
        }
    }
}
