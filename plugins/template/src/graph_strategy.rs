//! A strategy: samples new nodes, and now and then joins two components by a transfer and regrasps.

use regrasp_api::{
    Action, Build, CallError, Context, EdgeKind, Entry, GraphStrategy, GraphView, Link, NodeId, Settings,
    SettingsError, Slot, check_settings,
};
use serde::{Deserialize, Serialize};

/// Settings of [`Alternate`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct AlternateSettings {
    /// The part of the steps (no unit) that connects two components in place of sampling.
    #[schemars(range(min = 0.0, max = 0.9), extend("x-unit" = "1"))]
    pub connect: f64,
}

impl Default for AlternateSettings {
    fn default() -> Self {
        Self { connect: 0.3 }
    }
}

impl Settings for AlternateSettings {}

/// Explores and connects at a fixed rate.
#[derive(Clone, Copy, Debug)]
pub struct Alternate {
    settings: AlternateSettings,
}

impl Alternate {
    /// A strategy with checked settings.
    pub fn new(settings: AlternateSettings) -> Result<Self, SettingsError> {
        settings.validate()?;
        Ok(Self { settings })
    }
}

impl GraphStrategy for Alternate {
    fn next(&self, graph: &dyn GraphView, context: &mut Context<'_>) -> Result<Action, CallError> {
        context.count_call(Slot::GraphStrategy);
        if graph.joined() {
            return Ok(Action::Query);
        }
        let (samples, most) = graph.samples();
        if samples >= most {
            return Ok(Action::Stop);
        }
        let connect = context.random.unit() < self.settings.connect;
        let node = NodeId(context.random.index(graph.node_count()) as u32);
        Ok(match nearest_elsewhere(graph, node).filter(|_| connect) {
            Some(other) => Action::Connect(node, other, EdgeKind::TransferRegrasp),
            None => Action::Explore(Link::Components),
        })
    }
}

/// The nearest node of another component with which `node` was not tried yet.
fn nearest_elsewhere(graph: &dyn GraphView, node: NodeId) -> Option<NodeId> {
    let own = graph.component(node);
    (0..graph.node_count() as u32)
        .map(NodeId)
        .filter(|&other| graph.component(other) != own)
        .filter(|&other| !graph.attempted(node, other, EdgeKind::TransferRegrasp))
        .min_by(|&a, &b| graph.distance(node, a).total_cmp(&graph.distance(node, b)))
}

/// How the plugin presents itself.
pub const ENTRY: Entry = Entry {
    id: "graph-strategy/template",
    slots: &[Slot::GraphStrategy],
    summary: "explores and connects at a fixed rate",
    references: &[
        "Kavraki, Svestka, Latombe, Overmars, Probabilistic roadmaps for path planning in high-dimensional \
         configuration spaces, T-RA 1996",
    ],
    schema: AlternateSettings::schema,
    check: check_settings::<AlternateSettings>,
    build: Build::GraphStrategy(|json, _parts| {
        Ok(Box::new(Alternate::new(AlternateSettings::from_json(json)?)?))
    }),
};
