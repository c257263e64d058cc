//! From what is asked for to a study: variants, their plugins built for every scenario, refusals before the
//! first run.

use super::{Hypotheses, LeftOut, Machine, RunKey, Seeds, Shard, Study, StudyFormat, StudyScenario, Variant};
use super::{STUDY_VERSION, StudyError};
use regrasp_api::Slot;
use regrasp_host::{Choices, HostError, Preset, Registry};
use regrasp_plan::PluginChoice;
use regrasp_run::scenario::Scenario;
use regrasp_run::{RunError, Setup};
use serde_json::{Map, Value};
use std::collections::{BTreeMap, BTreeSet};

/// What a variant changes in one slot.
#[derive(Clone, Debug, PartialEq)]
pub struct Change {
    /// The slot.
    pub slot: Slot,
    /// The plugin that fills it; the role can be omitted. Absent where only settings change.
    pub id: Option<String>,
    /// Settings that change.
    pub settings: Map<String, Value>,
}

impl Change {
    /// Makes the change.
    pub fn apply(&self, choices: &mut Choices) {
        self.id.iter().for_each(|id| choices.use_plugin(self.slot, id));
        self.settings.iter().for_each(|(key, value)| choices.set(self.slot, key, value.clone()));
    }

    /// A few words: the plugin's name without its role, and the settings, such as `interleaved end=0.8`.
    pub fn label(&self) -> String {
        let id = self.id.as_deref().map(|id| id.rsplit_once('/').map_or(id, |(_, name)| name).to_owned());
        let setting = |(key, value): (&String, &Value)| match value {
            Value::String(text) => format!("{key}={text}"),
            value => format!("{key}={value}"),
        };
        id.into_iter().chain(self.settings.iter().map(setting)).collect::<Vec<_>>().join(" ")
    }
}

/// One level of a factor.
#[derive(Clone, Debug, PartialEq)]
pub enum Level {
    /// A preset as a whole.
    Preset(&'static Preset),
    /// A change in one slot.
    Change(Change),
}

/// A variant that is asked for.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct VariantWish {
    /// Its name.
    pub name: String,
    /// The presets that it begins with; more than one are refused.
    pub presets: Vec<&'static Preset>,
    /// What it changes after that.
    pub changes: Vec<Change>,
}

impl VariantWish {
    /// The variant with these levels, named after them.
    fn of_levels(levels: Vec<Level>) -> Self {
        let mut variant = Self::default();
        for level in levels {
            match level {
                Level::Preset(preset) => variant.presets.push(preset),
                Level::Change(change) => variant.changes.push(change),
            }
        }
        let mut ordered: Vec<&Change> = variant.changes.iter().collect();
        ordered.sort_by_key(|change| change.slot);
        let presets = variant.presets.iter().map(|preset| preset.name.to_owned());
        let labels: Vec<String> = presets.chain(ordered.iter().map(|change| change.label())).collect();
        variant.name = if labels.is_empty() { "base".to_owned() } else { labels.join(" + ") };
        variant
    }

    /// The choices of a scenario with the changes: the preset first, then plugins before settings, in
    /// whatever order they were given.
    fn choices(&self, base: &Choices) -> Choices {
        let mut choices = base.clone();
        self.presets.iter().for_each(|preset| preset.apply(&mut choices));
        let (plugins, settings): (Vec<&Change>, Vec<&Change>) =
            self.changes.iter().partition(|change| change.id.is_some());
        plugins.into_iter().chain(settings).for_each(|change| change.apply(&mut choices));
        choices
    }

    fn variant(&self) -> Variant {
        let mut levels: BTreeMap<Slot, String> = BTreeMap::new();
        let mut add = |slot: Slot, label: &str| {
            let level = levels.entry(slot).or_default();
            let space = if level.is_empty() { "" } else { " " };
            *level += &format!("{space}{label}");
        };
        for preset in &self.presets {
            Preset::slots().into_iter().for_each(|slot| add(slot, preset.name));
        }
        self.changes.iter().for_each(|change| add(change.slot, &change.label()));
        Variant { name: self.name.clone(), levels }
    }
}

/// The full factorial: a variant for every way to take one level of each factor. The first takes the first of
/// each: the baseline.
pub fn factorial(factors: &[Vec<Level>]) -> Vec<VariantWish> {
    let mut combinations: Vec<Vec<Level>> = vec![Vec::new()];
    for factor in factors {
        let with = |levels: &Vec<Level>| -> Vec<Vec<Level>> {
            factor.iter().map(|level| [levels.as_slice(), std::slice::from_ref(level)].concat()).collect()
        };
        combinations = combinations.iter().flat_map(with).collect();
    }
    combinations.into_iter().map(VariantWish::of_levels).collect()
}

