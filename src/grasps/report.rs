//! What is told of a search for grasps.

use crate::{Failure, say, say_json};
use regrasp::api::{Reason, Slot};
use regrasp::grasps::{Ending, GraspSource};
use regrasp::run::scenario::Scenario;
use serde_json::{Map, Value, json};
use std::path::Path;

/// A search that has ended.
pub struct Report<'a> {
    pub scenario: &'a Scenario,
    pub source: &'a GraspSource<'a>,
    pub ending: &'a Ending,
    pub seconds: f64,
    pub threads: u16,
    /// Grasps that an earlier run had found.
    pub resumed: u64,
}

impl Report<'_> {
    /// What the files say of the set: nothing of this run's time or threads.
    pub fn info(&self) -> Value {
        let (plan, wish) = (self.source.plan(), self.source.wish());
        let id = |slot: Slot| plan.scenario.plugins.get(&slot).map(|choice| &choice.id);
        json!({
            "format": "regrasp-grasps",
            "version": 2,
            "scenario": self.scenario.name,
            "hand": plan.scenario.problem.hand.name,
            "object": plan.scenario.problem.object.name,
            "contact_model": id(Slot::ContactModel),
            "stability_test": id(Slot::StabilityTest),
            "criterion": plan.claims.criterion,
            "cone": plan.claims.contact.cone,
            "seed": wish.seed,
            "spread": wish.spread,
            "per_pose": wish.per_pose,
            "per_facet": wish.per_facets,
            "versions": plan.versions,
        })
    }

    /// Tells of it on standard output.
    pub fn tell(&self, as_json: bool, written: Option<&Path>) -> Result<(), Failure> {
        if as_json { say_json(&self.json(written)) } else { say(&self.text(written)) }
    }

    fn rate(&self) -> f64 {
        (self.ending.grasps - self.resumed) as f64 / self.seconds.max(1e-9)
    }

    fn json(&self, written: Option<&Path>) -> Value {
        let counts = &self.ending.counts;
        let causes = counts.causes().into_iter().map(|(reason, n)| (reason.name().to_owned(), json!(n)));
        json!({
            "file": written,
            "grasps": self.ending.grasps,
            "resumed": self.resumed,
            "edges": self.source.wish().graph.then_some(self.ending.edges),
            "seconds": self.seconds,
            "grasps_per_second": self.rate(),
            "threads": self.threads,
            "poses": counts.poses,
            "reached": counts.reached,
            "tried": counts.tried,
            "twins": counts.twins,
            "surplus": counts.surplus,
            "refused_by_verifier": counts.refused,
            "rejections": causes.collect::<Map<String, Value>>(),
            "set": self.info(),
        })
    }

    fn text(&self, written: Option<&Path>) -> String {
        let (counts, ending) = (&self.ending.counts, self.ending);
        let place = written.map_or("nothing is written".into(), |path| format!("in {}", path.display()));
        let mut text = format!("{} grasps of {}: {place}\n", ending.grasps, self.scenario.name);
        let mut line = |key: &str, value: String| text += &format!("  {key:<11} {value}\n");
        let resumed = match self.resumed {
            0 => String::new(),
            before => format!(" ({before} were there)"),
        };
        line(
            "search",
            format!("{:.2} s, {:.0} grasps/s, {} threads{resumed}", self.seconds, self.rate(), self.threads),
        );
        line("poses", format!("{} drawn, {} reached by enough fingers", counts.poses, counts.reached));
        line("grasps", format!("{} tried, {} twins", counts.tried, counts.twins));
        if self.source.wish().graph {
            line("regrasps", format!("{} connect two of them", ending.edges));
        }
        let causes = counts.causes().into_iter().take(4);
        let causes: Vec<String> = causes.map(|(reason, n)| format!("{} {n}", reason.name())).collect();
        line("given up", causes.join(", "));
        if counts.refused > 0 {
            line(
                "verifier",
                format!(
                    "refused {}, which are left out: a fault of the program, which its makers like to hear \
                     of",
                    counts.refused
                ),
            );
        }
        text
    }

    /// Why there are no more, from the counts, and what to try.
    pub fn why_no_more(&self, found: &str) -> String {
        let counts = &self.ending.counts;
        let causes: Vec<String> =
            counts.causes().iter().map(|(reason, n)| format!("{} {n}", reason.name())).collect();
        let start = format!(
            "no more grasps: {found}; {} poses were drawn, {} within the reach of enough fingers; given up \
             because of: {}",
            counts.poses,
            counts.reached,
            if causes.is_empty() { "nothing".to_owned() } else { causes.join(", ") }
        );
        format!("{start}\n  to try  {}", self.advice())
    }

    fn advice(&self) -> &'static str {
        let counts = &self.ending.counts;
        if self.ending.grasps > 0 {
            return "a smaller `--spread`, a larger `--per-facet`, or fewer grasps";
        }
        // Fewer than one pose in a thousand: what is in the way there is not what to mend first.
        if 1000 * counts.reached < counts.poses {
            return match counts.causes().first() {
                Some((Reason::Collision, _)) => {
                    "the object meets palm or obstacles, or links touch it: move obstacles, widen \
                     `workspace`, or \
                     lower `limits.resolution.clearance`"
                }
                Some((Reason::Edge, _)) => {
                    "contacts lie too close to sharp edges: lower `limits.resolution.edge_margin`"
                }
                _ => "the fingers do not reach the object: look at its size and unit, and at `workspace`",
            };
        }
        match counts.causes().iter().find(|(reason, _)| *reason == Reason::Stability) {
            Some((_, n)) if 2 * n >= counts.tried => {
                "the fingers touch the object and do not hold it: more friction, or less load in `[hold]`"
            }
            _ => {
                "fingers are in each other's way: fewer `--fingers`, or a lower `limits.resolution.clearance`"
            }
        }
    }
}
