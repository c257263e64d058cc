//! Algorithm 2: new nodes of GS_n, and their links to what is there.

use crate::search::{Sample, Search};
use crate::session::Call;
use regrasp_api::{
    CallError, Configuration, EdgeKind, EdgeVerdict, Effect, Link, NodeId, Origin, PoseRequest, Vicinity,
};

impl Search<'_> {
    /// A new node of GS_n, joined to the components that a path in GS_n reaches.
    pub fn explore(&mut self, link: Link) -> Result<Effect, CallError> {
        if self.state.drawn.is_empty() {
            let first = self.budget.anywhere;
            self.state.drawn = self.session.draw(self.session.threads(), |i| self.anywhere(first + i)).into();
        }
        let sample = self.state.drawn.pop_front().expect("at least one sample was drawn");
        self.budget.anywhere += 1;
        self.enter(sample, Origin::Explored, link)
    }

    /// A new node near an old one.
    pub fn extend(&mut self, node: NodeId, within: Vicinity, link: Link) -> Result<Effect, CallError> {
        let configuration = self.state.graph.node(node).clone();
        let key = (Call::Extend, self.leg.number as u64, self.budget.samples as u64);
        let sample = self.session.counted(&self.leg.task, key, |work| {
            let Vicinity { radius, angle } = within;
            let request = PoseRequest::Near { configuration: &configuration, radius, angle };
            let holding = configuration.holding();
            work.plugins.sampler.sample(work.task, request, holding, &mut work.context)
        });
        self.enter(sample, Origin::Extended(node), link)
    }

    /// The sample with number `k` of this leg.
    fn anywhere(&self, k: usize) -> Sample {
        let choices = self.leg.choices;
        self.session.counted(&self.leg.task, (Call::Sample, self.leg.number as u64, k as u64), |work| {
            let holding = choices[work.context.random.index(choices.len())];
            work.plugins.sampler.sample(work.task, PoseRequest::Anywhere, holding, &mut work.context)
        })
    }

    /// Takes a sample into the graph.
    fn enter(&mut self, sample: Sample, origin: Origin, link: Link) -> Result<Effect, CallError> {
        self.budget.samples += 1;
        self.state.tally.add(&sample.tally);
        let effect = match sample.result? {
            Some(q) => self.add(q, origin, link)?,
            None => Effect::Failed,
        };
        self.more_goals()?;
        Ok(effect)
    }

    fn add(&mut self, q: Configuration, origin: Origin, link: Link) -> Result<Effect, CallError> {
        self.budget.generated += 1;
        let node = self.state.graph.add_node(q, origin);
        let mut keep = true;
        match link {
            Link::Components => _ = self.link_components(node)?,
            Link::ComponentsOrDrop => keep = self.link_components(node)? > 0,
            Link::Unchecked(count) => self.link_unchecked(node, count),
            Link::None => {}
        }
        if !keep {
            self.state.graph.drop_newest();
            return Ok(Effect::Failed);
        }
        self.budget.kept += 1;
        Ok(Effect::Done)
    }

    /// Lines 3 to 9 of Algorithm 2: tries the nearest node of each component; how many of them it reached.
    fn link_components(&mut self, node: NodeId) -> Result<usize, CallError> {
        let mut reached = 0;
        let near = self.nearest_of_each_component(node, |other| self.same_fingers(other, node));
        let paths = self.session.ahead(near.len(), |i| self.grasp_path(near[i], node)).collect::<Vec<_>>();
        for (&other, path) in near.iter().zip(paths) {
            self.state.tally.add(&path.tally);
            self.state.graph.mark_tried(other, node, EdgeKind::Grasp);
            if path.result? {
                self.state.graph.add_edge(other, node, EdgeKind::Grasp, EdgeVerdict::Valid);
                reached += 1;
            }
        }
        Ok(reached)
    }

    fn link_unchecked(&mut self, node: NodeId, count: usize) {
        let graph = &*self.state.graph;
        let mut others: Vec<_> =
            graph.ids().filter(|&other| other != node && self.same_fingers(other, node)).collect();
        others.sort_by(|&a, &b| graph.distance(a, node).total_cmp(&graph.distance(b, node)));
        for other in others.into_iter().take(count) {
            self.state.graph.add_edge(other, node, EdgeKind::Grasp, EdgeVerdict::Unchecked);
        }
    }

    /// The node nearest to `node` in each component but its own, of those that are `wanted`.
    pub fn nearest_of_each_component(&self, node: NodeId, wanted: impl Fn(NodeId) -> bool) -> Vec<NodeId> {
        let graph = &*self.state.graph;
        let mut best: Vec<Option<(f64, NodeId)>> = vec![None; graph.node_count()];
        let own = graph.component(node);
        for other in graph.ids() {
            let component = graph.component(other);
            if component == own || !wanted(other) {
                continue;
            }
            let distance = graph.distance(other, node);
            let place = &mut best[component.0 as usize];
            if place.is_none_or(|(least, _)| distance < least) {
                *place = Some((distance, other));
            }
        }
        best.into_iter().flatten().map(|(_, nearest)| nearest).collect()
    }

    /// Another grasp at the goal's pose from time to time: the ones that were found may all be bad ones.
    fn more_goals(&mut self) -> Result<(), CallError> {
        let period = self.leg.policy.samples_per_goal;
        if period == 0 || !self.budget.samples.is_multiple_of(period) {
            return Ok(());
        }
        let Some(finder) = &mut self.state.finder else { return Ok(()) };
        let leg = &self.leg;
        if let Some(q) = finder.next(self.session, &leg.task, leg.choices, self.state.tally)? {
            let node = self.state.graph.add_node(q, Origin::Goal);
            self.state.goals.push(node);
        }
        Ok(())
    }
}
