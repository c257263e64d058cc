//! Presets: plugins and settings that belong together, under one name.

use crate::{Choices, HostError};
use regrasp_api::{Slot, near};
use serde_json::Value;
use std::collections::BTreeSet;

/// A named set of plugins and settings.
#[derive(Debug, PartialEq, Eq)]
pub struct Preset {
    /// Its name.
    pub name: &'static str,
    /// What it is, in one line.
    pub summary: &'static str,
    /// What it sets, in turn.
    pub lines: &'static [PresetLine],
}

/// One thing that a preset sets.
#[derive(Debug, PartialEq, Eq)]
pub struct PresetLine {
    /// The slot.
    pub slot: Slot,
    /// What becomes of it.
    pub change: PresetChange,
    /// The place in the source that it stands for.
    pub source: &'static str,
}

/// What a preset does to a slot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PresetChange {
    /// Fills it with the plugin of this id.
    Use(&'static str),
    /// Sets a setting of its plugin; the value is JSON.
    Set(&'static str, &'static str),
}
use PresetChange::{Set, Use};

const fn line(slot: Slot, change: PresetChange, source: &'static str) -> PresetLine {
    PresetLine { slot, change, source }
}

/// Every preset.
///
/// Line and section numbers are those of A. Sahbani, J.-P. Saut, V. Perdereau, "An efficient algorithm for
/// dexterous manipulation planning", SSD 2007.
pub const PRESETS: &[Preset] = &[
    Preset {
        name: "default",
        summary: "the program's own choice: what it departs in from the paper was measured",
        lines: &[],
    },
    Preset {
        name: "paper",
        summary: "the algorithm as the paper has it, line by line",
        lines: &[
            line(Slot::Surface, Use("surface/steiner"), "IV.B: shortest paths by Lanthier's method"),
            line(Slot::Sampler, Use("sampler/rlg"), "IV.B: random loop generator"),
            line(Slot::Sampler, Set("anywhere", "1.0"), "IV.B: the active part is drawn at random"),
            line(Slot::RegraspPlanner, Use("local-planner/rrt"), "IV.C: regrasps by RRT"),
            line(Slot::RegraspPlanner, Set("direct", "false"), "IV.C: regrasps by RRT, all of them"),
            line(
                Slot::RegraspPlanner,
                Set("nodes", "400"),
                "IV.C: ours, enough for a tree without the direct way",
            ),
            line(Slot::GraphStrategy, Use("graph-strategy/interleaved"), "Algorithm 1"),
            line(Slot::GraphStrategy, Set("first_try", "false"), "Algorithm 1: nothing goes before line 2"),
            line(
                Slot::GraphStrategy,
                Set("join_ends", "false"),
                "Algorithm 2: paths in GS_n begin in new nodes",
            ),
            line(Slot::GraphStrategy, Set("start", "0.1"), "IV.A: P(α = 1) is low at first"),
            line(Slot::GraphStrategy, Set("end", "0.5"), "IV.A: and rises; the law is ours"),
            line(Slot::GraphStrategy, Set("growth", "20.0"), "IV.A: as the graph grows; the law is ours"),
            line(Slot::GraphStrategy, Set("drop_unconnected", "true"), "Algorithm 2, lines 10 to 13"),
            line(Slot::GraphStrategy, Set("all_components", "true"), "Algorithm 3, line 3"),
            line(Slot::GraphStrategy, Set("policy.start_grasps", "1"), "Algorithm 1, line 1: one q_init"),
            line(Slot::GraphStrategy, Set("policy.goal_grasps", "1"), "Algorithm 1, line 1: one q_goal"),
            line(
                Slot::GraphStrategy,
                Set("policy.samples_per_goal", "0"),
                "Algorithm 1: no other goals later",
            ),
            line(
                Slot::GraphStrategy,
                Set("policy.restart_samples", "0"),
                "Algorithm 1, line 4: one graph until Nbr_Max",
            ),
            line(Slot::GraphStrategy, Set("policy.more_fingers", "false"), "III: the search lives in GS_n"),
            line(
                Slot::GraphStrategy,
                Set("policy.connection", "\"one-end\""),
                "IV.C: roll to the pose, regrasp there",
            ),
            line(Slot::GraphStrategy, Set("policy.decomposition", "\"halving\""), "IV.D: a finite sequence"),
        ],
    },
];

/// The preset of this name.
pub fn preset(name: &str) -> Result<&'static Preset, HostError> {
    PRESETS.iter().find(|preset| preset.name == name).ok_or_else(|| {
        let known = || PRESETS.iter().map(|preset| preset.name);
        HostError::UnknownPreset {
            name: name.to_owned(),
            near: near(name, known()),
            known: known().map(str::to_owned).collect(),
        }
    })
}

impl Preset {
    /// The slots that a preset, this one or another, fills or sets: those in which two of them can differ.
    pub fn slots() -> BTreeSet<Slot> {
        PRESETS.iter().flat_map(|preset| preset.lines).map(|line| line.slot).collect()
    }

    /// Sets what the preset sets, over whatever is chosen; first what the other presets set goes back to the
    /// defaults.
    pub fn apply(&self, choices: &mut Choices) {
        let defaults = Choices::default();
        for line in PRESETS.iter().flat_map(|preset| preset.lines) {
            match line.change {
                Use(_) => choices.use_plugin(line.slot, &defaults.choice(line.slot).id),
                Set(key, _) => choices.unset(line.slot, key),
            }
        }
        for line in self.lines {
            match line.change {
                Use(id) => choices.use_plugin(line.slot, id),
                Set(key, _) => choices.set(line.slot, key, line.value()),
            }
        }
    }
}

impl PresetLine {
    /// The value that it sets; null where it sets none.
    pub fn value(&self) -> Value {
        match self.change {
            Use(_) => Value::Null,
            Set(_, json) => {
                serde_json::from_str(json).expect("the values of presets are JSON: a test reads all")
            }
        }
    }
}

impl std::fmt::Display for PresetLine {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self.change {
            Use(id) => {
                write!(f, "{} = {}", self.slot.name(), id.rsplit_once('/').map_or(id, |(_, name)| name))
            }
            Set(key, json) => write!(f, "{}.{key} = {}", self.slot.name(), json.trim_matches('"')),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_value_is_json_and_every_line_has_its_source() {
        for line in PRESETS.iter().flat_map(|preset| preset.lines) {
            assert!(!line.source.is_empty());
            assert_eq!(line.value().is_null(), matches!(line.change, Use(_)));
        }
    }

    #[test]
    fn the_default_takes_back_what_another_preset_set() {
        let mut choices = Choices::default();
        preset("paper").unwrap().apply(&mut choices);
        assert_eq!(choices.choice(Slot::Surface).id, "surface/steiner");
        assert_eq!(choices.choice(Slot::GraphStrategy).settings["policy"]["goal_grasps"], 1);
        preset("default").unwrap().apply(&mut choices);
        assert_eq!(choices, Choices::default());
    }

    #[test]
    fn what_no_preset_sets_stays() {
        let mut choices = Choices::default();
        choices.use_plugin(Slot::ContactModel, "soft-finger");
        choices.set(Slot::Sampler, "poses", Value::from(7));
        preset("paper").unwrap().apply(&mut choices);
        assert_eq!(choices.choice(Slot::ContactModel).id, "soft-finger");
        assert_eq!(choices.choice(Slot::Sampler).settings["poses"], 7);
    }

    #[test]
    fn a_misspelt_name_is_refused_with_the_likely_one() {
        let text = preset("papre").unwrap_err().to_string();
        assert_eq!(text, "there is no preset `papre`; did you mean `paper`?");
    }
}
