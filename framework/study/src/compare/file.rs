//! Study files: comparisons that are too long for a command line, or that are to be kept.

use super::{Change, DEFAULT_BAND, Hypotheses, Level, MeasureName, PRESET, Pairs, VariantWish, factorial};
use regrasp_api::{Refuse, Slot};
use regrasp_host::{HostError, Preset, Registry, preset, slot_by_name};
use regrasp_run::scenario::{
    self, BuiltIn, Document, PluginTable, PluginTables, Scenario, ScenarioError, key_path,
};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::path::Path;

/// How many seeds a study may have.
pub const MOST_SEEDS: u64 = 1_000_000;

/// How many seeds a study has unless it says otherwise.
pub const DEFAULT_SEEDS: u64 = 20;

/// A study file: what is compared on which scenarios. Variants are either the full factorial of `[[vary]]`,
/// or listed one by one as `[[variant]]`.
#[derive(Clone, Debug, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct StudyFile {
    /// Built-in scenarios by name, or scenario files, relative to this file.
    pub scenarios: Vec<String>,
    /// Built-in scenarios by the dozen, before those in `scenarios`.
    #[schemars(example = &"paper")]
    pub suite: Option<Suite>,
    /// How many seeds; 20 where absent.
    #[schemars(range(min = 1, max = 1_000_000))]
    pub seeds: Option<u64>,
    /// The first seed; 0 where absent.
    pub first_seed: Option<u64>,
    /// Most time for one run (s); no limit where absent.
    #[schemars(range(min = 0.001, max = 1e7), extend("x-unit" = "s"))]
    pub time_limit: Option<f64>,
    /// Most nodes to generate for each goal; where absent, what the scenario says.
    #[schemars(range(min = 1, max = 10_000_000))]
    #[schemars(example = 500)]
    pub max_nodes: Option<u64>,
    /// Which variants are compared: each with the first, or each with each; `baseline` where absent.
    pub pairs: Option<Pairs>,
    /// What they are compared in; everything that the runs have where empty.
    pub measures: Vec<MeasureName>,
    /// Differences within this share of the first variant's median, in percent, count as practically none; 10
    /// where absent.
    #[schemars(range(min = 0.0, max = 100.0), extend("x-unit" = "1"))]
    pub equivalence: Option<f64>,
    /// Plugins for all variants, where these do not choose others.
    pub plugins: PluginTables,
    /// Factors: all combinations of their levels are compared. The first level of each makes the baseline.
    pub vary: Vec<FactorTable>,
    /// Variants; the first is the baseline.
    pub variant: Vec<VariantTable>,
}

/// A set of built-in scenarios.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Suite {
    /// The paper's three problems.
    Paper,
    /// The same with grasps given at both ends, five pairs each, as the paper's Algorithm 1 has them.
    Strict,
    /// The paper's problems made harder.
    Harder,
    /// Every built-in scenario.
    All,
}

/// The paper's problems among the built-in scenarios.
const PAPER: [&str; 3] = ["sphere", "cubic", "ellip-obst"];

impl Suite {
    /// Every suite.
    pub const ALL: [Self; 4] = [Self::Paper, Self::Strict, Self::Harder, Self::All];

    /// The name in files and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Paper => "paper",
            Self::Strict => "strict",
            Self::Harder => "harder",
            Self::All => "all",
        }
    }

    /// The names of its scenarios.
    pub fn scenarios(self) -> Vec<&'static str> {
        let names = |files: &[BuiltIn]| files.iter().map(|built_in| built_in.name).collect();
        match self {
            Self::Paper => PAPER.to_vec(),
            Self::Strict => names(scenario::STRICT),
            Self::Harder => names(scenario::HARDER),
            Self::All => names(scenario::SCENARIOS),
        }
    }
}

/// A factor: one slot and what it is filled with in turn, or presets.
#[derive(Clone, Debug, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FactorTable {
    /// The slot, such as `sampler` or `local-planner.regrasp`; or `preset`, whose levels are presets by name.
    #[schemars(example = &"sampler")]
    pub slot: String,
    /// The levels: plugins, settings, or both.
    pub levels: Vec<PluginTable>,
}

