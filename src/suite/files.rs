//! The folder of a protocol's results.

use super::SuiteArgs;
use crate::Failure;
use crate::outputs::{self, Kind, OverwriteArgs};
use regrasp::plan::{Plan, write, write_file};
use regrasp::suite::{Protocol, Trial};
use std::fs;
use std::path::{Path, PathBuf};

/// Where results and plans go.
pub struct Files {
    results: PathBuf,
    summary: PathBuf,
    plans: PathBuf,
    part: PathBuf,
    overwrite: OverwriteArgs,
}

impl Files {
    /// Makes the folder; refuses what would destroy something.
    pub fn new(folder: &Path, args: &SuiteArgs) -> Result<Self, Failure> {
        let [results, summary, plans, part] =
            ["results.json", "summary.md", "plans", "results.part"].map(|name| folder.join(name));
        let made = |folder: &Path| {
            fs::create_dir_all(folder)
                .map_err(|error| Failure::bad_input(format!("`{}`: {error}", folder.display())))
        };
        made(folder)?;
        let wished = [&results, &summary, &part].map(|path| (path.as_path(), Kind::Suite));
        outputs::check(&[], &wished, args.work.overwrite)?;
        if args.keep_plans {
            made(&plans)?;
        }
        Ok(Self { results, summary, plans, part, overwrite: args.work.overwrite })
    }

    pub fn summary(&self) -> &Path {
        &self.summary
    }

    /// What was found so far.
    pub fn part(&self) -> &Path {
        &self.part
    }

    /// Writes the results; what was found on the way there is in them.
    pub fn write(&self, json: &str, markdown: &str) -> Result<(), Failure> {
        let marked = format!("<!-- regrasp-suite -->\n{markdown}");
        for (path, content) in [(&self.results, json), (&self.summary, marked.as_str())] {
            write_file(path, |out| out.write_all(content.as_bytes())).map_err(Failure::refused)?;
        }
        // Where it cannot be deleted it is in nobody's way.
        drop(fs::remove_file(&self.part));
        Ok(())
    }

    /// Keeps the plans of a trial: `plans/SERIES-PROBLEM-GOAL.json`, each counted from 1.
    pub fn keep(&self, protocol: &Protocol, trial: &Trial, plans: &[Plan]) -> Result<(), Failure> {
        let series = &protocol.series[trial.series].name;
        let plain = |c: char| if c.is_ascii_alphanumeric() || c == '-' { c } else { '-' };
        let series: String = series.chars().map(plain).collect();
        for (goal, plan) in plans.iter().enumerate() {
            let name = format!("{series}-{:04}-{:02}.json", trial.problem + 1, goal + 1);
            let path = self.plans.join(name);
            outputs::check(&[], &[(&path, Kind::Plan)], self.overwrite)?;
            write(&path, plan).map_err(Failure::refused)?;
        }
        Ok(())
    }
}
