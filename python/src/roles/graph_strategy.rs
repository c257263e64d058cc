//! Role 6 in Python.

use super::loan::{Loan, lend_graph};
use super::plugin::Plugin;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use regrasp::api::{
    self, Action, CallError, Context, EdgeId, EdgeKind, EdgeVerdict, Effect, Link, NodeId, Slot, Vicinity,
};

/// The graph as a strategy sees it, for the time of one call.
#[pyclass(unsendable, module = "regrasp")]
pub struct Graph(pub Loan<&'static dyn api::GraphView>);

impl Graph {
    fn node(&self, node: u32) -> PyResult<NodeId> {
        let count = self.0.value()?.node_count();
        if (node as usize) < count {
            return Ok(NodeId(node));
        }
        Err(PyValueError::new_err(format!("`node` = {node} is outside 0..={}", count.saturating_sub(1))))
    }
}

#[pymethods]
impl Graph {
    #[getter]
    fn node_count(&self) -> PyResult<usize> {
        Ok(self.0.value()?.node_count())
    }

    #[getter]
    fn generated(&self) -> PyResult<(usize, usize)> {
        Ok(self.0.value()?.samples())
    }

    #[getter]
    fn start(&self) -> PyResult<u32> {
        Ok(self.0.value()?.start().0)
    }

    #[getter]
    fn goals(&self) -> PyResult<Vec<u32>> {
        Ok(self.0.value()?.goals().iter().map(|node| node.0).collect())
    }

    fn component(&self, node: u32) -> PyResult<u32> {
        Ok(self.0.value()?.component(self.node(node)?).0)
    }

    #[getter]
    fn components(&self) -> PyResult<Vec<u32>> {
        Ok(self.0.value()?.components().iter().map(|component| component.0).collect())
    }

    #[getter]
    fn joined(&self) -> PyResult<bool> {
        Ok(self.0.value()?.joined())
    }

    fn distance(&self, a: u32, b: u32) -> PyResult<f64> {
        Ok(self.0.value()?.distance(self.node(a)?, self.node(b)?))
    }

    #[pyo3(signature = (a, b, kind = "grasp"))]
    fn attempted(&self, a: u32, b: u32, kind: &str) -> PyResult<bool> {
        Ok(self.0.value()?.attempted(self.node(a)?, self.node(b)?, edge_kind(kind)?))
    }

    /// Number, ends, kind and verdict of every edge.
    #[getter]
    fn edges(&self) -> PyResult<Vec<(u32, u32, u32, &'static str, &'static str)>> {
        let row = |edge: &api::EdgeView| {
            let kind = match edge.kind {
                EdgeKind::Grasp => "grasp",
                EdgeKind::TransferRegrasp => "transfer-regrasp",
            };
            let verdict = match edge.verdict {
                EdgeVerdict::Unchecked => "unchecked",
                EdgeVerdict::Valid => "valid",
                EdgeVerdict::Executable => "executable",
            };
            (edge.id.0, edge.from.0, edge.to.0, kind, verdict)
        };
        Ok(self.0.value()?.edges().iter().map(row).collect())
    }

    /// The configuration of a node.
    fn configuration(&self, node: u32) -> PyResult<super::data::Configuration> {
        Ok(super::data::Configuration(self.0.value()?.configuration(self.node(node)?).clone()))
    }

    /// What was done so far: the name of the action, what it came to, the nodes that it made, and by how
    /// many components fewer it left.
    #[getter]
    fn history(&self) -> PyResult<Vec<(&'static str, &'static str, Vec<u32>, usize)>> {
        let row = |past: &api::PastAction| {
            let effect = match past.effect {
                Effect::Done => "done",
                Effect::Failed => "failed",
                Effect::Futile => "futile",
            };
            (name(&past.action), effect, past.nodes.iter().map(|node| node.0).collect(), past.merges)
        };
        Ok(self.0.value()?.history().iter().map(row).collect())
    }

    fn shortest_path(&self) -> PyResult<Vec<u32>> {
        Ok(self.0.value()?.shortest_path().into_iter().map(|edge| edge.0).collect())
    }
}

/// A graph strategy.
pub struct GraphStrategy(pub Plugin);

impl api::GraphStrategy for GraphStrategy {
    fn next(&self, graph: &dyn api::GraphView, context: &mut Context<'_>) -> Result<Action, CallError> {
        self.0.with_context(Slot::GraphStrategy, context, |py, object, context| {
            lend_graph(py, graph, |view| {
                let (name, a, b, word): (String, u32, u32, String) =
                    object.call_method1("next", (view, context))?.extract()?;
                action(&view.borrow(), &name, (a, b), &word)
            })
        })
    }
}

fn name(action: &Action) -> &'static str {
    match action {
        Action::Explore(_) => "explore",
        Action::Extend(..) => "extend",
        Action::Connect(..) => "connect",
        Action::Check(_) => "check",
        Action::Query => "query",
        _ => "stop",
    }
}

fn action(graph: &Graph, name: &str, (a, b): (u32, u32), word: &str) -> PyResult<Action> {
    match name {
        "explore" => Ok(Action::Explore(link(word)?)),
        "extend" => Ok(Action::Extend(graph.node(a)?, Vicinity::default(), link(word)?)),
        "connect" => Ok(Action::Connect(graph.node(a)?, graph.node(b)?, edge_kind(word)?)),
        "check" => Ok(Action::Check(EdgeId(a))),
        "query" => Ok(Action::Query),
        "stop" => Ok(Action::Stop),
        _ => Err(PyValueError::new_err(format!("there is no action `{name}`; make one with `Action`"))),
    }
}

fn link(word: &str) -> PyResult<Link> {
    match (word, word.parse()) {
        ("components", _) => Ok(Link::Components),
        ("none", _) => Ok(Link::None),
        (_, Ok(nearest)) => Ok(Link::Unchecked(nearest)),
        _ => Err(PyValueError::new_err(format!(
            "`link` = {word:?} is outside \"components\", \"none\", counts"
        ))),
    }
}

fn edge_kind(word: &str) -> PyResult<EdgeKind> {
    match word {
        "grasp" => Ok(EdgeKind::Grasp),
        "transfer-regrasp" => Ok(EdgeKind::TransferRegrasp),
        _ => Err(PyValueError::new_err(format!(
            "`kind` = {word:?} is outside \"grasp\", \"transfer-regrasp\""
        ))),
    }
}
