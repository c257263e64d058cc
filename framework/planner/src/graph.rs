//! The manipulation graph: configurations of GS_n, and the edges between them.

use regrasp_api::{
    ComponentId, Configuration, Contact, EdgeId, EdgeKind, EdgeVerdict, EdgeView, FingerIndex, NodeId,
    Origin, angle_between,
};
use regrasp_plan::Segment;
use std::collections::{BTreeMap, HashSet};

/// The graph of one run; it grows from leg to leg.
pub(crate) struct Graph {
    nodes: Vec<Configuration>,
    /// Where each node comes from.
    origins: Vec<Origin>,
    edges: Vec<EdgeView>,
    /// What executes an edge, from its `from` to its `to`.
    steps: BTreeMap<EdgeId, Vec<Segment>>,
    next_edge: u32,
    tried: HashSet<(NodeId, NodeId, EdgeKind)>,
    component: Vec<ComponentId>,
    components: Vec<ComponentId>,
    /// What a turn by one radian counts (m): the object's radius.
    turn_length: f64,
}

impl Graph {
    /// An empty graph whose metric counts a radian of turn as `turn_length` (m).
    pub fn new(turn_length: f64) -> Self {
        Self {
            nodes: Vec::new(),
            origins: Vec::new(),
            edges: Vec::new(),
            steps: BTreeMap::new(),
            next_edge: 0,
            tried: HashSet::new(),
            component: Vec::new(),
            components: Vec::new(),
            turn_length,
        }
    }

    /// Adds a node as a component of its own.
    pub fn add_node(&mut self, q: Configuration, origin: Origin) -> NodeId {
        let node = NodeId(self.nodes.len() as u32);
        self.nodes.push(q);
        self.origins.push(origin);
        self.component.push(ComponentId(node.0));
        self.components.push(ComponentId(node.0));
        node
    }

    /// Takes the newest node out again; it has no edges.
    pub fn drop_newest(&mut self) {
        let node = NodeId(self.nodes.len() as u32 - 1);
        debug_assert!(self.edges.iter().all(|edge| edge.from != node && edge.to != node));
        self.nodes.pop();
        self.origins.pop();
        self.component.pop();
        self.components.retain(|component| component.0 != node.0);
        self.tried.retain(|&(_, larger, _)| larger != node);
    }

    /// Takes out all nodes but the first `count`, with their edges and what was tried with them.
    pub fn truncate(&mut self, count: usize) {
        let stays = |node: NodeId| (node.0 as usize) < count;
        self.nodes.truncate(count);
        self.origins.truncate(count);
        self.tried.retain(|&(_, larger, _)| stays(larger));
        let gone: Vec<_> =
            self.edges.iter().filter(|edge| !stays(edge.from.max(edge.to))).map(|edge| edge.id).collect();
        self.edges.retain(|edge| stays(edge.from.max(edge.to)));
        gone.iter().for_each(|id| _ = self.steps.remove(id));
        self.label();
    }

    /// The configuration of a node.
    pub fn node(&self, node: NodeId) -> &Configuration {
        &self.nodes[node.0 as usize]
    }

    /// The configurations of all nodes, by number.
    pub fn nodes(&self) -> &[Configuration] {
        &self.nodes
    }

    /// The numbers of all nodes.
    pub fn ids(&self) -> impl Iterator<Item = NodeId> + use<> {
        (0..self.nodes.len() as u32).map(NodeId)
    }

    /// Where a node comes from.
    pub fn origin(&self, node: NodeId) -> Origin {
        self.origins[node.0 as usize]
    }

    /// How many nodes.
    pub fn node_count(&self) -> usize {
        self.nodes.len()
    }

    /// The components in ascending order.
    pub fn components(&self) -> &[ComponentId] {
        &self.components
    }

    /// Remembers that an edge of this kind was tried.
    pub fn mark_tried(&mut self, a: NodeId, b: NodeId, kind: EdgeKind) {
        self.tried.insert((a.min(b), a.max(b), kind));
    }

    /// Whether an edge of this kind was tried, in either direction.
    pub fn was_tried(&self, a: NodeId, b: NodeId, kind: EdgeKind) -> bool {
        self.tried.contains(&(a.min(b), a.max(b), kind))
    }

    /// All that was tried: two nodes, the smaller number first, and the kind of edge; in no order.
    pub fn tried(&self) -> impl Iterator<Item = (NodeId, NodeId, EdgeKind)> {
        self.tried.iter().copied()
    }

