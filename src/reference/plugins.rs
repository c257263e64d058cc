//! The page of plugins and their settings, from the registry.

use super::GENERATED;
use super::markdown::{block, code, heading, lines, prose, table};
use crate::Failure;
use crate::plugins::{in_scenario, on_command_line, properties};
use regrasp::api::{Entry, Slot};
use regrasp::host::{Choices, Registry, settings_schema};
use serde_json::Value;

pub fn page(registry: &Registry) -> Result<String, Failure> {
    let defaults = Choices::default();
    let mut text = format!("{GENERATED}{INTRODUCTION}\n");
    let rows: Vec<Vec<String>> = Slot::ALL.map(|slot| overview(registry, &defaults, slot)).into();
    text += &table(&["slot", "plugins"], &rows);
    let mut last = None;
    for entry in registry.entries() {
        let role = entry.role().name();
        if last != Some(role) {
            text += &heading(2, &code(role), role);
            last = Some(role);
        }
        text += &section(entry, &defaults)?;
    }
    Ok(text)
}

const INTRODUCTION: &str = "\
# Plugins and settings

Each component of the algorithm is a slot that a plugin fills. A scenario chooses a plugin with a table \
`[plugins.SLOT]`, the command line \
with `--use SLOT=ID` and `--set SLOT.KEY=VALUE`, which win over the scenario; the role in front of an id \
can be omitted. `regrasp plugins` \
prints the same as this page, for the plugins of loaded libraries too.

Settings that are left out have their defaults; a value outside of its range is refused. Where a default is \
empty, the meaning says what \
happens without the setting.

The default of each slot, the paper's, comes first.
";

/// The row of one slot: its plugins, the default one first.
fn overview(registry: &Registry, defaults: &Choices, slot: Slot) -> Vec<String> {
    let is_default = |entry: &Entry| defaults.choice(slot).id == entry.id;
    let mut entries: Vec<&Entry> = registry.entries().filter(|entry| entry.slots.contains(&slot)).collect();
    entries.sort_by_key(|entry| !is_default(entry));
    let link = |entry: &&Entry| format!("[{}](#{})", crate::plugins::bare(entry), anchor(entry));
    vec![code(slot.name()), entries.iter().map(link).collect::<Vec<_>>().join(", ")]
}

fn anchor(entry: &Entry) -> String {
    entry.id.replace('/', "-")
}

fn section(entry: &Entry, defaults: &Choices) -> Result<String, Failure> {
    let schema = settings_schema(entry).map_err(Failure::refused)?;
    let mut text = heading(3, &code(entry.id), &anchor(entry));
    text += &format!("{}\n\n", sentence(entry.summary));
    let slot = |&slot: &Slot| {
        let by_default = if defaults.choice(slot).id == entry.id { " (by default)" } else { "" };
        format!("`{}`{by_default}", slot.name())
    };
    text += &format!("Fills {}.\n\n", entry.slots.iter().map(slot).collect::<Vec<_>>().join(", "));
    text += &settings(&schema);
    text += &block("toml", &in_scenario(entry, &schema));
    text += &block("console", &format!("$ {}", on_command_line(entry, &schema)));
    if !entry.references.is_empty() {
        text += "Sources:\n\n";
        text +=
            &entry.references.iter().map(|reference| format!("- {}\n", prose(reference))).collect::<String>();
        text += "\n";
    }
    Ok(text)
}

/// A summary as a sentence.
fn sentence(summary: &str) -> String {
    let mut letters = summary.chars();
    let first: String = letters.next().into_iter().flat_map(char::to_uppercase).collect();
    let end = if summary.ends_with('.') { "" } else { "." };
    prose(&format!("{first}{}{end}", letters.as_str()))
}

fn settings(schema: &Value) -> String {
    let row = |(key, property): (&String, crate::property::Property<'_>)| {
        vec![
            code(key),
            lines(&[property.kind(), property.range_and_unit()]),
            code(&property.default()),
            prose(&property.meaning()),
        ]
    };
    let rows: Vec<Vec<String>> = properties(schema).map(row).collect();
    match rows.is_empty() {
        true => "It has no settings.\n\n".to_owned(),
        false => table(&["setting", "type, range, unit", "default", "meaning"], &rows),
    }
}
