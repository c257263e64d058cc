//! `--use`, `--set` and the budgets: what the command line changes in a scenario.

use crate::Failure;
use crate::args::{ChoiceArgs, PlanArgs};
use regrasp::api::Slot;
use regrasp::host::{Choices, HostError, slot_by_name};
use regrasp::run::scenario::Scenario;
use serde_json::Value;

/// Applies the changes; `--use` before `--set`, whatever their order.
pub fn apply(scenario: &mut Scenario, args: &PlanArgs) -> Result<(), Failure> {
    apply_choices(&mut scenario.choices, &args.choices)?;
    limit_nodes(scenario, args.max_nodes);
    let budget = &mut scenario.problem.limits.budget;
    budget.time_limit = args.time_limit.or(budget.time_limit);
    Ok(())
}

/// Applies `--preset`, then `--use`, then `--set`.
pub fn apply_choices(choices: &mut Choices, args: &ChoiceArgs) -> Result<(), Failure> {
    apply_preset(choices, args.preset.as_deref())?;
    apply_plugins(choices, &args.uses, &args.sets)
}

/// Applies `--preset`, which comes before `--use` and `--set`.
pub fn apply_preset(choices: &mut Choices, name: Option<&str>) -> Result<(), Failure> {
    let Some(name) = name else { return Ok(()) };
    let preset = regrasp::host::preset(name).map_err(Failure::refused)?;
    preset.apply(choices);
    Ok(())
}

/// What a preset sets, for a person: a line each, with the place in the source that it stands for.
pub fn preset_lines(name: &str) -> Vec<String> {
    let lines = regrasp::host::preset(name).map(|preset| preset.lines).unwrap_or_default();
    lines.iter().map(|line| format!("{line}  ({})", line.source)).collect()
}

/// Applies `--use` and then `--set`.
pub fn apply_plugins(choices: &mut Choices, uses: &[String], sets: &[String]) -> Result<(), Failure> {
    uses.iter().try_for_each(|text| use_plugin(choices, text))?;
    sets.iter().try_for_each(|text| set(choices, text))
}

/// Applies `--max-nodes`.
pub fn limit_nodes(scenario: &mut Scenario, max_nodes: Option<u64>) {
    if let Some(max_nodes) = max_nodes {
        scenario.problem.limits.budget.max_nodes = max_nodes as usize;
    }
}

fn use_plugin(choices: &mut Choices, text: &str) -> Result<(), Failure> {
    let parts = text.split_once('=').filter(|(slot, id)| !slot.is_empty() && !id.is_empty());
    let Some((slot, id)) = parts else {
        let example = "such as sampler=rlg; `regrasp plugins` lists both";
        return Err(Failure::bad_input(format!("`--use {text}` is not of the form SLOT=ID, {example}")));
    };
    let slot = slot_by_name(slot).map_err(|error| refuse("use", text, &error))?;
    choices.use_plugin(slot, id);
    Ok(())
}

fn set(choices: &mut Choices, text: &str) -> Result<(), Failure> {
    let form = || {
        let example = "such as sampler.poses=200; `regrasp plugins ID` lists the keys";
        Failure::bad_input(format!("`--set {text}` is not of the form SLOT.KEY=VALUE, {example}"))
    };
    let (path, value) = text.split_once('=').ok_or_else(form)?;
    let (slot, key) = split_slot(path).map_err(|error| refuse("set", text, &error))?.ok_or_else(form)?;
    let value = match value {
        // Nothing behind the `=` unsets an option, also one that has a default.
        "" => Value::Null,
        value => parse(value).map_err(|reason| Failure::bad_input(format!("`--set {text}`: {reason}")))?,
    };
    choices.set(slot, key, value);
    Ok(())
}

/// Slot and key of `local-planner.transfer.max_slip`; a slot's own name may have a dot in it.
pub fn split_slot(path: &str) -> Result<Option<(Slot, &str)>, HostError> {
    let key_of = |slot: Slot| Some((slot, path.strip_prefix(slot.name())?.strip_prefix('.')?));
    match Slot::ALL.into_iter().find_map(key_of) {
        Some((_, "")) => Ok(None),
        Some(found) => Ok(Some(found)),
        None => match path.rsplit_once('.') {
            Some((slot, _)) => slot_by_name(slot).map(|_| None),
            None => Ok(None),
        },
    }
}

