//! What a long piece of work has found so far, on disk: one line for each part that is done, which a kill at
//! any moment cannot spoil.

use regrasp_api::{Refusal, Refuse};
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{self, ErrorKind, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use thiserror::Error;

/// An open journal: a first line that says which work it is of, then a line of JSON for each part that is
/// done. Nobody else can open it meanwhile.
#[derive(Debug)]
pub struct Journal {
    path: PathBuf,
    file: File,
}

/// Why a journal cannot be used.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum JournalError {
    /// Reading or writing.
    #[error("`{}`: {cause}", path.display())]
    File {
        /// Which file.
        path: PathBuf,
        /// What the system says.
        cause: io::Error,
    },
    /// The disk is full.
    #[error(
        "`{}` cannot grow: no space is left there; free some, and give the same command again",
        path.display()
    )]
    DiskFull {
        /// Which file.
        path: PathBuf,
    },
    /// Somebody else works on it.
    #[error("`{}` is in use by another process; wait for its end, or name another folder", path.display())]
    Busy {
        /// Which file.
        path: PathBuf,
    },
    /// It belongs to other work.
    #[error(
        "`{}` is what another command, or the same one with other files, has begun; name another folder, or \
         give `--force`",
        path.display()
    )]
    Other {
        /// Which file.
        path: PathBuf,
    },
    /// A line that is no part of this work.
    #[error("`{}`, line {line}: {reason}; delete the line, and its part is done again", path.display())]
    Line {
        /// Which file.
        path: PathBuf,
        /// The line, from 1.
        line: usize,
        /// What is wrong with it.
        reason: String,
    },
}

impl Journal {
    /// Opens the journal of the work that `head` describes, or begins it, and gives the parts that are done;
    /// `anew` throws away what there is.
    ///
    /// Refuses that of other work. A last line that is torn, as a kill in the middle of writing leaves it, is
    /// cut off: its part is done again.
    pub fn open<T: DeserializeOwned>(
        path: &Path,
        head: &impl Serialize,
        anew: bool,
    ) -> Result<(Self, Vec<T>), JournalError> {
        let failed = |cause| JournalError::File { path: path.to_owned(), cause };
        let head = line_of(head);
        let opened = OpenOptions::new().read(true).write(true).create(true).truncate(false).open(path);
        let mut file = opened.map_err(failed)?;
        // Some network file systems know no locks: then it is up to the user that nobody else works there.
        if let Err(TryLockError::WouldBlock) = file.try_lock() {
            return Err(JournalError::Busy { path: path.to_owned() });
        }
        let mut bytes = Vec::new();
        if !anew {
            file.read_to_end(&mut bytes).map_err(failed)?;
        }
        let is_torn_head = bytes.len() < head.len() && head.starts_with(&bytes);
        if !is_torn_head && !bytes.starts_with(&head) {
            return Err(JournalError::Other { path: path.to_owned() });
        }
        let whole = match is_torn_head {
            true => 0,
            false => bytes.iter().rposition(|&byte| byte == b'\n').map_or(0, |end| end + 1),
        };
        let parts = parts(&bytes[head.len().min(whole)..whole], path)?;
        file.set_len(whole as u64).and_then(|()| file.seek(SeekFrom::End(0))).map_err(failed)?;
        let mut journal = Self { path: path.to_owned(), file };
        if whole == 0 {
            journal.put(&head)?;
        }
        Ok((journal, parts))
    }

    /// Adds a part that is done.
    pub fn append(&mut self, part: &impl Serialize) -> Result<(), JournalError> {
        self.put(&line_of(part))
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.path
    }

    fn put(&mut self, line: &[u8]) -> Result<(), JournalError> {
        // In one write: whatever becomes of the process, the line is there or its end is torn.
        self.file.write_all(line).map_err(|cause| match cause.kind() {
            ErrorKind::StorageFull | ErrorKind::QuotaExceeded => {
                JournalError::DiskFull { path: self.path.clone() }
            }
            _ => JournalError::File { path: self.path.clone(), cause },
        })
    }
}

fn line_of(part: &impl Serialize) -> Vec<u8> {
    let mut line = serde_json::to_vec(part).expect("parts of work are plain data with text keys");
    line.push(b'\n');
    line
}

fn parts<T: DeserializeOwned>(bytes: &[u8], path: &Path) -> Result<Vec<T>, JournalError> {
    let lines = bytes.split_inclusive(|&byte| byte == b'\n').enumerate();
    let read = |(index, line)| {
        let wrong = |error: serde_json::Error| JournalError::Line {
            path: path.to_owned(),
            line: index + 2,
            reason: error.to_string(),
        };
        serde_json::from_slice(line).map_err(wrong)
    };
    lines.map(read).collect()
}

impl Refuse for JournalError {
    fn refusal(&self) -> Refusal {
        let (code, path) = match self {
            Self::File { path, .. } => ("not-written", path),
            Self::DiskFull { path } => ("disk-full", path),
            Self::Busy { path } => ("busy", path),
            Self::Other { path } => ("other-work", path),
            Self::Line { path, .. } => ("journal", path),
        };
        let refusal = Refusal::new(code, self).file(path.display());
        match self {
            Self::Line { line, .. } => refusal.line(Some(*line)),
            Self::Other { .. } => refusal.remedy("name another folder, or give `--force`"),
            _ => refusal,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn open(path: &Path, head: &str, anew: bool) -> Result<(Journal, Vec<[u32; 2]>), JournalError> {
        Journal::open(path, &head, anew)
    }

    #[test]
    fn work_goes_on_after_a_kill_at_any_byte() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("work.part");
        let (mut journal, parts) = open(&path, "a head", false).unwrap();
        assert!(parts.is_empty());
        (0..3).for_each(|k| journal.append(&[k, 10 * k]).unwrap());
        drop(journal);
        let bytes = std::fs::read(&path).unwrap();
        for end in 0..=bytes.len() {
            std::fs::write(&path, &bytes[..end]).unwrap();
            let (mut journal, parts) = open(&path, "a head", false).unwrap();
            let whole = bytes[..end].iter().filter(|&&byte| byte == b'\n').count().saturating_sub(1);
            assert_eq!(parts.len(), whole, "{end} bytes");
            journal.append(&[7, 8]).unwrap();
            drop(journal);
            assert_eq!(open(&path, "a head", false).unwrap().1.last(), Some(&[7, 8]));
        }
    }

    #[test]
    fn other_work_is_refused_and_kept() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("work.part");
        open(&path, "one", false).unwrap().0.append(&[1, 2]).unwrap();
        let before = std::fs::read(&path).unwrap();
        assert!(matches!(open(&path, "another", false), Err(JournalError::Other { .. })));
        assert_eq!(std::fs::read(&path).unwrap(), before);
        assert!(open(&path, "another", true).unwrap().1.is_empty(), "unless it is thrown away");
    }

    #[test]
    fn two_at_once_and_lines_that_make_no_sense_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("work.part");
        let first = open(&path, "h", false).unwrap();
        assert!(matches!(open(&path, "h", true), Err(JournalError::Busy { .. })));
        drop(first);
        std::fs::write(&path, "\"h\"\n[1,2]\nnonsense\n[3,4]\n").unwrap();
        let Err(error) = open(&path, "h", false) else { panic!("nonsense") };
        assert!(matches!(error, JournalError::Line { line: 3, .. }), "{error}");
    }
}
