//! A plan of the gallery.

use super::figures::Figures;
use super::{GalleryArgs, picture, put};
use crate::watch::Watch;
use crate::{Failure, inputs};
use regrasp::host::Registry;
use regrasp::plan::Plan;
use regrasp::run::{RunOptions, Setup, Stop};

/// A problem with its verified plan.
pub struct Entry {
    /// The scenario's name, which is that of the files, too.
    pub name: String,
    /// What was asked for: a built-in name or a file.
    pub asked: String,
    /// What the scenario shows, in one line.
    pub summary: String,
    /// The plan in figures.
    pub figures: Figures,
    /// The plan in a few moments, as SVG.
    pub picture: String,
    plan: Plan,
}

impl Entry {
    /// Plans the scenario; a plan that is not whole, or not verified, is none to be shown.
    pub fn plan(asked: &str, seed: u64, registry: &Registry, watch: &Watch) -> Result<Self, Failure> {
        let scenario = inputs::scenario(asked, registry)?;
        let setup = Setup::new(&scenario, &scenario.choices, registry).map_err(Failure::refused)?;
        let options =
            RunOptions { seed, threads: 1, stop: watch, clock: watch, progress: &regrasp::planner::Silent };
        let run = setup.run(&options).map_err(Failure::refused)?;
        let failed = |why: &str| format!("`{asked}`: {why}; `regrasp plan` with `--seed {seed}` says more");
        if let Some(why) = run.why_not_solved() {
            return Err(match watch.cause() {
                regrasp::plan::StoppedBy::Interrupt => Failure::interrupted("interrupted".into()),
                _ => Failure::no_plan(failed(&why)),
            });
        }
        let verified = run.is_verified();
        let Some(plan) = run.plan.filter(|_| verified) else {
            return Err(Failure::not_verified(failed("the plan does not verify")));
        };
        Ok(Self {
            name: scenario.name.clone(),
            asked: asked.to_owned(),
            summary: scenario.summary.clone(),
            figures: Figures::of(&plan),
            picture: picture::strip(&scenario, &run.outcome.motion),
            plan,
        })
    }

    /// Writes the picture and, unless it is left out, the page.
    pub fn write(&self, args: &GalleryArgs) -> Result<(), Failure> {
        put(args, &format!("{}.svg", self.name), &self.picture)?;
        if args.no_pages {
            return Ok(());
        }
        let page = regrasp::view::page(&self.plan, &regrasp::page::of_plan(&self.plan));
        put(args, &format!("{}.html", self.name), &page.map_err(Failure::bad_input)?)
    }
}