/// A variant of its own name.
#[derive(Clone, Debug, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct VariantTable {
    /// What it is called.
    pub name: String,
    /// What it changes.
    #[serde(default)]
    pub plugins: PluginTables,
}

/// What is to be compared on what, read and checked.
#[derive(Default)]
pub struct StudyRequest {
    /// The scenarios, with the changes for all variants made.
    pub scenarios: Vec<Scenario>,
    /// The variants.
    pub variants: Vec<VariantWish>,
    /// How many seeds.
    pub seeds: Option<u64>,
    /// The first seed.
    pub first_seed: Option<u64>,
    /// Most seconds for one run.
    pub time_limit_s: Option<f64>,
    /// Most nodes to generate for each goal.
    pub max_nodes: Option<u64>,
    /// Which hypotheses are tested.
    pub hypotheses: Hypotheses,
}

/// Reads a study file.
pub fn load_study(path: &Path, registry: &Registry) -> Result<StudyRequest, ScenarioError> {
    let name = path.display().to_string();
    let document = Document::parse(&name, &scenario::read(path)?)?;
    let content: StudyFile = document.read()?;
    let variants = variants(&document, &content, registry)?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let base_preset = preset_of(&document, &content.plugins, "plugins")?;
    let base = changes(&content.plugins);
    base.iter().try_for_each(|change| check_plugin(&document, change, "plugins", registry))?;
    let mut scenarios = Vec::new();
    for name in scenario_names(&document, &content, folder)? {
        let mut scenario = scenario::load(&name, registry)?;
        base_preset.iter().for_each(|preset| preset.apply(&mut scenario.choices));
        base.iter().for_each(|change| change.apply(&mut scenario.choices));
        scenarios.push(scenario);
    }
    Ok(StudyRequest {
        scenarios,
        variants,
        seeds: content.seeds,
        first_seed: content.first_seed,
        time_limit_s: content.time_limit,
        max_nodes: content.max_nodes,
        hypotheses: Hypotheses {
            pairs: content.pairs.unwrap_or_default(),
            measures: content.measures,
            band: content.equivalence.map_or(DEFAULT_BAND, |percent| 1e-2 * percent),
        },
    })
}

/// The JSON schema of study files, as text for a person or an editor to read.
pub fn study_schema() -> String {
    let schema = schemars::schema_for!(StudyFile).to_value();
    serde_json::to_string_pretty(&schema).expect("a JSON value is JSON")
}

fn scenario_names(
    document: &Document,
    content: &StudyFile,
    folder: &Path,
) -> Result<Vec<String>, ScenarioError> {
    let suite = content.suite.map(Suite::scenarios).unwrap_or_default();
    let place = |name: &String| match scenario::find_scenario(name) {
        Some(_) => name.clone(),
        // A word that is neither a built-in name nor looks like a file is for `load` to explain.
        None if !folder.join(name).exists() && Path::new(name).extension().is_none() => name.clone(),
        None => folder.join(name).display().to_string(),
    };
    let names: Vec<String> =
        suite.into_iter().map(str::to_owned).chain(content.scenarios.iter().map(place)).collect();
    if names.is_empty() {
        let message = "give `scenarios`, such as [\"sphere\", \"cubic\"], or a `suite`".to_owned();
        return Err(document.refuse(&key_path("scenarios"), message));
    }
    Ok(names)
}

fn variants(
    document: &Document,
    content: &StudyFile,
    registry: &Registry,
) -> Result<Vec<VariantWish>, ScenarioError> {
    if !content.vary.is_empty() && !content.variant.is_empty() {
        let message = "give either `vary`, of which all combinations are compared, or `variant`, not both";
        return Err(document.refuse(&key_path("variant"), message.to_owned()));
    }
    if content.variant.is_empty() {
        let factors = content.vary.iter().enumerate();
        let factors = factors.map(|(i, table)| factor(document, table, i, registry));
        return Ok(factorial(&factors.collect::<Result<Vec<_>, _>>()?));
    }
    let drafts = content.variant.iter().enumerate().map(|(i, table)| {
        let key = format!("variant[{i}].plugins");
        let presets = preset_of(document, &table.plugins, &key)?.into_iter().collect();
        let changes = changes(&table.plugins);
        changes.iter().try_for_each(|change| check_plugin(document, change, &key, registry))?;
        Ok(VariantWish { name: table.name.clone(), presets, changes })
    });
    drafts.collect()
}

