//! What `regrasp suite` takes.

use crate::work::WorkArgs;
use std::path::PathBuf;

/// Run the problems of a published paper, and set the results beside the published ones.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Without a protocol the built-in ones are listed. Each says what is like for like and what is chosen here; a \
row has the published figure, where that method works (a real hand, a simulation, a model), what is planned \
and verified in our model, and what arrives when the plans are replayed in rapier. Where a trial is a chain \
of goals, each is planned from where the one before has ended. The problems are always the same; times are \
of this machine, and with more threads than idle cores they grow.\n\n\
A folder with a file `protocol.toml` is a protocol, too. The folder of the output gets `summary.md` and \
`results.json`, with `--keep-plans` also `plans/`. After a crash, Ctrl-C or `--time-limit` the same \
command goes on from where it was.\n\n\
Examples:\n  regrasp suite\n  regrasp suite sahbani-2007 -o sahbani\n  \
regrasp suite drop --threads 2 --keep-plans -o drop\n  regrasp suite paper --no-replay -o paper")]
pub struct SuiteArgs {
    /// A built-in protocol (`paper` is `sahbani-2007`), or a folder with a file `protocol.toml`.
    pub protocol: Option<String>,
    /// Write the results to this folder.
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// Do not replay the plans.
    #[arg(long)]
    pub no_replay: bool,
    /// Keep all plans, for `regrasp view`, and for the replay in MuJoCo by
    /// `tests/outside/mujoco_replay.py`.
    #[arg(long)]
    pub keep_plans: bool,
    #[command(flatten)]
    pub work: WorkArgs,
}
