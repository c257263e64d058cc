//! The command line's form.

use crate::numbers::{extent, objective, seconds, whole};
use crate::outputs::OverwriteArgs;
use crate::terminal::{When, when};
use clap::{Args, Parser, Subcommand};
use regrasp::api::Level;
use regrasp::run::{Extent, Objective};
use std::path::PathBuf;

/// Plans how a multi-fingered hand moves an object from a start to goals, by rolling it and by regrasping,
/// and verifies the plan.
#[derive(Debug, Parser)]
#[command(
    name = "regrasp",
    version,
    after_help = "Exit codes: 0 done; 2 bad input; 3 no plan within the budget; 4 a plan that does not \
        verify, or a replay that does not arrive; 130 interrupted.\n\n\
                  Example:\n  regrasp plan sphere -o plan.json && regrasp verify plan.json"
)]
pub struct Arguments {
    /// Colour the report: on a terminal (`auto`, which heeds `NO_COLOR`, `CLICOLOR` and `CLICOLOR_FORCE`),
    /// `always`, or `never`.
    #[arg(long, global = true, value_name = "WHEN", default_value = "auto", value_parser = when)]
    pub color: When,
    #[command(subcommand)]
    pub command: Command,
}

#[derive(Debug, Subcommand)]
pub enum Command {
    Plan(PlanArgs),
    Verify(VerifyArgs),
    Compare(crate::compare::CompareArgs),
    View(crate::view::ViewArgs),
    Serve(crate::serve::ServeArgs),
    Export(crate::export::ExportArgs),
    Grasps(crate::grasps::GraspsArgs),
    Roadmap(crate::roadmap::RoadmapArgs),
    Atlas(crate::atlas::AtlasArgs),
    Suite(crate::suite::SuiteArgs),
    Gallery(crate::gallery::GalleryArgs),
    Replay(crate::replay::ReplayArgs),
    Hand(crate::hand::HandArgs),
    Object(crate::object::ObjectArgs),
    Plugins(PluginsArgs),
    Scenarios(ScenariosArgs),
    New(crate::new::NewArgs),
    Schema(SchemaArgs),
    NewPlugin(NewPluginArgs),
    Doctor(crate::doctor::DoctorArgs),
    Completions(crate::completions::CompletionsArgs),
    Man(crate::man::ManArgs),
    Reference(crate::reference::ReferenceArgs),
}

/// A level of messages.
fn level(text: &str) -> Result<Level, String> {
    let level = Level::ALL.into_iter().find(|level| level.name() == text);
    level.ok_or_else(|| "it must be `warning`, `info` or `debug`".into())
}

impl Command {
    /// Whether standard output is to be one JSON object.
    pub fn is_json(&self) -> bool {
        match self {
            Self::Plan(args) => args.json,
            Self::Verify(args) => args.json,
            Self::Compare(args) => args.json,
            Self::Grasps(args) => args.work.json,
            Self::Roadmap(args) => args.json,
            Self::Atlas(args) => args.work.json,
            Self::Suite(args) => args.work.json,
            Self::Replay(args) => args.json,
            Self::Hand(args) => args.json,
            Self::Plugins(args) => args.json,
            Self::Scenarios(args) => args.json,
            Self::Doctor(args) => args.json,
            _ => false,
        }
    }
}

