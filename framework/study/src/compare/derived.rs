//! The files that say what a study's runs mean.

use super::{RunRecord, Study, analyse, ompl, summary};
use std::path::PathBuf;

/// Every file that is made from the runs alone, with its path in the study's folder: `summary.csv`, `summary.md`, and for each scenario a log
/// for OMPL's tools. Equal runs give equal files.
pub fn derived_files(study: &Study, records: &[RunRecord]) -> Vec<(PathBuf, String)> {
    let rows = analyse(study, records);
    let mut files = vec![
        (PathBuf::from("summary.csv"), summary::csv(&rows)),
        (PathBuf::from("summary.md"), summary::markdown(study, &rows)),
    ];
    let logs = ompl::logs(study, &rows).into_iter();
    files.extend(logs.map(|(name, text)| (PathBuf::from("ompl").join(name), text)));
    files
}
