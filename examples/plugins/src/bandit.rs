//! A strategy that learns: three ways to go on, each drawn the more often the more it has achieved for what
//! it cost.

use regrasp_api::{
    Action, Build, CallError, Context, EdgeKind, Entry, GraphStrategy, GraphView, Link, NoSettings, NodeId,
    Settings, Slot, Vicinity, check_settings, inventory,
};

/// What a strategy can do: explore, extend, connect.
const ARMS: usize = 3;

/// UCB1 over the kinds of actions; the reward is components merged, or a quarter for a node.
struct Bandit;

/// Which arm an action belongs to.
fn arm(action: &Action) -> Option<usize> {
    match action {
        Action::Explore(_) => Some(0),
        Action::Extend(..) => Some(1),
        Action::Connect(..) => Some(2),
        _ => None,
    }
}

/// The arm with the largest upper confidence bound.
fn choose(graph: &dyn GraphView) -> usize {
    let (mut pulls, mut gains) = ([0.0_f64; ARMS], [0.0_f64; ARMS]);
    for past in graph.history() {
        let Some(arm) = arm(&past.action) else { continue };
        pulls[arm] += 1.0;
        gains[arm] += (past.merges as f64 + 0.25 * past.nodes.len() as f64).min(1.0);
    }
    let all: f64 = pulls.iter().sum();
    let bound = |arm: &usize| match pulls[*arm] {
        0.0 => f64::INFINITY,
        n => gains[*arm] / n + (2.0 * all.ln() / n).sqrt(),
    };
    (0..ARMS).max_by(|a, b| bound(a).total_cmp(&bound(b))).unwrap_or(0)
}

/// The untried pair of nodes from two components that lies nearest to `node`.
fn partner(graph: &dyn GraphView, node: NodeId) -> Option<NodeId> {
    let open = |other: &NodeId| {
        graph.component(*other) != graph.component(node)
            && !graph.attempted(node, *other, EdgeKind::TransferRegrasp)
    };
    let nodes = (0..graph.node_count() as u32).map(NodeId);
    nodes.filter(open).min_by(|&a, &b| graph.distance(node, a).total_cmp(&graph.distance(node, b)))
}

impl GraphStrategy for Bandit {
    fn next(&self, graph: &dyn GraphView, context: &mut Context<'_>) -> Result<Action, CallError> {
        context.count_call(Slot::GraphStrategy);
        if graph.joined() {
            return Ok(Action::Query);
        }
        let (samples, most) = graph.samples();
        if samples >= most {
            return Ok(Action::Stop);
        }
        let node = NodeId(context.random.index(graph.node_count()) as u32);
        let arm = choose(graph);
        context.note(Slot::GraphStrategy, ["explored", "extended", "connected"][arm], 1.0);
        Ok(match (arm, partner(graph, node)) {
            (2, Some(other)) => Action::Connect(node, other, EdgeKind::TransferRegrasp),
            (1, _) => Action::Extend(node, Vicinity::default(), Link::Components),
            _ => Action::Explore(Link::Components),
        })
    }
}

/// How the plugin presents itself.
pub const ENTRY: Entry = Entry {
    id: "graph-strategy/bandit",
    slots: &[Slot::GraphStrategy],
    summary: "explores, extends and connects by what each has achieved so far (UCB1)",
    references: &[
        "Auer, Cesa-Bianchi, Fischer, Finite-time analysis of the multiarmed bandit problem, Machine \
         Learning 47, 2002",
    ],
    schema: NoSettings::schema,
    check: check_settings::<NoSettings>,
    build: Build::GraphStrategy(|json, _parts| {
        NoSettings::from_json(json)?;
        Ok(Box::new(Bandit))
    }),
};
inventory::submit! { ENTRY }
