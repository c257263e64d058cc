//! The graph as the strategy of one leg sees it.

use crate::graph::Graph;
use crate::shortest_path::shortest_path;
use regrasp_api::{
    ComponentId, Configuration, EdgeId, EdgeKind, EdgeView, GraphView, NodeId, Origin, PastAction,
};

/// The graph as the strategy of one leg sees it.
pub(crate) struct LegView<'a> {
    pub graph: &'a Graph,
    pub start: NodeId,
    pub goals: &'a [NodeId],
    pub samples: (usize, usize),
    pub history: &'a [PastAction],
}

impl GraphView for LegView<'_> {
    fn node_count(&self) -> usize {
        self.graph.node_count()
    }
    fn samples(&self) -> (usize, usize) {
        self.samples
    }
    fn start(&self) -> NodeId {
        self.start
    }
    fn configuration(&self, node: NodeId) -> &Configuration {
        self.graph.node(node)
    }
    fn origin(&self, node: NodeId) -> Origin {
        self.graph.origin(node)
    }
    fn history(&self) -> &[PastAction] {
        self.history
    }
    fn goals(&self) -> &[NodeId] {
        self.goals
    }
    fn component(&self, node: NodeId) -> ComponentId {
        self.graph.component(node)
    }
    fn components(&self) -> &[ComponentId] {
        self.graph.components()
    }
    fn joined(&self) -> bool {
        let start = self.graph.component(self.start);
        self.goals.iter().any(|&goal| self.graph.component(goal) == start)
    }
    fn distance(&self, a: NodeId, b: NodeId) -> f64 {
        self.graph.distance(a, b)
    }
    fn attempted(&self, a: NodeId, b: NodeId, kind: EdgeKind) -> bool {
        self.graph.was_tried(a, b, kind)
    }
    fn edges(&self) -> &[EdgeView] {
        self.graph.edges()
    }
    fn shortest_path(&self) -> Vec<EdgeId> {
        let path = shortest_path(self.graph, self.start, self.goals).unwrap_or_default();
        path.into_iter().map(|step| step.edge).collect()
    }
}
