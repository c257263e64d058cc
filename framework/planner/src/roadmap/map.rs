//! A roadmap as plain data.

use super::nodes::Nodes;
use regrasp_api::{EdgeKind, Hand};

/// An edge: steps from its later node to its earlier one were found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Link {
    /// The node that was made later.
    pub from: u32,
    /// The other.
    pub to: u32,
    /// How the nodes are joined.
    pub kind: EdgeKind,
    /// Regrasps of the steps.
    pub regrasps: u8,
    /// How far the poses of its nodes are apart (m): displacement, and turn times the object's radius.
    pub length: f32,
}

/// Words of an edge.
const WORDS: usize = 4;

impl Link {
    fn words(&self) -> [u32; WORDS] {
        let kind = u32::from(self.kind == EdgeKind::Grasp);
        [self.from, self.to, kind | u32::from(self.regrasps) << 8, self.length.to_bits()]
    }

    /// The edge of these words; `None` where they are none of a roadmap with so many nodes.
    fn of_words(words: &[u32], nodes: u32) -> Option<Self> {
        let [from, to, how, length] = *words else { return None };
        let kind = match how & 0xff {
            0 => EdgeKind::TransferRegrasp,
            1 => EdgeKind::Grasp,
            _ => return None,
        };
        let length = f32::from_bits(length);
        let is_sound = to < from && from < nodes && how >> 16 == 0 && length.is_finite() && length >= 0.0;
        is_sound.then_some(Self { from, to, kind, regrasps: (how >> 8) as u8, length })
    }
}

/// A manipulation graph that depends on no start and no goal.
///
/// It grows node by node: its first nodes with the edges between them are the roadmap that fewer nodes would
/// have given.
#[derive(Clone, Debug, PartialEq)]
pub struct Roadmap {
    pub(crate) nodes: Nodes,
    pub(crate) links: Vec<Link>,
    /// Seed of all streams that it was grown with.
    pub(crate) seed: u64,
    /// Calls of the sampler that were made for it.
    pub(crate) samples: u64,
    /// Nodes that come from plans instead of samples.
    pub(crate) learnt: u64,
}

/// What a file of a roadmap holds, in words.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct RoadmapParts {
    /// How many joints each finger has.
    pub joints: Vec<usize>,
    /// Seed of all streams that it was grown with.
    pub seed: u64,
    /// Calls of the sampler that were made for it.
    pub samples: u64,
    /// Nodes that come from plans instead of samples.
    pub learnt: u64,
    /// A row for each node.
    pub rows: Vec<u32>,
    /// Four words for each edge.
    pub links: Vec<u32>,
}

impl Roadmap {
    /// Without nodes.
    pub fn new(hand: &dyn Hand, seed: u64) -> Self {
        Self { nodes: Nodes::of(hand), links: Vec::new(), seed, samples: 0, learnt: 0 }
    }

    /// How many nodes.
    pub fn node_count(&self) -> usize {
        self.nodes.len()
    }

    /// How many edges.
    pub fn edge_count(&self) -> usize {
        self.links.len()
    }

    /// Nodes that come from plans instead of samples.
    pub fn learnt(&self) -> u64 {
        self.learnt
    }

    /// Calls of the sampler that were made for it.
    pub fn samples(&self) -> u64 {
        self.samples
    }

    /// Seed of all streams that it was grown with.
    pub fn seed(&self) -> u64 {
        self.seed
    }

    /// As words.
    pub fn parts(&self) -> RoadmapParts {
        RoadmapParts {
            joints: self.nodes.joints().to_vec(),
            seed: self.seed,
            samples: self.samples,
            learnt: self.learnt,
            rows: self.nodes.rows().to_vec(),
            links: self.links.iter().flat_map(Link::words).collect(),
        }
    }

    /// Of words; `None` where they are no roadmap.
    pub fn from_parts(parts: RoadmapParts) -> Option<Self> {
        let RoadmapParts { joints, seed, samples, learnt, rows, links } = parts;
        let nodes = Nodes::from_rows(joints, rows)?;
        let count = u32::try_from(nodes.len()).ok()?;
        if !links.len().is_multiple_of(WORDS) {
            return None;
        }
        let links: Option<_> = links.chunks_exact(WORDS).map(|words| Link::of_words(words, count)).collect();
        Some(Self { nodes, links: links?, seed, samples, learnt })
    }
}
