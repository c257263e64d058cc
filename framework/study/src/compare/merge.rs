//! Joining the parts of a study that were made elsewhere.

use super::{Folder, RunRecord, Shard, Study, StudyError, read_study};
use regrasp_plan::write_file;
use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// A part: its folder, what it is of, and its runs.
struct Part {
    folder: PathBuf,
    shard: Shard,
    study: Study,
    records: Vec<RunRecord>,
}

/// Joins the parts in `folders` into `output`: the same files, times aside, as a study that was never in
/// parts. Gives the study.
///
/// Refuses parts of different studies, parts that are missing, there twice, or not finished.
pub fn merge(folders: &[PathBuf], output: &Path) -> Result<Study, StudyError> {
    let parts = parts(folders)?;
    let mut study = whole(&parts);
    let mut folder = Folder::open(output, &mut study)?;
    for part in &parts {
        for record in &part.records {
            let key = study.key(record).filter(|key| part.study.has(*key));
            let key = key.ok_or_else(|| refusal(part, "it has a run that is not of the study"))?;
            if !folder.holds(key) {
                folder.keep(&study, key, record, None)?;
            }
        }
        copy_plans(part, output)?;
    }
    folder.finish(&study)?;
    Ok(study)
}

fn refusal(part: &Part, reason: &str) -> StudyError {
    let Shard { part: number, of } = part.shard;
    StudyError::Merge(format!("`{}` (part {number} of {of}): {reason}", part.folder.display()))
}

/// The parts, every one of them once and finished, in their order.
fn parts(folders: &[PathBuf]) -> Result<Vec<Part>, StudyError> {
    let mut parts: BTreeMap<u64, Part> = BTreeMap::new();
    for folder in folders {
        let part = part(folder)?;
        if let Some(first) = parts.values().next() {
            check_same(first, &part)?;
        }
        if let Some(other) = parts.get(&part.shard.part) {
            let reason = format!("the same part is in `{}`; give each part once", other.folder.display());
            return Err(refusal(&part, &reason));
        }
        parts.insert(part.shard.part, part);
    }
    let of = parts.values().next().map_or(0, |part| part.shard.of);
    let missing: Vec<String> =
        (1..=of).filter(|k| !parts.contains_key(k)).map(|k| format!("{k}/{of}")).take(20).collect();
    match missing.as_slice() {
        [] => Ok(parts.into_values().collect()),
        missing => {
            let list = missing.join(", ");
            Err(StudyError::Merge(format!("parts are missing: {list}; give the folders of all parts")))
        }
    }
}

fn part(folder: &Path) -> Result<Part, StudyError> {
    let (study, records) = read_study(folder)?;
    let folder = folder.to_owned();
    let Some(shard) = study.shard else {
        let reason = "it is a whole study, not a part that `--shard I/N` made".to_owned();
        return Err(StudyError::NoStudy { folder, reason });
    };
    let part = Part { folder, shard, study, records };
    let (there, all) = (part.records.len(), part.study.keys().len());
    if there < all {
        let reason = format!("{there} of its {all} runs are there; finish it with the command that began it");
        return Err(refusal(&part, &reason));
    }
    Ok(part)
}

fn check_same(first: &Part, part: &Part) -> Result<(), StudyError> {
    let of = |part: &Part| Study { shard: None, ..part.study.clone() };
    let number = (first.shard.of != part.shard.of)
        .then(|| format!("one is of {} parts, the other of {}", first.shard.of, part.shard.of));
    match number.or_else(|| of(first).difference(&of(part))) {
        None => Ok(()),
        Some(difference) => {
            let reason = format!("it is of another study than `{}`: {difference}", first.folder.display());
            Err(refusal(part, &reason))
        }
    }
}

/// The study that the parts make.
fn whole(parts: &[Part]) -> Study {
    let mut study = parts[0].study.clone();
    study.shard = None;
    study.started_s = parts.iter().map(|part| part.study.started_s).min().unwrap_or(study.started_s);
    parts.iter().for_each(|part| study.add_machines(part.study.machines.iter().cloned()));
    study
}

/// Copies the plans that a part keeps, each of which must be of one of the part's hands.
fn copy_plans(part: &Part, to: &Path) -> Result<(), StudyError> {
    let (from, to) = (part.folder.join(super::PLANS), to.join(super::PLANS));
    let failed = |path: &Path, source: io::Error| StudyError::Io { path: path.to_owned(), source };
    let entries = match fs::read_dir(&from) {
        Ok(entries) => entries,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(()),
        Err(error) => return Err(failed(&from, error)),
    };
    fs::create_dir_all(&to).map_err(|error| failed(&to, error))?;
    for entry in entries {
        let path = entry.map_err(|error| failed(&from, error))?.path();
        let (Some(name), Some("json")) = (path.file_name(), path.extension().and_then(|e| e.to_str())) else {
            continue;
        };
        let bytes = fs::read(&path).map_err(|error| failed(&path, error))?;
        check_hand(part, &path)?;
        write_file(&to.join(name), |out| out.write_all(&bytes))?;
    }
    Ok(())
}

/// Refuses a kept plan of a hand that is in none of the part's scenarios.
fn check_hand(part: &Part, path: &Path) -> Result<(), StudyError> {
    let named = |reason: String| refusal(part, &format!("`{}`: {reason}", path.display()));
    let plan = regrasp_plan::read(path).map_err(|error| named(error.to_string()))?;
    let hand = &plan.scenario.problem.hand;
    if part.study.scenarios.iter().any(|scenario| scenario.problem.hand == *hand) {
        return Ok(());
    }
    let reason = format!("the plan is of the hand `{}`, which no scenario of the study has", hand.name);
    Err(named(reason))
}
