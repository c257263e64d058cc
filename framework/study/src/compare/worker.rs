//! Who works on a study's folder: a file that is there while somebody does.

use std::fmt;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::UNIX_EPOCH;

/// The name of the file, which holds the number of the process; it was written when the work began.
pub(super) const WORKER: &str = "worker.txt";

/// The process that works on a folder.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Worker {
    /// Its number.
    pub process: u32,
    /// When it began (seconds since 1970, UTC).
    pub since_s: u64,
}

/// Takes the file away when the work ends.
pub(super) struct AtWork(PathBuf);

impl AtWork {
    /// Says that this process works on the folder, whose lock it holds. Where that cannot be written, a
    /// second process hears less, and is refused all the same.
    pub fn begin(folder: &Path) -> Self {
        let path = folder.join(WORKER);
        let _ = fs::write(&path, format!("{}\n", std::process::id()));
        Self(path)
    }
}

impl Drop for AtWork {
    fn drop(&mut self) {
        let _ = fs::remove_file(&self.0);
    }
}

impl Worker {
    /// Who works on a folder, where that is known.
    pub(super) fn of(folder: &Path) -> Option<Self> {
        let path = folder.join(WORKER);
        let process = fs::read_to_string(&path).ok()?.trim().parse().ok()?;
        let begun = fs::metadata(&path).ok()?.modified().ok()?;
        Some(Self { process, since_s: begun.duration_since(UNIX_EPOCH).ok()?.as_secs() })
    }
}

impl fmt::Display for Worker {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (year, month, day) = date(self.since_s / 86_400);
        let minutes = self.since_s % 86_400 / 60;
        let (hour, minute) = (minutes / 60, minutes % 60);
        write!(f, "process {} since {year}-{month:02}-{day:02} {hour:02}:{minute:02} UTC", self.process)
    }
}

/// Year, month and day of a day counted from 1 January 1970 in the Gregorian calendar (H. Hinnant,
/// "chrono-Compatible Low-Level Date Algorithms", 2013: years begin in March).
fn date(day: u64) -> (u64, u64, u64) {
    let day = day + 719_468;
    let (era, of_era) = (day / 146_097, day % 146_097);
    let year = (of_era - of_era / 1460 + of_era / 36_524 - of_era / 146_096) / 365;
    let of_year = of_era - (365 * year + year / 4 - year / 100);
    let month = (5 * of_year + 2) / 153;
    let day = of_year - (153 * month + 2) / 5 + 1;
    let month = if month < 10 { month + 3 } else { month - 9 };
    (era * 400 + year + u64::from(month <= 2), month, day)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dates_are_those_of_the_calendar() {
        for (since_s, said) in [
            (0, "1970-01-01 00:00"),
            (951_782_399, "2000-02-28 23:59"),
            (951_782_400, "2000-02-29 00:00"),
            (1_795_316_400, "2026-11-22 03:00"),
        ] {
            let worker = Worker { process: 7, since_s };
            assert_eq!(worker.to_string(), format!("process 7 since {said} UTC"));
        }
    }

    #[test]
    fn who_works_is_known_until_the_work_ends() {
        let folder = tempfile::tempdir().unwrap();
        let at_work = AtWork::begin(folder.path());
        assert_eq!(Worker::of(folder.path()).map(|worker| worker.process), Some(std::process::id()));
        drop(at_work);
        assert_eq!(Worker::of(folder.path()), None);
    }
}
