//! The journal: an append-only file with one line for each finished run, which a kill at any moment cannot
//! spoil.

use super::worker::{AtWork, Worker};
use super::{RunRecord, StudyError};
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};

/// The journal's name within a study's folder.
pub const JOURNAL: &str = "runs.jsonl";

/// An open journal; nobody else can open it meanwhile.
pub(super) struct Journal {
    file: File,
    path: PathBuf,
    _at_work: AtWork,
}

impl Journal {
    /// Opens the journal of a folder, or begins one, and gives the runs that it holds in the order in which
    /// they ended.
    ///
    /// A last line that is torn, as a kill in the middle of writing leaves it, is cut off: its run is made
    /// again.
    pub fn open(folder: &Path) -> Result<(Self, Vec<RunRecord>), StudyError> {
        let path = folder.join(JOURNAL);
        let failed = |source| StudyError::Io { path: path.clone(), source };
        let opened = OpenOptions::new().read(true).append(true).create(true).open(&path);
        let mut file = opened.map_err(failed)?;
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => {
                let worker = Worker::of(folder);
                return Err(StudyError::Busy { folder: folder.to_owned(), worker });
            }
            // Some network file systems know no locks: then it is up to the user that nobody else works
            // there.
            Err(TryLockError::Error(_)) => {}
        }
        let mut bytes = Vec::new();
        file.read_to_end(&mut bytes).map_err(failed)?;
        let (records, whole) = records(&bytes, &path)?;
        if whole < bytes.len() {
            file.set_len(whole as u64).map_err(failed)?;
        }
        let _at_work = AtWork::begin(folder);
        Ok((Self { file, path, _at_work }, records))
    }

    /// Adds a finished run.
    pub fn append(&mut self, record: &RunRecord) -> Result<(), StudyError> {
        // In one write: whatever becomes of the process, the line is there or its end is torn.
        let written = self.file.write_all(&line(record));
        written.map_err(|source| StudyError::Io { path: self.path.clone(), source })
    }
}

/// Reads the journal of a folder that nobody writes to.
pub(super) fn read(folder: &Path) -> Result<Vec<RunRecord>, StudyError> {
    let path = folder.join(JOURNAL);
    let bytes = match std::fs::read(&path) {
        Ok(bytes) => bytes,
        Err(error) if error.kind() == io::ErrorKind::NotFound => Vec::new(),
        Err(source) => return Err(StudyError::Io { path, source }),
    };
    records(&bytes, &path).map(|(records, _)| records)
}

/// Writes the journal anew, its runs in the order given.
pub(super) fn write(folder: &Path, records: &[RunRecord]) -> Result<(), StudyError> {
    let lines = |out: &mut dyn Write| records.iter().try_for_each(|record| out.write_all(&line(record)));
    Ok(regrasp_plan::write_file(&folder.join(JOURNAL), lines)?)
}

fn line(record: &RunRecord) -> Vec<u8> {
    let mut line = serde_json::to_vec(record).expect("a record is plain data with text keys");
    line.push(b'\n');
    line
}

/// The records of a journal, and how many of its bytes hold them.
fn records(bytes: &[u8], path: &Path) -> Result<(Vec<RunRecord>, usize), StudyError> {
    let (mut records, mut whole) = (Vec::new(), 0);
    for (index, line) in bytes.split_inclusive(|&byte| byte == b'\n').enumerate() {
        match serde_json::from_slice(line) {
            Ok(record) if line.ends_with(b"\n") => records.push(record),
            _ if whole + line.len() == bytes.len() => break,
            Ok(_) => unreachable!("only the last line can lack its end"),
            Err(error) => {
                let reason = error.to_string();
                return Err(StudyError::Journal { path: path.to_owned(), line: index + 1, reason });
            }
        }
        whole += line.len();
    }
    Ok((records, whole))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::{Counts, RunStatus, Times};

    fn record(seed: u64) -> RunRecord {
        RunRecord {
            scenario: "a \"ball\"\n".into(),
            variant: "base".into(),
            seed,
            status: RunStatus::NoPlan,
            verified: false,
            message: Some("no way, no \"plan\"\nat all".into()),
            times: Times { planning_s: 0.1 + 0.2, ..Times::default() },
            counts: Counts::default(),
            motion: None,
            certified: None,
        }
    }

    #[test]
    fn what_was_appended_is_read_back_exactly() {
        let folder = tempfile::tempdir().unwrap();
        let (mut journal, before) = Journal::open(folder.path()).unwrap();
        assert!(before.is_empty());
        (0..3).for_each(|seed| journal.append(&record(seed)).unwrap());
        drop(journal);
        let (_, records) = Journal::open(folder.path()).unwrap();
        assert_eq!(records, [record(0), record(1), record(2)]);
    }

    #[test]
    fn a_line_torn_at_any_byte_is_cut_off_and_the_rest_kept() {
        let bytes = [line(&record(0)), line(&record(1))].concat();
        let first = line(&record(0)).len();
        for cut in first..bytes.len() {
            let folder = tempfile::tempdir().unwrap();
            std::fs::write(folder.path().join(JOURNAL), &bytes[..cut]).unwrap();
            let (mut journal, records) = Journal::open(folder.path()).unwrap();
            assert_eq!(records, [record(0)], "cut at {cut}");
            journal.append(&record(2)).unwrap();
            drop(journal);
            assert_eq!(read(folder.path()).unwrap(), [record(0), record(2)], "cut at {cut}");
        }
    }

    #[test]
    fn a_damaged_line_in_the_middle_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let bytes = [line(&record(0)), b"{\"scenario\": 3}\n".to_vec(), line(&record(1))].concat();
        std::fs::write(folder.path().join(JOURNAL), bytes).unwrap();
        let text = read(folder.path()).unwrap_err().to_string();
        assert!(text.contains("line 2") && text.contains("delete the line"), "{text}");
    }

    #[test]
    fn two_cannot_work_on_one_journal() {
        let folder = tempfile::tempdir().unwrap();
        let first = Journal::open(folder.path()).unwrap();
        let Err(error) = Journal::open(folder.path()) else { panic!("two at once") };
        let text = error.to_string();
        let named = format!("by process {} since 20", std::process::id());
        assert!(matches!(error, StudyError::Busy { .. }) && text.contains(&named), "{text}");
        drop(first);
        assert!(Journal::open(folder.path()).is_ok());
    }
}
