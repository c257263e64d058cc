//! Strategies under audit.

use crate::Audited;
use crate::auditor::Key;
use crate::laws::{self, ensure};
use regrasp_api::{Action, CallError, Context, GraphStrategy, GraphView, NodeId, SearchPolicy};
use serde_json::json;

impl GraphStrategy for Audited<'_, dyn GraphStrategy + '_> {
    fn next(&self, graph: &dyn GraphView, context: &mut Context<'_>) -> Result<Action, CallError> {
        self.call(
            ("next", Key::Always),
            context,
            |strategy, context| strategy.next(graph, context),
            |context| {
                json!({
                    "nodes": graph.node_count(),
                    "components": graph.components().len(),
                    "edges": graph.edges().len(),
                    "samples": graph.samples().0,
                    "history": graph.history().len(),
                    "random": crate::input::random(context),
                })
            },
            |_, action, _| {
                let known = |node: NodeId| (node.0 as usize) < graph.node_count();
                if let Action::Extend(_, within, _) = action {
                    laws::vicinity_kept(within)?;
                }
                let sound = match *action {
                    Action::Extend(node, ..) => known(node),
                    Action::Connect(a, b, _) => known(a) && known(b) && a != b,
                    Action::ConnectAll(node, _) => known(node),
                    Action::Check(id) => graph.edges().iter().any(|edge| edge.id == id),
                    _ => true,
                };
                ensure("strategy-sensible", sound, || format!("{action:?} with {} nodes", graph.node_count()))
            },
        )
    }

    fn policy(&self) -> SearchPolicy {
        self.inner.policy()
    }
}
