//! What `plan` says about a run.

use crate::holds::holds_lines;
use crate::quantity::{digits, span};
use crate::table::Table;
use crate::terminal::{Paint, paint};
use crate::verify::check_table;
use regrasp::Needed;
use regrasp::api::{Reason, Slot, Tally};
use regrasp::host::Choices;
use regrasp::page::place_text;
use regrasp::plan::{Extreme, HoldsAt, Plan, SegmentKind, Statistics};
use regrasp::planner::Status;
use regrasp::run::scenario::Scenario;
use regrasp::run::{Course, Run, RunOptions};
use regrasp::verify::Check;
use serde_json::{Map, Value, json};
use std::collections::BTreeSet;
use std::path::Path;

/// A run with everything that a report about it mentions.
pub struct Summary<'a> {
    pub scenario: &'a Scenario,
    pub choices: &'a Choices,
    pub run: &'a Run,
    /// How the plan was improved, where that was asked for.
    pub course: Option<&'a Course>,
    pub options: &'a RunOptions<'a>,
    pub saved: Option<&'a Path>,
}

impl Summary<'_> {
    /// The one JSON object of `plan --json`.
    pub fn json(&self) -> Value {
        let (run, statistics) = (self.run, &self.run.outcome.statistics);
        let motion = &run.outcome.motion;
        json!({
            "scenario": self.scenario.name,
            "status": run.outcome.status,
            "verified": run.is_verified(),
            "stopped_by": run.stopped_by,
            "seed": self.options.seed,
            "threads": self.options.threads,
            "goals": self.scenario.problem.goal.len(),
            "goals_reached": run.outcome.goal_ends,
            "time_s": run.planning_s,
            "verification_s": run.verification_s,
            "phases_s": statistics.time_s,
            "generated_nodes": statistics.generated_nodes,
            "graph_nodes": statistics.graph_nodes,
            "components": statistics.components,
            "roadmap": statistics.roadmap,
            "transfers": statistics.transfers,
            "regrasps": statistics.regrasps,
            "regrasps_before_smoothing": statistics.regrasps_before_smoothing,
            "states": motion.segments.iter().map(|segment| segment.states.len()).sum::<usize>(),
            "duration_s": duration(run),
            "improve": self.course,
            "certificate": run.plan.as_ref().and_then(|plan| plan.certificate.as_ref()),
            "checks": run.verdict.as_ref().map(|verdict| &verdict.checks),
            "rejections": rejection_counts(statistics),
            "plugins": self.plugins(),
            "warnings": run.outcome.warnings,
            "output": self.saved,
        })
    }

    fn plugins(&self) -> Value {
        let choice = |(slot, choice): (Slot, &regrasp::host::Choice)| (slot.name().to_owned(), json!(choice));
        Value::Object(self.choices.iter().map(choice).collect::<Map<_, _>>())
    }

    /// The report for a person.
    pub fn text(&self) -> String {
        let (run, statistics) = (self.run, &self.run.outcome.statistics);
        let verdict = match run.is_verified() {
            true => paint(Paint::Good, "solved, verified"),
            false => paint(Paint::Bad, "solved, not verified"),
        };
        let mut text = match run.outcome.status {
            Status::Solved => {
                format!("{}: {verdict} (seed {})\n", self.scenario.name, self.options.seed)
            }
            _ => format!(
                "{}: {} (seed {})\n",
                self.scenario.name,
                paint(
                    Paint::Bad,
                    &format!(
                        "{} of {} goals reached",
                        run.outcome.goal_ends.len(),
                        self.scenario.problem.goal.len()
                    )
                ),
                self.options.seed
            ),
        };
        text += &self.times();
        text += &self.course.map(improvement).unwrap_or_default();
        text += &format!(
            "  graph         {} in {}, {} generated\n",
            counted(statistics.graph_nodes, "node"),
            counted(statistics.components, "component"),
            statistics.generated_nodes
        );
        text += &run.plan.as_ref().map(|plan| self.plan_lines(plan)).unwrap_or_default();
        text += &run
            .outcome
            .warnings
            .iter()
            .map(|warning| format!("  {}       {warning}\n", paint(Paint::Look, "warning")))
            .collect::<String>();
        text + &self.saved_line()
    }

    fn times(&self) -> String {
        let phases = self.run.outcome.statistics.time_s.iter();
        // The parts in the unit of the whole.
        let scale = if self.run.planning_s < 0.9995 { 1e3 } else { 1.0 };
        let phases: Vec<String> = phases.map(|(phase, s)| format!("{phase} {:.1}", s * scale)).collect();
        let planning = format!("  planning      {} ({})\n", span(self.run.planning_s), phases.join(", "));
        match self.run.verdict {
            Some(_) => format!("{planning}  verification  {}\n", span(self.run.verification_s)),
            None => planning,
        }
    }

    fn plan_lines(&self, plan: &Plan) -> String {
        let statistics = &self.run.outcome.statistics;
        let states: usize = plan.segments.iter().map(|segment| segment.states.len()).sum();
        let mut text = format!(
            "  plan          {}, {} ({} before smoothing), {states} states, {:.1} s of motion\n",
            counted(statistics.transfers, "transfer"),
            counted(statistics.regrasps, "regrasp"),
            statistics.regrasps_before_smoothing,
            duration(self.run).unwrap_or(0.0)
        );
        let Some(certificate) = &plan.certificate else { return text };
        let mut figure = |name: &str, extreme: &Option<Extreme>, scale: f64, unit: &str| {
            if let Some(extreme) = extreme {
                let (value, place) =
                    (extreme.value * scale, place_text(&extreme.place, &self.scenario.problem));
                let least = if name == "clearance" || name == "margin" { "at least " } else { "" };
                let times = extreme.holds_at.map_or("", HoldsAt::remark);
                text += &format!("  {name:<13} {least}{value:.3}{unit}{times} ({place})\n");
            }
        };
        figure("margin", &certificate.closure_margin, 1.0, "");
        figure("clearance", &certificate.clearance, 1e3, " mm");
        figure("slip", &certificate.slip, 1e3, " mm");
        figure("closure", &certificate.closure_residual, 1e6, " µm");
        text += &holds_lines(certificate.holds.as_ref(), &self.scenario.problem);
        text + &self.remarks()
    }

    /// What the verifier could not check although it found nothing wrong, such as the cones of a contact
    /// model that it does not know.
    fn remarks(&self) -> String {
        let checks = self.run.verdict.iter().flat_map(|verdict| &verdict.checks);
        // Other notes belong to a place in the plan.
        let of_the_whole = |check: &&Check| check.ok && check.place.segment.is_none();
        let remark = |check: &Check| Some(format!("  {:<13} {}\n", check.name, check.place.note.as_ref()?));
        checks.filter(of_the_whole).filter_map(remark).collect()
    }

    fn saved_line(&self) -> String {
        match self.saved {
            Some(path) => format!("  written to    {}\n", path.display()),
            None if self.run.is_verified() => "  not written   add `-o plan.json` to keep the plan\n".into(),
            None => String::new(),
        }
    }

    /// Why a plan was rejected: the checks that it does not meet.
    pub fn why_not_verified(&self) -> String {
        let table = self
            .run
            .verdict
            .as_ref()
            .map(|verdict| check_table(verdict.failures(), None, &self.scenario.problem))
            .unwrap_or_default();
        let kept = match self.saved {
            Some(path) => format!("it was kept as `{}`", path.display()),
            None => "it was not written".into(),
        };
        format!("the plan does not verify; {kept}\n{table}{}", self.culprits())
    }

    /// Whose segments fail, and how to hear more.
    fn culprits(&self) -> String {
        let checks = self.run.verdict.iter().flat_map(|verdict| verdict.failures());
        let (mut slots, segments) = (BTreeSet::new(), &self.run.outcome.motion.segments);
        for check in checks {
            let Some(segment) = check.place.segment.and_then(|index| segments.get(index)) else { continue };
            slots.insert(match segment.kind {
                SegmentKind::Transfer => Slot::TransferPlanner,
                SegmentKind::Regrasp(_) => Slot::RegraspPlanner,
            });
            if check.name == "stability" {
                slots.extend([Slot::ContactModel, Slot::StabilityTest]);
            }
        }
        let name = |slot: Slot| format!("`{}`", self.choices.choice(slot).id);
        let names: Vec<String> = slots.into_iter().map(name).collect();
        match names.as_slice() {
            [] => String::new(),
            names => format!(
                "  what fails comes from {}; the same command with `--audit` names the call and the law it \
                 breaks\n",
                names.join(" and ")
            ),
        }
    }

    /// Why there is no plan, what to try, and the rejections by cause.
    pub fn why_no_plan(&self) -> String {
        let outcome = &self.run.outcome;
        let reason = self.run.why_not_solved().unwrap_or_default();
        let kept = self.saved.map(|path| format!("; what was reached is kept as `{}`", path.display()));
        let rejections = rejections(&outcome.statistics);
        let given = self.scenario.problem.object.friction;
        let fix = "raise `object.friction` if the surfaces allow it";
        let advice = match regrasp::needed_friction(self.scenario, self.run) {
            Some(Needed::ForGrasps(needed)) => format!(
                "most grasps are not stable: grasps are found at friction {needed}, {given} is given; {fix}"
            ),
            Some(Needed::ForPlan(needed)) => format!(
                "nearly all grasps are not stable: at friction {needed} there is a plan, {given} is given; \
                    {fix}"
            ),
            None => regrasp::advice(self.run),
        };
        let warned = outcome.warnings.iter().map(|warning| format!("  first look at  {warning}\n"));
        let warned: String = warned.collect();
        format!("{reason}{}\n{warned}  to try  {advice}\n{rejections}", kept.unwrap_or_default())
    }
}

