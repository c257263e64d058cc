//! How the search went: counts that the seed determines, and times that it does not.

use crate::PluginNotes;
use regrasp_api::{Reason, Slot, Tally};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// How the search went. Everything but `time_s` is the same on every run with the same seed.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Statistics {
    /// Nodes that the search generated.
    pub generated_nodes: usize,
    /// Nodes of the final manipulation graph.
    pub graph_nodes: usize,
    /// Components of the final manipulation graph.
    pub components: usize,
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
