//! Why a scenario is refused: always with the file and, where there is one, the key, the line and the likely
//! fix.

use regrasp_api::{Fault, Refusal, Refuse, did_you_mean};
use regrasp_host::HostError;
use std::fmt;
use thiserror::Error;

/// A place in a file.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Place {
    /// The file, or the name of a built-in one.
    pub file: String,
    /// The path of the key, such as `goal[1].pose.position`; empty for the file as a whole.
    pub key: String,
    /// The line, counted from 1.
    pub line: Option<usize>,
    /// What the line says.
    pub excerpt: String,
}

impl Place {
    /// A file as a whole.
    pub fn file(file: &str) -> Box<Self> {
        Box::new(Self { file: file.to_owned(), ..Self::default() })
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "  --> {}", self.file)?;
        if let Some(line) = self.line {
            write!(f, ":{line}")?;
        }
        if !self.key.is_empty() {
            write!(f, ", key `{}`", self.key)?;
        }
        if let (Some(line), false) = (self.line, self.excerpt.is_empty()) {
            write!(f, "\n{line:>6} | {}", self.excerpt)?;
        }
        Ok(())
    }
}

/// A scenario, or something that it names, is refused.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum ScenarioError {
    /// Neither a built-in name nor a file.
    #[error("there is no built-in {what} `{name}`, and no such file; {}", or_all(.near, .known))]
    Unknown {
        /// `scenario` or `hand`.
        what: &'static str,
        /// The name that was given.
        name: String,
        /// Built-in names that resemble it.
        near: Vec<String>,
        /// Every built-in name.
        known: Vec<String>,
    },
    /// A file cannot be read.
    #[error("cannot read the file: {cause}\n{place}")]
    Unreadable {
        /// The file.
        place: Box<Place>,
        /// The system's word.
        cause: String,
    },
    /// A file is neither TOML nor JSON.
    #[error("not valid {language}: {message}\n{place}")]
    Syntax {
        /// What it was read as: `TOML`, or `JSON` where it begins with a brace.
        language: &'static str,
        /// Where.
        place: Box<Place>,
        /// What the parser says.
        message: String,
    },
    /// A key or a type is wrong.
    #[error("{fault}\n{place}")]
    Form {
        /// Where.
        place: Box<Place>,
        /// What is wrong.
        fault: Fault,
    },
    /// A number is outside its range, NaN or infinite.
    #[error("{value} is outside {range}\n{place}")]
    Range {
        /// Where.
        place: Box<Place>,
        /// The number that was given.
        value: String,
        /// The allowed range, with its unit.
        range: String,
    },
    /// A value makes no sense.
    #[error("{}\n{place}", .refusal.message)]
    Value {
        /// Where.
        place: Box<Place>,
        /// What is wrong, and the likely fix.
        refusal: Box<Refusal>,
    },
    /// A plugin or its settings are refused.
    #[error("{error}\n{place}")]
    Plugin {
        /// Where.
        place: Box<Place>,
        /// The registry's word.
        error: Box<HostError>,
    },
}

fn or_all(near: &[String], known: &[String]) -> String {
    if near.is_empty() { format!("built in are `{}`", known.join("`, `")) } else { did_you_mean(near) }
}

impl Refuse for ScenarioError {
    fn refusal(&self) -> Refusal {
        match self {
            Self::Unknown { what, name, near, known } => {
                let key = if *what == "hand" { "hand.builtin" } else { "scenario" };
                Refusal::new("unknown-name", self)
                    .key(key)
                    .value(name)
                    .range(known.join(", "))
                    .remedy(did_you_mean(near))
            }
            Self::Unreadable { place, cause } => {
                at(place, Refusal::new("unreadable", &format!("cannot read the file: {cause}")))
            }
            Self::Syntax { place, message, language } => {
                at(place, Refusal::new("syntax", &format!("not valid {language}: {message}")))
            }
            Self::Form { place, fault } => at(place, fault.refusal()),
            Self::Range { place, value, range } => {
                let message = format!("{value} is outside {range}");
                at(place, Refusal::new("out-of-range", &message).value(value).range(range))
            }
            Self::Value { place, refusal } => at(place, refusal.refusal()),
            Self::Plugin { place, error } => at(place, error.refusal()),
        }
    }
}

/// A refusal with its place in the file; the file's own key is the whole path.
fn at(place: &Place, refusal: Refusal) -> Refusal {
    let refusal = refusal.file(&place.file).line(place.line);
    if place.key.is_empty() { refusal } else { refusal.key(&place.key) }
}
