//! Comparisons of plugin combinations: every scenario, planned by every variant, with every seed; every plan
//! verified.
//!
//! [`prepare`] makes a [`Study`] of what is asked for, [`Folder::open`] begins or resumes it in a folder,
//! [`execute`] makes its runs and keeps each as soon as it has ended, [`Folder::finish`] writes the results.
//! Parts of a study, made elsewhere, are joined by [`merge`].

mod against;
mod analysis;
mod begun;
mod csv;
mod derived;
mod error;
mod execute;
mod family;
mod figure;
mod file;
mod fingerprint;
#[cfg(test)]
mod fixture;
mod folder;
mod hypotheses;
mod isolate;
mod journal;
mod machinery;
mod measure;
mod memory;
mod merge;
pub mod ompl;
mod one_run;
mod paper_table;
mod question;
mod record;
pub mod report;
mod results;
mod runs_csv;
mod search;
pub mod statistics;
mod study;
pub mod summary;
mod timed;
mod wish;
mod worker;

pub use against::*;
pub use analysis::*;
pub use begun::BEGUN;
pub use error::*;
pub use execute::*;
pub use family::*;
pub use figure::*;
pub use file::*;
pub use fingerprint::*;
pub use folder::*;
pub use hypotheses::*;
pub use isolate::*;
pub use journal::JOURNAL;
pub use machinery::{Means, make_run};
pub use measure::*;
pub use memory::*;
pub use merge::*;
pub use one_run::*;
pub use paper_table::*;
pub use question::Question;
use question::row_horizon_s;
pub use record::*;
pub use results::*;
pub use search::*;
pub use study::*;
pub use timed::{CLEARANCE, FRAMEWORK, PERIOD};
pub use wish::*;
pub use worker::Worker;
