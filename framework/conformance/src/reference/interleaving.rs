//! The reference strategy: query when joined, connect what was not tried, explore otherwise.

use regrasp_api::{Action, CallError, Context, EdgeKind, GraphStrategy, GraphView, Link, NodeId, Slot};

/// Explores and connects in turn, half of the time each.
#[derive(Clone, Copy, Debug, Default)]
pub struct Interleaving;

impl GraphStrategy for Interleaving {
    fn next(&self, graph: &dyn GraphView, context: &mut Context<'_>) -> Result<Action, CallError> {
        context.count_call(Slot::GraphStrategy);
        if graph.joined() {
            return Ok(Action::Query);
        }
        let (samples, most) = graph.samples();
        if samples >= most {
            return Ok(Action::Stop);
        }
        let nodes = graph.node_count() as u32;
        if context.random.unit() < 0.5 {
            let a = NodeId(context.random.index(nodes as usize) as u32);
            let apart = |b: &NodeId| {
                graph.component(*b) != graph.component(a)
                    && !graph.attempted(a, *b, EdgeKind::TransferRegrasp)
            };
            let nearest = (0..nodes)
                .map(NodeId)
                .filter(apart)
                .min_by(|x, y| graph.distance(a, *x).total_cmp(&graph.distance(a, *y)));
            if let Some(b) = nearest {
                return Ok(Action::Connect(a, b, EdgeKind::TransferRegrasp));
            }
        }
        Ok(Action::Explore(Link::Components))
    }
}
