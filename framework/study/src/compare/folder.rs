//! A study's folder: what it holds, and whether it may be worked on.

use super::journal::Journal;
use super::worker::WORKER;
use super::{JOURNAL, RunKey, RunName, RunRecord, STUDY_VERSION, Study, StudyError, journal};
use regrasp_plan::{Plan, TEMPORARY, write_file, write_json};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// The name of the file that says what the study is.
pub const STUDY_FILE: &str = "study.json";

/// The name of the folder of the plans that a study keeps.
pub const PLANS: &str = "plans";

/// A study's folder, open for work; nobody else can open it meanwhile.
pub struct Folder {
    path: PathBuf,
    journal: Journal,
    records: BTreeMap<RunKey, RunRecord>,
}

impl Folder {
    /// Opens a folder for a study, new or begun before; `study` then is as it was begun, with this machine
    /// added.
    ///
    /// A folder that holds another study, or something else, is refused.
    pub fn open(path: &Path, study: &mut Study) -> Result<Self, StudyError> {
        if path.exists() && !path.is_dir() {
            let reason = "it is a file; give a folder".to_owned();
            return Err(StudyError::NoStudy { folder: path.to_owned(), reason });
        }
        fs::create_dir_all(path).map_err(|source| StudyError::Io { path: path.to_owned(), source })?;
        let begun = path.join(STUDY_FILE);
        let refuse = |entry| StudyError::NotEmpty { folder: path.to_owned(), entry };
        if let (false, Some(entry)) = (begun.exists(), stranger(path)?) {
            return Err(refuse(entry));
        }
        let (journal, found) = Journal::open(path)?;
        // Looked at again: whoever held the journal may have begun the study meanwhile.
        match begun.exists() {
            true => resume(path, study)?,
            false if found.is_empty() => {}
            false => return Err(refuse(JOURNAL.to_owned())),
        }
        sweep(path);
        write_file(&path.join(STUDY_FILE), |out| write_json(study, out))?;
        let mut records = BTreeMap::new();
        for record in found {
            let key = study.key(&record).filter(|key| study.has(*key));
            let key = key.ok_or_else(|| StudyError::NoStudy {
                folder: path.to_owned(),
                reason: format!("`{JOURNAL}` has a run that is not of the study in `{STUDY_FILE}`"),
            })?;
            records.insert(key, record);
        }
        Ok(Self { path: path.to_owned(), journal, records })
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Whether a run is there.
    pub fn holds(&self, key: RunKey) -> bool {
        self.records.contains_key(&key)
    }

    /// The runs that are there, in the order of their keys.
    pub fn records(&self) -> Vec<RunRecord> {
        self.records.values().cloned().collect()
    }

    /// Keeps a run that has ended, and its plan.
    pub(super) fn keep(
        &mut self,
        study: &Study,
        key: RunKey,
        record: &RunRecord,
        plan: Option<&Plan>,
    ) -> Result<(), StudyError> {
        // The plan first: a run that is in the journal is never made again.
        if let Some(plan) = plan {
            let place = match study.keeps_plan(key) {
                true => plan_path(&self.path, study, key.scenario),
                false => further_plan_path(&self.path, study, key),
            };
            let folder = place.parent().unwrap_or(Path::new(""));
            fs::create_dir_all(folder)
                .map_err(|source| StudyError::Io { path: folder.to_owned(), source })?;
            regrasp_plan::write(&place, plan)?;
        }
        self.journal.append(record)?;
        self.records.insert(key, record.clone());
        Ok(())
    }

    /// Writes the journal in the order of the keys, which tells nothing any more of who came first.
    pub(super) fn settle(&self) -> Result<(), StudyError> {
        journal::write(&self.path, &self.records())
    }
}

impl Study {
    /// What a run is called.
    pub(super) fn run_name(&self, key: RunKey) -> RunName<'_> {
        let (scenario, variant) = (&self.scenarios[key.scenario].name, &self.variants[key.variant].name);
        RunName { scenario, variant, seed: key.seed }
    }

