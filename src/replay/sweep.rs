//! `replay --sweep`: what arrives in worlds other than the one that was planned for, against what the plan
//! promises.

use super::ReplayArgs;
use super::simulated::Told;
use crate::table::Table;
use crate::{Failure, say, say_json};
use regrasp::plan::{Holds, Plan};
use serde_json::{Value, json};

const FRICTIONS: [f64; 4] = [1.0, 0.8, 0.6, 0.5];
const MASSES: [f64; 2] = [1.0, 2.0];
const STIFFNESSES: [f64; 2] = [0.5, 2.0];
const SLOWDOWNS: [f64; 2] = [2.0, 4.0];

/// One world.
struct World {
    args: ReplayArgs,
    /// Whether the plan's certificate says that its grasps hold there; `None` where it says nothing.
    promised: Option<bool>,
    arrives: bool,
}

/// Replays the plan in every world, friction and mass with each stiffness and slowdown, and tells what
/// arrives.
pub fn run(args: &ReplayArgs) -> Result<(), Failure> {
    let plan = &regrasp::plan::read(&args.plan).map_err(Failure::refused)?;
    let holds = plan.certificate.as_ref().and_then(|certificate| certificate.holds.as_ref());
    let mut worlds = Vec::new();
    for args in all(args) {
        let arrives = Told::new(&args, plan)?.report.arrived;
        let promised = holds.map(|holds| promises(holds, plan, &args));
        worlds.push(World { args, promised, arrives });
    }
    let broken = worlds.iter().filter(|world| world.promised == Some(true) && !world.arrives).count();
    if args.json {
        say_json(&told(&worlds, broken))?
    } else {
        say(&text(args, &worlds, broken))?
    }
    if broken == 0 {
        return Ok(());
    }
    Err(Failure::not_arrived(format!("{broken} of {} worlds break what the plan promises", worlds.len())))
}

fn all(args: &ReplayArgs) -> Vec<ReplayArgs> {
    let mut all = Vec::new();
    for (friction_scale, mass_scale) in pairs(&FRICTIONS, &MASSES) {
        for (stiffness_scale, slowdown) in pairs(&STIFFNESSES, &SLOWDOWNS) {
            all.push(ReplayArgs { friction_scale, mass_scale, stiffness_scale, slowdown, ..args.clone() });
        }
    }
    all
}

fn pairs<'a>(a: &'a [f64], b: &'a [f64]) -> impl Iterator<Item = (f64, f64)> + 'a {
    a.iter().flat_map(move |&a| b.iter().map(move |&b| (a, b)))
}

/// Whether the certificate covers this friction and mass, each by itself: less friction and more mass at once
/// it does not speak of.
fn promises(holds: &Holds, plan: &Plan, args: &ReplayArgs) -> bool {
    let object = &plan.scenario.problem.object;
    let alone = args.friction_scale == 1.0 || args.mass_scale == 1.0;
    alone
        && holds.friction.value <= object.friction * args.friction_scale
        && (args.mass_scale == 1.0 || holds.mass.value >= object.mass * args.mass_scale)
}

fn told(worlds: &[World], broken: usize) -> Value {
    let world = |world: &World| {
        json!({
            "friction_scale": world.args.friction_scale,
            "mass_scale": world.args.mass_scale,
            "stiffness_scale": world.args.stiffness_scale,
            "slowdown": world.args.slowdown,
            "promised": world.promised,
            "arrived": world.arrives,
        })
    };
    json!({ "worlds": worlds.iter().map(world).collect::<Vec<_>>(), "broken": broken })
}

fn text(args: &ReplayArgs, worlds: &[World], broken: usize) -> String {
    let mut table =
        Table::new(">>>><<", &["friction", "mass", "stiffness", "slowdown", "promised", "arrives"]);
    for World { args, promised, arrives } in worlds {
        let scales = [args.friction_scale, args.mass_scale, args.stiffness_scale, args.slowdown];
        let promised = match promised {
            Some(true) => "yes",
            Some(false) => "no",
            None => "-",
        };
        let words = [promised, if *arrives { "yes" } else { "no" }].map(str::to_owned);
        table.row(scales.map(|scale| format!("× {scale}")).into_iter().chain(words));
    }
    let arrived = worlds.iter().filter(|world| world.arrives).count();
    format!(
        "{}: arrives in {arrived} of {} worlds; promises broken: {broken}\n{}",
        args.plan.display(),
        worlds.len(),
        table.text()
    )
}
