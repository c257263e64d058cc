//! Algorithm 1: explores GS_n and connects its components until start and goal are joined by an executable path.

use crate::decompose::decompose;
use crate::endpoints::Finder;
use crate::graph::{Graph, LegView};
use crate::meet;
use crate::query::{Step, shortest_path};
use crate::session::{Call, Counted, Session};
use crate::steps;
use regrasp_api::{
    Action, CallError, Configuration, EdgeId, EdgeKind, EdgeVerdict, FingerSet, GraphView, GuardedService,
    Link, NodeId, PoseRequest, Slot, Tally, Target, Task,
};
use regrasp_plan::Segment;
use std::collections::VecDeque;

/// After this many more samples another grasp is looked for at a goal that is given by its pose alone.
const SAMPLES_PER_GOAL: usize = 10;

/// The search of one leg, from one start to the nodes of one goal.
pub(crate) struct Search<'a> {
    pub session: &'a Session<'a>,
    pub task: Task<'a>,
    pub graph: &'a mut Graph,
    pub tally: &'a mut Tally,
    pub leg: u64,
    pub start: NodeId,
    pub goals: Vec<NodeId>,
    /// Finds more grasps at the goal's pose, if the goal is given by its pose alone.
    pub finder: Option<Finder>,
    /// The sets of fingers that may hold the object.
    pub choices: &'a [FingerSet],
    pub max_nodes: usize,
    pub progress: &'a dyn crate::Progress,
    /// Samples drawn ahead of their turn.
    pub drawn: VecDeque<Sample>,
    pub generated: usize,
    /// Samples anywhere, counted apart: those drawn ahead must not change their numbers when nodes are extended in between.
    pub explored: usize,
    pub samples: usize,
    /// The edges of the way that was found.
    pub used: Vec<EdgeId>,
}

type Sample = Counted<Result<Option<Configuration>, CallError>>;
type Decomposed = Counted<Result<Option<Vec<Segment>>, CallError>>;