    /// Whether the study keeps the plan of this run: for each scenario that of the first variant with the
    /// first seed.
    pub(super) fn keeps_plan(&self, key: RunKey) -> bool {
        let first = (0..self.variants.len()).find(|&variant| !self.is_left_out(key.scenario, variant));
        key.seed == self.seeds.first && Some(key.variant) == first
    }
}

/// Where a study keeps a plan of a scenario, that of the first variant with the first seed; there is none
/// where that run reached no goal.
pub fn plan_path(folder: &Path, study: &Study, scenario: usize) -> PathBuf {
    folder.join(PLANS).join(format!("{}.json", study.file_stem(scenario)))
}

/// Where a study that keeps all plans keeps that of any other run: `plans/SCENARIO/VARIANT-SEED.json`,
/// variants counted from 0.
pub fn further_plan_path(folder: &Path, study: &Study, key: RunKey) -> PathBuf {
    let stem = study.file_stem(key.scenario);
    folder.join(PLANS).join(stem).join(format!("{}-{}.json", key.variant, key.seed))
}

/// Reads the study of a folder that nobody works on, and its runs.
pub fn read_study(folder: &Path) -> Result<(Study, Vec<RunRecord>), StudyError> {
    let study = read_description(folder)?;
    Ok((study, journal::read(folder)?))
}

fn read_description(folder: &Path) -> Result<Study, StudyError> {
    let refuse = |reason: String| StudyError::NoStudy { folder: folder.to_owned(), reason };
    let bytes = fs::read(folder.join(STUDY_FILE)).map_err(|error| match error.kind() {
        io::ErrorKind::NotFound => refuse(format!("it has no `{STUDY_FILE}`")),
        _ => refuse(format!("`{STUDY_FILE}`: {error}")),
    })?;
    let value: Value =
        serde_json::from_slice(&bytes).map_err(|error| refuse(format!("`{STUDY_FILE}`: {error}")))?;
    let version = &value["version"];
    if value["format"] == "regrasp-study" && *version != STUDY_VERSION {
        let known = format!("this program reads version {STUDY_VERSION}");
        return Err(refuse(format!("`{STUDY_FILE}` is of format version {version}, {known}")));
    }
    let study: Study =
        serde_json::from_value(value).map_err(|error| refuse(format!("`{STUDY_FILE}`: {error}")))?;
    match study.fault() {
        None => Ok(study),
        Some(fault) => Err(refuse(format!("`{STUDY_FILE}`: {fault}"))),
    }
}

/// Takes over what a study that was begun before says of itself; refuses another study.
fn resume(folder: &Path, study: &mut Study) -> Result<(), StudyError> {
    let begun = read_description(folder)?;
    if let Some(difference) = begun.difference(study) {
        let program = difference.starts_with("`versions.");
        return Err(StudyError::OtherStudy { folder: folder.to_owned(), difference, program });
    }
    let asked = std::mem::replace(study, begun);
    study.add_machines(asked.machines);
    study.hypotheses = asked.hypotheses;
    Ok(())
}

/// An entry that is neither a study's nor left over from the very beginning of one.
fn stranger(folder: &Path) -> Result<Option<String>, StudyError> {
    let failed = |source| StudyError::Io { path: folder.to_owned(), source };
    let mut strangers = Vec::new();
    for entry in fs::read_dir(folder).map_err(failed)? {
        let name = entry.map_err(failed)?.file_name().to_string_lossy().into_owned();
        if name != JOURNAL && name != WORKER && !is_temporary(&name) {
            strangers.push(name);
        }
    }
    Ok(strangers.into_iter().min())
}

fn is_temporary(name: &str) -> bool {
    name.starts_with(TEMPORARY.0) && name.ends_with(TEMPORARY.1)
}

/// Deletes what a killed process left behind half written, in the folder and those within.
fn sweep(folder: &Path) {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let inner = entries.map(|entry| entry.path()).filter(|path| path.is_dir());
    for folder in inner.chain([folder.to_owned()]) {
        let entries = fs::read_dir(folder).into_iter().flatten().flatten();
        for entry in entries.filter(|entry| is_temporary(&entry.file_name().to_string_lossy())) {
            // A file that cannot be deleted is in nobody's way.
            let _ = fs::remove_file(entry.path());
        }
    }
}
