//! What plans teach a roadmap.

use super::grow::{Gardener, with_gardener};
use super::map::Roadmap;
use crate::error::PlanError;
use crate::request::Request;
use regrasp_api::{CallError, Configuration};
use regrasp_plan::{Motion, Segment, SegmentKind};

/// Adds to a roadmap the grasps in which a motion begins, rolls on, and ends, those that may be nodes, each
/// joined to the one before and to nodes near it; how many were added.
///
/// A roadmap that has learnt is no longer the one that its seed and its number of nodes give.
pub fn learn(request: &Request<'_>, roadmap: &mut Roadmap, motion: &Motion) -> Result<usize, PlanError> {
    with_gardener(request, roadmap.seed, |gardener| {
        let (mut before, mut added) = (None, 0);
        for q in stations(motion) {
            if let Some(node) = gardener.plant(roadmap, q, before)? {
                (before, added) = (Some(node), added + 1);
            }
        }
        Ok(added)
    })
}

/// The grasps in which a motion begins, rolls on, and ends.
fn stations(motion: &Motion) -> impl Iterator<Item = &Configuration> {
    let first = motion.segments.first().and_then(|segment| segment.states.first());
    let rolls_on = |next: Option<&Segment>| next.is_none_or(|next| next.kind == SegmentKind::Transfer);
    let numbered = motion.segments.iter().enumerate();
    let left = numbered.filter(move |(k, _)| rolls_on(motion.segments.get(k + 1)));
    first.into_iter().chain(left.filter_map(|(_, segment)| segment.states.last()))
}

impl Gardener<'_> {
    /// Adds a grasp as a node, joined to the node `before` and to others; its number, if it may be one.
    fn plant(
        &self,
        roadmap: &mut Roadmap,
        q: &Configuration,
        before: Option<u32>,
    ) -> Result<Option<u32>, CallError> {
        if !self.choices.contains(&q.holding()) {
            return Ok(None);
        }
        let Some((q, row)) = self.rounded(q)? else { return Ok(None) };
        let node = roadmap.nodes.len() as u32;
        roadmap.nodes.push(&row);
        let mut links = self.links(roadmap, node, &q)?;
        if let Some(before) = before.filter(|before| links.iter().all(|link| link.to != *before)) {
            links.extend(self.link(roadmap, (node, &q), before)?);
        }
        roadmap.links.extend(links);
        roadmap.learnt += 1;
        Ok(Some(node))
    }
}
