//! Mistakes of strategies.

use regrasp_api::*;
use regrasp_conformance::reference::Interleaving;
use std::collections::HashSet;
use std::sync::atomic::{AtomicU64, Ordering};

struct Mistaken {
    mistake: String,
    calls: AtomicU64,
}

impl Mistaken {
    fn new(mistake: String, _: &Parts<'_>) -> Self {
        Self { mistake, calls: AtomicU64::new(0) }
    }

    /// The nearest pair of two components, whether it was tried or not.
    fn nearest(graph: &dyn GraphView, untried: bool) -> Option<Action> {
        let nodes = || (0..graph.node_count() as u32).map(NodeId);
        let kind = EdgeKind::TransferRegrasp;
        let pairs = nodes().flat_map(|a| nodes().filter(move |b| a < *b).map(move |b| (a, b)));
        let apart = pairs.filter(|&(a, b)| graph.component(a) != graph.component(b));
        let open = apart.filter(|&(a, b)| !untried || !graph.attempted(a, b, kind));
        let nearest = open.min_by(|x, y| graph.distance(x.0, x.1).total_cmp(&graph.distance(y.0, y.1)));
        nearest.map(|(a, b)| Action::Connect(a, b, kind))
    }
}

impl GraphStrategy for Mistaken {
    fn next(&self, graph: &dyn GraphView, context: &mut Context<'_>) -> Result<Action, CallError> {
        let (samples, most) = graph.samples();
        let joined_first = graph.component(graph.start()) == graph.component(graph.goals()[0]);
        let right = Interleaving.next(graph, context)?;
        let calls = self.calls.fetch_add(1, Ordering::Relaxed);
        let growing = matches!(right, Action::Explore(_));
        Ok(match (self.mistake.as_str(), right) {
            // Nothing is ever joined.
            ("never-joins", Action::Explore(_) | Action::Connect(..)) => Action::Explore(Link::None),
            ("extends-the-newest-alone", Action::Explore(_) | Action::Connect(..)) => {
                let newest = NodeId(graph.node_count() as u32 - 1);
                Action::Extend(newest, Vicinity::default(), Link::None)
            }
            ("degrees", _) if growing => {
                Action::Extend(graph.start(), Vicinity { radius: 0.01, angle: 30.0 }, Link::Components)
            }
            ("millimetres", _) if growing => {
                Action::Extend(graph.start(), Vicinity { radius: 10.0, angle: 0.5 }, Link::Components)
            }
            ("first-goal-alone", Action::Query) if !joined_first => {
                if samples < most {
                    Action::Explore(Link::Components)
                } else {
                    Action::Stop
                }
            }
            ("tries-again", _) if !graph.joined() && samples < most && calls.is_multiple_of(2) => {
                Self::nearest(graph, false).unwrap_or(right)
            }
            ("counts-on-its-own", Action::Connect(..) | Action::Explore(_)) if calls.is_multiple_of(3) => {
                Action::Explore(Link::None)
            }
            ("order-of-a-hash", Action::Connect(_, b, kind)) => {
                let open = |a: &NodeId| graph.component(*a) != graph.component(b);
                let nodes: HashSet<NodeId> =
                    (0..graph.node_count() as u32).map(NodeId).filter(open).collect();
                nodes.into_iter().next().map_or(right, |a| Action::Connect(a, b, kind))
            }
            ("gives-up-once-it-fails", _) if graph.history().len() > 8 && !graph.joined() => Action::Stop,
            ("asks-early", _) if growing && samples % 2 == 0 => Action::Query,
            ("counts-nodes-from-one", Action::Connect(a, b, kind)) => {
                Action::Connect(NodeId(a.0 + 1), NodeId(b.0 + 1), kind)
            }
            ("checks-what-is-checked", _) if growing && !graph.edges().is_empty() => {
                Action::Check(graph.edges()[0].id)
            }
            _ => right,
        })
    }

    fn policy(&self) -> SearchPolicy {
        let mut policy = SearchPolicy::default();
        if self.mistake == "another-policy-each-time" {
            policy.goal_grasps += self.calls.fetch_add(1, Ordering::Relaxed) as usize;
        }
        if self.mistake == "no-grasps" {
            policy.goal_grasps = 0;
        }
        policy
    }
}

#[test]
fn caught() {
    let entry = crate::mistaken!(GraphStrategy, "graph-strategy", &[Slot::GraphStrategy], Mistaken::new);
    super::judge(
        &entry,
        &[
            ("never-joins", "strategy-solves"),
            ("extends-the-newest-alone", "strategy-solves"),
            ("degrees", "strategy-sensible"),
            ("millimetres", "strategy-sensible"),
            ("first-goal-alone", "strategy-queries"),
            ("tries-again", "strategy-not-futile|strategy-pure"),
            ("counts-on-its-own", "strategy-pure"),
            ("order-of-a-hash", "strategy-pure"),
            ("gives-up-once-it-fails", "strategy-goes-on"),
            ("asks-early", "strategy-not-futile"),
            ("counts-nodes-from-one", "strategy-sensible"),
            ("checks-what-is-checked", "strategy-sensible"),
            ("another-policy-each-time", "strategy-policy"),
            ("no-grasps", "strategy-policy"),
        ],
    );
}
