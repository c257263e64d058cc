//! The files of a study, made of its runs.

use super::derived::derived_files;
use super::{Folder, RunRecord, Study, StudyError, runs_csv};
use regrasp_plan::write_file;
use std::fs;
use std::path::Path;

/// The name of the table of runs.
pub const RUNS_FILE: &str = "runs.csv";

/// Writes the files of a complete study: the table of its runs, and what is made of them.
///
/// `records` are of the study, in the order of their keys. Each file is written under another name first.
pub fn write_results(folder: &Path, study: &Study, records: &[RunRecord]) -> Result<(), StudyError> {
    write_runs(folder, study, records)?;
    for (name, text) in derived_files(folder, study, records) {
        let path = folder.join(name);
        let inner = path.parent().unwrap_or(folder);
        fs::create_dir_all(inner).map_err(|source| StudyError::Io { path: inner.to_owned(), source })?;
        write_file(&path, |out| out.write_all(text.as_bytes()))?;
    }
    Ok(())
}

/// Writes the table of runs, of a study that need not be complete.
pub fn write_runs(folder: &Path, study: &Study, records: &[RunRecord]) -> Result<(), StudyError> {
    Ok(write_file(&folder.join(RUNS_FILE), |out| runs_csv::write_rows(study, records, out))?)
}

impl Folder {
    /// Writes the results of the runs that are there. Of a study that is not complete that is the table of
    /// runs alone.
    pub fn finish(&self, study: &Study) -> Result<(), StudyError> {
        let records = self.records();
        if records.len() < study.keys().len() {
            return write_runs(self.path(), study, &records);
        }
        write_results(self.path(), study, &records)?;
        self.settle()
    }
}
