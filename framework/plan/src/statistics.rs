//! How the search went: counts that the seed determines, and times that it does not.

use regrasp_api::{Figure, Reason, Slot, Tally};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// What one plugin has to say of a plan.
pub type PluginNotes = BTreeMap<String, Figure>;

/// How the search went. Everything but `time_s` is the same on every run with the same seed.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Statistics {
    /// Nodes that the search generated: samples that gave a grasp, kept or not; start and goals are not among
    /// them.
    pub generated_nodes: usize,
    /// Nodes of the final manipulation graph: those that were kept, and the grasps at start and goals.
    pub graph_nodes: usize,
    /// Components of the final manipulation graph, by edges of every kind.
    pub components: usize,
    /// The graph's part in GS_n, and what became of it.
    pub roadmap: RoadmapStatistics,
    /// Transfers of the plan.
    pub transfers: usize,
    /// Regrasps of the plan.
    pub regrasps: usize,
    /// Regrasps before smoothing.
    pub regrasps_before_smoothing: usize,
    /// Calls and rejections of the plugin in each slot.
    pub plugins: BTreeMap<Slot, PluginStatistics>,
    /// Wall time by phase, such as `search` and `smoothing`, and by slot where it was measured (s).
    pub time_s: BTreeMap<String, f64>,
}

/// What the search found out about GS_n, and what the plan uses of it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct RoadmapStatistics {
    /// Generated nodes that stayed in the graph.
    pub kept_nodes: usize,
    /// Components of the graph's nodes by paths in GS_n alone.
    pub grasp_components: usize,
    /// Nodes in the largest of them.
    pub largest_grasp_component: usize,
    /// Paths in GS_n on the way that was found.
    pub used_grasp_edges: usize,
    /// Connections outside of GS_n on that way.
    pub used_transfer_edges: usize,
    /// Paths in GS_n that were to be decomposed into transfers and regrasps.
    pub decompositions: usize,
    /// Those of them that could not be.
    pub failed_decompositions: usize,
    /// How often a search was begun anew; generated nodes are those of all rounds, the graph that of the
    /// last.
    pub restarts: usize,
}

/// What one plugin did.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct PluginStatistics {
    /// How often it was called.
    pub calls: u64,
    /// How often it said no, by cause; causes that never occurred are left out.
    pub rejections: BTreeMap<Reason, u64>,
}

/// Calls and rejections of every slot that was called, from a search's counts.
pub fn plugin_statistics(tally: &Tally) -> BTreeMap<Slot, PluginStatistics> {
    let mut all = BTreeMap::new();
    for slot in Slot::ALL {
        let counts = Reason::ALL.map(|reason| (reason, tally.rejections(slot, reason)));
        let rejections: BTreeMap<_, _> = counts.into_iter().filter(|&(_, count)| count > 0).collect();
        if tally.calls(slot) > 0 || !rejections.is_empty() {
            all.insert(slot, PluginStatistics { calls: tally.calls(slot), rejections });
        }
    }
    all
}

/// What the plugins noted, by slot and name, from a search's counts.
pub fn plugin_notes(tally: &Tally) -> BTreeMap<Slot, PluginNotes> {
    let mut all: BTreeMap<Slot, PluginNotes> = BTreeMap::new();
    for note in tally.notes() {
        all.entry(note.slot).or_default().insert(note.name.to_owned(), note.figure);
    }
    all
}
