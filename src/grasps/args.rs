//! What `regrasp grasps` takes.

use crate::args::ChoiceArgs;
use crate::numbers::whole;
use crate::work::WorkArgs;
use std::path::PathBuf;

/// Find many distinct, verified grasps of a hand and an object.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
A scenario needs a hand and an object here; start and goals do not count. Poses of the object are drawn \
evenly \
over the places at which enough fingers may reach it (or over the scenario's `workspace`) and over all \
orientations; at each, contacts of the fingers are drawn and combined. Each grasp that is kept is stable by \
the \
scenario's stability test, free of collisions, and passed the independent verifier. Of two grasps that are \
nearer than the spread, the earlier one is kept.\n\n\
The file's name says what is written: `.npz` NumPy arrays, `.jsonl` one JSON object a line, `.xml` a MuJoCo \
model with a keyframe for each grasp, `.reset.npz` reset states as 32-bit arrays. The same seed gives the \
same \
grasps on any number of threads, and fewer grasps are the first of more.\n\n\
What was found is kept beside the output in a file that ends with `.part`: after Ctrl-C, a time limit or a \
crash the same command goes on from there, and with `--force` it begins anew.\n\n\
Examples:\n  regrasp grasps allegro-cube -n 10000 -o grasps.npz\n  \
regrasp grasps sphere -n 500 --graph -o grasps.npz\n  \
regrasp grasps my-hand.toml --objects parts/ -n 1000 -o grasps.npz")]
pub struct GraspsArgs {
    /// A scenario file, or the name of a built-in scenario.
    pub scenario: String,
    /// How many grasps.
    #[arg(short = 'n', long = "count", default_value_t = 1000, value_name = "N", allow_negative_numbers = true,
          value_parser = whole::<usize, 1, 1_000_000_000>)]
    pub count: usize,
    /// Write them to this file: `.npz`, `.jsonl`, `.xml` or `.reset.npz`.
    #[arg(short, long, value_name = "FILE")]
    pub output: PathBuf,
    /// Take the meshes in this folder for the object, one after the other; `grasps.npz` becomes
    /// `grasps.NAME.npz`.
    #[arg(long, value_name = "DIR")]
    pub objects: Option<PathBuf>,
    /// How far (m) two grasps are apart at least: in the object's position, in its orientation times its
    /// radius, or in a contact point; 0.000001 to 1.
    #[arg(long, default_value_t = 0.002, value_name = "M", allow_negative_numbers = true, value_parser = spread)]
    pub spread: f64,
    /// Keep at most this many grasps of one pose of the object, 1 to 1000.
    #[arg(long, default_value_t = 8, value_name = "N", allow_negative_numbers = true,
          value_parser = whole::<usize, 1, 1000>)]
    pub per_pose: usize,
    /// Keep at most this many grasps in which the same fingers touch the same facets; 1 without a number.
    #[arg(long, value_name = "N", num_args = 0..=1, default_missing_value = "1", allow_negative_numbers = true,
          value_parser = whole::<usize, 1, 1_000_000_000>)]
    pub per_facet: Option<usize>,
    /// How many fingers hold: a number, or a range such as 3..4; by default as the contact model allows.
    #[arg(long, value_name = "N|A..B", value_parser = range)]
    pub fingers: Option<(usize, usize)>,
    /// Find out which grasps of one pose a regrasp connects, by the regrasp planner.
    #[arg(long)]
    pub graph: bool,
    /// Seed of all random choices.
    #[arg(long, default_value_t = 0, value_name = "N", allow_negative_numbers = true,
          value_parser = whole::<u64, 0, { u64::MAX }>)]
    pub seed: u64,
    #[command(flatten)]
    pub choices: ChoiceArgs,
    #[command(flatten)]
    pub work: WorkArgs,
}

fn spread(text: &str) -> Result<f64, &'static str> {
    match text.trim().parse::<f64>() {
        Ok(spread) if (1e-6..=1.0).contains(&spread) => Ok(spread),
        _ => Err("it must be a length in metres in 0.000001..=1"),
    }
}

/// `4`, or `3..4`, both ends included.
fn range(text: &str) -> Result<(usize, usize), &'static str> {
    let (least, most) = text.split_once("..").unwrap_or((text, text));
    let most = most.strip_prefix('=').unwrap_or(most);
    match (least.trim().parse(), most.trim().parse()) {
        (Ok(least), Ok(most)) if 1 <= least && least <= most && most <= 8 => Ok((least, most)),
        _ => Err("it must be a number of fingers in 1..=8, or two with `..` between"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fingers_are_a_number_or_a_range() {
        assert_eq!(range("4"), Ok((4, 4)));
        assert_eq!(range("3..4"), Ok((3, 4)));
        for bad in ["", "0", "4..3", "9", "a..b", "3...4"] {
            assert!(range(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn spreads_are_lengths() {
        assert_eq!(spread("0.01"), Ok(0.01));
        for bad in ["0", "-1", "2", "nan", "wide"] {
            assert!(spread(bad).is_err(), "{bad}");
        }
    }
}