    /// Adds an edge and joins the components of its ends.
    pub fn add_edge(&mut self, from: NodeId, to: NodeId, kind: EdgeKind, verdict: EdgeVerdict) -> EdgeId {
        let id = EdgeId(self.next_edge);
        self.next_edge += 1;
        self.mark_tried(from, to, kind);
        self.edges.push(EdgeView { id, from, to, kind, verdict });
        self.merge(from, to);
        id
    }

    /// The edge with this id, if it is still in the graph.
    pub fn edge(&self, id: EdgeId) -> Option<&EdgeView> {
        self.edges.binary_search_by_key(&id, |edge| edge.id).ok().map(|place| &self.edges[place])
    }

    /// Sets what is known about an edge.
    pub fn set_verdict(&mut self, id: EdgeId, verdict: EdgeVerdict) {
        if let Ok(place) = self.edges.binary_search_by_key(&id, |edge| edge.id) {
            self.edges[place].verdict = verdict;
        }
    }

    /// Stores what executes an edge, from its `from` to its `to`.
    pub fn set_steps(&mut self, id: EdgeId, steps: Vec<Segment>) {
        self.set_verdict(id, EdgeVerdict::Executable);
        self.steps.insert(id, steps);
    }

    /// What executes an edge, once it is known.
    pub fn steps(&self, id: EdgeId) -> Option<&[Segment]> {
        self.steps.get(&id).map(Vec::as_slice)
    }

    /// Takes an edge out and recomputes the components.
    pub fn remove_edge(&mut self, id: EdgeId) {
        self.edges.retain(|edge| edge.id != id);
        self.steps.remove(&id);
        self.label();
    }

    /// Works the components out anew.
    fn label(&mut self) {
        self.component = (0..self.nodes.len() as u32).map(ComponentId).collect();
        self.components = self.component.clone();
        for (from, to) in self.edges.iter().map(|edge| (edge.from, edge.to)).collect::<Vec<_>>() {
            self.merge(from, to);
        }
    }

    /// The edges in the graph, in ascending order of ids.
    pub fn edges(&self) -> &[EdgeView] {
        &self.edges
    }

    /// The number of the edge that is added next.
    pub fn next_edge(&self) -> EdgeId {
        EdgeId(self.next_edge)
    }

    /// The component of a node.
    pub fn component(&self, node: NodeId) -> ComponentId {
        self.component[node.0 as usize]
    }

    /// Distance of two nodes (m): the object's displacement, its turn times the object's radius, and how far
    /// the contacts lie apart on the object, averaged over the fingers.
    pub fn distance(&self, a: NodeId, b: NodeId) -> f64 {
        configuration_distance(self.node(a), self.node(b), self.turn_length)
    }

    /// The components of the nodes by paths in GS_n alone: how many, and how many nodes the largest has.
    pub fn grasp_components(&self) -> (usize, usize) {
        let mut sizes: BTreeMap<ComponentId, usize> = BTreeMap::new();
        for component in self.grasp_labels() {
            *sizes.entry(component).or_default() += 1;
        }
        (sizes.len(), sizes.into_values().max().unwrap_or(0))
    }

    /// For each node its component by paths in GS_n alone: the smallest number of a node in it.
    pub fn grasp_labels(&self) -> Vec<ComponentId> {
        let mut inside = Self::new(self.turn_length);
        inside.component = self.ids().map(|node| ComponentId(node.0)).collect();
        for edge in self.edges.iter().filter(|edge| edge.kind == EdgeKind::Grasp) {
            inside.merge(edge.from, edge.to);
        }
        inside.component
    }

    fn merge(&mut self, a: NodeId, b: NodeId) {
        let (first, second) = (self.component(a), self.component(b));
        if first == second {
            return;
        }
        let (kept, gone) = (first.min(second), first.max(second));
        self.component
            .iter_mut()
            .filter(|component| **component == gone)
            .for_each(|component| *component = kept);
        self.components.retain(|&component| component != gone);
    }
}

