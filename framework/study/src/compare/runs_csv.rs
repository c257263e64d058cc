//! `runs.csv`: a row for each run; the same columns in every study, and behind them those that plugins noted.

use super::timed::{CLEARANCE, FRAMEWORK};
use super::{Certified, MotionFigures, PHASES, RunRecord, Study, csv};
use regrasp_api::{Figure, Reason, Slot};
use regrasp_plan::{PluginChoice, RoadmapStatistics};
use std::collections::{BTreeMap, BTreeSet};
use std::io::{self, Write};

type Plugins = BTreeMap<Slot, PluginChoice>;
type Cell = Box<dyn Fn(&RunRecord, &Plugins) -> String>;

/// A column: its name, and what stands in it for a run. Figures that a run does not have are empty.
struct Column {
    name: String,
    cell: Cell,
}

/// Writes the rows of the records, in their order, which must be of the study.
pub(super) fn write_rows(study: &Study, records: &[RunRecord], out: &mut dyn Write) -> io::Result<()> {
    let mut columns = columns();
    columns.extend(note_columns(records));
    let head = columns.iter().map(|column| column.name.clone()).collect();
    out.write_all(csv::line(head).as_bytes())?;
    for record in records {
        let key = study.key(record).expect("the records are of this study");
        let plugins = study.plugins(key);
        let cells = columns.iter().map(|column| (column.cell)(record, plugins)).collect();
        out.write_all(csv::line(cells).as_bytes())?;
    }
    Ok(())
}

fn column(name: impl Into<String>, cell: impl Fn(&RunRecord, &Plugins) -> String + 'static) -> Column {
    Column { name: name.into(), cell: Box::new(cell) }
}

fn columns() -> Vec<Column> {
    let mut columns = vec![
        column("scenario", |run, _| run.scenario.clone()),
        column("variant", |run, _| run.variant.clone()),
        column("seed", |run, _| run.seed.to_string()),
        column("status", |run, _| run.status.name().to_owned()),
        column("verified", |run, _| run.verified.to_string()),
        column("message", |run, _| run.message.clone().unwrap_or_default()),
    ];
    columns.extend(time_columns());
    columns.extend(count_columns());
    columns.extend(motion_columns());
    columns.extend(certified_columns());
    columns.extend(Slot::ALL.into_iter().flat_map(plugin_columns));
    columns
}

fn time_columns() -> Vec<Column> {
    let of = |times: &BTreeMap<String, f64>, name: &str| number(times.get(name).copied());
    let mut columns = vec![
        column("planning_s", |run, _| run.times.planning_s.to_string()),
        column("verification_s", |run, _| run.times.verification_s.to_string()),
    ];
    columns.push(column("memory_bytes", |run, _| {
        run.times.memory_bytes.map(|bytes| bytes.to_string()).unwrap_or_default()
    }));
    columns.extend(PHASES.map(|phase| {
        column(format!("phase.{phase}_s"), move |run: &RunRecord, _: &Plugins| {
            let phases = &run.times.phases_s;
            // A phase that such a plan did not need took no time; a run without phases says nothing of them.
            number((!phases.is_empty()).then(|| phases.get(phase).copied().unwrap_or(0.0)))
        })
    }));
    let roles = Slot::ALL.into_iter().map(Slot::name).chain([CLEARANCE, FRAMEWORK]);
    columns.extend(roles.map(|role| {
        column(format!("self.{role}_s"), move |run: &RunRecord, _: &Plugins| of(&run.times.roles_s, role))
    }));
    columns
}

fn count_columns() -> [Column; 13] {
    let roadmap = |name: &str, count: fn(&RoadmapStatistics) -> usize| {
        column(name, move |run: &RunRecord, _: &Plugins| count(&run.counts.roadmap).to_string())
    };
    [
        column("generated_nodes", |run, _| run.counts.generated_nodes.to_string()),
        column("graph_nodes", |run, _| run.counts.graph_nodes.to_string()),
        column("components", |run, _| run.counts.components.to_string()),
        roadmap("kept_nodes", |roadmap| roadmap.kept_nodes),
        roadmap("grasp_components", |roadmap| roadmap.grasp_components),
        roadmap("largest_grasp_component", |roadmap| roadmap.largest_grasp_component),
        roadmap("used_grasp_edges", |roadmap| roadmap.used_grasp_edges),
        roadmap("used_transfer_edges", |roadmap| roadmap.used_transfer_edges),
        roadmap("decompositions", |roadmap| roadmap.decompositions),
        roadmap("failed_decompositions", |roadmap| roadmap.failed_decompositions),
        roadmap("restarts", |roadmap| roadmap.restarts),
        column("collision_tests", |run, _| run.counts.collision_tests.to_string()),
        column("goals_reached", |run, _| run.counts.goals_reached.to_string()),
    ]
}