/// Plan a scenario, verify the plan, and write it to a file.
#[derive(Debug, Args)]
#[command(after_help = "\
`regrasp scenarios` lists the built-in scenarios, `regrasp plugins` the slots, their plugins and \
settings.\n\n\
Ctrl-C and the time limit end the search and keep what was found: with `-o plan.json`, a motion that \
reaches some of the goals and \
verifies goes to `plan.partial.json`. A plan that does not verify is never written under the wished name \
but to `plan.rejected.json`.\n\n\
Examples:\n  regrasp plan sphere\n  regrasp plan my-problem.toml --seed 7 -o plan.json\n  \
regrasp plan cubic --use stability-test=socp --set graph-strategy.end=0.8 --rejections\n  \
regrasp plan cubic --improve 20x -o plan.json\n  \
regrasp plan cubic --roadmap cube.roadmap --goals goals.toml -o plans")]
pub struct PlanArgs {
    /// A scenario file in TOML or JSON, the name of a built-in scenario, or `-` for standard input.
    pub scenario: String,
    /// Seed of all random choices: the same seed gives the same plan, on any number of threads.
    #[arg(long, default_value_t = 0, value_name = "N", allow_negative_numbers = true,
          value_parser = whole::<u64, 0, { u64::MAX }>)]
    pub seed: u64,
    #[command(flatten)]
    pub choices: ChoiceArgs,
    /// Stop after this many seconds; by default when the scenario says, or never.
    #[arg(long, value_name = "S", allow_negative_numbers = true, value_parser = seconds)]
    pub time_limit: Option<f64>,
    /// Generate at most this many nodes for each goal; by default as many as the scenario says.
    #[arg(long, value_name = "N", allow_negative_numbers = true,
          value_parser = whole::<u64, 1, 10_000_000>)]
    pub max_nodes: Option<u64>,
    /// Compute with this many threads, 1 to 256; the plan is the same.
    #[arg(long, default_value_t = 1, value_name = "N", allow_negative_numbers = true,
          value_parser = whole::<u16, 1, 256>)]
    pub threads: u16,
    /// Go on after the first plan, with other seeds, and keep the best plan: for this many seconds, or with
    /// an `x` for this many searches (`20x`), which gives the same plan whatever the machine.
    #[arg(long, value_name = "S|Nx", allow_negative_numbers = true, value_parser = extent)]
    #[arg(conflicts_with_all = ["audit", "audit_save"])]
    pub improve: Option<Extent>,
    /// What `--improve` makes less: `regrasps` (the default), `duration`, `holds` (the friction that the
    /// grasps need), or `travel` of the joints; of two plans that are alike in it the shorter motion is
    /// better.
    #[arg(long, value_name = "WHAT", requires = "improve", value_parser = objective)]
    pub optimise: Option<Objective>,
    /// Plan through this roadmap, which `regrasp roadmap` grew for the same hand, object and settings; where
    /// it knows no way, plan as without it, and say so.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["audit", "audit_save", "improve"])]
    pub roadmap: Option<PathBuf>,
    /// Add the grasps of plans that were found without the roadmap to its file.
    #[arg(long, requires = "roadmap")]
    pub roadmap_add: bool,
    /// Plan to each goal of this list instead of the scenario's, each from the scenario's start: a TOML file
    /// of `[[goal]]` tables as scenarios have them. What becomes of each is a line, with `--json` an object;
    /// a wrong row is told with its number, and the rest is done. With `-o` the plans go to that folder.
    #[arg(long, value_name = "FILE")]
    #[arg(conflicts_with_all = ["audit", "audit_save", "improve", "grasps", "view", "view_graph"])]
    pub goals: Option<PathBuf>,
    /// Write the plan to this file; `-` is standard output, and the report then goes to standard error.
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    #[command(flatten)]
    pub overwrite: OverwriteArgs,
    /// Keep the stable grasps of the manipulation graph in this file, `.json` or `.npz`.
    #[arg(long, value_name = "FILE")]
    pub grasps: Option<PathBuf>,
    /// Write a page that plays the plan, beside the plan file or to a temporary place, and open it in the
    /// browser.
    #[arg(long)]
    pub view: bool,
    /// The same with the manipulation graph: what was tried, failed, found and used; also where there is no
    /// plan.
    #[arg(long)]
    pub view_graph: bool,
    /// Hold the calls of plugins against the laws of their roles; the first breach ends the run and names
    /// plugin, law and call. The run takes one and a half to three times as long. A program built for
    /// debugging looks at a share of the calls unasked.
    #[arg(long)]
    pub audit: bool,
    /// Audit, and write what broke a law to this file: the call with its input, and the whole problem.
    #[arg(long, value_name = "FILE")]
    pub audit_save: Option<PathBuf>,
    /// Print on standard error what plugins say, up to this level: `warning`, `info` or `debug`.
    #[arg(long, value_name = "LEVEL", default_value = "warning", value_parser = level)]
    pub log: Level,
    /// Print one JSON object instead of text.
    #[arg(long)]
    pub json: bool,
    /// Print how often each plugin said no, by cause.
    #[arg(short = 'v', long)]
    pub rejections: bool,
}