/// What an improvement has come to.
fn improvement(course: &Course) -> String {
    let (Some(first), Some(best)) = (course.curve.first(), course.curve.last()) else { return String::new() };
    let searches = match course.searches {
        1 => "1 further search".to_owned(),
        count => format!("{count} further searches"),
    };
    let figure = |x: f64| if x.fract() == 0.0 { format!("{x:.0}") } else { format!("{x:.3}") };
    let found = match best.search {
        0 => "the first plan is the best".to_owned(),
        _ => format!(
            "{} {} instead of {} after {:.2} s, by seed {}",
            course.objective.name(),
            figure(best.cost),
            figure(first.cost),
            best.time_s,
            best.seed
        ),
    };
    format!("  improved      {searches}: {found}\n")
}

/// A number with its noun.
fn counted(number: usize, noun: &str) -> String {
    let ending = if number == 1 { "" } else { "s" };
    format!("{number} {noun}{ending}")
}

/// Duration of the motion (s).
fn duration(run: &Run) -> Option<f64> {
    run.outcome.motion.segments.last()?.times.last().copied()
}

fn rejection_counts(statistics: &Statistics) -> Value {
    let counts =
        statistics.plugins.iter().map(|(slot, plugin)| (slot.name().to_owned(), json!(plugin.rejections)));
    Value::Object(counts.collect())
}