fn motion_columns() -> [Column; 9] {
    let of = |name: &str, figure: fn(&MotionFigures) -> String| {
        column(name, move |run: &RunRecord, _: &Plugins| run.motion.as_ref().map(figure).unwrap_or_default())
    };
    [
        of("transfers", |motion| motion.transfers.to_string()),
        of("regrasps", |motion| motion.regrasps.to_string()),
        of("regrasps_before_smoothing", |motion| motion.regrasps_before_smoothing.to_string()),
        of("states", |motion| motion.states.to_string()),
        of("duration_s", |motion| motion.duration_s.to_string()),
        of("object_path_m", |motion| motion.object_path_m.to_string()),
        of("object_turn_rad", |motion| motion.object_turn_rad.to_string()),
        of("joint_travel_rad", |motion| motion.joint_travel_rad.to_string()),
        of("joint_travel_m", |motion| motion.joint_travel_m.to_string()),
    ]
}

fn certified_columns() -> [Column; 9] {
    let of = |name: &str, figure: fn(&Certified) -> String| {
        column(name, move |run: &RunRecord, _: &Plugins| {
            run.certified.as_ref().map(figure).unwrap_or_default()
        })
    };
    [
        of("margin", |certified| number(certified.margin)),
        of("clearance_m", |certified| number(certified.clearance_m)),
        of("slip_m", |certified| number(certified.slip_m)),
        of("closure_m", |certified| number(certified.closure_m)),
        of("holds_friction", |certified| number(certified.holds_friction)),
        of("holds_mass_kg", |certified| number(certified.holds_mass_kg)),
        of("holds_force_n", |certified| number(certified.holds_force_n)),
        of("effort_share", |certified| number(certified.effort_share)),
        of("failed_checks", |certified| certified.failed_checks.join(" ")),
    ]
}

/// What fills a slot, how often it was called, and how often it said no, by cause.
fn plugin_columns(slot: Slot) -> Vec<Column> {
    let name = slot.name();
    let mut columns = vec![
        column(name, move |_, plugins| plugins[&slot].id.clone()),
        column(format!("{name}.settings"), move |_, plugins| plugins[&slot].settings.to_string()),
    ];
    // Contact models are handed nothing to count with.
    if slot == Slot::ContactModel {
        return columns;
    }
    let calls = move |run: &RunRecord, _: &Plugins| {
        run.counts.plugins.get(&slot).map_or(0, |plugin| plugin.calls).to_string()
    };
    columns.push(column(format!("{name}.calls"), calls));
    columns.extend(Reason::ALL.map(|reason| {
        column(format!("{name}.rejected.{}", reason.name()), move |run: &RunRecord, _: &Plugins| {
            let rejections = run.counts.plugins.get(&slot).map(|plugin| &plugin.rejections);
            rejections.and_then(|counts| counts.get(&reason)).copied().unwrap_or(0).to_string()
        })
    }));
    columns
}

/// What plugins noted under names of their own: mean, and how often.
fn note_columns(records: &[RunRecord]) -> Vec<Column> {
    let noted = |run: &RunRecord| {
        let names =
            run.counts.notes.iter().flat_map(|(slot, notes)| notes.keys().map(|name| (*slot, name.clone())));
        names.collect::<Vec<_>>()
    };
    let names: BTreeSet<(Slot, String)> = records.iter().flat_map(noted).collect();
    names.into_iter().flat_map(|(slot, name)| of_note(slot, &name)).collect()
}

fn of_note(slot: Slot, name: &str) -> [Column; 2] {
    let (of_mean, of_count) = (name.to_owned(), name.to_owned());
    let head = format!("{}.note.{name}", slot.name());
    let count = column(format!("{head}.count"), move |run: &RunRecord, _: &Plugins| {
        noted(run, slot, &of_count).map_or(0, |figure| figure.count).to_string()
    });
    let mean = column(head, move |run: &RunRecord, _: &Plugins| {
        number(noted(run, slot, &of_mean).map(|figure| figure.mean))
    });
    [mean, count]
}

fn noted(run: &RunRecord, slot: Slot, name: &str) -> Option<Figure> {
    run.counts.notes.get(&slot)?.get(name).copied()
}

fn number(value: Option<f64>) -> String {
    value.map(|value| value.to_string()).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_named_once_and_begin_with_what_tells_runs_apart() {
        let names: Vec<String> = columns().into_iter().map(|column| column.name).collect();
        assert_eq!(names[..3], ["scenario", "variant", "seed"]);
        assert_eq!(names.iter().collect::<BTreeSet<_>>().len(), names.len());
        for name in
            ["sampler", "sampler.settings", "sampler.rejected.reach", "phase.search_s", "self.clearance_s"]
        {
            assert!(names.iter().any(|other| other == name), "{name}");
        }
    }
}
