//! `--vary`: what is compared, from the command line.

use crate::Failure;
use crate::overrides::{parse, refuse, split_slot};
use regrasp::api::Slot;
use regrasp::host::{Registry, preset, slot_by_name};
use regrasp::study::compare::{Change, Level, PRESET};
use serde_json::{Map, Value};

/// The levels of `SLOT=ID,ID…`, of `SLOT=ID{KEY=VALUE,…},…`, of `SLOT.KEY=VALUE,VALUE…`, or of
/// `preset=NAME,NAME…`.
pub fn factor(text: &str, registry: &Registry) -> Result<Vec<Level>, Failure> {
    if let Some((PRESET, list)) = text.split_once('=') {
        let named = |name: &str| preset(name.trim()).map_err(|error| refuse("vary", text, &error));
        return list.split(',').map(|name| named(name).map(Level::Preset)).collect();
    }
    Ok(changes(text, registry)?.into_iter().map(Level::Change).collect())
}

/// The levels of one slot.
fn changes(text: &str, registry: &Registry) -> Result<Vec<Change>, Failure> {
    let form = || {
        Failure::bad_input(format!(
            "`--vary {text}` is not of the form SLOT=ID,ID…, SLOT=ID{{KEY=VALUE}},…, \
             SLOT.KEY=VALUE,VALUE… or preset=NAME,NAME…, such as sampler=rlg,projection"
        ))
    };
    let (path, list) = text.split_once('=').ok_or_else(form)?;
    let setting = Slot::ALL.iter().all(|slot| slot.name() != path);
    let found = if setting { split_slot(path) } else { Ok(None) };
    if let Some((slot, key)) = found.map_err(|error| refuse("vary", text, &error))? {
        let values = values(list).map_err(|reason| wrong(text, &reason))?;
        return Ok(values.into_iter().map(|value| set(slot, key, value)).collect());
    }
    let slot = slot_by_name(path).map_err(|error| refuse("vary", text, &error))?;
    let plugin = |level: &str| {
        let (id, settings) = split_settings(level.trim()).ok_or_else(form)?;
        registry.lookup(slot, id).map_err(|error| refuse("vary", text, &error))?;
        let settings = settings.map(|list| table(list).map_err(|reason| wrong(text, &reason)));
        Ok(Change { slot, id: Some(id.to_owned()), settings: settings.transpose()?.unwrap_or_default() })
    };
    levels(list).into_iter().map(plugin).collect()
}

/// The parts of a list between the commas that stand outside of braces and brackets.
fn levels(list: &str) -> Vec<&str> {
    let mut depth = 0_i32;
    let outside = |c: char| {
        depth += i32::from(matches!(c, '{' | '[')) - i32::from(matches!(c, '}' | ']'));
        c == ',' && depth == 0
    };
    list.split(outside).collect()
}

/// `ID` or `ID{SETTINGS}`; `None` where it is neither.
fn split_settings(level: &str) -> Option<(&str, Option<&str>)> {
    let (id, settings) = match level.split_once('{') {
        Some((id, rest)) => (id, Some(rest.strip_suffix('}')?)),
        None => (level, None),
    };
    (!id.is_empty() && !id.contains('}')).then_some((id, settings))
}

/// `KEY=VALUE,…` as settings; a value is TOML or a word.
fn table(list: &str) -> Result<Map<String, Value>, String> {
    let entry = |entry: &str| {
        let (key, value) = entry.split_once('=').ok_or_else(|| format!("`{entry}` is not KEY=VALUE"))?;
        let [value] = values(value)?.try_into().map_err(|_| format!("`{entry}` has no single value"))?;
        Ok((key.trim().to_owned(), value))
    };
    levels(list).into_iter().map(entry).collect()
}

fn wrong(text: &str, reason: &str) -> Failure {
    Failure::bad_input(format!("`--vary {text}`: {reason}"))
}

fn set(slot: Slot, key: &str, value: Value) -> Change {
    Change { slot, id: None, settings: Map::from_iter([(key.to_owned(), value)]) }
}

/// Values separated by commas: TOML values, or words without quotes.
fn values(list: &str) -> Result<Vec<Value>, String> {
    match parse(&format!("[{list}]")) {
        // A number that is not finite has no place in JSON.
        Ok(Value::Array(values)) if values.contains(&Value::Null) => {
            Err(format!("{list} is outside the finite numbers"))
        }
        Ok(Value::Array(values)) if !values.is_empty() => Ok(values),
        _ if list.split(',').any(|word| word.trim().is_empty()) => Err("a value is missing".into()),
        _ => list.split(',').map(|word| parse(word.trim())).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn registry() -> Registry {
        Registry::linked().expect("the built-in plugins differ")
    }

    #[test]
    fn plugins_and_settings_are_told_apart() {
        let plugins = changes("local-planner.regrasp=rrt,lift-slide-touch", &registry()).unwrap();
        assert_eq!(plugins.len(), 2);
        assert_eq!((plugins[0].slot, plugins[0].id.as_deref()), (Slot::RegraspPlanner, Some("rrt")));
        let settings = changes("graph-strategy.end=0.3,0.8", &registry()).unwrap();
        assert_eq!(settings[1].settings, *json!({"end": 0.8}).as_object().unwrap());
        assert_eq!(settings[1].label(), "end=0.8");
    }

    #[test]
    fn a_variant_may_bring_settings_of_its_own() {
        let text = "graph-strategy=interleaved{start=0.2,end=1.0},lazy,interleaved{growth=2.0}";
        let levels = changes(text, &registry()).unwrap();
        assert_eq!(levels[0].settings, *json!({"start": 0.2, "end": 1.0}).as_object().unwrap());
        assert!(levels[1].settings.is_empty());
        assert_eq!(levels[2].label(), "interleaved growth=2.0");
        for bad in ["graph-strategy=lazy{", "graph-strategy={a=1}", "graph-strategy=lazy{a}"] {
            assert!(factor(bad, &registry()).is_err(), "{bad}");
        }
    }

    #[test]
    fn presets_are_levels_too() {
        let levels = factor("preset=paper, default", &registry()).unwrap();
        let name = |level: &Level| match level {
            Level::Preset(preset) => preset.name,
            Level::Change(_) => "",
        };
        assert_eq!(levels.iter().map(name).collect::<Vec<_>>(), ["paper", "default"]);
    }

    #[test]
    fn values_are_toml_or_words() {
        assert_eq!(values("1,2.5"), Ok(vec![json!(1), json!(2.5)]));
        assert_eq!(values("[1,2],[3]"), Ok(vec![json!([1, 2]), json!([3])]));
        assert_eq!(values("fast,slow"), Ok(vec![json!("fast"), json!("slow")]));
        assert!(values("1,nan").is_err() && values("a,").is_err() && values("").is_err());
    }

    #[test]
    fn what_does_not_exist_is_refused_with_what_does() {
        for (text, hint) in [
            ("samler=rlg,projection", "did you mean `sampler`"),
            ("sampler=rlg,projectoin", "did you mean `sampler/projection`"),
            ("sampler=rlg,", "is not of the form"),
            ("sampler", "is not of the form"),
            ("local-planner=rrt", "local-planner.regrasp"),
            ("sampler.tries=", "a value is missing"),
            ("preset=papre,default", "did you mean `paper`"),
        ] {
            let failure = format!("{:?}", factor(text, &registry()).unwrap_err());
            assert!(failure.contains(hint), "{text}: {failure}");
        }
    }
}
