//! Two studies side by side: two commits, two machines, the same problems.

use super::family::{Asked, judge};
use super::question::{Seeds, band, contrast, horizon_s};
use super::summary::{comparisons_csv, line, subject};
use super::{Family, Measure, Question, RunRecord, Study, StudyError, read_study};
use regrasp_plan::write_file;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;

/// The tables that a comparison with an older study leaves in the folder of the newer one.
pub const AGAINST_FILES: [&str; 2] = ["against.csv", "against.md"];

/// A study beside an older one.
pub struct Against {
    /// The newer study.
    pub study: Study,
    /// What differs between the two, but for the runs: versions, machines, problems; a line each.
    pub differs: Vec<String>,
    /// Every variant on every scenario that both have, seed by seed, new less old: one family.
    pub family: Family,
}

/// The runs of each scenario and variant by seed, found by name.
type Shelf<'a> = BTreeMap<(&'a str, &'a str), Seeds<'a>>;

fn shelf(records: &[RunRecord]) -> Shelf<'_> {
    let mut shelf = Shelf::new();
    for run in records {
        shelf.entry((&run.scenario, &run.variant)).or_default().insert(run.seed, run);
    }
    shelf
}

impl Against {
    /// Compares the study in `folder` with the one in `older`, on the seeds that both have.
    pub fn of(folder: &Path, older: &Path) -> Result<Self, StudyError> {
        let ((study, records), (old, old_records)) = (read_study(folder)?, read_study(older)?);
        let asked = asked(&study, &records, &old, &old_records);
        if asked.iter().all(|asked| asked.contrast.is_none()) {
            return Err(StudyError::NothingInCommon { folder: folder.to_owned(), older: older.to_owned() });
        }
        Ok(Self { differs: differences(&study, &old), family: judge(asked), study })
    }

    /// What may be said, as Markdown.
    pub fn markdown(&self) -> String {
        let mut text = String::from("# Against an older study\n\nNew less old, on the same seeds.\n");
        self.differs.iter().for_each(|line| write!(text, "\n- {line}").expect("a text takes everything"));
        for (k, scenario) in self.study.scenarios.iter().enumerate() {
            let questions = self.family.questions(k);
            if questions.is_empty() {
                continue;
            }
            let name = scenario.name.replace(['\n', '\r', '<', '>'], "'");
            write!(text, "\n\n## {name}\n").expect("a text takes everything");
            for (question, answers) in questions {
                let who = subject(&self.study, question, &|name| format!("`{}`", name.replace('`', "'")));
                let said = line(answers, self.study.hypotheses.band);
                write!(text, "\n- {who}: {said}.").expect("a text takes everything");
            }
        }
        text + "\n"
    }

    /// Writes [`AGAINST_FILES`] into a folder.
    pub fn write(&self, folder: &Path) -> Result<(), StudyError> {
        let texts = [comparisons_csv(&self.study, &self.family), self.markdown()];
        for (name, text) in AGAINST_FILES.into_iter().zip(texts) {
            write_file(&folder.join(name), |out| out.write_all(text.as_bytes()))?;
        }
        Ok(())
    }
}

fn asked(study: &Study, records: &[RunRecord], old: &Study, old_records: &[RunRecord]) -> Vec<Asked> {
    let (mine, theirs) = (shelf(records), shelf(old_records));
    let mut all = Vec::new();
    for (k, scenario) in study.scenarios.iter().enumerate() {
        let Some(other) = old.scenarios.iter().find(|other| other.name == scenario.name) else { continue };
        let is_here = |run: &&RunRecord| run.scenario == scenario.name;
        let runs = records.iter().chain(old_records).filter(is_here);
        let limits = [scenario, other].map(|one| one.problem.limits.budget.time_limit);
        // The shorter limit of two: beyond it one side knows nothing.
        let limit_s = limits.into_iter().flatten().reduce(f64::min);
        let horizon_s = horizon_s(limit_s, runs.clone());
        let measures = Measure::of_runs(runs, &study.hypotheses.measures);
        for (variant, named) in study.variants.iter().enumerate() {
            let key = (scenario.name.as_str(), named.name.as_str());
            let (Some(new), Some(old)) = (mine.get(&key), theirs.get(&key)) else { continue };
            all.extend(measures.iter().map(|measure| Asked {
                scenario: k,
                question: Question::Older { variant },
                measure: measure.clone(),
                contrast: contrast(&[(new, 1.0), (old, -1.0)], measure, horizon_s),
                band: band(measure, old, study.hypotheses.band, horizon_s),
            }));
        }
    }
    all
}

/// What differs but for the runs.
fn differences(study: &Study, old: &Study) -> Vec<String> {
    let mut lines = Vec::new();
    let names = study.versions.keys().chain(old.versions.keys());
    for name in names.collect::<std::collections::BTreeSet<_>>() {
        let of = |study: &Study| study.versions.get(name).cloned().unwrap_or_else(|| "absent".into());
        let (now, then) = (of(study), of(old));
        if now != then {
            lines.push(format!("{name}: {then} then, {now} now"));
        }
    }
    if study.machines != old.machines {
        lines
            .push("the machines differ, or how many runs were made at once: times compare these, too".into());
    }
    for scenario in &study.scenarios {
        let other = old.scenarios.iter().find(|other| other.name == scenario.name);
        match other {
            None => lines.push(format!("{}: not in the older study", scenario.name)),
            Some(other) if other.problem != scenario.problem => {
                lines.push(format!("{}: the problem itself differs", scenario.name));
            }
            Some(_) => {}
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::fixture::{runs, study};
    use crate::compare::{Figure, RunKey, Verdict};

    #[test]
    fn the_same_variant_is_compared_with_itself_of_before() {
        let (new, mut old) = (study(&["rlg", "other"]), study(&["rlg"]));
        old.versions.insert("program".into(), "1234".into());
        old.scenarios[1].name = "gone".into();
        let time = |factor: f64| move |key: RunKey| Some(factor * (1.0 + 0.1 * key.seed as f64));
        let (mine, theirs) = (runs(&new, time(1.0)), runs(&old, time(2.0)));
        let family = judge(asked(&new, &mine, &old, &theirs));
        let planning: Vec<_> = family
            .comparisons
            .iter()
            .filter(|found| found.measure == Measure::Figure(Figure::Planning))
            .collect();
        assert_eq!(planning.len(), 1, "one scenario and one variant are in both");
        assert_eq!((planning[0].verdict, planning[0].is_better()), (Verdict::Less, 1));
        let against = Against { differs: differences(&new, &old), family, study: new };
        let text = against.markdown();
        assert!(text.contains("- program: 1234 then, absent now"), "{text}");
        assert!(text.contains("- `rlg`: planning 1.55 s faster"), "{text}");
    }
}
