//! Role 6: what to do next with the manipulation graph.

use crate::{CallError, Configuration, Context, SearchPolicy, Tally};

/// A node of the manipulation graph, counted from 0 in the order of creation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct NodeId(pub u32);

/// An edge of the manipulation graph, counted from 0 in the order of creation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct EdgeId(pub u32);

/// A connected component, named by its smallest node.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ComponentId(pub u32);

/// How two nodes are joined.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum EdgeKind {
    /// By a path inside GS_n, contacts sliding: it must be decomposed before it can be executed.
    Grasp,
    /// By a transfer followed by regrasps: executable as it is.
    TransferRegrasp,
}

/// What is known about an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum EdgeVerdict {
    /// Entered without a check.
    Unchecked,
    /// Its local path is valid.
    Valid,
    /// Valid, and decomposed into executable segments.
    Executable,
}

/// An edge with its ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EdgeView {
    /// Its number.
    pub id: EdgeId,
    /// One end.
    pub from: NodeId,
    /// The other end.
    pub to: NodeId,
    /// How it joins them.
    pub kind: EdgeKind,
    /// What is known about it.
    pub verdict: EdgeVerdict,
}

/// How a new node is joined to the graph inside GS_n.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Link {
    /// Try a checked grasp edge to each component (lines 3 to 9 of the paper's Algorithm 2), and keep the
    /// node whatever comes of it.
    Components,
    /// The same, and drop the node if it reaches no component (lines 10 to 13).
    ComponentsOrDrop,
    /// Enter unchecked grasp edges to this many nearest nodes.
    Unchecked(usize),
    /// Leave it alone.
    None,
}

/// How far from a node another one is sampled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vicinity {
    /// Largest displacement of the object (m), above 0.
    pub radius: f64,
    /// Largest turn of the object (rad), above 0.
    pub angle: f64,
}

impl Default for Vicinity {
    /// 10 mm and half a radian: about as far as one transfer goes.
    fn default() -> Self {
        Self { radius: 0.01, angle: 0.5 }
    }
}

/// What the planner does next.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Action {
    /// Sample a node anywhere in GS_n, and join it.
    Explore(Link),
    /// Sample a node near the given one, with the same fingers holding, and join it.
    Extend(NodeId, Vicinity, Link),
    /// Try an edge of the given kind between two nodes.
    Connect(NodeId, NodeId, EdgeKind),
    /// Try an edge of the given kind from a node to the nearest node of every other component (Algorithm 3 of
    /// the paper); pairs that were tried before are left out.
    ConnectAll(NodeId, EdgeKind),
    /// Check an unchecked edge; if it fails it leaves the graph.
    Check(EdgeId),
    /// Search the graph for a path from start to goal and decompose it.
    Query,
    /// Give up.
    Stop,
}

/// Where a node comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Origin {
    /// It is the start of the problem.
    Start,
    /// It is a grasp at the pose of a goal.
    Goal,
    /// [`Action::Explore`] made it.
    Explored,
    /// [`Action::Extend`] made it, near this node.
    Extended(NodeId),
}

/// What an action came to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Effect {
    /// It did what it was to do: a node was made, an edge was entered, an edge passed its check.
    Done,
    /// It was tried and failed: no sample, a node that was dropped, no path, an edge that left the graph.
    Failed,
    /// It could change nothing, and nothing was tried: a pair tried before, an edge checked before or gone, a
    /// query while start and goal lie apart.
    Futile,
}

/// An action of the past, and what it came to.
#[derive(Clone, Debug, PartialEq)]
pub struct PastAction {
    /// What the strategy wanted.
    pub action: Action,
    /// What it came to.
    pub effect: Effect,
    /// The nodes that it made, in ascending order; a sample may bring another grasp at the goal with it.
    pub nodes: Vec<NodeId>,
    /// The edges that it entered, in ascending order.
    pub edges: Vec<EdgeId>,
    /// By how many components fewer its edges left.
    pub merges: usize,
    /// The calls that it took and what they were refused for, by slot: what the action cost.
    pub tally: Tally,
}

/// The graph as a strategy sees it, and what was done so far; its only memory.
pub trait GraphView {
    /// Nodes in the graph; their ids are `0..node_count()`.
    fn node_count(&self) -> usize;
    /// Samples asked for so far, whether they gave a node or not, and the most that may be.
    fn samples(&self) -> (usize, usize);
    /// The node that the search starts from.
    fn start(&self) -> NodeId;
    /// The goal's nodes, one for each grasp that was found at the goal's pose.
    fn goals(&self) -> &[NodeId];
    /// The configuration of a node: the object's pose, the joints, which fingers hold where.
    fn configuration(&self, node: NodeId) -> &Configuration;
    /// Where a node comes from.
    fn origin(&self, node: NodeId) -> Origin;
    /// What was done since the search for this goal was begun, or begun anew
    /// ([`SearchPolicy::restart_samples`]), first to last, each action with what it came to.
    fn history(&self) -> &[PastAction];
    /// The component of a node, unchecked edges included.
    fn component(&self, node: NodeId) -> ComponentId;
    /// The components in ascending order.
    fn components(&self) -> &[ComponentId];
    /// Whether start and some goal lie in one component: a query may succeed.
    fn joined(&self) -> bool;
    /// Distance between two nodes in the planner's metric (m).
    fn distance(&self, a: NodeId, b: NodeId) -> f64;
    /// Whether an edge of this kind was tried between the two nodes, in either direction.
    fn attempted(&self, a: NodeId, b: NodeId, kind: EdgeKind) -> bool;
    /// The edges in the graph, in ascending order of ids.
    fn edges(&self) -> &[EdgeView];
    /// The edges of the shortest path from start to a goal, unchecked ones included; empty if there is none.
    fn shortest_path(&self) -> Vec<EdgeId>;
}

/// Decides what to do next, given a view of the graph.
///
/// Pure in the view and the context's random stream: it has no other memory. What it wants to learn from, it
/// finds in [`GraphView::history`].
///
/// The search ends without a plan at [`Action::Stop`], at a sample beyond the budget of nodes, and after as
/// many actions with [`Effect::Futile`] as there may be nodes.
pub trait GraphStrategy: Send + Sync {
    /// The next action.
    fn next(&self, graph: &dyn GraphView, context: &mut Context<'_>) -> Result<Action, CallError>;

    /// How the planner carries out its actions; the program's defaults unless the strategy says otherwise.
    /// Asked once a run.
    fn policy(&self) -> SearchPolicy {
        SearchPolicy::default()
    }
}
const _: Option<&dyn GraphStrategy> = None; // must stay object safe