/// A study that is asked for.
#[derive(Clone, Debug)]
pub struct StudyWish {
    /// See [`Study::command`].
    pub command: Vec<String>,
    /// See [`Study::versions`].
    pub versions: BTreeMap<String, String>,
    /// Where it is to run.
    pub machine: Machine,
    /// When it begins: seconds since 1970-01-01 UTC.
    pub started_s: u64,
    /// The part that is to be made; `None` for the whole.
    pub shard: Option<Shard>,
    /// What is to be compared, the baseline first.
    pub variants: Vec<VariantWish>,
    /// The seeds.
    pub seeds: Seeds,
    /// Most seconds for one run.
    pub time_limit_s: Option<f64>,
    /// Leaves out what a variant's plugins do not support, instead of refusing the study.
    pub skip_unsupported: bool,
    /// Which hypotheses are to be tested.
    pub hypotheses: Hypotheses,
}

/// A study whose plugins are built.
pub struct Prepared<'a> {
    /// What it is.
    pub study: Study,
    /// For each scenario and variant; `None` where that was left out.
    setups: Vec<Vec<Option<Setup<'a>>>>,
}

impl Prepared<'_> {
    /// What makes a run.
    pub(super) fn setup(&self, key: RunKey) -> Option<&Setup<'_>> {
        self.setups[key.scenario][key.variant].as_ref()
    }
}

/// Builds every variant's plugins for every scenario, and refuses what cannot work.
pub fn prepare<'a>(
    wish: StudyWish,
    scenarios: &'a [Scenario],
    registry: &Registry,
) -> Result<Prepared<'a>, StudyError> {
    check_names(&wish, scenarios)?;
    let mut left_out = Vec::new();
    let mut setups = Vec::new();
    for scenario in scenarios {
        let row = wish.variants.iter().map(|variant| setup(&wish, scenario, variant, registry));
        let row = row.collect::<Result<Vec<_>, _>>()?;
        let gone = row.iter().filter_map(|built| built.as_ref().err()).cloned();
        left_out.extend(gone);
        setups.push(row.into_iter().map(Result::ok).collect::<Vec<_>>());
    }
    if setups.iter().flatten().all(Option::is_none) {
        let reason = left_out.first().map_or(String::new(), |pair: &LeftOut| format!(": {}", pair.reason));
        return Err(StudyError::Empty { reason });
    }
    let described = scenarios.iter().zip(&setups).map(|(scenario, row)| described(scenario, &wish, row));
    let study = Study {
        format: StudyFormat::RegraspStudy,
        version: STUDY_VERSION,
        versions: wish.versions.clone(),
        machines: vec![wish.machine.clone()],
        started_s: wish.started_s,
        shard: wish.shard,
        scenarios: described.collect(),
        varied: varied(&wish.variants),
        variants: wish.variants.iter().map(VariantWish::variant).collect(),
        left_out,
        seeds: wish.seeds,
        time_limit_s: wish.time_limit_s,
        hypotheses: wish.hypotheses,
        command: wish.command,
    };
    Ok(Prepared { study, setups })
}

fn check_names(wish: &StudyWish, scenarios: &[Scenario]) -> Result<(), StudyError> {
    let double = |names: Vec<&str>| {
        let mut seen = BTreeSet::new();
        names.into_iter().find(|name| !seen.insert(*name)).map(str::to_owned)
    };
    if let Some(name) = double(scenarios.iter().map(|scenario| scenario.name.as_str()).collect()) {
        return Err(StudyError::DoubleScenario { name });
    }
    if let Some(name) = double(wish.variants.iter().map(|variant| variant.name.as_str()).collect()) {
        return Err(StudyError::DoubleVariant { name });
    }
    for variant in &wish.variants {
        let filled = variant.changes.iter().filter(|change| change.id.is_some());
        let filled = filled.map(|change| change.slot.name());
        // A preset counts as one more place that can be filled once.
        let presets = variant.presets.iter().map(|_| PRESET);
        if let Some(slot) = double(presets.chain(filled).collect()) {
            return Err(StudyError::TwoPlugins { variant: variant.name.clone(), slot });
        }
    }
    Ok(())
}

/// The word that takes the place of a slot where presets are varied.
pub const PRESET: &str = "preset";

/// The slots that variants fill by themselves.
fn varied(variants: &[VariantWish]) -> Vec<Slot> {
    let changed = variants.iter().flat_map(|variant| &variant.changes).map(|change| change.slot);
    let mut slots: BTreeSet<Slot> = changed.collect();
    if variants.iter().any(|variant| !variant.presets.is_empty()) {
        slots.extend(Preset::slots());
    }
    slots.into_iter().collect()
}

