//! What `regrasp roadmap` takes.

use crate::args::ChoiceArgs;
use crate::numbers::{seconds, whole};
use crate::outputs::OverwriteArgs;
use std::path::PathBuf;

/// Nodes where neither nodes nor seconds are given.
const NODES: usize = 2000;

/// Grow a manipulation graph that is kept, for many plans with one hand and object.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
The graph does not depend on start and goal: its nodes are grasps at poses drawn evenly over all \
orientations and over the scenario's `workspace` (where it has none, a box 15 mm about its start and \
goals); its edges are those alone for which transfers and regrasps were found. `regrasp plan --roadmap \
FILE` plans through it.\n\n\
Where the file is there already it grows on. It is written anew every ten seconds: after Ctrl-C or a \
crash the same command goes on from there. The same seed gives the same roadmap on any number of threads, \
in however many pieces it was grown, and fewer nodes are the first of more. With `--force` it begins \
anew.\n\n\
Examples:\n  regrasp roadmap sphere --nodes 1000 -o sphere.roadmap\n  \
regrasp roadmap cubic --seconds 60 --threads 2 --report 100 -o cube.roadmap\n  \
regrasp plan sphere --roadmap sphere.roadmap -o plan.json")]
pub struct RoadmapArgs {
    /// A scenario file, or the name of a built-in scenario.
    pub scenario: String,
    /// Write the roadmap to this file, or grow the one that is in it.
    #[arg(short, long, value_name = "FILE")]
    pub output: PathBuf,
    /// Grow it to this many nodes; 2000 where no seconds are given.
    #[arg(long, value_name = "N", allow_negative_numbers = true,
          value_parser = whole::<usize, 1, 100_000_000>)]
    pub nodes: Option<usize>,
    /// Grow it for this many seconds.
    #[arg(long, value_name = "S", allow_negative_numbers = true, value_parser = seconds)]
    pub seconds: Option<f64>,
    /// Then plan between this many random starts and goals, 100 without a number, and tell how many the
    /// roadmap solves, and how many it solved with fewer nodes.
    #[arg(long, value_name = "N", num_args = 0..=1, default_missing_value = "100",
          allow_negative_numbers = true, value_parser = whole::<usize, 1, 1_000_000>)]
    pub report: Option<usize>,
    /// Seed of all random choices.
    #[arg(long, default_value_t = 0, value_name = "N", allow_negative_numbers = true,
          value_parser = whole::<u64, 0, { u64::MAX }>)]
    pub seed: u64,
    #[command(flatten)]
    pub choices: ChoiceArgs,
    /// Compute with this many threads, 1 to 256; the roadmap is the same.
    #[arg(long, default_value_t = 1, value_name = "N", allow_negative_numbers = true,
          value_parser = whole::<u16, 1, 256>)]
    pub threads: u16,
    #[command(flatten)]
    pub overwrite: OverwriteArgs,
    /// Print one JSON object instead of text.
    #[arg(long)]
    pub json: bool,
}

impl RoadmapArgs {
    /// How many nodes it is to have.
    pub fn nodes(&self) -> usize {
        let otherwise = if self.seconds.is_some() { usize::MAX } else { NODES };
        self.nodes.unwrap_or(otherwise)
    }
}
