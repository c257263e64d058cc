//! The manipulation graph as a run left it, for those who want to look at it.

use crate::error::End;
use crate::graph::Graph;
use regrasp_api::{ComponentId, Configuration, EdgeId, EdgeKind, EdgeVerdict, NodeId};
use std::collections::BTreeSet;

/// The manipulation graph at the end of a run.
///
/// It is the planner's own graph, handed out instead of dropped: to have it costs a run nothing, and what is
/// asked of it is computed then.
pub struct GraphRecord {
    graph: Graph,
    ends: Vec<(End, NodeId)>,
    used: BTreeSet<EdgeId>,
}

/// Two nodes that the planner tried to join.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct EdgeRecord {
    /// The end of smaller number.
    pub from: NodeId,
    /// The other end.
    pub to: NodeId,
    /// How they were to be joined.
    pub kind: EdgeKind,
    /// What came of it.
    pub fate: Fate,
}

/// What came of an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Fate {
    /// No path was found, or it could not be decomposed into transfers and regrasps.
    Failed,
    /// Entered into the graph, but never checked.
    Unchecked,
    /// A path in GS_n joins the nodes; nobody asked whether it can be decomposed.
    Valid,
    /// Transfers and regrasps that join the nodes are known.
    Executable,
    /// Executable, and part of the way that was found.
    Used,
}

impl GraphRecord {
    pub(crate) fn new(graph: Graph, ends: Vec<(End, NodeId)>, used: BTreeSet<EdgeId>) -> Self {
        Self { graph, ends, used }
    }

    /// The configurations of the nodes; a node's number is its place here.
    pub fn nodes(&self) -> &[Configuration] {
        self.graph.nodes()
    }

    /// The component of a node of this graph: the smallest number of a node in it.
    pub fn component(&self, node: NodeId) -> ComponentId {
        self.graph.component(node)
    }

    /// For each node its component by paths in GS_n alone: the smallest number of a node in it.
    pub fn grasp_components(&self) -> Vec<ComponentId> {
        self.graph.grasp_labels()
    }

    /// The nodes that were made for start and goals, in the order in which they were.
    pub fn ends(&self) -> &[(End, NodeId)] {
        &self.ends
    }

    /// Everything that was tried, by nodes and kind; what left the graph again counts as failed.
    pub fn edges(&self) -> Vec<EdgeRecord> {
        let key = |from: NodeId, to: NodeId, kind| (from.min(to), from.max(to), kind);
        let inside = self.graph.edges().iter();
        let mut records: Vec<_> = inside
            .map(|edge| {
                let (from, to, kind) = key(edge.from, edge.to, edge.kind);
                EdgeRecord { from, to, kind, fate: self.fate(edge.id, edge.verdict) }
            })
            .collect();
        let kept: BTreeSet<_> = records.iter().map(|edge| key(edge.from, edge.to, edge.kind)).collect();
        let failed = self.graph.tried().filter(|edge| !kept.contains(edge));
        records.extend(failed.map(|(from, to, kind)| EdgeRecord { from, to, kind, fate: Fate::Failed }));
        records.sort_unstable();
        records
    }

    fn fate(&self, edge: EdgeId, verdict: EdgeVerdict) -> Fate {
        match verdict {
            _ if self.used.contains(&edge) => Fate::Used,
            EdgeVerdict::Unchecked => Fate::Unchecked,
            EdgeVerdict::Valid => Fate::Valid,
            EdgeVerdict::Executable => Fate::Executable,
        }
    }
}

impl std::fmt::Debug for GraphRecord {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "GraphRecord({} nodes, {} edges)", self.nodes().len(), self.graph.edges().len())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use regrasp_api::{Origin, PerFinger, Pose};

    #[test]
    fn edges_are_failed_kept_or_used() {
        let mut graph = Graph::new(0.03);
        for i in 0..4 {
            let q = Configuration {
                X_HO: Pose::translation(f64::from(i), 0.0, 0.0),
                joints: PerFinger::filled(1, Default::default()),
                contacts: PerFinger::filled(1, None),
            };
            graph.add_node(q, Origin::Explored);
        }
        let join = |graph: &mut Graph, a, b| {
            graph.add_edge(NodeId(a), NodeId(b), EdgeKind::Grasp, EdgeVerdict::Valid)
        };
        let used = join(&mut graph, 1, 0);
        join(&mut graph, 1, 2);
        let removed = join(&mut graph, 2, 3);
        graph.remove_edge(removed);
        graph.mark_tried(NodeId(3), NodeId(0), EdgeKind::TransferRegrasp);
        let record = GraphRecord::new(graph, vec![(End::Start, NodeId(0))], [used].into());
        let found: Vec<_> = record.edges().iter().map(|e| (e.from.0, e.to.0, e.fate)).collect();
        let expected = [(0, 1, Fate::Used), (0, 3, Fate::Failed), (1, 2, Fate::Valid), (2, 3, Fate::Failed)];
        assert_eq!(found, expected);
        assert_eq!(record.component(NodeId(2)), ComponentId(0));
        assert_eq!(record.component(NodeId(3)), ComponentId(3));
    }
}