/// A variant's plugins for a scenario; `Ok(Err(_))` where the pair is left out.
fn setup<'a>(
    wish: &StudyWish,
    scenario: &'a Scenario,
    variant: &VariantWish,
    registry: &Registry,
) -> Result<Result<Setup<'a>, LeftOut>, StudyError> {
    let error = match Setup::new(scenario, &variant.choices(&scenario.choices), registry) {
        Ok(setup) => return Ok(Ok(setup)),
        Err(error) => error,
    };
    let (name, of) = (scenario.name.clone(), variant.name.clone());
    let unsupported =
        matches!(&error, RunError::Host(HostError::Build { .. } | HostError::TooFewFingers { .. }));
    match unsupported && wish.skip_unsupported {
        true => Ok(Err(LeftOut { scenario: name, variant: of, reason: error.to_string() })),
        false => {
            let error = Box::new(error);
            Err(StudyError::Refused { scenario: name, variant: of, unsupported, error })
        }
    }
}

fn described(scenario: &Scenario, wish: &StudyWish, row: &[Option<Setup<'_>>]) -> StudyScenario {
    let plugin = |choice: &regrasp_host::Choice| PluginChoice {
        id: choice.id.clone(),
        settings: Value::Object(choice.settings.clone()),
    };
    let plugins = |(variant, setup): (&VariantWish, &Option<Setup<'_>>)| {
        // What was left out could not be built, so that its settings are those that were asked for.
        let asked = || variant.choices(&scenario.choices);
        let choices = setup.as_ref().map_or_else(asked, |setup| setup.choices().clone());
        choices.iter().map(|(slot, choice)| (slot, plugin(choice))).collect()
    };
    let mut problem = scenario.problem.clone();
    problem.limits.budget.time_limit = wish.time_limit_s.or(problem.limits.budget.time_limit);
    StudyScenario {
        name: scenario.name.clone(),
        summary: scenario.summary.clone(),
        source: scenario.source.clone(),
        paper: scenario.paper.clone(),
        plugins: wish.variants.iter().zip(row).map(plugins).collect(),
        problem,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn change(slot: Slot, id: Option<&str>, settings: Value) -> Level {
        let settings = settings.as_object().cloned().unwrap_or_default();
        Level::Change(Change { slot, id: id.map(str::to_owned), settings })
    }

    #[test]
    fn the_factorial_takes_one_of_each_and_begins_with_the_firsts() {
        let factors = [
            vec![
                change(Slot::Sampler, Some("sampler/rlg"), json!({})),
                change(Slot::Sampler, Some("projection"), json!({})),
            ],
            vec![
                change(Slot::StabilityTest, Some("force-closure"), json!({})),
                change(Slot::StabilityTest, Some("linearised"), json!({"edges": 8})),
            ],
        ];
        let names: Vec<String> = factorial(&factors).into_iter().map(|variant| variant.name).collect();
        let expected = [
            "force-closure + rlg",
            "linearised edges=8 + rlg",
            "force-closure + projection",
            "linearised edges=8 + projection",
        ];
        assert_eq!(names, expected);
        assert_eq!(factorial(&[]).len(), 1, "nothing varied is one variant");
        assert_eq!(factorial(&[])[0].name, "base");
    }

    #[test]
    fn plugins_are_chosen_before_their_settings_are_set() {
        let settings = change(Slot::Sampler, None, json!({"tries": 3}));
        let plugin = change(Slot::Sampler, Some("projection"), json!({}));
        let variant = VariantWish::of_levels(vec![settings, plugin]);
        let choices = variant.choices(&Choices::default());
        let choice = choices.choice(Slot::Sampler);
        assert_eq!((choice.id.as_str(), &choice.settings["tries"]), ("projection", &json!(3)));
        assert_eq!(variant.variant().levels[&Slot::Sampler], "tries=3 projection");
    }

    #[test]
    fn a_preset_comes_first_and_what_is_varied_besides_wins() {
        let preset = |name| Level::Preset(regrasp_host::preset(name).unwrap());
        let factors = [
            vec![change(Slot::Sampler, Some("projection"), json!({}))],
            vec![preset("paper"), preset("default")],
        ];
        let variants = factorial(&factors);
        let names: Vec<&str> = variants.iter().map(|variant| variant.name.as_str()).collect();
        assert_eq!(names, ["paper + projection", "default + projection"]);
        let choices = variants[0].choices(&Choices::default());
        assert_eq!(choices.choice(Slot::Surface).id, "surface/steiner");
        let sampler = choices.choice(Slot::Sampler);
        assert!(sampler.id == "projection" && sampler.settings.is_empty(), "{sampler:?}");
        assert_eq!(
            variants[1].choices(&choices).choice(Slot::Surface),
            Choices::default().choice(Slot::Surface)
        );
        let levels = variants[0].variant().levels;
        assert_eq!(
            (levels[&Slot::Surface].as_str(), levels[&Slot::Sampler].as_str()),
            ("paper", "paper projection")
        );
        assert_eq!(varied(&variants), levels.keys().copied().collect::<Vec<_>>());
    }
}
