//! What a study is: everything that is needed to repeat it, the content of `study.json`.

use super::{Hypotheses, RunRecord};
use regrasp_api::{Problem, Slot};
use regrasp_plan::PluginChoice;
use regrasp_run::scenario::PaperFigures;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// The version of `study.json` and `runs.jsonl` that this program reads and writes.
pub const STUDY_VERSION: u32 = 1;

/// The name of the format, the file's first key.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum StudyFormat {
    /// A study.
    #[default]
    #[serde(rename = "regrasp-study")]
    RegraspStudy,
}

/// A study: every scenario is planned by every variant with every seed, and every plan is verified.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Study {
    /// Says that this is a study.
    pub format: StudyFormat,
    /// [`STUDY_VERSION`].
    pub version: u32,
    /// The command that makes this study, word by word, but for what does not change its results: folder,
    /// threads, shard.
    pub command: Vec<String>,
    /// Versions of what computes, by name: `regrasp`, `program` (a hash of the executable), `library NAME` (a
    /// hash of a loaded library).
    pub versions: BTreeMap<String, String>,
    /// The machines that took part, in the order in which they came; usually one.
    pub machines: Vec<Machine>,
    /// When the study began: seconds since 1970-01-01 UTC; of a merged study, when its first part did.
    pub started_s: u64,
    /// The part of the study that is here; absent where it is the whole.
    pub shard: Option<Shard>,
    /// The scenarios, in the order in which they were named; their names differ.
    pub scenarios: Vec<StudyScenario>,
    /// The slots in which the variants differ, in the order of the slots.
    pub varied: Vec<Slot>,
    /// What is compared; the first is the baseline, with which the others are compared. Their names differ.
    pub variants: Vec<Variant>,
    /// Scenarios that a variant cannot plan, and that were left out; there are no runs of them.
    pub left_out: Vec<LeftOut>,
    /// The seeds.
    pub seeds: Seeds,
    /// Most seconds for one run; none where absent.
    pub time_limit_s: Option<f64>,
    /// Which hypotheses are tested.
    #[serde(default)]
    pub hypotheses: Hypotheses,
}

/// A scenario of a study.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StudyScenario {
    /// Its name, unique in the study.
    pub name: String,
    /// What it shows, in one line.
    pub summary: String,
    /// Where the problem comes from.
    pub source: String,
    /// What was published about it.
    pub paper: Option<PaperFigures>,
    /// For each variant, in their order: the plugin in each slot, with full id and complete settings.
    pub plugins: Vec<BTreeMap<Slot, PluginChoice>>,
    /// The problem with all limits, meshes inside.
    pub problem: Problem,
}

/// One choice of plugins that is compared with others.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Variant {
    /// Its name, unique in the study, such as `force-closure + rlg`.
    pub name: String,
    /// In each slot that is varied and that this variant fills by itself: what it fills it with, in a word or
    /// a few, such as `socp` or `interleaved end=0.8`.
    pub levels: BTreeMap<Slot, String>,
}

/// A scenario that a variant cannot plan.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LeftOut {
    /// The scenario's name.
    pub scenario: String,
    /// The variant's name.
    pub variant: String,
    /// Why.
    pub reason: String,
}

/// Consecutive seeds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Seeds {
    /// The first.
    pub first: u64,
    /// How many.
    pub count: u64,
}

impl Seeds {
    /// The seeds in ascending order.
    pub fn iter(self) -> impl Iterator<Item = u64> {
        (0..self.count).map(move |k| self.first + k)
    }
}

/// One of several parts of a study: all variants of every `of`-th pair of scenario and seed, so that runs
/// that are compared with each other were made on the same machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Shard {
    /// Which part, counted from 1.
    pub part: u64,
    /// How many parts there are.
    pub of: u64,
}

/// A machine, as far as it matters for times.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Machine {
    /// Its name in the network; empty where it is unknown.
    pub host: String,
    /// Its operating system, such as `linux`.
    pub os: String,
    /// Its architecture, such as `x86_64`.
    pub arch: String,
    /// The processor's model; empty where it is unknown.
    pub cpu: String,
    /// How many threads the processor runs at once.
    pub cores: usize,
    /// How many runs were made at once, each on one thread.
    pub threads: usize,
}

/// What identifies a run within its study: indices of scenario and variant, and the seed. In the order of
/// `runs.csv`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct RunKey {
    /// Index into [`Study::scenarios`].
    pub scenario: usize,
    /// Index into [`Study::variants`].
    pub variant: usize,
    /// The seed.
    pub seed: u64,
}

impl Study {
    /// The plugins with which a run is made.
    pub fn plugins(&self, key: RunKey) -> &BTreeMap<Slot, PluginChoice> {
        &self.scenarios[key.scenario].plugins[key.variant]
    }

    /// Index of the scenario with this name.
    pub fn scenario_index(&self, name: &str) -> Option<usize> {
        self.scenarios.iter().position(|scenario| scenario.name == name)
    }

