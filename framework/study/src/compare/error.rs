//! Why a study is refused, or cannot go on.

use super::Worker;
use regrasp_api::{Refusal, Refuse};
use regrasp_plan::WriteError;
use regrasp_run::RunError;
use std::{io, path::PathBuf};
use thiserror::Error;

/// A study is refused, or cannot go on. Runs that fail are not among these: they are rows of the study.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum StudyError {
    /// A variant's plugins cannot be had for a scenario.
    #[error("variant `{variant}`, scenario `{scenario}`: \
        {error}{}", if *.unsupported { "\n  `--skip-unsupported` leaves such pairs out" } else { "" })]
    Refused {
        /// The scenario's name.
        scenario: String,
        /// The variant's name.
        variant: String,
        /// Whether the plugins exist and are well set, only not for this scenario.
        unsupported: bool,
        /// Why.
        error: Box<RunError>,
    },
    /// Everything was left out.
    #[error("there is nothing to run: no variant supports any of the scenarios{reason}")]
    Empty {
        /// The first reason.
        reason: String,
    },
    /// Two scenarios share a name.
    #[error(
        "two scenarios are called `{name}`; name each once, and give files of the same name another `name`"
    )]
    DoubleScenario {
        /// The name.
        name: String,
    },
    /// Two variants share a name.
    #[error(
        "two variants are called `{name}`; name each plugin once, and give each variant a name of its own"
    )]
    DoubleVariant {
        /// The name.
        name: String,
    },
    /// A variant fills a slot twice.
    #[error("variant `{variant}` fills `{slot}` twice; vary each slot's plugin once")]
    TwoPlugins {
        /// The variant's name.
        variant: String,
        /// The slot.
        slot: String,
    },
    /// The folder holds another study.
    #[error(
        "`{}` holds another study: {difference}; {}give another folder, or delete this one",
        folder.display(),
        if *.program { "go on with the same build of the program, or " } else { "" }
    )]
    OtherStudy {
        /// The folder.
        folder: PathBuf,
        /// What differs first.
        difference: String,
        /// Whether it is the program itself.
        program: bool,
    },
    /// The folder holds other things.
    #[error("`{}` holds no study, but has `{entry}` in it; give a new or an empty folder", folder.display())]
    NotEmpty {
        /// The folder.
        folder: PathBuf,
        /// One of its entries.
        entry: String,
    },
    /// The folder is no study's.
    #[error("`{}` holds no study: {reason}", folder.display())]
    NoStudy {
        /// The folder.
        folder: PathBuf,
        /// Why.
        reason: String,
    },
    /// Another process works on the same study.
    #[error(
        "`{}` is being worked on by {}; wait for it, or give another folder",
        folder.display(),
        worker.map_or("another process".into(), |worker| worker.to_string())
    )]
    Busy {
        /// The folder.
        folder: PathBuf,
        /// The process and when it began, where that is known.
        worker: Option<Worker>,
    },
    /// A line of the journal cannot be read.
    #[error("`{}`, line {line}: {reason}; delete the line, and its run will be made again", path.display())]
    Journal {
        /// The journal.
        path: PathBuf,
        /// The line, counted from 1.
        line: usize,
        /// What is wrong with it.
        reason: String,
    },
    /// Parts do not make a whole.
    #[error("{0}")]
    Merge(String),
    /// Two studies have no scenario, variant and seed in common.
    #[error(
        "`{}` and `{}` have no scenario, variant and seed in common, by their names; compare studies of the \
         same command",
        folder.display(),
        older.display()
    )]
    NothingInCommon {
        /// The folder of the newer study.
        folder: PathBuf,
        /// The folder of the older one.
        older: PathBuf,
    },
    /// A file cannot be written.
    #[error(transparent)]
    Write(#[from] WriteError),
    /// A file or folder cannot be used.
    #[error("`{}`: {source}", path.display())]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
}

impl Refuse for StudyError {
    fn refusal(&self) -> Refusal {
        match self {
            Self::Refused { error, .. } => error.refusal().told(self),
            Self::Empty { .. } => Refusal::new("nothing-to-run", self),
            Self::DoubleScenario { name } => Refusal::new("double-scenario", self).value(name),
            Self::DoubleVariant { name } => Refusal::new("double-variant", self).value(name),
            Self::TwoPlugins { variant, slot } => Refusal::new("two-plugins", self).key(slot).value(variant),
            Self::OtherStudy { folder, difference, .. } => {
                Refusal::new("other-study", self).file(folder.display()).value(difference)
            }
            Self::NotEmpty { folder, entry } => {
                Refusal::new("not-empty", self).file(folder.display()).value(entry)
            }
            Self::NoStudy { folder, .. } => Refusal::new("no-study", self).file(folder.display()),
            Self::Busy { folder, .. } => Refusal::new("busy", self).file(folder.display()),
            Self::Journal { path, line, .. } => Refusal::new("journal", self)
                .file(path.display())
                .line(Some(*line))
                .remedy("delete the line, and its run will be made again"),
            Self::NothingInCommon { folder, .. } => {
                Refusal::new("nothing-in-common", self).file(folder.display())
            }
            Self::Merge(_) => Refusal::new("merge", self),
            Self::Write(error) => error.refusal(),
            Self::Io { path, .. } => Refusal::new("io", self).file(path.display()),
        }
    }
}
