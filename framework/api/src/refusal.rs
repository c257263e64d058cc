//! What an error says, as data: for programs that read it, and for those who look for the line of a file that
//! it belongs to.

use crate::{BuildError, CallError, Departure, Fault, SettingsError, did_you_mean};
use serde::Serialize;

/// Something that is refused, in fields.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Refusal {
    /// What kind of refusal it is, in kebab case: `out-of-range`, `unknown-key`.
    pub code: &'static str,
    /// The whole as a sentence.
    pub message: String,
    /// The file.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// The line in it, counted from 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub line: Option<usize>,
    /// The path of the key, such as `goal[1].pose.position`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub key: Option<String>,
    /// The value that was given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub value: Option<String>,
    /// The allowed range, with its unit.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub range: Option<String>,
    /// What to do.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub remedy: Option<String>,
}

/// An error that says what it is about in fields.
pub trait Refuse {
    /// The fields.
    fn refusal(&self) -> Refusal;
}

impl Refuse for Refusal {
    fn refusal(&self) -> Refusal {
        self.clone()
    }
}

impl Refusal {
    /// A refusal with its kind and its sentence; everything else is added where it is known.
    pub fn new(code: &'static str, message: &(impl ToString + ?Sized)) -> Self {
        Self { code, message: message.to_string(), ..Self::default() }
    }

    /// With the path of the key.
    #[must_use]
    pub fn key(self, key: impl ToString) -> Self {
        Self { key: Some(key.to_string()), ..self }
    }

    /// With the value that was given.
    #[must_use]
    pub fn value(self, value: impl ToString) -> Self {
        Self { value: Some(value.to_string()), ..self }
    }

    /// With the allowed range.
    #[must_use]
    pub fn range(self, range: impl ToString) -> Self {
        Self { range: Some(range.to_string()), ..self }
    }

    /// With what to do; the empty text is nothing.
    #[must_use]
    pub fn remedy(self, remedy: impl ToString) -> Self {
        Self { remedy: Some(remedy.to_string()).filter(|remedy| !remedy.is_empty()), ..self }
    }

    /// With the file.
    #[must_use]
    pub fn file(self, file: impl ToString) -> Self {
        Self { file: Some(file.to_string()), ..self }
    }

    /// With the line.
    #[must_use]
    pub fn line(self, line: Option<usize>) -> Self {
        Self { line, ..self }
    }

    /// The same within a longer sentence.
    #[must_use]
    pub fn told(self, message: &(impl ToString + ?Sized)) -> Self {
        Self { message: message.to_string(), ..self }
    }

    /// The same with its key below `table`.
    #[must_use]
    pub fn below(self, table: &str) -> Self {
        let key = self.key.map_or(table.to_owned(), |key| format!("{table}.{key}"));
        Self { key: Some(key), ..self }
    }
}

impl Refuse for Fault {
    fn refusal(&self) -> Refusal {
        match self {
            Self::UnknownKey { near, .. } => Refusal::new("unknown-key", self).remedy(did_you_mean(near)),
            Self::Missing { key, example } => {
                let such =
                    example.as_ref().map(|example| format!(", such as `{}`", example.replace('\n', " ")));
                let message = format!("the key `{key}` is missing");
                Refusal::new("missing-key", &message)
                    .remedy(format!("give `{key}`{}", such.unwrap_or_default()))
            }
            Self::Type { expected, found } => {
                Refusal::new("wrong-type", self).value(found).remedy(format!("give {expected}"))
            }
            Self::Choice { found, near, known } => Refusal::new("unknown-choice", self)
                .value(found)
                .range(known.join(", "))
                .remedy(did_you_mean(near)),
            Self::Range { found, range } => Refusal::new("out-of-range", self).value(found).range(range),
        }
    }
}

impl Refuse for Departure {
    fn refusal(&self) -> Refusal {
        self.fault.refusal().told(self).key(&self.path)
    }
}

impl Refuse for SettingsError {
    fn refusal(&self) -> Refusal {
        match self {
            Self::Form(_) => Refusal::new("settings-form", self),
            Self::Departs(departure) => departure.refusal(),
            Self::Value { key, value, remedy, .. } => {
                Refusal::new("settings-value", self).key(key).value(value).remedy(remedy)
            }
            Self::Panicked(_) => Refusal::new("plugin-panicked", self),
        }
    }
}

impl Refuse for BuildError {
    fn refusal(&self) -> Refusal {
        match self {
            Self::Settings(error) => error.refusal(),
            Self::Unsupported(_) => Refusal::new("plugin-unsupported", self),
            Self::Panicked(_) => Refusal::new("plugin-panicked", self),
        }
    }
}

impl Refuse for CallError {
    fn refusal(&self) -> Refusal {
        let code = match self {
            Self::Interrupted => "interrupted",
            Self::Unsupported { .. } => "plugin-unsupported",
            Self::Contract { .. } => "plugin-contract",
            Self::Panicked { .. } => "plugin-panicked",
        };
        Refusal::new(code, self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{KeyPath, Range};

    #[test]
    fn a_departure_says_what_it_is_about() {
        let range = Range { low: Some(0.0), high: Some(1.0), unit: "m".into() };
        let path = KeyPath::default().key("goal").item(1).key("lift");
        let departure = Departure { path, fault: Fault::Range { found: "2".into(), range } };
        let text = serde_json::to_string(&departure.refusal()).unwrap();
        let wanted = r#"{"code":"out-of-range","message":"`goal[1].lift` = 2 is outside 0..=1 m","#
            .to_owned()
            + r#""key":"goal[1].lift","value":"2","range":"0..=1 m"}"#;
        assert_eq!(text, wanted);
    }

    #[test]
    fn keys_are_put_below_their_table() {
        let refusal = Refusal::new("code", "text").key("radius").below("object.shape");
        assert_eq!(refusal.key.as_deref(), Some("object.shape.radius"));
    }
}
