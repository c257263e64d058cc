//! `regrasp plugins`

use crate::args::{LibraryArgs, PluginsArgs};
use crate::property::Property;
use crate::table::Table;
use crate::{Failure, say, say_json};
use regrasp::api::{Entry, Role, Slot, did_you_mean, near};
use regrasp::host::{Choices, Registry, settings_schema};
use regrasp::run::scenario::SCENARIOS;
use serde_json::{Value, json};

/// The plugins that are linked into the program, and those of the libraries that are to be loaded.
pub fn registry(libraries: &LibraryArgs) -> Result<Registry, Failure> {
    let linked = Registry::linked().map_err(Failure::refused)?;
    linked.with_libraries(&libraries.load).map_err(Failure::refused)
}

pub fn run(args: &PluginsArgs) -> Result<(), Failure> {
    let registry = registry(&args.libraries)?;
    let entries = select(&registry, args.what.as_deref())?;
    if args.json {
        let described: Result<_, Failure> = entries.iter().map(|entry| described(&registry, entry)).collect();
        return say_json(&Value::Array(described?));
    }
    match (entries.as_slice(), &args.what) {
        ([one], Some(what)) if Role::ALL.iter().all(|role| role.name() != what) => {
            say(&details(&registry, one)?)
        }
        (entries, _) => say(&list(&registry, entries)),
    }
}

/// The plugins that are asked for: all, those of a role, or one.
fn select(registry: &Registry, what: Option<&str>) -> Result<Vec<&'static Entry>, Failure> {
    let Some(what) = what else { return Ok(registry.entries().collect()) };
    if let Some(role) = Role::ALL.into_iter().find(|role| role.name() == what) {
        return Ok(registry.of_role(role).collect());
    }
    if let Some(entry) = registry.find(what) {
        return Ok(vec![entry]);
    }
    let names = Role::ALL.iter().map(|role| role.name()).chain(registry.entries().map(|entry| entry.id));
    let bare = registry.entries().filter_map(|entry| entry.id.split_once('/')).map(|(_, name)| name);
    let hint = match did_you_mean(&near(what, names.chain(bare))) {
        none if none.is_empty() => "`regrasp plugins` lists them".to_owned(),
        hint => hint,
    };
    Err(Failure::bad_input(format!("there is no role or plugin `{what}`; {hint}")))
}

fn described(registry: &Registry, entry: &Entry) -> Result<Value, Failure> {
    Ok(json!({
        "id": entry.id,
        "role": entry.role().name(),
        "slots": entry.slots.iter().map(|slot| slot.name()).collect::<Vec<_>>(),
        "summary": entry.summary,
        "references": entry.references,
        "settings_schema": settings_schema(entry).map_err(Failure::refused)?,
        "source": registry.source(entry).to_string(),
    }))
}

fn list(registry: &Registry, entries: &[&'static Entry]) -> String {
    let defaults = Choices::default();
    let mut table = Table::new("<", &["plugin", "slots (* by default)", "source", "what it is"]);
    for entry in entries {
        let slot = |&slot: &Slot| {
            let star = if defaults.choice(slot).id == entry.id { "*" } else { "" };
            format!("{}{star}", slot.name())
        };
        let slots: Vec<String> = entry.slots.iter().map(slot).collect();
        let source = registry.source(entry).to_string();
        table.row([entry.id.to_owned(), slots.join(", "), source, entry.summary.to_owned()]);
    }
    table.text()
}

fn details(registry: &Registry, entry: &Entry) -> Result<String, Failure> {
    let slots: Vec<&str> = entry.slots.iter().map(|slot| slot.name()).collect();
    let mut text = format!("{}\n  {}\n  slots: {}\n", entry.id, entry.summary, slots.join(", "));
    text += &format!("  source: {}\n", registry.source(entry));
    for reference in entry.references {
        text += &format!("  reference: {reference}\n");
    }
    let schema = settings_schema(entry).map_err(Failure::refused)?;
    Ok(text + &settings(&schema) + &example(entry, &schema))
}

/// The settings that a schema knows, in the order of their names.
pub fn properties(schema: &Value) -> impl Iterator<Item = (&String, Property<'_>)> {
    let all = schema.get("properties").and_then(Value::as_object);
    all.into_iter().flatten().map(|(key, value)| (key, Property::new(value, schema)))
}

/// The table of settings.
fn settings(schema: &Value) -> String {
    if properties(schema).next().is_none() {
        return "  no settings\n".into();
    }
    let mut table = Table::new("<", &["setting", "type", "default", "range", "meaning"]);
    for (key, property) in properties(schema) {
        let kind = property.kind().replace('`', "");
        table.row([key.clone(), kind, property.default(), property.range_and_unit(), property.meaning()]);
    }
    table.text()
}

/// How a scenario and the command line choose the plugin.
fn example(entry: &Entry, schema: &Value) -> String {
    let indented: String = in_scenario(entry, schema).lines().map(|line| format!("    {line}\n")).collect();
    format!("  in a scenario:\n{indented}  on the command line:\n    {}\n", on_command_line(entry, schema))
}

/// The name of a plugin without its role.
pub fn bare(entry: &Entry) -> &'static str {
    entry.id.split_once('/').map_or(entry.id, |(_, name)| name)
}

/// The table of a scenario that chooses the plugin, with all its settings at their defaults; those that have
/// none are commented out.
pub fn in_scenario(entry: &Entry, schema: &Value) -> String {
    let slot = entry.slots.first().map_or("", |slot| slot.name());
    let line = |(key, property): (&String, Property<'_>)| match (property.default(), property.example()) {
        (default, _) if !default.is_empty() => format!("{key} = {default}\n"),
        (_, Some(example)) => format!("# {key} = {example}\n"),
        (_, None) => String::new(),
    };
    let lines: String = properties(schema).map(line).collect();
    format!("[plugins.{slot}]\nuse = \"{}\"\n{lines}", bare(entry))
}

/// The command that plans with the plugin, and sets its first setting.
pub fn on_command_line(entry: &Entry, schema: &Value) -> String {
    let slot = entry.slots.first().map_or("", |slot| slot.name());
    // A built-in scenario made for the plugin, if there is one: not every plugin fits the hand of `sphere`.
    let made_for = SCENARIOS.iter().find(|file| file.text.contains(&format!("use = \"{}\"", entry.id)));
    let scenario = made_for.map_or("sphere", |file| file.name);
    let set = properties(schema).find_map(|(key, property)| {
        let value = property.default();
        let plain = !value.is_empty() && !value.contains([' ', '"', '{']);
        plain.then(|| format!(" --set {slot}.{key}={value}"))
    });
    format!("regrasp plan {scenario} --use {slot}={}{}", bare(entry), set.unwrap_or_default())
}
