//! Which plugin fills each slot, with which settings.

use crate::{HostError, Registry};
use regrasp_api::{Entry, Slot, fill_defaults, unless_fault};
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

/// One plugin with its settings.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Choice {
    /// The plugin's id; the role can be omitted until the choice is resolved.
    pub id: String,
    /// Its settings; the plugin's defaults stand for what is absent.
    #[serde(default)]
    pub settings: Map<String, Value>,
}

/// A plugin for each slot.
#[derive(Clone, Debug, PartialEq)]
pub struct Choices {
    choices: [Choice; Slot::ALL.len()],
}

impl Default for Choices {
    fn default() -> Self {
        let choice = |slot: Slot| Choice { id: slot.default_plugin().to_owned(), settings: Map::new() };
        Self { choices: Slot::ALL.map(choice) }
    }
}

impl Choices {
    /// The choice for a slot.
    pub fn choice(&self, slot: Slot) -> &Choice {
        &self.choices[slot as usize]
    }

    /// Slots and choices, in the order of the slots.
    pub fn iter(&self) -> impl Iterator<Item = (Slot, &Choice)> {
        Slot::ALL.into_iter().zip(&self.choices)
    }

    /// Fills a slot with the plugin `id`; the settings of another plugin that filled it before are dropped.
    pub fn use_plugin(&mut self, slot: Slot, id: &str) {
        let choice = &mut self.choices[slot as usize];
        let same = choice.id == id || choice.id == format!("{}/{id}", slot.role().name());
        if !same {
            *choice = Choice { id: id.to_owned(), settings: Map::new() };
        }
    }

    /// Sets one setting of the plugin in a slot; a dot in `key` leads into a table.
    pub fn set(&mut self, slot: Slot, key: &str, value: Value) {
        let mut table = &mut self.choices[slot as usize].settings;
        let mut key = key;
        while let Some((head, rest)) = key.split_once('.') {
            let inner = table.entry(head).or_insert_with(|| Value::Object(Map::new()));
            if !inner.is_object() {
                *inner = Value::Object(Map::new());
            }
            table = inner.as_object_mut().expect("it was made a table just now");
            key = rest;
        }
        table.insert(key.to_owned(), value);
    }

    /// Takes one setting back to the plugin's default; a dot in `key` leads into a table, which goes too once
    /// it is empty.
    pub fn unset(&mut self, slot: Slot, key: &str) {
        unset(&mut self.choices[slot as usize].settings, key);
    }

    /// The same choices with full ids and complete settings, each accepted by its plugin.
    pub fn resolve(&self, registry: &Registry) -> Result<Self, HostError> {
        let mut resolved = self.clone();
        for slot in Slot::ALL {
            resolved = resolved.resolve_slot(registry, slot)?;
        }
        Ok(resolved)
    }

    /// The same choices with one slot resolved, as [`Self::resolve`] resolves all.
    pub fn resolve_slot(mut self, registry: &Registry, slot: Slot) -> Result<Self, HostError> {
        self.choices[slot as usize] = resolve_choice(registry, slot, self.choice(slot))?;
        Ok(self)
    }
}

fn unset(table: &mut Map<String, Value>, key: &str) {
    let Some((head, rest)) = key.split_once('.') else {
        table.remove(key);
        return;
    };
    let Some(inner) = table.get_mut(head).and_then(Value::as_object_mut) else { return };
    unset(inner, rest);
    if inner.is_empty() {
        table.remove(head);
    }
}

fn resolve_choice(registry: &Registry, slot: Slot, choice: &Choice) -> Result<Choice, HostError> {
    let entry = registry.lookup(slot, &choice.id)?;
    let id = entry.id.to_owned();
    let mut settings = choice.settings.clone();
    fill_defaults(&mut settings, &settings_schema(entry)?);
    (entry.check)(&settings_text(&settings))
        .map_err(|error| HostError::Settings { id: id.clone(), error })?;
    Ok(Choice { id, settings })
}

/// The JSON schema of a plugin's settings.
pub fn settings_schema(entry: &Entry) -> Result<Value, HostError> {
    // A schema that is not JSON cannot say more than the plugin's own check of its settings.
    Ok(unless_fault(Ok(serde_json::from_str(&(entry.schema)()).unwrap_or_default()))?)
}

/// Settings as the JSON text that an entry's functions take.
pub(crate) fn settings_text(settings: &Map<String, Value>) -> String {
    serde_json::to_string(settings).expect("a map of JSON values is JSON")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_plugins::{all_choices, entries};
    use serde_json::json;

    fn registry() -> Registry {
        Registry::new(entries()).unwrap()
    }

    #[test]
    fn defaults_are_the_papers() {
        let ids: Vec<String> = Choices::default().iter().map(|(_, choice)| choice.id.clone()).collect();
        assert_eq!(ids[0], "contact-model/pcwf");
        assert_eq!(ids[7], "graph-strategy/interleaved");
        let roles = Choices::default();
        assert!(roles.iter().all(|(slot, choice)| choice.id.starts_with(slot.role().name())));
    }

    #[test]
    fn another_plugin_drops_the_settings_and_the_same_keeps_them() {
        let mut choices = Choices::default();
        choices.set(Slot::Sampler, "tries", json!(3));
        choices.use_plugin(Slot::Sampler, "rlg");
        assert_eq!(choices.choice(Slot::Sampler).settings["tries"], json!(3));
        choices.use_plugin(Slot::Sampler, "projection");
        assert!(choices.choice(Slot::Sampler).settings.is_empty());
    }

    #[test]
    fn dots_lead_into_tables() {
        let mut choices = Choices::default();
        choices.set(Slot::Sampler, "a.b", json!(1));
        choices.set(Slot::Sampler, "a.c", json!(2));
        assert_eq!(choices.choice(Slot::Sampler).settings["a"], json!({"b": 1, "c": 2}));
    }

    #[test]
    fn resolving_completes_ids_and_settings_and_refuses_bad_ones() {
        let mut choices = all_choices();
        choices.use_plugin(Slot::StabilityTest, "always");
        let resolved = choices.resolve(&registry()).unwrap();
        let choice = resolved.choice(Slot::StabilityTest);
        assert_eq!(choice.id, "stability-test/always");
        assert_eq!(choice.settings["edges"], json!(8));

        choices.set(Slot::StabilityTest, "edge", json!(3));
        let text = choices.resolve(&registry()).unwrap_err().to_string();
        assert_eq!(text, "`stability-test/always`: `edge`: unknown key; did you mean `edges`?");

        let mut choices = all_choices();
        choices.set(Slot::StabilityTest, "edges", json!(2));
        let text = choices.resolve(&registry()).unwrap_err().to_string();
        assert_eq!(text, "`stability-test/always`: `edges` = 2 is outside 3..=64");
    }
}