/// A value as TOML reads it; what is no TOML value is taken as a text, so that quotes can be omitted. So is
/// what TOML reads as no finite number: `how=nan` means the word where `how` is one of some words, and is
/// refused where it is a number.
pub fn parse(text: &str) -> Result<Value, String> {
    let table: Result<toml::Table, _> = toml::from_str(&format!("value = {text}"));
    let value = match table {
        Ok(mut table) => table.remove("value").unwrap_or(toml::Value::String(text.to_owned())),
        Err(_) => toml::Value::String(text.to_owned()),
    };
    match value {
        toml::Value::Float(number) if !number.is_finite() => Ok(Value::String(text.trim().to_owned())),
        value => serde_json::to_value(value).map_err(|error| error.to_string()),
    }
}

pub fn refuse(option: &str, text: &str, error: &HostError) -> Failure {
    Failure::refused(error.clone()).told(format!("`--{option} {text}`: {error}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn values_are_toml_or_plain_text() {
        assert_eq!(parse("3"), Ok(json!(3)));
        assert_eq!(parse("0.5"), Ok(json!(0.5)));
        assert_eq!(parse("[1, 2]"), Ok(json!([1, 2])));
        assert_eq!(parse("true"), Ok(json!(true)));
        assert_eq!(parse("some-word"), Ok(json!("some-word")));
        assert_eq!(parse("nan"), Ok(json!("nan")));
        assert_eq!(parse("-inf"), Ok(json!("-inf")));
    }

    #[test]
    fn slots_with_dots_are_told_from_keys_with_dots() {
        assert_eq!(split_slot("sampler.tries"), Ok(Some((Slot::Sampler, "tries"))));
        assert_eq!(split_slot("local-planner.regrasp.a.b"), Ok(Some((Slot::RegraspPlanner, "a.b"))));
        assert_eq!(split_slot("sampler"), Ok(None));
        assert_eq!(split_slot("sampler."), Ok(None));
        assert!(split_slot("samler.tries").unwrap_err().to_string().contains("did you mean `sampler`"));
    }

    #[test]
    fn words_of_the_wrong_form_are_refused() {
        let mut choices = Choices::default();
        assert!(use_plugin(&mut choices, "sampler").is_err());
        assert!(set(&mut choices, "sampler.tries").is_err());
        assert!(set(&mut choices, "sampler.tries=4").is_ok());
        assert_eq!(choices.choice(Slot::Sampler).settings["tries"], json!(4));
        assert!(set(&mut choices, "sampler.tries=").is_ok());
        assert_eq!(choices.choice(Slot::Sampler).settings["tries"], Value::Null);
    }

    /// How something is done.
    #[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize, schemars::JsonSchema)]
    #[serde(rename_all = "kebab-case")]
    enum How {
        /// As always.
        Plain,
        /// As not a number.
        Nan,
    }

    /// Settings with a word that TOML reads as a number, and an option that has a default.
    #[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize, schemars::JsonSchema)]
    #[serde(deny_unknown_fields, default)]
    struct Own {
        /// How it is done.
        how: How,
        /// The most (N), if there is one.
        #[schemars(range(min = 0.0, max = 10.0), extend("x-unit" = "N"))]
        most: Option<f64>,
    }

    impl Default for Own {
        fn default() -> Self {
            Self { how: How::Plain, most: Some(3.0) }
        }
    }

    impl regrasp::api::Settings for Own {}

    #[test]
    fn words_that_read_as_numbers_and_options_with_defaults_reach_the_plugin() {
        use regrasp::api::{Settings, fill_defaults};
        let made = |sets: &[&str]| {
            let mut choices = Choices::default();
            sets.iter().for_each(|text| set(&mut choices, text).unwrap());
            let mut settings = choices.choice(Slot::Sampler).settings.clone();
            let schema = serde_json::from_str(&Own::schema()).unwrap();
            fill_defaults(&mut settings, &schema);
            Own::from_json(&Value::Object(settings).to_string())
        };
        assert_eq!(made(&[]).unwrap(), Own::default());
        assert_eq!(made(&["sampler.how=nan"]).unwrap(), Own { how: How::Nan, most: Some(3.0) });
        assert_eq!(made(&["sampler.most="]).unwrap(), Own { how: How::Plain, most: None });
        let refused = made(&["sampler.most=nan"]).unwrap_err().to_string();
        assert!(refused.contains("`most`"), "{refused}");
    }
}
