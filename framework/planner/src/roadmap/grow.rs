//! Growing: one grasp of GS_n after the other, each joined to some of those that are there.

use super::map::{Link, Roadmap};
use super::near::{apart, nearest};
use super::nodes::{decode, encode};
use crate::draft::regrasps;
use crate::error::PlanError;
use crate::joined::joined;
use crate::request::Request;
use crate::session::{Call, Session};
use crate::solve::{finger_choices, with_task};
use regrasp_api::{
    CallError, Configuration, Context, EdgeKind, FingerSet, PoseRequest, SearchPolicy, Task, angle_between,
};

/// Nodes that are looked at together; what comes of them does not depend on it.
const BATCH: usize = 32;
/// So many calls of the sampler in turn without a grasp, and there is none in the workspace.
const BARREN: u64 = 500;
/// How many of the nearest nodes a new one is joined to, among all nodes, then among the first quarter of
/// them, and so on: these are farther away, and ways along them need fewer regrasps.
const LINKS: usize = 2;
/// How many of the nearest are tried for that.
const TRIES: usize = 4;
/// What is left of the nodes from one look to the next.
const THINNED: usize = 4;
/// Among fewer nodes than these nothing is near.
const FEWEST: usize = 8;
/// The largest turn (rad) between nodes for which a path in GS_n is asked for where rolls do not join them.
const INSIDE_TURN: f64 = 1.0;

/// How growing ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Grown {
    /// There are as many nodes as were asked for.
    Enough,
    /// Stopped from outside.
    Interrupted,
    /// Call after call of the sampler gives no grasp.
    Barren,
}

/// Grows a roadmap to so many nodes; `told` of every few of them, and grows on as long as it says so.
///
/// The roadmap of a seed and a number of nodes is always the same, on any number of threads and in however
/// many pieces it was grown, unless something was learnt in between. Start and goals of the request do not
/// count, but for the box about them where the problem has no workspace; its seed does not either.
pub fn grow(
    request: &Request<'_>,
    roadmap: &mut Roadmap,
    nodes: usize,
    told: &mut dyn FnMut(&Roadmap) -> bool,
) -> Result<Grown, PlanError> {
    with_gardener(request, roadmap.seed, |gardener| {
        loop {
            match gardener.batch(roadmap, nodes) {
                Ok(None) => {}
                Ok(Some(end)) => return Ok(end),
                Err(CallError::Interrupted) => return Ok(Grown::Interrupted),
                Err(error) => return Err(error.into()),
            }
            if !told(roadmap) {
                return Ok(Grown::Interrupted);
            }
        }
    })
}

/// Does something with what growing needs for a request and a roadmap's seed.
pub(super) fn with_gardener<T>(
    request: &Request<'_>,
    seed: u64,
    work: impl FnOnce(&Gardener<'_>) -> Result<T, PlanError>,
) -> Result<T, PlanError> {
    let poses = request.problem.poses()?;
    with_task(request, &poses, |task, session, policy| {
        let task = Task { landmarks: &[], ..*task };
        let session = Session { seed, ..*session };
        let choices = finger_choices(&task, policy.spare_fingers, policy.more_fingers)?;
        work(&Gardener { task, session, policy, choices })
    })
}

/// What growing needs.
pub(crate) struct Gardener<'a> {
    pub task: Task<'a>,
    pub session: Session<'a>,
    pub policy: SearchPolicy,
    pub choices: Vec<FingerSet>,
}

/// A new node, and the calls of the sampler that it took.
struct Sprout {
    q: Configuration,
    row: Vec<u32>,
    samples: u64,
}

