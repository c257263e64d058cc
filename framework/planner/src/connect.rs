//! Algorithm 3: edges between nodes that are there.

use crate::joined::joined;
use crate::search::Search;
use crate::session::Call;
use regrasp_api::{CallError, EdgeId, EdgeKind, EdgeVerdict, Effect, NodeId};

impl Search<'_> {
    /// Tries an edge of the given kind between two nodes.
    pub fn connect(&mut self, a: NodeId, b: NodeId, kind: EdgeKind) -> Result<Effect, CallError> {
        self.state.graph.mark_tried(a, b, kind);
        match kind {
            EdgeKind::Grasp if !self.same_fingers(a, b) => Ok(Effect::Failed),
            EdgeKind::Grasp => self.connect_inside(a, b),
            EdgeKind::TransferRegrasp => self.connect_outside(a, b),
        }
    }

    /// Algorithm 3 as a whole: tries the nearest node of each component but that of `node`.
    pub fn connect_all(&mut self, node: NodeId, kind: EdgeKind) -> Result<Effect, CallError> {
        let mut effect = Effect::Failed;
        for other in self.nearest_untried(node, kind) {
            // An edge found on the way may have joined this component too.
            if self.state.graph.component(other) != self.state.graph.component(node)
                && self.connect(node, other, kind)? == Effect::Done
            {
                effect = Effect::Done;
            }
        }
        Ok(effect)
    }

    /// The nearest node of each other component that was not tried with `node`.
    pub fn nearest_untried(&self, node: NodeId, kind: EdgeKind) -> Vec<NodeId> {
        self.nearest_of_each_component(node, |other| !self.state.graph.was_tried(node, other, kind))
    }

    /// By a path in GS_n.
    fn connect_inside(&mut self, a: NodeId, b: NodeId) -> Result<Effect, CallError> {
        let path = self.grasp_path(a, b);
        self.state.tally.add(&path.tally);
        if !path.result? {
            return Ok(Effect::Failed);
        }
        self.state.graph.add_edge(a, b, EdgeKind::Grasp, EdgeVerdict::Valid);
        Ok(Effect::Done)
    }

    /// Line 4 of Algorithm 3: by transfers and regrasps.
    fn connect_outside(&mut self, a: NodeId, b: NodeId) -> Result<Effect, CallError> {
        let (from, to) = (self.state.graph.node(a), self.state.graph.node(b));
        let key = (Call::TransferRegrasp, u64::from(a.0), u64::from(b.0));
        let how = (EdgeKind::TransferRegrasp, &self.leg.policy);
        let found = self.session.counted(&self.leg.task, key, |work| joined(work, how, from, to));
        self.state.tally.add(&found.tally);
        let Some(segments) = found.result? else { return Ok(Effect::Failed) };
        let graph = &mut self.state.graph;
        let edge = graph.add_edge(a, b, EdgeKind::TransferRegrasp, EdgeVerdict::Executable);
        graph.set_steps(edge, segments);
        Ok(Effect::Done)
    }

    /// Checks an edge that was entered without a check; if it fails it leaves the graph.
    pub fn check(&mut self, id: EdgeId) -> Result<Effect, CallError> {
        let Some(&edge) = self.state.graph.edge(id) else { return Ok(Effect::Futile) };
        let path = self.grasp_path(edge.from, edge.to);
        self.state.tally.add(&path.tally);
        if path.result? {
            self.state.graph.set_verdict(id, EdgeVerdict::Valid);
            Ok(Effect::Done)
        } else {
            self.state.graph.remove_edge(id);
            Ok(Effect::Failed)
        }
    }
}
