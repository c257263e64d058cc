//! The query: a way through the graph, whose paths in GS_n become transfers and regrasps.

use crate::joined::joined;
use crate::search::Search;
use crate::segments::{moves, reversed};
use crate::session::{Call, Counted};
use crate::shortest_path::{Step, shortest_path};
use regrasp_api::{CallError, EdgeId, EdgeKind};
use regrasp_plan::Segment;

type Decomposed = Counted<Result<Option<Vec<Segment>>, CallError>>;

impl Search<'_> {
    /// Searches a path and decomposes its edges; the first that fails leaves the graph, and the search goes
    /// on.
    pub fn query(&mut self) -> Result<Option<Vec<Segment>>, CallError> {
        let path = shortest_path(self.state.graph, self.leg.start, &self.state.goals);
        let Some(path) = path else { return Ok(None) };
        let todo: Vec<_> = path.iter().filter(|step| self.state.graph.steps(step.edge).is_none()).collect();
        let decomposed = self.decompose_until_failure(&todo);
        for (step, found) in todo.iter().zip(decomposed) {
            self.state.tally.add(&found.tally);
            self.budget.decompositions.0 += 1;
            match found.result? {
                Some(segments) => self.state.graph.set_steps(step.edge, segments),
                None => {
                    self.budget.decompositions.1 += 1;
                    self.state.graph.remove_edge(step.edge);
                    return Ok(None);
                }
            }
        }
        self.state.used = path.iter().map(|step| step.edge).collect();
        Ok(Some(self.assemble(&path)))
    }

    /// The decompositions of a path's edges in turn, up to and including the first that fails.
    fn decompose_until_failure(&self, todo: &[&Step]) -> Vec<Decomposed> {
        let mut decomposed = Vec::new();
        for found in self.session.ahead(todo.len(), |i| self.decompose(todo[i].edge)) {
            let failed = !matches!(found.result, Ok(Some(_)));
            decomposed.push(found);
            if failed {
                break;
            }
        }
        decomposed
    }

    fn decompose(&self, id: EdgeId) -> Decomposed {
        let graph = &*self.state.graph;
        let edge = graph.edge(id).expect("the path's edges are in the graph");
        let (from, to) = (graph.node(edge.from), graph.node(edge.to));
        let key = (Call::Decompose, u64::from(edge.from.0), u64::from(edge.to.0));
        let how = (EdgeKind::Grasp, &self.leg.policy);
        self.session.counted(&self.leg.task, key, |work| joined(work, how, from, to))
    }

    fn assemble(&self, path: &[Step]) -> Vec<Segment> {
        let steps_of = |step: &Step| {
            let steps = self.state.graph.steps(step.edge);
            let steps = steps.expect("every edge of the path was decomposed").to_vec();
            if step.forward { steps } else { reversed(steps) }
        };
        path.iter().flat_map(steps_of).filter(moves).collect()
    }
}
