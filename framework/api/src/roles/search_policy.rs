//! How the planner carries out what a strategy asks for.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The parts of the algorithm around Algorithms 1 to 3 that a strategy chooses; section numbers are those of
/// A. Sahbani, J.-P. Saut, V. Perdereau, "An efficient algorithm for dexterous manipulation planning", SSD
/// 2007.
///
/// The defaults are those of the program. What the paper does is said at each field, and is what the preset
/// `paper` sets.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct SearchPolicy {
    /// Grasps that are looked for at a start given by its pose alone: the search begins in the one from which
    /// the object seems to roll farthest towards the first goal. The paper is given one (Algorithm 1, line
    /// 1).
    #[schemars(range(min = 1, max = 1000))]
    pub start_grasps: usize,
    /// Grasps that are looked for at a goal given by its pose alone before the search starts; a grasp costs
    /// little against a plan, and with several the cube's turns need fewer regrasps
    /// (`studies/departures.toml`). The paper is given one.
    #[schemars(range(min = 1, max = 1000))]
    pub goal_grasps: usize,
    /// Samples after which another grasp is looked for at such a goal; 0 means never. In the paper goals stay
    /// as they are.
    #[schemars(range(min = 0, max = 100_000))]
    pub samples_per_goal: usize,
    /// Samples after which a search without a plan is begun anew, with other grasps at its ends; 0 means
    /// never. Later rounds are longer, by Luby's sequence. All together spend `limits.budget.max_nodes`. The
    /// paper's graph grows until it is given up.
    #[schemars(range(min = 0, max = 100_000))]
    pub restart_samples: usize,
    /// Fingers that hold a node beyond the fewest that can be stable: the search lives in GS_k with k =
    /// fewest + this. The paper's reduction to GS_n is 1; 0 searches in all stable grasps.
    #[schemars(range(min = 0, max = 4))]
    pub spare_fingers: usize,
    /// Whether grasps of more fingers are nodes too, where the hand has them.
    pub more_fingers: bool,
    /// Which grasps may become nodes.
    pub admission: Admission,
    /// How two nodes are connected outside of GS_n.
    pub connection: Connection,
    /// How a path in GS_n becomes transfers and regrasps.
    pub decomposition: Decomposition,
    /// How often a way from each start to its goal is looked for by a relay, rolls with regrasps of the
    /// fingers that bar them, before the graph is begun; 0 means never. No setting: a strategy that tries
    /// start and goal first says so by settings of its own.
    #[serde(skip)]
    pub relays: usize,
}

impl Default for SearchPolicy {
    fn default() -> Self {
        Self {
            start_grasps: 12,
            goal_grasps: 6,
            samples_per_goal: 10,
            restart_samples: 60,
            spare_fingers: 1,
            more_fingers: true,
            admission: Admission::Leavable,
            connection: Connection::BothEnds,
            decomposition: Decomposition::Greedy,
            relays: 0,
        }
    }
}

/// Which grasps may become nodes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Admission {
    /// Those that can be left: stable, all fingers but one can be lifted one at a time, and every finger can
    /// retreat.
    #[default]
    Leavable,
    /// All that are free of collisions and stable, as the paper has it (section IV.B).
    Stable,
}

/// How two nodes are connected outside of GS_n (Algorithm 3, line 4).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Connection {
    /// The object rolls from both ends, and fingers are regrasped where the rolls meet; looks ahead leave
    /// hopeless rolls out.
    #[default]
    BothEnds,
    /// The object rolls from one end to the pose of the other, and fingers are regrasped there, as the paper
    /// has it (section IV.C).
    OneEnd,
}

/// How a path in GS_n becomes transfers and regrasps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Decomposition {
    /// Roll along the path as far as it goes, regrasp to the path's contacts there, go on.
    #[default]
    Greedy,
    /// Roll from one end of a piece to the other and regrasp there; where that fails, halve the piece. The
    /// paper says "a finite sequence" (section IV.D); halving is how its sources refine paths (T. Siméon,
    /// J.-P. Laumond, J. Cortés, A. Sahbani, IJRR 2004).
    Halving,
}
