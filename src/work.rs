//! How commands that work for long are asked to work.

use crate::numbers::{seconds, whole};
use crate::outputs::OverwriteArgs;

/// How long a command works, on how many threads, over which files, and how it says what it found.
#[derive(Clone, Copy, Debug, clap::Args)]
pub struct WorkArgs {
    /// Stop after this many seconds; what was found by then is kept.
    #[arg(long, value_name = "S", allow_negative_numbers = true, value_parser = seconds)]
    pub time_limit: Option<f64>,
    /// Compute with this many threads, 1 to 256; but for times, what is found is the same.
    #[arg(long, default_value_t = 1, value_name = "N", allow_negative_numbers = true,
          value_parser = whole::<u16, 1, 256>)]
    pub threads: u16,
    #[command(flatten)]
    pub overwrite: OverwriteArgs,
    /// Print one JSON object instead of text.
    #[arg(long)]
    pub json: bool,
}
