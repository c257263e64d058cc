//! `regrasp plugins`

use crate::args::PluginsArgs;
use crate::table::Table;
use crate::{Failure, say, say_json};
use regrasp::api::{Entry, Role, Slot};
use regrasp::host::{Choices, Registry, did_you_mean, near};
use serde_json::{Value, json};

pub fn run(args: &PluginsArgs) -> Result<(), Failure> {
    let registry = Registry::linked().map_err(Failure::bad_input)?;
    let entries = select(&registry, args.what.as_deref())?;
    if args.json {
        return say_json(&Value::Array(entries.iter().map(|entry| described(entry)).collect()));
    }
    match (entries.as_slice(), &args.what) {
        ([one], Some(what)) if Role::ALL.iter().all(|role| role.name() != what) => say(&details(one)),
        (entries, _) => say(&list(entries)),
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

fn described(entry: &Entry) -> Value {
    json!({
        "id": entry.id,
        "role": entry.role().name(),
        "slots": entry.slots.iter().map(|slot| slot.name()).collect::<Vec<_>>(),
        "summary": entry.summary,
        "references": entry.references,
        "settings_schema": schema(entry),
        "source": "built-in",
    })
}

fn schema(entry: &Entry) -> Value {
    serde_json::from_str(&(entry.schema)()).unwrap_or_default()
}

fn list(entries: &[&'static Entry]) -> String {
    let defaults = Choices::default();
    let mut table = Table::new("<", &["plugin", "slots (* by default)", "what it is"]);
    for entry in entries {
        let slot = |&slot: &Slot| {
            let star = if defaults.choice(slot).id == entry.id { "*" } else { "" };
            format!("{}{star}", slot.name())
        };
        let slots: Vec<String> = entry.slots.iter().map(slot).collect();
        table.row([entry.id.to_owned(), slots.join(", "), entry.summary.to_owned()]);
    }
    table.text()
}

fn details(entry: &Entry) -> String {
    let slots: Vec<&str> = entry.slots.iter().map(|slot| slot.name()).collect();
    let mut text = format!("{}\n  {}\n  slots: {}\n", entry.id, entry.summary, slots.join(", "));
    for reference in entry.references {
        text += &format!("  reference: {reference}\n");
    }
    let schema = schema(entry);
    let properties = schema.get("properties").and_then(Value::as_object);
    let Some(properties) = properties.filter(|properties| !properties.is_empty()) else {
        return text + "  no settings\n";
    };
    let mut table = Table::new("<", &["setting", "default", "meaning"]);
    for (key, property) in properties {
        let default = property.get("default").map(Value::to_string).unwrap_or_default();
        let meaning = property.get("description").and_then(Value::as_str).unwrap_or_default();
        table.row([key.clone(), default, meaning.split_whitespace().collect::<Vec<_>>().join(" ")]);
    }
    text + &table.text()
}
