//! What a log says of each run.

use crate::compare::{Certified, MotionFigures, PHASES, RunRecord, RunStatus};
use regrasp_api::{Reason, Slot};

/// OMPL's own kinds of endings in its own order (`ompl::base::PlannerStatus`), so that logs of both programs
/// can share a database; then ours.
pub const STATUSES: [&str; 13] = [
    "Unknown status",
    "Invalid start",
    "Invalid goal",
    "Unrecognized goal type",
    "Timeout",
    "Approximate solution",
    "Exact solution",
    "Crash",
    "Abort",
    "Infeasible",
    "No plan",
    "Rejected plan",
    "Error",
];

/// The index of a run's ending in [`STATUSES`].
fn status(run: &RunRecord) -> f64 {
    f64::from(match run.status {
        RunStatus::Solved if run.verified => 6,
        RunStatus::Solved => 11,
        RunStatus::NoPlan => 10,
        RunStatus::TimeOut => 4,
        RunStatus::Error => 12,
        RunStatus::Panic | RunStatus::Crash => 7,
    })
}

/// Reads a value off a run.
type Reader = Box<dyn Fn(&RunRecord) -> Option<f64>>;

/// A column: letters, digits and blanks, no digit first, no word of SQL; blanks become underscores in the
/// database.
pub struct Property {
    /// The name.
    pub name: String,
    /// The type, as SQLite takes it.
    pub kind: &'static str,
    /// The value of a run; empty where it has none.
    pub value: Reader,
}

fn property(
    name: impl Into<String>,
    kind: &'static str,
    value: impl Fn(&RunRecord) -> Option<f64> + 'static,
) -> Property {
    let finite = move |run: &RunRecord| value(run).filter(|value| value.is_finite());
    Property { name: name.into(), kind, value: Box::new(finite) }
}

/// Every column, the same for every planner.
pub fn properties() -> Vec<Property> {
    let mut all = outcome();
    all.extend(times());
    all.extend(search());
    all.extend(motion());
    all.extend(certified());
    all
}

fn outcome() -> Vec<Property> {
    let flag = |name: &str, is_so: fn(&RunRecord) -> bool| {
        property(name, "BOOLEAN", move |run| Some(f64::from(u8::from(is_so(run)))))
    };
    vec![
        flag("solved", RunRecord::is_success),
        property("status", "ENUM", |run| Some(status(run))),
        property("time", "REAL", |run| Some(run.times.planning_s)),
        // In MB, as OMPL's own logs have it.
        property("memory", "REAL", |run| run.times.memory_bytes.map(|bytes| bytes as f64 / 1e6)),
        flag("correct solution", |run| run.verified),
        property("run seed", "INTEGER", |run| Some(run.seed as f64)),
    ]
}

fn times() -> Vec<Property> {
    let mut all = vec![property("verification time", "REAL", |run| Some(run.times.verification_s))];
    for phase in PHASES {
        all.push(property(format!("phase {phase} time"), "REAL", move |run| {
            run.times.phases_s.get(phase).copied()
        }));
    }
    let roles = Slot::ALL.map(Slot::name).into_iter().chain(["clearance", "framework"]);
    for role in roles {
        let name = format!("role {} time", words(role));
        all.push(property(name, "REAL", move |run| run.times.roles_s.get(role).copied()));
    }
    all
}

/// A name without the marks that a column may not have.
fn words(name: &str) -> String {
    name.replace(['-', '.'], " ")
}

fn search() -> Vec<Property> {
    let count =
        |name: &str, of: fn(&RunRecord) -> usize| property(name, "INTEGER", move |run| Some(of(run) as f64));
    let mut all = vec![
        count("generated nodes", |run| run.counts.generated_nodes),
        count("graph states", |run| run.counts.graph_nodes),
        count("graph components", |run| run.counts.components),
        count("goals reached", |run| run.counts.goals_reached),
    ];
    for slot in Slot::ALL {
        let name = format!("calls {}", words(slot.name()));
        let calls = move |run: &RunRecord| run.counts.plugins.get(&slot).map_or(0, |plugin| plugin.calls);
        all.push(property(name, "INTEGER", move |run| Some(calls(run) as f64)));
    }
    for reason in Reason::ALL {
        let name = format!("rejections {}", words(reason.name()));
        let rejections = move |run: &RunRecord| {
            let plugins = run.counts.plugins.values();
            plugins.filter_map(|plugin| plugin.rejections.get(&reason)).sum::<u64>()
        };
        all.push(property(name, "INTEGER", move |run| Some(rejections(run) as f64)));
    }
    all
}

fn motion() -> Vec<Property> {
    let of = |name: &str, kind, figure: fn(&MotionFigures) -> f64| {
        property(name, kind, move |run| run.motion.as_ref().map(figure))
    };
    vec![
        of("transfers", "INTEGER", |motion| motion.transfers as f64),
        of("regrasps", "INTEGER", |motion| motion.regrasps as f64),
        of("regrasps before smoothing", "INTEGER", |motion| motion.regrasps_before_smoothing as f64),
        of("solution states", "INTEGER", |motion| motion.states as f64),
        of("solution length", "REAL", |motion| motion.object_path_m),
        of("object turn", "REAL", |motion| motion.object_turn_rad),
        of("joint travel", "REAL", |motion| motion.joint_travel_rad),
        of("sliding joint travel", "REAL", |motion| motion.joint_travel_m),
        of("motion duration", "REAL", |motion| motion.duration_s),
    ]
}

fn certified() -> Vec<Property> {
    let of = |name: &str, figure: fn(&Certified) -> Option<f64>| {
        property(name, "REAL", move |run| run.certified.as_ref().and_then(figure))
    };
    vec![
        of("closure margin", |certified| certified.margin),
        of("solution clearance", |certified| certified.clearance_m),
        of("largest slip", |certified| certified.slip_m),
        of("closure residual", |certified| certified.closure_m),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn names_are_columns() {
        let names: Vec<String> = properties().into_iter().map(|property| property.name).collect();
        for name in &names {
            assert!(name.starts_with(|letter: char| letter.is_ascii_lowercase()), "{name}");
            assert!(name.chars().all(|letter| letter.is_ascii_lowercase() || letter == ' '), "{name}");
        }
        assert_eq!(names.iter().collect::<BTreeSet<_>>().len(), names.len());
        // `computeViews` would add OMPL's own time of simplification to ours, which holds smoothing already.
        assert!(!names.iter().any(|name| name == "simplification time"));
    }
}
