//! Protocols of published papers: their problems in one runnable form, and their published results beside
//! ours.
//!
//! A [`Protocol`] is a file: what was published, of which world, what is like for like, what is chosen, and
//! series of problems. [`problems`] makes the problems of a series, a pure function of the file; [`run()`]
//! plans and verifies them, and replays the plans by what the caller brings; [`Outcome`] is what came of it.

mod attempt;
mod error;
mod group;
mod journal;
mod library;
mod outcome;
mod problem;
mod protocol;
mod run;
mod summary;

pub use attempt::{Attempt, Replayed, Trial, Unreplayable};
pub use error::SuiteError;
pub use journal::journal;
pub use library::{BuiltIn, Files, PROTOCOLS, load};
pub use outcome::{Outcome, Spread};
pub use problem::{Problem, Turn, problems};
pub use protocol::{Problems, Protocol, Published, Series, World};
pub use run::{Judge, Options, Told, run, scenarios};
pub use summary::{json, markdown, rows};
