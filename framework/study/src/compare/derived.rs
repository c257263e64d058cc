//! The files that say what a study's runs mean.

use super::{RunRecord, Study, analyse, judge_all, ompl, plan_path, report, search_markdown, summary};
use std::path::{Path, PathBuf};

/// Every file that is made from the runs, with its path in the study's folder: `summary.csv`,
/// `comparisons.csv`, `summary.md`, `search.md`, `report.html`, and for each scenario a log for OMPL's tools.
/// Equal runs give equal files.
///
/// The report's pictures come from the plans that the folder keeps; it does without those that are not there.
pub fn derived_files(folder: &Path, study: &Study, records: &[RunRecord]) -> Vec<(PathBuf, String)> {
    let rows = analyse(study, records);
    let family = judge_all(study, &rows);
    let strip = |scenario| report::strip(&regrasp_plan::read(&plan_path(folder, study, scenario)).ok()?);
    let strips: Vec<Option<String>> = (0..study.scenarios.len()).map(strip).collect();
    let mut files = vec![
        (PathBuf::from("summary.csv"), summary::csv(&rows)),
        (PathBuf::from("comparisons.csv"), summary::comparisons_csv(study, &family)),
        (PathBuf::from("summary.md"), summary::markdown(study, &rows, &family)),
        (PathBuf::from("search.md"), search_markdown(&rows)),
        (PathBuf::from("report.html"), report::html(study, &rows, &family, &strips)),
    ];
    let logs = ompl::logs(study, &rows).into_iter();
    files.extend(logs.map(|(name, text)| (PathBuf::from("ompl").join(name), text)));
    files
}
