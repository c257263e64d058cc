//! The laws of every entry, whatever its role: how it presents itself and its settings.

use crate::law::{Law, Subject};
use crate::leaves::{Leaf, leaves, nested, tables};
use crate::report::{Fault, Finding, broken, ensure};
use regrasp_api::{Build, BuildError, Departure, Entry, Fault as Refusal, Parts, SettingsError};
use serde_json::{Map, Value, json};

pub(crate) const LAWS: &[Law] = &[
    Law {
        name: "entry-identity",
        why: "scenario files and the registry find a plugin by `role/name` and by its slots",
        check: identity,
    },
    Law {
        name: "entry-description",
        why: "the list of plugins shows one line and the sources, and a result must be traceable to them",
        check: description,
    },
    Law {
        name: "entry-schema",
        why: "forms, error messages and documentation are made from the schema of the settings",
        check: schema,
    },
    Law {
        name: "entry-defaults",
        why: "a plugin that is swapped in without settings must work",
        check: defaults,
    },
    Law {
        name: "entry-unknown-key",
        why: "a mistyped key that is ignored silently makes an experiment wrong",
        check: unknown_key,
    },
    Law {
        name: "entry-ranges",
        why: "a value outside its range must be refused when it is read, not crash or loop in the search",
        check: ranges,
    },
    Law {
        name: "entry-build-agrees",
        why: "settings that were checked must build, and settings that were refused must not",
        check: build_agrees,
    },
];

fn identity(subject: &Subject<'_>) -> Finding {
    let Entry { id, slots, .. } = *subject.entry;
    let role = subject.entry.role();
    let Some((prefix, name)) = id.split_once('/') else { return broken(format!("`{id}` is not role/name")) };
    ensure(prefix == role.name(), || format!("`{id}` builds a {} plugin", role.name()))?;
    let word =
        |word: &str| !word.is_empty() && word.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit());
    ensure(name.split('-').all(word), || format!("`{name}` is not in kebab case"))?;
    ensure(!slots.is_empty(), || "it fills no slot".into())?;
    ensure(slots.iter().all(|slot| slot.role() == role), || format!("a slot of another role: {slots:?}"))?;
    ensure((1..slots.len()).all(|i| !slots[..i].contains(&slots[i])), || format!("a slot twice: {slots:?}"))
}

fn description(subject: &Subject<'_>) -> Finding {
    let Entry { summary, references, .. } = *subject.entry;
    ensure(!summary.trim().is_empty() && !summary.contains('\n'), || "the summary is not one line".into())?;
    ensure(summary.chars().count() <= 160, || "the summary is longer than 160 characters".into())?;
    ensure(!references.is_empty(), || "it names no source".into())?;
    ensure(references.iter().all(|r| !r.trim().is_empty()), || "a reference is empty".into())
}

fn schema(subject: &Subject<'_>) -> Finding {
    let schema = parsed_schema(subject)?;
    ensure(schema["type"] == "object", || "the schema is not that of an object".into())?;
    for (key, property) in properties(&schema) {
        let text = property["description"].as_str().unwrap_or("");
        ensure(!text.trim().is_empty(), || format!("`{key}` has no description"))?;
        ensure(property.get("default").is_some(), || format!("`{key}` has no default"))?;
    }
    Ok(())
}

fn defaults(subject: &Subject<'_>) -> Finding {
    let entry = subject.entry;
    for text in ["", "{}", " \n"] {
        (entry.check)(text).map_err(|error| Fault::Broken(format!("refuses {text:?}: {error}")))?;
    }
    let spelled_out: Map<String, Value> = properties(&parsed_schema(subject)?)
        .into_iter()
        .filter_map(|(key, property)| Some((key, property.get("default")?.clone())))
        .collect();
    let text = Value::Object(spelled_out).to_string();
    (entry.check)(&text).map_err(|error| Fault::Broken(format!("refuses its own defaults {text}: {error}")))
}

fn unknown_key(subject: &Subject<'_>) -> Finding {
    for text in [r#"{"no_such_key": 1}"#, "{", "7"] {
        ensure((subject.entry.check)(text).is_err(), || format!("accepts {text}"))?;
    }
    // A table within the settings is as strict as they are.
    for path in tables(&parsed_schema(subject)?) {
        let text = nested(&path, json!({ "no_such_key": 1 })).to_string();
        ensure((subject.entry.check)(&text).is_err(), || {
            format!("accepts {text}: the inner struct lacks `#[serde(deny_unknown_fields)]`")
        })?;
    }
    Ok(())
}

