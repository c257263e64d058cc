//! Which runs were begun: what a run that ends its process leaves behind.

use super::{RunKey, StudyError};
use std::fs::{self, File, OpenOptions};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// The name of the list of begun runs in a study's folder; it is there only while runs are made, or after a
/// process that came to no end.
pub const BEGUN: &str = "begun.txt";

/// The open list.
pub(super) struct Begun {
    file: Mutex<File>,
    path: PathBuf,
}

impl Begun {
    /// Opens the list, and gives the runs that were begun before.
    pub fn open(folder: &Path) -> Result<(Self, Vec<RunKey>), StudyError> {
        let path = folder.join(BEGUN);
        let failed = |source| StudyError::Io { path: path.clone(), source };
        let text = fs::read_to_string(&path).unwrap_or_default();
        let file = OpenOptions::new().append(true).create(true).open(&path).map_err(failed)?;
        let before = text.split_inclusive('\n').filter_map(key).collect();
        Ok((Self { file: Mutex::new(file), path }, before))
    }

    /// Says that a run begins. Where that cannot be written the run is made all the same.
    pub fn add(&self, key: RunKey) {
        let line = format!("{} {} {}\n", key.scenario, key.variant, key.seed);
        let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        let _ = file.write_all(line.as_bytes());
    }

    /// Deletes the list: nothing that was begun is open.
    pub fn close(self) {
        drop(self.file);
        // A list that stays costs a run in a process of its own, no more.
        let _ = fs::remove_file(self.path);
    }
}

/// A whole line.
fn key(line: &str) -> Option<RunKey> {
    let mut numbers = line.strip_suffix('\n')?.split(' ');
    let key = RunKey {
        scenario: numbers.next()?.parse().ok()?,
        variant: numbers.next()?.parse().ok()?,
        seed: numbers.next()?.parse().ok()?,
    };
    numbers.next().is_none().then_some(key)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_begun_is_known_until_the_list_is_closed() {
        let folder = tempfile::tempdir().unwrap();
        let keys = [1, 2].map(|seed| RunKey { scenario: 0, variant: 3, seed });
        let (begun, before) = Begun::open(folder.path()).unwrap();
        assert!(before.is_empty());
        keys.iter().for_each(|key| begun.add(*key));
        drop(begun);
        // Torn by a kill.
        let mut text = fs::read_to_string(folder.path().join(BEGUN)).unwrap();
        text.push_str("0 3 1");
        fs::write(folder.path().join(BEGUN), text).unwrap();
        let (begun, before) = Begun::open(folder.path()).unwrap();
        assert_eq!(before, keys);
        begun.close();
        assert!(!folder.path().join(BEGUN).exists());
    }
}