fn factor(
    document: &Document,
    table: &FactorTable,
    index: usize,
    registry: &Registry,
) -> Result<Vec<Level>, ScenarioError> {
    let key = format!("vary[{index}]");
    let slot = match table.slot.as_str() {
        PRESET => None,
        name => Some(slot_by_name(name).map_err(|error| {
            let key = format!("{key}.slot");
            document.refused(&error.refusal().told(&format!("`{key}`: {error}")).key(key))
        })?),
    };
    if table.levels.is_empty() {
        let message = format!("`{key}.levels` is empty; give it plugins, such as [{{ use = \"…\" }}]");
        return Err(document.refuse(&key_path(&format!("{key}.levels")), message));
    }
    let Some(slot) = slot else { return preset_levels(document, table, &key) };
    let levels = table.levels.iter().enumerate().map(|(k, level)| {
        let change = change(slot, level);
        check_id(document, &change, &format!("{key}.levels[{k}]"), registry)?;
        Ok(Level::Change(change))
    });
    levels.collect()
}

/// The levels of a factor of presets.
fn preset_levels(document: &Document, table: &FactorTable, key: &str) -> Result<Vec<Level>, ScenarioError> {
    let level = |(k, level): (usize, &PluginTable)| {
        let key = format!("{key}.levels[{k}]");
        match (&level.id, level.settings.is_empty()) {
            (Some(name), true) => named_preset(document, name, &format!("{key}.use")).map(Level::Preset),
            _ => {
                let message = format!("`{key}` names a preset by `use`, such as `paper`, and nothing else");
                Err(document.refuse(&key_path(&key), message))
            }
        }
    };
    table.levels.iter().enumerate().map(level).collect()
}

fn change(slot: Slot, table: &PluginTable) -> Change {
    Change { slot, id: table.id.clone(), settings: table.settings.clone() }
}

/// The preset that tables of plugins begin with.
fn preset_of(
    document: &Document,
    tables: &PluginTables,
    key: &str,
) -> Result<Option<&'static Preset>, ScenarioError> {
    let preset = |name: &String| named_preset(document, name, &format!("{key}.{PRESET}"));
    tables.preset.as_ref().map(preset).transpose()
}

fn named_preset(document: &Document, name: &str, key: &str) -> Result<&'static Preset, ScenarioError> {
    let refuse =
        |error: HostError| document.refused(&error.refusal().told(&format!("`{key}`: {error}")).key(key));
    preset(name).map_err(refuse)
}

/// What tables of plugins change after that.
fn changes(tables: &PluginTables) -> Vec<Change> {
    let changes = Slot::ALL.into_iter().map(|slot| change(slot, tables.table(slot)));
    changes.filter(|change| change.id.is_some() || !change.settings.is_empty()).collect()
}

fn check_plugin(
    document: &Document,
    change: &Change,
    tables: &str,
    registry: &Registry,
) -> Result<(), ScenarioError> {
    check_id(document, change, &format!("{tables}.{}", change.slot.name()), registry)
}

/// Refuses a plugin that does not exist where it is named; settings are looked at with each scenario's own.
fn check_id(
    document: &Document,
    change: &Change,
    key: &str,
    registry: &Registry,
) -> Result<(), ScenarioError> {
    let Some(id) = &change.id else { return Ok(()) };
    let key = format!("{key}.use");
    let refuse = |error: regrasp_host::HostError| {
        document.refused(&error.refusal().told(&format!("`{key}`: {error}")).key(&key))
    };
    registry.lookup(change.slot, id).map(drop).map_err(refuse)
}