fn ranges(subject: &Subject<'_>) -> Finding {
    for leaf in leaves(&parsed_schema(subject)?) {
        for value in absurd(&leaf) {
            let Err(error) = with(subject, &leaf, &value) else {
                return broken(format!("accepts `{}` = {value}", leaf.name()));
            };
            edges(subject, &leaf, &error)?;
        }
    }
    Ok(())
}

/// The range that a refusal states is the one that is kept: its ends are accepted, what lies beyond is not.
fn edges(subject: &Subject<'_>, leaf: &Leaf, error: &SettingsError) -> Finding {
    let SettingsError::Departs(departure) = error else { return Ok(()) };
    let Departure { path, fault: Refusal::Range { range, .. } } = &**departure else { return Ok(()) };
    let name = leaf.name();
    // An item of a list is named by its list and its place.
    let own = |path: &str| path == name || path.starts_with(&format!("{name}["));
    ensure(own(&path.to_string()), || format!("`{name}` is refused with a message about `{path}`"))?;
    let (Some(low), Some(high)) = (range.low, range.high) else { return Ok(()) };
    for edge in [low, high] {
        let refused = with(subject, leaf, &number(leaf, edge));
        // Another setting's default may rule out this end; that is another message.
        let here =
            matches!(&refused, Err(SettingsError::Departs(departure)) if own(&departure.path.to_string()));
        ensure(!here, || format!("refuses `{name}` = {edge}, though the range is {range}"))?;
    }
    for beyond in beyond(leaf, low, high) {
        let accepted = with(subject, leaf, &beyond).is_ok();
        ensure(!accepted, || format!("accepts `{name}` = {beyond}, though the range is {range}"))?;
    }
    Ok(())
}

fn build_agrees(subject: &Subject<'_>) -> Finding {
    let schema = parsed_schema(subject)?;
    let mut probes = vec![String::new(), r#"{"no_such_key": 1}"#.into(), "{".into()];
    for leaf in leaves(&schema) {
        probes.extend(absurd(&leaf).into_iter().map(|value| leaf.with(value).to_string()));
    }
    let bench = crate::fixtures::Bench::free_sphere();
    for text in probes {
        let checked = (subject.entry.check)(&text);
        let built = try_build(subject.entry, &text, &bench.parts());
        let agrees = match &built {
            Ok(()) | Err(BuildError::Unsupported(_)) => checked.is_ok(),
            Err(_) => checked.is_err(),
        };
        ensure(agrees, || format!("settings {text:?}: check says {checked:?}, build says {built:?}"))?;
    }
    Ok(())
}

/// Values that no setting can mean; `null` is how JSON writes NaN, but for a setting that may be absent.
fn absurd(leaf: &Leaf) -> Vec<Value> {
    let null = (!leaf.optional).then_some(Value::Null);
    let numbers = match leaf.integer {
        true => [json!(-1), json!(1_000_000_000_000_000_u64)],
        false => [json!(-1e300), json!(1e300)],
    };
    numbers.into_iter().chain(null).collect()
}

fn number(leaf: &Leaf, x: f64) -> Value {
    if leaf.integer { json!(x as i64) } else { json!(x) }
}

/// Values just outside `low..=high`.
fn beyond(leaf: &Leaf, low: f64, high: f64) -> [Value; 2] {
    match leaf.integer {
        true => [json!(low as i64 - 1), json!(high as i64 + 1)],
        false => [json!(low.next_down()), json!(high.next_up())],
    }
}

fn parsed_schema(subject: &Subject<'_>) -> Finding<Value> {
    serde_json::from_str(&(subject.entry.schema)())
        .map_err(|error| Fault::Broken(format!("the schema is not JSON: {error}")))
}

fn properties(schema: &Value) -> Vec<(String, Value)> {
    let properties = schema["properties"].as_object().cloned().unwrap_or_default();
    properties.into_iter().collect()
}

/// What the plugin's check says of one value, the other settings being the defaults.
fn with(subject: &Subject<'_>, leaf: &Leaf, value: &Value) -> Result<(), SettingsError> {
    (subject.entry.check)(&leaf.with(value.clone()).to_string())
}

macro_rules! try_build {
    ($([$role:ident $name:ident $trait:ident] $row:tt)+) => {
        /// Builds the plugin, whatever its role, and drops it.
        fn try_build(entry: &Entry, json: &str, parts: &Parts<'_>) -> Result<(), BuildError> {
            match entry.build {
                $(Build::$role(build) => build(json, parts).map(drop),)+
            }
        }
    };
}
regrasp_api::with_roles!(try_build);
