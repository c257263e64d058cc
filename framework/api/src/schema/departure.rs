//! Where and how data depart from a schema.

use crate::did_you_mean;
use std::fmt;
use thiserror::Error;

/// One step into nested data.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Step {
    /// To the value of a key.
    Key(String),
    /// To an item, counted from 0.
    Item(usize),
}

/// A place in nested data, written `goal[1].pose.position`.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct KeyPath(pub Vec<Step>);

impl KeyPath {
    /// The path one key deeper.
    #[must_use]
    pub fn key(&self, key: &str) -> Self {
        self.with(Step::Key(key.to_owned()))
    }

    /// The path one item deeper.
    #[must_use]
    pub fn item(&self, item: usize) -> Self {
        self.with(Step::Item(item))
    }

    fn with(&self, step: Step) -> Self {
        Self(self.0.iter().cloned().chain([step]).collect())
    }
}

impl fmt::Display for KeyPath {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, step) in self.0.iter().enumerate() {
            match step {
                Step::Key(key) if i > 0 => write!(f, ".{key}")?,
                Step::Key(key) => write!(f, "{key}")?,
                Step::Item(item) => write!(f, "[{item}]")?,
            }
        }
        Ok(())
    }
}

/// The range that a schema allows, written `0.1..=2 m`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Range {
    /// The least number.
    pub low: Option<f64>,
    /// The greatest number.
    pub high: Option<f64>,
    /// The unit; empty where the number has none, or where it depends on something else.
    pub unit: String,
}

impl fmt::Display for Range {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let end = |end: Option<f64>| end.map(|end| end.to_string()).unwrap_or_default();
        let equal = if self.high.is_some() { "=" } else { "" };
        write!(f, "{}..{equal}{}", end(self.low), end(self.high))?;
        if self.unit.is_empty() { Ok(()) } else { write!(f, " {}", self.unit) }
    }
}

/// How data departs from a schema.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum Fault {
    /// A key that the schema does not know; its path ends with it.
    #[error("unknown key; {}", suggestion(.near, .known))]
    UnknownKey {
        /// Known keys that resemble it.
        near: Vec<String>,
        /// Every known key.
        known: Vec<String>,
    },
    /// A key is missing.
    #[error("the key `{key}` is missing{}", shown_example(.example.as_deref()))]
    Missing {
        /// The key.
        key: String,
        /// What could stand there, as lines of a TOML file, where the schema says it.
        example: Option<String>,
    },
    /// A value of the wrong type.
    #[error("{found} is not {expected}")]
    Type {
        /// The type that the schema asks for.
        expected: String,
        /// The value that was found.
        found: String,
    },
    /// A text that is none of the allowed ones.
    #[error("{found} is not one of the allowed values; {}", suggestion(.near, .known))]
    Choice {
        /// The value that was found.
        found: String,
        /// Allowed values that resemble it.
        near: Vec<String>,
        /// Every allowed value.
        known: Vec<String>,
    },
    /// A number below the schema's minimum or above its maximum.
    #[error("{found} is outside {range}")]
    Range {
        /// The number that was found.
        found: String,
        /// The allowed range.
        range: Range,
    },
}

/// The lines of an example, set off from the sentence.
fn shown_example(example: Option<&str>) -> String {
    let lines = |example: &str| example.lines().map(|line| format!("\n    {line}")).collect::<String>();
    example.map(|example| format!("; for example{}", lines(example))).unwrap_or_default()
}

fn suggestion(near: &[String], known: &[String]) -> String {
    match (near, known) {
        ([], []) => "there are none here".to_owned(),
        ([], known) => format!("known are `{}`", known.join("`, `")),
        (near, _) => did_you_mean(near),
    }
}

/// What stands before a fault: the key; nothing where the data as a whole depart.
fn place(path: &KeyPath, fault: &Fault) -> String {
    match fault {
        _ if path.0.is_empty() => String::new(),
        Fault::Range { .. } => format!("`{path}` = "),
        _ => format!("`{path}`: "),
    }
}

/// The first place where data depart from a schema.
#[derive(Clone, Debug, Error, PartialEq)]
#[error("{}{fault}", place(.path, .fault))]
pub struct Departure {
    /// Where.
    pub path: KeyPath,
    /// How.
    pub fault: Fault,
}
