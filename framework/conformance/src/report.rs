//! What the kit says about a plugin: one outcome for each check.

use regrasp_api::{BuildError, CallError};
use std::fmt;

/// How one check ended.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// The plugin keeps this law.
    Passed,
    /// It does not; the text says where it was caught.
    Failed(String),
    /// The law says nothing about this plugin; the text says why.
    NotApplicable(String),
}

/// One check and how it ended.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Check {
    /// The check's name: stable, in kebab case.
    pub name: &'static str,
    /// Why the law matters.
    pub why: &'static str,
    /// How it ended.
    pub outcome: Outcome,
}

/// Everything that the kit found out about one plugin.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Report {
    /// The plugin's id.
    pub plugin: String,
    /// The checks in the order in which they ran.
    pub checks: Vec<Check>,
}

impl Report {
    /// The names of the checks that failed.
    pub fn failed(&self) -> Vec<&'static str> {
        let failed = self.checks.iter().filter(|check| matches!(check.outcome, Outcome::Failed(_)));
        failed.map(|check| check.name).collect()
    }

    /// Whether no check failed.
    pub fn passes(&self) -> bool {
        self.failed().is_empty()
    }

    /// One line: how many checks were made, and which were not, with the reason.
    pub fn summary(&self) -> String {
        let skipped = self.checks.iter().filter_map(|check| match &check.outcome {
            Outcome::NotApplicable(reason) => Some(format!("`{}` ({reason})", check.name)),
            _ => None,
        });
        let skipped: Vec<String> = skipped.collect();
        let made = self.checks.len() - skipped.len();
        let failed = self.failed().len();
        let mut line = format!("`{}`: {made} checks made, {failed} failed", self.plugin);
        if !skipped.is_empty() {
            line += &format!(", {} not tried: {}", skipped.len(), skipped.join(", "));
        }
        line
    }

    /// Panics with the whole report where a check failed.
    pub fn assert_passes(&self) {
        assert!(self.passes(), "{self}");
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "`{}`: {} checks, {} failed", self.plugin, self.checks.len(), self.failed().len())?;
        for check in &self.checks {
            match &check.outcome {
                Outcome::Passed => writeln!(f, "  ok    {}", check.name)?,
                Outcome::NotApplicable(reason) => writeln!(f, "  -     {}: {reason}", check.name)?,
                Outcome::Failed(reason) => {
                    writeln!(f, "  FAIL  {}: {reason}\n        why it matters: {}", check.name, check.why)?;
                }
            }
        }
        Ok(())
    }
}

/// Why a check ends early.
#[derive(Debug)]
pub(crate) enum Fault {
    /// The law is broken.
    Broken(String),
    /// The law says nothing here.
    Skip(String),
}

impl Fault {
    /// The same with the place where it happened.
    pub fn at(self, place: &str) -> Self {
        match self {
            Self::Broken(reason) => Self::Broken(format!("{place}: {reason}")),
            skip => skip,
        }
    }
}

/// The same text with numbers of at most six decimals.
fn short(text: &str) -> String {
    let (mut decimals, mut out) = (None, String::with_capacity(text.len()));
    for c in text.chars() {
        decimals = match (c, decimals) {
            ('.', None) => Some(0),
            ('0'..='9', Some(count)) => Some(count + 1),
            _ => None,
        };
        if decimals.is_none_or(|count| count <= 6) {
            out.push(c);
        }
    }
    out
}

/// What a check comes to.
pub(crate) type Finding<T = ()> = Result<T, Fault>;

/// A broken law.
pub(crate) fn broken<T>(reason: impl Into<String>) -> Finding<T> {
    Err(Fault::Broken(reason.into()))
}

/// Breaks the law with `reason` unless `holds`.
pub(crate) fn ensure(holds: bool, reason: impl FnOnce() -> String) -> Finding {
    if holds { Ok(()) } else { broken(reason()) }
}

impl From<CallError> for Fault {
    fn from(error: CallError) -> Self {
        Self::Broken(format!("a call ended with an error: {error}"))
    }
}

impl From<BuildError> for Fault {
    fn from(error: BuildError) -> Self {
        match error {
            BuildError::Unsupported(reason) => Self::Skip(format!("the plugin refuses this: {reason}")),
            other => Self::Broken(format!("it cannot be built: {other}")),
        }
    }
}

impl From<Finding> for Outcome {
    fn from(finding: Finding) -> Self {
        match finding {
            Ok(()) => Self::Passed,
            Err(Fault::Broken(reason)) => Self::Failed(short(&reason)),
            Err(Fault::Skip(reason)) => Self::NotApplicable(reason),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        assert_eq!(
            short("at 0.123456789 of 3.5e-12, facet 1234567890."),
            "at 0.123456 of 3.5e-12, facet 1234567890."
        );
    }

    #[test]
    fn a_report_names_what_failed_and_why_it_matters() {
        let check = |name, outcome| Check { name, why: "somebody relies on it", outcome };
        let report = Report {
            plugin: "surface/flat".into(),
            checks: vec![
                check("round", Outcome::Failed("it is flat".into())),
                check("closed", Outcome::Passed),
                check("smooth", Outcome::NotApplicable("no edges".into())),
            ],
        };
        assert_eq!(report.failed(), ["round"]);
        let line = report.summary();
        assert_eq!(line, "`surface/flat`: 2 checks made, 1 failed, 1 not tried: `smooth` (no edges)");
        let text = report.to_string();
        assert!(text.contains("FAIL  round: it is flat") && text.contains("somebody relies on it"), "{text}");
    }
}