impl Search<'_> {
    /// Runs until a path is found and decomposed (its segments), or the strategy or the budget ends the search (`None`).
    pub fn run(&mut self) -> Result<Option<Vec<Segment>>, CallError> {
        for step in 0.. {
            self.session.context(Call::Strategy, 0, 0).proceed()?;
            self.progress.search(self.leg as usize, self.graph.node_count(), self.graph.components().len());
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
                _ => break,
            }
        }
        Ok(None)
    }

    fn decide(&mut self, step: u64) -> Result<Action, CallError> {
        let view = LegView {
            graph: self.graph,
            start: self.start,
            goals: &self.goals,
            generated: (self.samples, self.max_nodes),
        };
        let view = GuardedService(&view as &dyn GraphView);
        let decided = self.session.counted(Call::Strategy, self.leg, step, |context| {
            self.session.drivers.strategy.next(&view, context)
        });
        self.tally.add(&decided.tally);
        decided.result.and_then(|action| self.refuse_unknown_nodes(action))
    }

    /// An action on nodes that are in the graph.
    fn refuse_unknown_nodes(&self, action: Action) -> Result<Action, CallError> {
        let known = |node: NodeId| (node.0 as usize) < self.graph.node_count();
        let sound = match action {
            Action::Extend(node, _) => known(node),
            Action::Connect(a, b, _) => known(a) && known(b) && a != b,
            _ => true,
        };
        if sound {
            return Ok(action);
        }
        let reason = format!("{action:?} with {} nodes in the graph", self.graph.node_count());
        Err(CallError::Contract { plugin: Slot::GraphStrategy.name().into(), reason })
    }

    /// Algorithm 2: a new node of GS_n, joined to the components that a path in GS_n reaches.
    fn explore(&mut self, link: Link) -> Result<(), CallError> {
        if self.drawn.is_empty() {
            let first = self.explored;
            self.drawn = self.session.draw(self.session.threads(), |i| self.sample(first + i)).into();
        }
        let sample = self.drawn.pop_front().expect("at least one sample was drawn");
        self.explored += 1;
        self.samples += 1;
        self.tally.add(&sample.tally);
        if let Some(q) = sample.result? {
            self.add(q, link)?;
        }
        self.more_goals()
    }

    /// The sample with number `k` of this leg.
    fn sample(&self, k: usize) -> Sample {
        self.session.counted(Call::Sample, self.leg, k as u64, |context| {
            let holding = self.choices[context.random.index(self.choices.len())];
            self.session.drivers.sampler.sample(&self.task, PoseRequest::Anywhere, holding, context)
        })
    }

    /// A new node near an old one.
    fn extend(&mut self, node: NodeId, link: Link) -> Result<(), CallError> {
        let configuration = self.graph.node(node).clone();
        let sample = self.session.counted(Call::Extend, self.leg, self.samples as u64, |context| {
            let request = PoseRequest::Near { configuration: &configuration, radius: 0.01, angle: 0.5 };
            self.session.drivers.sampler.sample(&self.task, request, configuration.holding(), context)
        });
        self.samples += 1;
        self.tally.add(&sample.tally);
        if let Some(q) = sample.result? {
            self.add(q, link)?;
        }
        self.more_goals()
    }

    fn add(&mut self, q: Configuration, link: Link) -> Result<(), CallError> {
        self.generated += 1;
        let node = self.graph.add_node(q);
        match link {
            Link::Components => self.link_components(node),
            Link::Unchecked(count) => {
                self.link_unchecked(node, count);
                Ok(())
            }
            Link::None => Ok(()),
        }
    }

    /// Lines 3 to 9 of Algorithm 2: tries the nearest node of each component.
    fn link_components(&mut self, node: NodeId) -> Result<(), CallError> {
        let near = self.nearest_of_each_component(node);
        let verdicts: Vec<_> = {
            let (graph, session, task) = (&*self.graph, self.session, &self.task);
            session.ahead(near.len(), |i| grasp_path(session, task, graph, near[i], node)).collect()
        };
        for (&other, verdict) in near.iter().zip(verdicts) {
            self.tally.add(&verdict.tally);
            self.graph.mark_tried(other, node, EdgeKind::Grasp);
            if verdict.result? {
                self.graph.add_edge(other, node, EdgeKind::Grasp, EdgeVerdict::Valid);
            }
        }
        Ok(())
    }

    fn link_unchecked(&mut self, node: NodeId, count: usize) {
        let mut others: Vec<_> =
            (0..node.0).map(NodeId).filter(|&other| self.same_fingers(other, node)).collect();
        others.sort_by(|&a, &b| self.graph.distance(a, node).total_cmp(&self.graph.distance(b, node)));
        for other in others.into_iter().take(count) {
            self.graph.add_edge(other, node, EdgeKind::Grasp, EdgeVerdict::Unchecked);
        }
    }

    fn nearest_of_each_component(&self, node: NodeId) -> Vec<NodeId> {
        let mut best: Vec<Option<(f64, NodeId)>> = vec![None; self.graph.node_count()];
        let own = self.graph.component(node);
        for other in (0..self.graph.node_count() as u32).map(NodeId) {
            let component = self.graph.component(other);
            if component == own || !self.same_fingers(other, node) {
                continue;
            }
            let distance = self.graph.distance(other, node);
            let place = &mut best[component.0 as usize];
            if place.is_none_or(|(least, _)| distance < least) {
                *place = Some((distance, other));
            }
        }
        best.into_iter().flatten().map(|(_, nearest)| nearest).collect()
    }

    fn same_fingers(&self, a: NodeId, b: NodeId) -> bool {
        self.graph.node(a).holding() == self.graph.node(b).holding()
    }

    fn connect(&mut self, a: NodeId, b: NodeId, kind: EdgeKind) -> Result<(), CallError> {
        self.graph.mark_tried(a, b, kind);
        match kind {
            EdgeKind::Grasp if !self.same_fingers(a, b) => Ok(()),
            EdgeKind::Grasp => {
                let verdict = grasp_path(self.session, &self.task, self.graph, a, b);
                self.tally.add(&verdict.tally);
                if verdict.result? {
                    self.graph.add_edge(a, b, kind, EdgeVerdict::Valid);
                }
                Ok(())
            }
            EdgeKind::TransferRegrasp => self.connect_outside(a, b),
        }
    }

    /// Algorithm 3: transfer and regrasps between nodes of two components.
    fn connect_outside(&mut self, a: NodeId, b: NodeId) -> Result<(), CallError> {
        let (from, to) = (self.graph.node(a), self.graph.node(b));
        let found = self.session.counted(Call::TransferRegrasp, u64::from(a.0), u64::from(b.0), |context| {
            meet::connect(self.session, &self.task, from, to, context)
        });
        self.tally.add(&found.tally);
        if let Some(segments) = found.result? {
            let edge = self.graph.add_edge(a, b, EdgeKind::TransferRegrasp, EdgeVerdict::Executable);
            self.graph.set_steps(edge, segments);
        }
        Ok(())
    }

    fn check(&mut self, id: EdgeId) -> Result<(), CallError> {
        let Some(&edge) = self.graph.edge(id) else { return Ok(()) };
        if edge.verdict != EdgeVerdict::Unchecked {
            return Ok(());
        }
        let verdict = grasp_path(self.session, &self.task, self.graph, edge.from, edge.to);
        self.tally.add(&verdict.tally);
        if verdict.result? {
            self.graph.set_verdict(id, EdgeVerdict::Valid);
        } else {
            self.graph.remove_edge(id);
        }
        Ok(())
    }

    /// Searches a path and decomposes its edges; the first that fails leaves the graph, and the search goes on.
    fn query(&mut self) -> Result<Option<Vec<Segment>>, CallError> {
        let Some(path) = shortest_path(self.graph, self.start, &self.goals) else { return Ok(None) };
        let todo: Vec<_> = path.iter().filter(|step| self.graph.steps(step.edge).is_none()).collect();
        let decomposed = self.decompose_until_failure(&todo);
        for (step, found) in todo.iter().zip(decomposed) {
            self.tally.add(&found.tally);
            match found.result? {
                Some(segments) => self.graph.set_steps(step.edge, segments),
                None => {
                    self.graph.remove_edge(step.edge);
                    return Ok(None);
                }
            }
        }
        self.used = path.iter().map(|step| step.edge).collect();
        Ok(Some(self.assemble(&path)))
    }

    /// The decompositions of a path's edges in turn, up to and including the first that fails.
    fn decompose_until_failure(&self, todo: &[&Step]) -> Vec<Decomposed> {
        let mut decomposed = Vec::new();
        for found in self.session.ahead(todo.len(), |i| self.decompose(todo[i].edge)) {
            let failed = !matches!(found.result, Ok(Some(_)));
            decomposed.push(found);
            if failed {
                break;
            }
        }
        decomposed
    }

    fn decompose(&self, id: EdgeId) -> Decomposed {
        let edge = self.graph.edge(id).expect("the path's edges are in the graph");
        let (from, to) = (self.graph.node(edge.from), self.graph.node(edge.to));
        let key = (u64::from(edge.from.0), u64::from(edge.to.0));
        self.session.counted(Call::Decompose, key.0, key.1, |context| {
            decompose(self.session, &self.task, from, to, context)
        })
    }

    fn assemble(&self, path: &[Step]) -> Vec<Segment> {
        let steps_of = |step: &Step| {
            let steps = self.graph.steps(step.edge).expect("every edge of the path was decomposed").to_vec();
            if step.forward { steps } else { steps::reversed(steps) }
        };
        path.iter().flat_map(steps_of).filter(steps::moves).collect()
    }

    /// Another grasp at the goal's pose from time to time: the ones that were found may all be bad ones.
    fn more_goals(&mut self) -> Result<(), CallError> {
        if !self.samples.is_multiple_of(SAMPLES_PER_GOAL) {
            return Ok(());
        }
        let Some(finder) = &mut self.finder else { return Ok(()) };
        if let Some(q) = finder.next(self.session, &self.task, self.choices, self.tally)? {
            let node = self.graph.add_node(q);
            self.goals.push(node);
        }
        Ok(())
    }
}

/// Whether a path in GS_n joins two nodes.
fn grasp_path(
    session: &Session<'_>,
    task: &Task<'_>,
    graph: &Graph,
    a: NodeId,
    b: NodeId,
) -> Counted<Result<bool, CallError>> {
    session.counted(Call::Grasp, u64::from(a.0), u64::from(b.0), |context| {
        let target = Target::Grasp(graph.node(b));
        let reached = session.drivers.grasp.connect(task, graph.node(a), &target, None, context)?;
        Ok(reached.is_complete())
    })
}