/// The planner's metric; see [`Graph::distance`].
pub(crate) fn configuration_distance(a: &Configuration, b: &Configuration, turn_length: f64) -> f64 {
    let displacement = (a.X_HO.translation.vector - b.X_HO.translation.vector).norm();
    let turn = angle_between(&a.X_HO.rotation, &b.X_HO.rotation) * turn_length;
    let apart = |(finger, contact): (FingerIndex, &Option<Contact>)| match (contact, b.contacts[finger]) {
        (Some(x), Some(y)) => (x.p_OC - y.p_OC).norm(),
        (None, None) => 0.0,
        _ => turn_length,
    };
    displacement + turn + a.contacts.iter().map(apart).sum::<f64>() / a.contacts.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use regrasp_api::{PerFinger, Pose, Vec3};

    fn at(x: f64) -> Configuration {
        let X_HO = Pose::translation(x, 0.0, 0.0);
        Configuration {
            X_HO,
            joints: PerFinger::filled(2, Default::default()),
            contacts: PerFinger::filled(2, None),
        }
    }

    fn chain(count: u32) -> (Graph, Vec<EdgeId>) {
        let mut graph = Graph::new(0.03);
        for i in 0..count {
            graph.add_node(at(f64::from(i)), Origin::Explored);
        }
        let join = |i| graph.add_edge(NodeId(i), NodeId(i + 1), EdgeKind::Grasp, EdgeVerdict::Valid);
        let edges = (0..count - 1).map(join).collect();
        (graph, edges)
    }

    #[test]
    fn components_merge_and_fall_apart_again() {
        let (mut graph, edges) = chain(5);
        assert_eq!(graph.components(), [ComponentId(0)]);
        graph.remove_edge(edges[2]);
        assert_eq!(graph.components(), [ComponentId(0), ComponentId(3)]);
        assert_eq!(graph.component(NodeId(4)), ComponentId(3));
        assert!(graph.was_tried(NodeId(3), NodeId(2), EdgeKind::Grasp), "a removed edge stays tried");
        assert!(!graph.was_tried(NodeId(3), NodeId(2), EdgeKind::TransferRegrasp));
    }

    #[test]
    fn a_truncated_graph_is_as_it_was() {
        let (mut graph, edges) = chain(3);
        graph.add_node(at(7.0), Origin::Explored);
        graph.add_edge(NodeId(0), NodeId(3), EdgeKind::Grasp, EdgeVerdict::Valid);
        graph.remove_edge(edges[1]);
        graph.truncate(3);
        assert_eq!((graph.node_count(), graph.edges().len()), (3, 1));
        assert_eq!(graph.components(), [ComponentId(0), ComponentId(2)]);
        assert!(graph.was_tried(NodeId(1), NodeId(2), EdgeKind::Grasp));
        assert!(!graph.was_tried(NodeId(0), NodeId(3), EdgeKind::Grasp));
    }

    #[test]
    fn components_of_gs_n_know_no_other_edges() {
        let (mut graph, _) = chain(3);
        let far = graph.add_node(at(9.0), Origin::Explored);
        graph.add_edge(NodeId(0), far, EdgeKind::TransferRegrasp, EdgeVerdict::Executable);
        assert_eq!((graph.components().len(), graph.grasp_components()), (1, (2, 3)));
        assert_eq!(graph.grasp_labels(), [0, 0, 0, 3].map(ComponentId));
    }

    #[test]
    fn a_dropped_node_leaves_nothing_behind() {
        let (mut graph, _) = chain(3);
        let node = graph.add_node(at(9.0), Origin::Explored);
        graph.mark_tried(NodeId(1), node, EdgeKind::Grasp);
        graph.drop_newest();
        assert_eq!((graph.node_count(), graph.components()), (3, &[ComponentId(0)][..]));
        assert_eq!(graph.add_node(at(5.0), Origin::Explored), node, "its number is free again");
        assert!(!graph.was_tried(node, NodeId(1), EdgeKind::Grasp), "what was tried with it is forgotten");
    }

    #[test]
    fn the_metric_counts_displacement_turn_and_contacts() {
        let mut a = at(0.0);
        let mut b = at(0.01);
        b.X_HO.rotation = regrasp_api::Rotation::from_scaled_axis(Vec3::z());
        assert!((configuration_distance(&a, &b, 0.03) - 0.04).abs() < 1e-12);
        let contact = |y| Some(Contact { facet: 0, p_OC: Vec3::new(0.0, y, 0.0), n_O: Vec3::z() });
        a.contacts[FingerIndex(0)] = contact(0.0);
        b.contacts[FingerIndex(0)] = contact(0.02);
        assert!((configuration_distance(&a, &b, 0.03) - 0.05).abs() < 1e-12);
    }
}
