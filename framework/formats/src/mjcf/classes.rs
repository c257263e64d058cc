//! Default classes: what elements have that they do not say.

use super::tag::Tag;
use crate::error::RobotFault as Fault;
use std::collections::BTreeMap;

/// Elements that set one and the same default: the actuators.
const ACTUATORS: &[&str] =
    &["general", "motor", "position", "velocity", "intvelocity", "damper", "cylinder", "muscle", "adhesion"];

/// By class, by kind of element, by attribute.
#[derive(Debug, Default)]
pub(super) struct Classes {
    values: BTreeMap<String, BTreeMap<String, BTreeMap<String, String>>>,
}

/// The class of everything that names none.
const MAIN: &str = "main";

impl Classes {
    pub fn new(root: &Tag) -> Self {
        let mut classes = Self::default();
        classes.values.insert(MAIN.into(), BTreeMap::new());
        for default in root.all("default") {
            classes.add(default, MAIN, default.own("class").unwrap_or(MAIN));
        }
        classes
    }

    fn add(&mut self, default: &Tag, parent: &str, name: &str) {
        let known = self.values.get(name).cloned();
        let mut values = known.or_else(|| self.values.get(parent).cloned()).unwrap_or_default();
        for element in default.children.iter().filter(|child| child.name != "default") {
            let kind = values.entry(kind(&element.name).to_owned()).or_default();
            for (key, value) in &element.attributes {
                kind.insert(key.clone(), value.clone());
            }
        }
        self.values.insert(name.to_owned(), values);
        for child in default.all("default") {
            self.add(child, name, child.own("class").unwrap_or(name));
        }
    }

    /// An element with the class that counts for it: its own, that of the bodies around it, or the main one.
    pub fn of<'t>(&'t self, tag: &'t Tag, around: Option<&'t str>) -> Result<Styled<'t>, Fault> {
        let class = tag.own("class").or(around).unwrap_or(MAIN);
        let values = self.values.get(class).ok_or_else(|| {
            tag.fault(format!("<{}> is of the class `{class}`, which no <default> makes", tag.name))
        })?;
        Ok(Styled { tag, defaults: values.get(kind(&tag.name)) })
    }
}

fn kind(name: &str) -> &str {
    if ACTUATORS.contains(&name) { "general" } else { name }
}

/// An element with what its class says.
#[derive(Clone, Copy, Debug)]
pub(super) struct Styled<'t> {
    pub tag: &'t Tag,
    defaults: Option<&'t BTreeMap<String, String>>,
}

impl Styled<'_> {
    pub fn text(&self, name: &str) -> Option<&str> {
        let default = || self.defaults.and_then(|values| values.get(name)).map(|value| value.trim());
        self.tag.own(name).or_else(default)
    }

    /// The numbers of an attribute, all finite; `None` where it is absent.
    pub fn list(&self, name: &str) -> Result<Option<Vec<f64>>, Fault> {
        let Some(text) = self.text(name) else { return Ok(None) };
        self.tag.numbers_of(name, text).map(Some)
    }

    /// Exactly `N` numbers.
    pub fn numbers<const N: usize>(&self, name: &str) -> Result<Option<[f64; N]>, Fault> {
        let Some(list) = self.list(name)? else { return Ok(None) };
        let count = list.len();
        list.try_into().map(Some).map_err(|_| {
            self.tag.fault(format!("<{} {name}>: {count} numbers where {N} belong", self.tag.name))
        })
    }

    pub fn number(&self, name: &str) -> Result<Option<f64>, Fault> {
        Ok(self.numbers::<1>(name)?.map(|[x]| x))
    }
}