    /// Index of the variant with this name.
    pub fn variant_index(&self, name: &str) -> Option<usize> {
        self.variants.iter().position(|variant| variant.name == name)
    }

    /// Which run of the study a record is of; `None` where it is of none.
    pub fn key(&self, record: &RunRecord) -> Option<RunKey> {
        let scenario = self.scenario_index(&record.scenario)?;
        let variant = self.variant_index(&record.variant)?;
        Some(RunKey { scenario, variant, seed: record.seed })
    }

    /// Whether a variant's runs of a scenario were left out.
    pub fn is_left_out(&self, scenario: usize, variant: usize) -> bool {
        let (scenario, variant) = (&self.scenarios[scenario].name, &self.variants[variant].name);
        self.left_out.iter().any(|pair| pair.scenario == *scenario && pair.variant == *variant)
    }

    /// The runs of the study, or of its shard, in the order of `runs.csv`: by scenario, then variant, then
    /// seed.
    pub fn keys(&self) -> Vec<RunKey> {
        let pairs = (0..self.scenarios.len()).flat_map(|s| (0..self.variants.len()).map(move |v| (s, v)));
        let seeds =
            |(scenario, variant)| self.seeds.iter().map(move |seed| RunKey { scenario, variant, seed });
        pairs.flat_map(seeds).filter(|key| self.has(*key)).collect()
    }

    /// Whether a run belongs to the study, and to its shard.
    pub fn has(&self, key: RunKey) -> bool {
        let number = key.seed.checked_sub(self.seeds.first).filter(|number| *number < self.seeds.count);
        let Some(number) = number else { return false };
        let block = key.scenario as u64 * self.seeds.count + number;
        self.shard.is_none_or(|shard| block % shard.of == shard.part - 1)
            && !self.is_left_out(key.scenario, key.variant)
    }

    /// The name of a scenario as the stem of a file's name: letters, digits, `-`, `_`, `.` alone, and for
    /// each scenario another.
    pub fn file_stem(&self, scenario: usize) -> String {
        let stem = |scenario: &StudyScenario| -> String {
            let plain = |c: char| if c.is_alphanumeric() || "-_".contains(c) { c } else { '-' };
            scenario.name.chars().take(80).map(plain).collect()
        };
        let wished = stem(&self.scenarios[scenario]);
        match self.scenarios[..scenario].iter().any(|other| stem(other) == wished) {
            true => format!("{wished}.{}", scenario + 1),
            false => wished,
        }
    }

    /// Adds machines that are not in the list.
    pub(super) fn add_machines(&mut self, machines: impl IntoIterator<Item = Machine>) {
        for machine in machines {
            if !self.machines.contains(&machine) {
                self.machines.push(machine);
            }
        }
    }

    /// What tells this study from another one, in words; `None` where both are the same: the same results but
    /// for times.
    ///
    /// The command counts for nothing, as there is more than one way to say the same, nor do machines, the
    /// time of the beginning, and the hypotheses: they change no run.
    pub fn difference(&self, other: &Self) -> Option<String> {
        let names = |study: &Self| {
            json!({
                "scenarios": study.scenarios.iter().map(|scenario| &scenario.name).collect::<Vec<_>>(),
                "variants": study.variants.iter().map(|variant| &variant.name).collect::<Vec<_>>(),
                "seeds": study.seeds,
            })
        };
        let all = |study: &Self| {
            let own = Self {
                command: Vec::new(),
                machines: Vec::new(),
                started_s: 0,
                hypotheses: Hypotheses::default(),
                ..study.clone()
            };
            serde_json::to_value(own).expect("a study is plain data with text keys")
        };
        // What a user thinks of first comes first.
        first_difference(&names(self), &names(other), "")
            .or_else(|| first_difference(&all(self), &all(other), ""))
    }

    /// Says what is wrong with a study that was read, where its parts do not fit together.
    pub(super) fn fault(&self) -> Option<String> {
        let Seeds { first, count } = self.seeds;
        let numbers = (self.scenarios.len() as u64).checked_mul(count).and(first.checked_add(count));
        if numbers.is_none() {
            return Some("`seeds` are beyond what 64 bits hold".into());
        }
        if self.shard.is_some_and(|shard| !(1..=shard.of).contains(&shard.part)) {
            return Some("`shard.part` is outside 1..=`shard.of`".into());
        }
        let whole = |scenario: &StudyScenario| {
            let full = |plugins: &BTreeMap<_, _>| plugins.len() == Slot::ALL.len();
            scenario.plugins.len() == self.variants.len() && scenario.plugins.iter().all(full)
        };
        let index = self.scenarios.iter().position(|scenario| !whole(scenario))?;
        Some(format!("`scenarios[{index}].plugins` does not have a plugin for each variant and slot"))
    }
}

