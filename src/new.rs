//! `regrasp new`: a scenario of one's own, from three answers.

mod answers;
mod text;

#[cfg(test)]
mod tests;

use crate::outputs::{self, Kind, OverwriteArgs};
use crate::plugins::registry;
use crate::{Failure, args::LibraryArgs, place, say};
use answers::{GoalChoice, HandGiven, ObjectChoice};
use clap::Args;
use regrasp::api::Vec3;
use regrasp::run::scenario::{SCENARIOS, load_hand};
use regrasp::world::{ChainHand, ObjectPlace, object_places};
use std::io::{self, BufRead, IsTerminal, Write};
use std::path::{Path, PathBuf};

/// Write a scenario of your own: asks for hand, object and goal, and comments what it writes.
///
/// What is not given as an option is asked for, and read from standard input line by line; an empty line, or
/// no more lines, takes what stands in brackets.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  regrasp new mine.toml\n  \
    regrasp new mine.toml --hand allegro-like --object 'cuboid 0.05 0.05 0.05' --goal 'turn z 45'\n  \
    regrasp new mine.toml --hand my-hand.urdf --object part.stl --goal 'move 0 0 0.01'")]
pub struct NewArgs {
    /// The file to write, in TOML.
    pub output: PathBuf,
    /// A built-in hand, a hand file (`.toml`), a URDF (`.urdf`) or an MJCF (`.xml`).
    #[arg(long, value_name = "NAME|FILE")]
    pub hand: Option<String>,
    /// `sphere RADIUS`, `ellipsoid A B C` (semi-axes), `cuboid X Y Z` (edges), `cylinder RADIUS HEIGHT`,
    /// `capsule RADIUS HEIGHT`, `torus RING TUBE` (radii), all in m, or a mesh file.
    #[arg(long, value_name = "SHAPE|FILE")]
    pub object: Option<String>,
    /// `turn AXIS DEGREES` (`x`, `y` or `z`) or `move X Y Z` (m), from the start, in the hand's frame.
    #[arg(long, value_name = "GOAL")]
    pub goal: Option<String>,
    #[command(flatten)]
    pub overwrite: OverwriteArgs,
}

pub fn run(args: &NewArgs) -> Result<(), Failure> {
    outputs::check(&[], &[(&args.output, Kind::Scenario)], args.overwrite)?;
    let folder = args.output.parent().unwrap_or(Path::new(""));
    let mut lines = io::stdin().lock();
    let mut ask = |option: &Option<String>, question: &str, usual: &str| -> Result<String, Failure> {
        option.clone().map_or_else(|| answer(&mut lines, question, usual), Ok)
    };
    let hand = HandGiven::read(&ask(&args.hand, "hand: a built-in one, or a file", "four-finger")?)?;
    let object = ask(&args.object, "object: a shape with its sizes in m, or a mesh file", "sphere 0.03")?;
    let object = ObjectChoice::read(&object)?;
    let goal = GoalChoice::read(&ask(&args.goal, "goal: `turn AXIS DEGREES` or `move X Y Z`", "turn z 45")?)?;
    let loaded = load_hand(&format!("[hand]\n{}\n", hand.line()), folder).map_err(Failure::refused)?;
    let places = starts(&hand, &loaded.hand, object.size())?;
    let fingers = loaded.description.finger.len();
    let text = |place: Vec3| text::scenario(&hand, &object, &goal, place.into(), fingers);
    let name = args.output.display().to_string();
    let registry = registry(&LibraryArgs { load: Vec::new() })?;
    let planned = place::that_plans((&name, folder), &registry, &places, text)?;
    let is_planned = planned.is_some();
    let text = planned.unwrap_or_else(|| text(places[0].p_HO));
    if outputs::is_standard(&args.output) {
        return say(&text);
    }
    regrasp::plan::write_file(&args.output, |out| out.write_all(text.as_bytes()))
        .map_err(Failure::refused)?;
    if !is_planned {
        let note = "note: no plan was found for it within a few seconds; a smaller goal or another place of \
                    the object (`start.pose`) may do better\n";
        let _ = io::stderr().write_all(note.as_bytes());
    }
    say(&format!("written to {name}\n  next  regrasp plan {name} -o plan.json\n"))
}

/// Asks on a terminal; reads the answer in any case.
fn answer(lines: &mut impl BufRead, question: &str, usual: &str) -> Result<String, Failure> {
    if io::stdin().is_terminal() {
        let _ = write!(io::stderr(), "{question} [{usual}] ");
        let _ = io::stderr().flush();
    }
    let mut line = String::new();
    lines.read_line(&mut line).map_err(|error| Failure::bad_input(format!("standard input: {error}")))?;
    Ok(if line.trim().is_empty() { usual.to_owned() } else { line.trim().to_owned() })
}

/// Where the object starts: where built-in scenarios of this hand have it, or where its fingertips surround
/// a ball of this radius, the best place first.
fn starts(given: &HandGiven, hand: &ChainHand, size: f64) -> Result<Vec<ObjectPlace>, Failure> {
    let uses = |name: &str| {
        let mut files = SCENARIOS.iter().filter_map(|file| file.read().ok());
        files.find(|file| file.hand.builtin.as_deref() == Some(name))
    };
    let known = match given {
        HandGiven::BuiltIn(name) => uses(name).map(|file| file.start.pose.position),
        HandGiven::File { .. } => None,
    };
    let places = match known {
        Some(position) => vec![ObjectPlace { p_HO: position.into(), quality: 1.0 }],
        None => object_places(hand, size),
    };
    match places.is_empty() {
        false => Ok(places),
        true => Err(Failure::bad_input(format!(
            "no place was found at which all fingertips reach a ball of {:.0} mm; choose another object",
            2e3 * size
        ))),
    }
}
