//! What an action came to, in the words of the graph's history.

use crate::graph::Graph;
use regrasp_api::{Action, EdgeId, Effect, NodeId, PastAction, Tally};

/// The graph and the counts before an action.
pub(crate) struct Before {
    nodes: usize,
    components: usize,
    edge: EdgeId,
    tally: Tally,
}

impl Before {
    /// What is remembered of the graph and the counts.
    pub fn of(graph: &Graph, tally: &Tally) -> Self {
        let (nodes, components) = (graph.node_count(), graph.components().len());
        Self { nodes, components, edge: graph.next_edge(), tally: tally.clone() }
    }

    /// What `action` came to, seen from the graph and the counts after it.
    pub fn past(&self, graph: &Graph, tally: &Tally, action: Action, effect: Effect) -> PastAction {
        let nodes: Vec<_> = (self.nodes..graph.node_count()).map(|node| NodeId(node as u32)).collect();
        let edges = (self.edge.0..graph.next_edge().0).map(EdgeId).collect();
        // An edge that left the graph may have made two components of one.
        let merges = (self.components + nodes.len()).saturating_sub(graph.components().len());
        PastAction { action, effect, nodes, edges, merges, tally: tally.since(&self.tally) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use regrasp_api::{
        Configuration, Context, EdgeKind, EdgeVerdict, Link, Origin, PerFinger, Pose, Reason, Slot,
    };

    #[test]
    fn an_action_is_told_by_what_it_added() {
        let q = Configuration {
            X_HO: Pose::identity(),
            joints: PerFinger::filled(2, Default::default()),
            contacts: PerFinger::filled(2, None),
        };
        let (mut graph, mut context) = (Graph::new(0.03), Context::seeded(0));
        let add = |graph: &mut Graph| graph.add_node(q.clone(), Origin::Explored);
        let first = [add(&mut graph), add(&mut graph)];
        context.count_call(Slot::Sampler);
        let before = Before::of(&graph, &context.tally);
        let third = add(&mut graph);
        for node in first {
            graph.add_edge(node, third, EdgeKind::Grasp, EdgeVerdict::Valid);
        }
        context.count_call(Slot::GraspPlanner);
        context.reject(Slot::GraspPlanner, Reason::Reach);
        let action = Action::Explore(Link::Components);
        let past = before.past(&graph, &context.tally, action, Effect::Done);
        assert_eq!((past.nodes, past.edges), (vec![third], vec![EdgeId(0), EdgeId(1)]));
        assert_eq!((past.merges, past.effect), (2, Effect::Done));
        assert_eq!(past.tally.calls(Slot::Sampler), 0, "counted before");
        assert_eq!(past.tally.rejections(Slot::GraspPlanner, Reason::Reach), 1);
    }
}
