//! `regrasp plugins`

use crate::args::{LibraryArgs, PluginsArgs};
use crate::table::Table;
use crate::{Failure, say, say_json};
use regrasp::api::{Entry, Role, Slot};
use regrasp::host::{Choices, Registry, did_you_mean, near, settings_schema};
use regrasp::study::scenario::SCENARIOS;
use serde_json::{Map, Value, json};

/// The plugins that are linked into the program, and those of the libraries that are to be loaded.
pub fn registry(libraries: &LibraryArgs) -> Result<Registry, Failure> {
    let linked = Registry::linked().map_err(Failure::bad_input)?;
    linked.with_libraries(&libraries.load).map_err(Failure::bad_input)
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
        "settings_schema": settings_schema(entry).map_err(Failure::bad_input)?,
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
    let schema = settings_schema(entry).map_err(Failure::bad_input)?;
    let none = Map::new();
    let properties = schema.get("properties").and_then(Value::as_object).unwrap_or(&none);
    Ok(text + &settings(properties) + &example(entry, properties))
}

/// The table of settings.
fn settings(properties: &Map<String, Value>) -> String {
    if properties.is_empty() {
        return "  no settings\n".into();
    }
    let mut table = Table::new("<", &["setting", "default", "range", "meaning"]);
    for (key, property) in properties {
        let default = property.get("default").map(Value::to_string).unwrap_or_default();
        let meaning = property.get("description").and_then(Value::as_str).unwrap_or_default();
        let meaning = meaning.split_whitespace().collect::<Vec<_>>().join(" ");
        table.row([key.clone(), default, range(property), meaning]);
    }
    table.text()
}

/// The range of a setting as its schema states it; the empty text where it does not state both ends.
fn range(property: &Value) -> String {
    let end = |key: &str| property.get(key).map(Value::to_string).unwrap_or_default();
    match (end("minimum"), end("maximum")) {
        (low, high) if low.is_empty() || high.is_empty() => String::new(),
        (low, high) => format!("{low}..={high}"),
    }
}

/// How a scenario and the command line choose the plugin.
fn example(entry: &Entry, properties: &Map<String, Value>) -> String {
    let Some(slot) = entry.slots.first().map(|slot| slot.name()) else { return String::new() };
    let name = entry.id.split_once('/').map_or(entry.id, |(_, name)| name);
    let mut text = format!("  in a scenario:\n    [plugins.{slot}]\n    use = \"{name}\"\n");
    for (key, property) in properties {
        let default = property.get("default").and_then(|value| toml::Value::try_from(value).ok());
        text += &default.map(|value| format!("    {key} = {value}\n")).unwrap_or_default();
    }
    // A built-in scenario made for the plugin, if there is one: not every plugin fits the hand of `sphere`.
    let made_for = SCENARIOS.iter().find(|file| file.text.contains(&format!("use = \"{}\"", entry.id)));
    let scenario = made_for.map_or("sphere", |file| file.name);
    text + &format!("  on the command line:\n    regrasp plan {scenario} --use {slot}={name}\n")
}