impl Gardener<'_> {
    /// Some more nodes; how growing ended if it did.
    fn batch(&self, roadmap: &mut Roadmap, nodes: usize) -> Result<Option<Grown>, CallError> {
        let wanted = nodes.saturating_sub(roadmap.node_count()).min(BATCH);
        if wanted == 0 {
            return Ok(Some(Grown::Enough));
        }
        let sprouts = self.sprouts(roadmap, wanted)?;
        if sprouts.is_empty() {
            return Ok(Some(Grown::Barren));
        }
        let before = roadmap.nodes.len();
        sprouts.iter().for_each(|sprout| roadmap.nodes.push(&sprout.row));
        let links = self.session.draw(sprouts.len(), |i| {
            let node = (before + i) as u32;
            self.links(roadmap, node, &sprouts[i].q)
        });
        let links: Result<Vec<_>, _> = links.into_iter().collect();
        match links {
            Ok(links) => {
                roadmap.links.extend(links.into_iter().flatten());
                roadmap.samples += sprouts.iter().map(|sprout| sprout.samples).sum::<u64>();
                Ok(None)
            }
            Err(error) => {
                roadmap.nodes.truncate(before);
                Err(error)
            }
        }
    }

    /// The next grasps, at most so many; none where there are none to be found.
    fn sprouts(&self, roadmap: &Roadmap, wanted: usize) -> Result<Vec<Sprout>, CallError> {
        let (mut sprouts, mut next, mut barren) = (Vec::new(), roadmap.samples, 0);
        while sprouts.len() < wanted && barren < BARREN {
            let drawn = self.session.draw(wanted, |i| self.sample(next + i as u64));
            for found in drawn {
                (next, barren) = (next + 1, barren + 1);
                if let Some((q, row)) = found? {
                    sprouts.push(Sprout { q, row, samples: barren });
                    barren = 0;
                }
                if sprouts.len() == wanted {
                    break;
                }
            }
        }
        Ok(sprouts)
    }

    /// The grasp of the sample with this number, as its row gives it back.
    fn sample(&self, number: u64) -> Result<Option<(Configuration, Vec<u32>)>, CallError> {
        let found = self.session.counted(&self.task, (Call::RoadmapSample, number, 0), |work| {
            let holding = self.choices[work.context.random.index(self.choices.len())];
            work.plugins.sampler.sample(work.task, PoseRequest::Anywhere, holding, &mut work.context)
        });
        let Some(q) = found.result? else { return Ok(None) };
        self.rounded(&q)
    }

    /// A grasp as a row gives it back, if it still may be a node.
    pub fn rounded(&self, q: &Configuration) -> Result<Option<(Configuration, Vec<u32>)>, CallError> {
        let row = encode(&self.task, q);
        let joints: Vec<usize> = q.joints.iter().map(|(_, joints)| joints.len()).collect();
        let Some(q) = decode(&self.task, &joints, &row) else { return Ok(None) };
        let mut context = Context::new(regrasp_api::Random::from_key(0, 0, 0, 0), self.session.interrupt);
        let refused = self.task.admissible.admit(&self.task, &q, &mut context);
        Ok(regrasp_api::unless_fault(refused)?.is_none().then_some((q, row)))
    }

    /// The edges from a node to earlier ones.
    pub fn links(&self, roadmap: &Roadmap, node: u32, q: &Configuration) -> Result<Vec<Link>, CallError> {
        let poses = roadmap.nodes.poses();
        let turn_length = self.task.object.mesh.radius() as f32;
        let (mut links, mut tried): (Vec<Link>, Vec<u32>) = (Vec::new(), Vec::new());
        let mut among = node as usize;
        loop {
            let near = nearest(&poses[..among], &poses[node as usize], turn_length, TRIES);
            let mut made = 0;
            for (other, _) in near {
                if made == LINKS || tried.contains(&other) {
                    continue;
                }
                tried.push(other);
                if let Some(link) = self.link(roadmap, (node, q), other)? {
                    links.push(link);
                    made += 1;
                }
            }
            among /= THINNED;
            if among < FEWEST {
                return Ok(links);
            }
        }
    }

    /// The edge between a node and an earlier one, if there is one.
    pub fn link(
        &self,
        roadmap: &Roadmap,
        (node, q): (u32, &Configuration),
        other: u32,
    ) -> Result<Option<Link>, CallError> {
        let Some(to) = roadmap.nodes.get(&self.task, other) else { return Ok(None) };
        for kind in [EdgeKind::TransferRegrasp, EdgeKind::Grasp] {
            if kind == EdgeKind::Grasp && !may_slide(q, &to) {
                continue;
            }
            let found = self.session.counted(&self.task, edge_key(node, other), |work| {
                joined(work, (kind, &self.policy), q, &to)
            });
            if let Some(segments) = found.result? {
                let poses = roadmap.nodes.poses();
                let turn_length = self.task.object.mesh.radius() as f32;
                let length = apart(&poses[node as usize], &poses[other as usize], turn_length);
                let regrasps = regrasps(&segments).min(usize::from(u8::MAX)) as u8;
                return Ok(Some(Link { from: node, to: other, kind, regrasps, length }));
            }
        }
        Ok(None)
    }
}

/// The key of the call that makes an edge.
pub(crate) fn edge_key(from: u32, to: u32) -> (Call, u64, u64) {
    (Call::RoadmapEdge, u64::from(from), u64::from(to))
}

/// Whether a path in GS_n may join two nodes and is worth asking for.
fn may_slide(q: &Configuration, to: &Configuration) -> bool {
    q.holding() == to.holding() && angle_between(&q.X_HO.rotation, &to.X_HO.rotation) < INSIDE_TURN
}