/// The first place where two values differ, and how.
fn first_difference(a: &Value, b: &Value, path: &str) -> Option<String> {
    let inner = |key: &str| if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") };
    match (a, b) {
        _ if a == b => None,
        (Value::Object(x), Value::Object(y)) => {
            let keys = x.keys().chain(y.keys().filter(|key| !x.contains_key(*key)));
            let at = |key: &String| {
                let of = |map: &serde_json::Map<String, Value>| map.get(key).cloned().unwrap_or_default();
                first_difference(&of(x), &of(y), &inner(key))
            };
            keys.into_iter().find_map(at)
        }
        (Value::Array(x), Value::Array(y)) if x.len() == y.len() => x
            .iter()
            .zip(y)
            .enumerate()
            .find_map(|(i, (x, y))| first_difference(x, y, &format!("{path}[{i}]"))),
        _ => Some(format!("`{path}` is {} there and {} here", brief(a), brief(b))),
    }
}

/// A value in at most 80 characters.
fn brief(value: &Value) -> String {
    let text = match value {
        Value::Null => "absent".to_owned(),
        Value::Array(items) if items.iter().all(Value::is_string) => items
            .iter()
            .filter_map(Value::as_str)
            .map(|item| format!("`{item}`"))
            .collect::<Vec<_>>()
            .join(", "),
        Value::Array(items) => format!("a list of {}", items.len()),
        Value::Object(_) => "a table".to_owned(),
        value => value.to_string(),
    };
    if text.chars().count() <= 80 { text } else { text.chars().take(79).chain(['…']).collect() }
}

#[cfg(test)]
mod tests {
    use super::super::fixture;
    use super::*;
    use serde_json::json;

    #[test]
    fn the_first_difference_is_named_with_both_values() {
        let a = json!({"seeds": {"count": 20}, "names": ["a", "b"]});
        let b = json!({"seeds": {"count": 30}, "names": ["a", "b"]});
        let text = first_difference(&a, &b, "").unwrap();
        assert_eq!(text, "`seeds.count` is 20 there and 30 here");
        let c = json!({"seeds": {"count": 20}, "names": ["a", "c"]});
        assert_eq!(first_difference(&a, &c, "").unwrap(), "`names[1]` is \"b\" there and \"c\" here");
        let d = json!({"seeds": {"count": 20}, "names": ["a", "b"], "limit": 3});
        assert_eq!(first_difference(&a, &d, "").unwrap(), "`limit` is absent there and 3 here");
        let f = json!({"seeds": {"count": 20}, "names": ["a"]});
        assert_eq!(first_difference(&a, &f, "").unwrap(), "`names` is `a`, `b` there and `a` here");
        assert_eq!(first_difference(&a, &a, ""), None);
        let e = json!({"seeds": {"count": 20}, "names": [1, {}]});
        assert!(first_difference(&a, &e, "").unwrap().contains("`names[0]` is \"a\" there and 1 here"));
    }

    #[test]
    fn shards_share_the_runs_out_whole_pairs_of_scenario_and_seed_at_a_time() {
        let mut study = fixture::study(&["rlg", "other"]);
        let all = study.keys();
        assert_eq!(all.len(), 2 * 2 * 12);
        assert!(all.is_sorted(), "the order of the table of runs");
        let mut parts = Vec::new();
        for part in 1..=5 {
            study.shard = Some(Shard { part, of: 5 });
            let keys = study.keys();
            let other = |key: &RunKey| RunKey { variant: 1 - key.variant, ..*key };
            assert!(keys.iter().all(|key| keys.contains(&other(key))), "compared on the same machine");
            parts.extend(keys);
        }
        parts.sort();
        assert_eq!(parts, all);
    }

    #[test]
    fn what_is_left_out_has_no_runs() {
        let mut study = fixture::study(&["rlg", "other"]);
        let pair = LeftOut { scenario: "sphere".into(), variant: "rlg".into(), reason: "a test".into() };
        study.left_out.push(pair);
        assert_eq!(study.keys().len(), 3 * 12);
        assert!(!study.has(RunKey { scenario: 0, variant: 0, seed: 0 }));
        assert!(study.keeps_plan(RunKey { scenario: 0, variant: 1, seed: 0 }));
        assert!(!study.has(RunKey { scenario: 1, variant: 0, seed: 12 }), "no such seed");
    }

    #[test]
    fn files_are_named_plainly_and_apart() {
        let mut study = fixture::study(&["rlg"]);
        study.scenarios[0].name = "a/b \"c\"".into();
        study.scenarios[1].name = "a-b -c-".into();
        assert_eq!([study.file_stem(0), study.file_stem(1)], ["a-b--c-", "a-b--c-.2"]);
    }

    #[test]
    fn a_study_whose_parts_do_not_fit_is_said_to_be_faulty() {
        let mut study = fixture::study(&["rlg"]);
        assert!(study.fault().unwrap().contains("scenarios[0].plugins"), "one slot is not all slots");
        study.seeds.first = u64::MAX;
        assert!(study.fault().unwrap().contains("seeds"));
        study.seeds.first = 0;
        study.shard = Some(Shard { part: 3, of: 2 });
        assert!(study.fault().unwrap().contains("shard.part"));
    }
}