/// The table of rejections: a row for each slot that was called, a column for each cause that occurred.
pub fn rejections(statistics: &Statistics) -> String {
    let occurred =
        |reason: &Reason| statistics.plugins.values().any(|plugin| plugin.rejections.contains_key(reason));
    let reasons: Vec<Reason> = Reason::ALL.into_iter().filter(occurred).collect();
    let head: Vec<&str> =
        ["rejections by cause", "calls"].into_iter().chain(reasons.iter().map(|r| r.name())).collect();
    let mut table = Table::new("<>", &head);
    for (slot, plugin) in &statistics.plugins {
        let count = |reason: &Reason| plugin.rejections.get(reason).map(u64::to_string).unwrap_or("-".into());
        let cells = [slot.name().to_owned(), plugin.calls.to_string()].into_iter();
        table.row(cells.chain(reasons.iter().map(count)));
    }
    table.text()
}

/// What plugins noted under names of their own; empty where none did.
pub fn notes(tally: &Tally) -> String {
    if tally.notes().is_empty() {
        return String::new();
    }
    let mut table = Table::new("<<>", &["noted by", "name", "times", "mean", "least", "most"]);
    for note in tally.notes() {
        let figure = note.figure;
        let numbers = [figure.mean, figure.least, figure.most].map(digits);
        let cells = [note.slot.name().to_owned(), note.name.to_owned(), figure.count.to_string()];
        table.row(cells.into_iter().chain(numbers));
    }
    table.text()
}

#[cfg(test)]
mod tests {
    use super::*;
    use regrasp::Stopwatch;

    /// What is said of a run whose plan has a joint moved in the middle of its first segment with or without
    /// a finger that moves.
    fn said_of_damage(regrasps: bool) -> String {
        let scenario = regrasp::load("sphere").unwrap();
        let setup = regrasp::setup(&scenario).unwrap();
        let clock = Stopwatch::start();
        let options = clock.options(0);
        let mut run = setup.run(&options).unwrap();
        let plan = run.plan.as_mut().unwrap();
        let segment = plan.segments.iter_mut().find(|segment| segment.finger.is_some() == regrasps).unwrap();
        let middle = segment.states.len() / 2;
        segment.states[middle].joints[usize::from(segment.finger.unwrap_or(0))][1] += 0.05;
        run.verdict = Some(regrasp::verify::verify_on(plan, 1));
        let choices = setup.choices();
        Summary { scenario: &scenario, choices, run: &run, course: None, options: &options, saved: None }
            .why_not_verified()
    }

    #[test]
    fn plugins_whose_segments_fail_are_named() {
        let (transfer, regrasp) = (said_of_damage(false), said_of_damage(true));
        let [rolling, rrt] = ["`local-planner/rolling`", "`local-planner/rrt`"].map(str::to_owned);
        assert!(transfer.contains("--audit") && transfer.contains(&rolling), "{transfer}");
        assert!(!transfer.contains(&rrt), "{transfer}");
        assert!(regrasp.contains(&rrt) && !regrasp.contains(&rolling), "{regrasp}");
    }
}
