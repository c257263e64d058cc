//! Whether one of some files was saved since.

use std::collections::BTreeMap;
use std::fs;
use std::path::PathBuf;
use std::time::SystemTime;

/// What a file looks like from outside: when it was changed, and how long it is; `None` where there is none.
type Look = Option<(SystemTime, u64)>;

/// Files that are looked at again and again.
#[derive(Default)]
pub struct Files {
    seen: BTreeMap<PathBuf, Look>,
}

impl Files {
    /// Looks at these files from now on.
    pub fn watch(&mut self, files: impl IntoIterator<Item = PathBuf>) {
        self.seen = files.into_iter().map(|file| (file.clone(), look(&file))).collect();
    }

    /// Whether one of them looks different from when it was first looked at.
    pub fn changed(&self) -> bool {
        self.seen.iter().any(|(file, seen)| look(file) != *seen)
    }
}

fn look(file: &PathBuf) -> Look {
    let found = fs::metadata(file).ok()?;
    Some((found.modified().ok()?, found.len()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_that_is_saved_deleted_or_made_has_changed() {
        let folder = tempfile::tempdir().unwrap();
        let [there, not_yet] = ["a", "b"].map(|name| folder.path().join(name));
        fs::write(&there, "one").unwrap();
        let mut files = Files::default();
        files.watch([there.clone(), not_yet.clone()]);
        assert!(!files.changed());
        fs::write(&there, "longer").unwrap();
        assert!(files.changed());
        files.watch([there.clone(), not_yet.clone()]);
        fs::write(&not_yet, "new").unwrap();
        assert!(files.changed());
        files.watch([there.clone(), not_yet]);
        fs::remove_file(there).unwrap();
        assert!(files.changed());
    }
}
