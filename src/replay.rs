//! `regrasp replay`: a plan carried out in simulation.

use clap::Args;
use std::path::PathBuf;

/// Carry out a plan in a physics simulation: does the object arrive?
#[derive(Clone, Debug, Args)]
#[command(after_help = "\
The object is free, under the gravity that the plan's scenario gives (0, 0, -9.81 m/s² in the hand's frame \
where it gave none), and held by friction alone. Each joint is \
driven by a motor with a stiffness, a damping and the joint's effort limit; it follows the plan, and what \
the grasp needs is fed forward: the plan's own \
forces, or, where it brings none and with `--grip` or `--gravity`, those that need the least share of the \
friction within the efforts. Nothing looks at where the object is. \
Between two segments the forces pass over to the fingers that hold next.\n\n\
Reported for each segment: the largest deviation of the object from the plan, the largest slip of a \
fingertip, where the object is at the segment's end, and what went wrong. The object has \
arrived if it is within 5 mm and 5° of the plan's end. It counts as dropped where it is 20 mm or 30° off; \
the replay ends there.\n\n\
Plans rely on force closure with 0.8 of the object's friction (`friction_margin` under [limits.resolution] \
in the scenario). Force closure knows no efforts: now and then a grasp of three fingers needs \
forces that the joints do not have, or that nearly slip. `regrasp plan --use stability-test=equilibrium` \
plans with the weight and bounded forces.\n\n\
The same replay in MuJoCo: `python3 tests/outside/mujoco_replay.py PLAN`.\n\n\
Exit codes: 0 the object arrives; 2 bad input; 4 it does not.\n\n\
Examples:\n  regrasp replay plan.json\n  regrasp replay plan.json --slowdown 4 --mass-scale 1.5\n  regrasp \
replay plan.json -o replay.json")]
pub struct ReplayArgs {
    /// A plan file.
    pub plan: PathBuf,
    /// Print one JSON object instead of text.
    #[arg(long)]
    pub json: bool,
    /// Write the JSON object to this file, with the object's pose at every state of the plan; `-` is standard
    /// output.
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    #[command(flatten)]
    pub overwrite: crate::outputs::OverwriteArgs,
    /// Multiply the simulated friction by this, 0 to 10; the forces are chosen for the plan's own.
    #[arg(long, value_name = "X", allow_negative_numbers = true, default_value_t = 1.0, value_parser = number::<0, 10>)]
    pub friction_scale: f64,
    /// Multiply the simulated mass by this, up to 1000; the forces are chosen for the plan's own.
    #[arg(long, value_name = "X", allow_negative_numbers = true, default_value_t = 1.0, value_parser = number::<0, 1000>)]
    pub mass_scale: f64,
    /// Multiply the motors' stiffness by this, up to 1000; at 1 it is 10 N·m/rad, or 1000 N/m in prismatic
    /// joints.
    #[arg(long, value_name = "X", allow_negative_numbers = true, default_value_t = 1.0, value_parser = number::<0, 1000>)]
    pub stiffness_scale: f64,
    /// Multiply the plan's times by this, 0.1 to 100: plans are as fast as the joints can be, and grips
    /// balance the weight alone.
    #[arg(long, value_name = "X", allow_negative_numbers = true, default_value_t = 2.0, value_parser = number::<0, 100>)]
    pub slowdown: f64,
    /// Most normal force of one contact (N), in place of the plan's own forces.
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = number::<0, 10_000>)]
    pub grip: Option<f64>,
    /// Replay in many worlds instead of one, friction, mass, stiffness and slowdown other than planned, and
    /// hold what arrives against what the plan promises.
    #[arg(long, conflicts_with_all = ["output", "friction_scale", "mass_scale", "stiffness_scale", "slowdown"])]
    pub sweep: bool,
    /// Gravity in the hand's frame (m/s²), such as 0,0,9.81; by default the scenario's.
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = vector)]
    pub gravity: Option<[f64; 3]>,
}

impl ReplayArgs {
    /// Whether the plan's own forces do: another grip or gravity asks for others.
    #[cfg(feature = "rapier")]
    fn keeps_forces(&self) -> bool {
        self.grip.is_none() && self.gravity.is_none()
    }
}

/// A finite number in `LOW..=HIGH`; the simulation has narrower ranges for some.
fn number<const LOW: i32, const HIGH: i32>(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(number) if (f64::from(LOW)..=f64::from(HIGH)).contains(&number) => Ok(number),
        _ => Err(format!("it must be a number in {LOW}..={HIGH}")),
    }
}

/// Three numbers with commas between them.
fn vector(text: &str) -> Result<[f64; 3], String> {
    let numbers: Result<Vec<f64>, String> = text.split(',').map(number::<-1000, 1000>).collect();
    let numbers = numbers.map_err(|reason| format!("each of its three numbers: {reason}"))?;
    numbers
        .try_into()
        .map_err(|_| "it must be three numbers with commas between them, such as 0,0,-9.81".into())
}

#[cfg(not(feature = "rapier"))]
pub fn run(_: &ReplayArgs) -> Result<(), crate::Failure> {
    Err(crate::Failure::bad_input(
        "this program was built without simulation; build it with the feature `rapier`, which is on by \
         default",
    ))
}

#[cfg(feature = "rapier")]
pub fn run(args: &ReplayArgs) -> Result<(), crate::Failure> {
    if args.sweep { sweep::run(args) } else { simulated::run(args) }
}

#[cfg(feature = "rapier")]
pub use simulated::by_default;

#[cfg(feature = "rapier")]
mod simulated;
#[cfg(feature = "rapier")]
mod sweep;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vectors_are_three_finite_numbers() {
        assert_eq!(vector("0,0,-9.81"), Ok([0.0, 0.0, -9.81]));
        assert_eq!(vector("1, 2, 3"), Ok([1.0, 2.0, 3.0]));
        for bad in ["1,2", "1,2,3,4", "1,2,x", "", "nan,0,0", "1e9,0,0"] {
            assert!(vector(bad).is_err(), "{bad}");
        }
    }
}
