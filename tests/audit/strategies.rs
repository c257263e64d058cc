//! Mistakes of strategies.

use super::audited;
use regrasp::api::{
    Action, CallError, Context, EdgeId, EdgeKind, GraphStrategy, GraphView, Link, NodeId, Parts, Slot,
    Vicinity,
};

struct Liar {
    lie: String,
    honest: Box<dyn GraphStrategy>,
}

impl GraphStrategy for Liar {
    fn next(&self, graph: &dyn GraphView, context: &mut Context<'_>) -> Result<Action, CallError> {
        let beyond = NodeId(graph.node_count() as u32);
        let node = graph.start();
        let action = match self.lie.as_str() {
            "counts-nothing" => return self.honest.next(graph, &mut context.twin()),
            "impure" if super::odd() => Action::Explore(Link::None),
            "one-too-far" => Action::Extend(beyond, Vicinity::default(), Link::Components),
            "nowhere" => Action::Extend(node, Vicinity { radius: 0.0, angle: 0.5 }, Link::Components),
            "with-itself" => Action::Connect(node, node, EdgeKind::Grasp),
            "no-edge" => Action::Check(EdgeId(1_000_000)),
            "again" => Action::Connect(node, graph.goals()[0], EdgeKind::TransferRegrasp),
            "for-ever" => Action::Explore(Link::None),
            _ => return self.honest.next(graph, context),
        };
        context.count_call(Slot::GraphStrategy);
        Ok(action)
    }
}

crate::liar!(GraphStrategy, "graph-strategy", &[Slot::GraphStrategy], |lie, parts: &Parts<'_>| {
    Ok(Liar { lie, honest: parts.plugins.graph_strategy(None, "", parts)? })
});

#[test]
fn caught() {
    super::judge(
        Slot::GraphStrategy,
        &[
            ("counts-nothing", "counted"),
            ("impure", "pure"),
            ("one-too-far", "strategy-sensible"),
            ("nowhere", "strategy-sensible"),
            ("with-itself", "strategy-sensible"),
            ("no-edge", "strategy-sensible"),
        ],
    );
}

/// What never ends and breaks no law of a single call ends with the budget, and says so.
#[test]
fn endless_strategies_end_with_the_budget_and_a_message() {
    for (lie, says) in [("again", "could change nothing"), ("for-ever", "goes on sampling")] {
        let (run, case) = audited("cubic", Slot::GraphStrategy, lie);
        assert!(case.is_none(), "{:?}", case.map(|case| case.breach));
        let run = run.unwrap();
        assert!(
            run.outcome.warnings.iter().any(|warning| warning.contains(says)),
            "{:?}",
            run.outcome.warnings
        );
    }
}