/// Which plugins fill the slots, with which settings.
#[derive(Debug, Args)]
pub struct ChoiceArgs {
    /// Choose plugins and settings that belong together, `paper` or `default`; `--use` and `--set` change
    /// them further.
    #[arg(long, value_name = "NAME")]
    pub preset: Option<String>,
    /// Fill a slot with another plugin; can be repeated.
    #[arg(long = "use", value_name = "SLOT=ID")]
    pub uses: Vec<String>,
    /// Change a setting of the plugin in a slot; the value is TOML, and nothing behind the `=` unsets an
    /// option; can be repeated.
    #[arg(long = "set", value_name = "SLOT.KEY=VALUE")]
    pub sets: Vec<String>,
    #[command(flatten)]
    pub libraries: LibraryArgs,
}

/// Libraries of plugins to load.
#[derive(Debug, Args)]
pub struct LibraryArgs {
    /// Load the plugins of this library, which `regrasp new-plugin` shows how to build; can be repeated.
    #[arg(long, value_name = "LIBRARY")]
    pub load: Vec<PathBuf>,
}

/// Check a plan file with the independent verifier.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  regrasp verify plan.json\n  regrasp verify plan.json --threads 1")]
pub struct VerifyArgs {
    /// A plan file.
    pub plan: PathBuf,
    /// Look with this many threads, 1 to 256; the verdict is the same. By default as many as there are cores.
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = whole::<u16, 1, 256>)]
    pub threads: Option<u16>,
    /// Print one JSON object instead of text.
    #[arg(long)]
    pub json: bool,
}

/// List the plugins, or show one with its settings.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  regrasp plugins\n  regrasp plugins sampler\n  regrasp plugins \
        stability-test/force-closure")]
pub struct PluginsArgs {
    /// A role, to list its plugins; or a plugin's id, to show its settings.
    #[arg(value_name = "ROLE|ID")]
    pub what: Option<String>,
    #[command(flatten)]
    pub libraries: LibraryArgs,
    /// Print a JSON list instead of text.
    #[arg(long)]
    pub json: bool,
}

/// List the built-in scenarios, or print the file of one, as a start for your own.
#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  regrasp scenarios\n  regrasp scenarios sphere > my-problem.toml\n  regrasp \
        scenarios four-finger > my-hand.toml"
)]
pub struct ScenariosArgs {
    /// A built-in scenario or hand, to print its file.
    pub name: Option<String>,
    /// Print a JSON list instead of text.
    #[arg(long, conflicts_with = "name")]
    pub json: bool,
}

/// Write a crate, or a Python package, with a plugin of your own: a working one to start from, and its test.
#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  regrasp new-plugin sampler mine && cd mine-sampler && cargo test\n  regrasp \
        new-plugin --python sampler mine && cd mine-sampler && python -m pytest"
)]
pub struct NewPluginArgs {
    /// The plugin's role: contact-model, stability-test, surface, sampler, local-planner or graph-strategy.
    pub role: String,
    /// The plugin's name, in kebab case; its id is ROLE/NAME.
    pub name: String,
    /// Write a package in Python in place of a crate; it needs Python's `regrasp`, and no checkout.
    #[arg(long, conflicts_with = "framework")]
    pub python: bool,
    /// A checkout of the framework to build against; by default the one that this program was built from.
    #[arg(long, value_name = "PATH")]
    pub framework: Option<PathBuf>,
    /// Write to this folder; by default NAME-ROLE.
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
}

/// Print the JSON schema of scenario files, hand files or study files.
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  regrasp schema > scenario.schema.json")]
pub struct SchemaArgs {
    /// Which kind of file.
    #[arg(value_enum, default_value_t = Kind::Scenario)]
    pub kind: Kind,
}

/// The kinds of files that have a schema.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Kind {
    /// Scenario files.
    Scenario,
    /// Hand files.
    Hand,
    /// Study files.
    Study,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_form_is_consistent() {
        use clap::CommandFactory;
        Arguments::command().debug_assert();
    }
}
