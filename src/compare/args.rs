//! The form of `regrasp compare`.

use crate::args::LibraryArgs;
use crate::numbers::{seconds, whole};
use clap::Args;
use regrasp::study::compare::{MOST_SEEDS, MeasureName, Pairs, RunKey, Shard, Suite};
use std::path::PathBuf;

/// Compare combinations of plugins: every scenario, planned by every variant with every seed, every plan
/// verified.
#[derive(Debug, Args)]
#[command(after_help = "\
`regrasp scenarios` lists the built-in scenarios, `regrasp plugins` the slots, their plugins and \
settings.\n\n\
Each `--vary` names plugins of one slot, or values of one setting; all combinations are compared, and the \
one of the first names is the \
baseline. Runs are made in parallel, each on one thread. Ctrl-C, or even a kill, keeps what is finished: \
the same command goes on from there \
and makes no run again. A run that fails, panics or takes too long is a row of the study, not its end; so \
is one that ends its process, the \
next time the same command is given, or at once with `--isolate`.\n\n\
DIR gets `runs.csv` (a row a run), `summary.csv` and `summary.md` (figures over the seeds and what may be \
said of them), `comparisons.csv` (a row a hypothesis, with its verdict), `search.md` (what the searches \
did: nodes, components, paths, tests), `report.html`, \
`ompl/` (logs for OMPL's tools and Planner Arena), `study.json` (all that is needed to repeat it), \
`runs.jsonl` (the runs in full) and \
`plans/` (for each scenario the baseline's plan with the first seed).\n\n\
Examples:\n  regrasp compare sphere cubic --vary stability-test=force-closure,socp --seeds 20 -o study\n  \
regrasp compare --suite paper --vary graph-strategy.end=0.3,0.5,0.8 --vary sampler=rlg,projection -o \
alpha\n  \
regrasp compare --suite paper --seeds 100 -o table1      # prints the paper's Table 1 beside ours\n  \
regrasp compare --suite strict --vary preset=paper,default -o strict    # and in the paper's own meanings\n  \
regrasp compare --study mine.toml -o study               # `regrasp schema study` says what may be in it\n  \
regrasp compare --suite all --shard 2/8 -o part2         # the second of eight parts\n  \
regrasp compare --merge part1 part2 part3 -o study")]
pub struct CompareArgs {
    /// Scenario files, or names of built-in scenarios.
    pub scenarios: Vec<String>,
    /// Add the paper's three problems (`paper`), these with five pairs of given grasps each (`strict`),
    /// harder ones after them (`harder`), or every built-in scenario (`all`).
    #[arg(long, value_name = "paper|strict|harder|all", value_parser = suite)]
    pub suite: Option<Suite>,
    /// Take scenarios and variants from a study file.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["scenarios", "suite", "vary"])]
    pub study: Option<PathBuf>,
    /// Compare these plugins in a slot, `ID` or `ID{KEY=VALUE,…}`, these values of a setting, or presets; can
    /// be repeated.
    #[arg(long, value_name = "SLOT[.KEY]=A,B…")]
    pub vary: Vec<String>,
    /// Plan each problem with this many seeds [default: 20].
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = whole::<u64, 1, MOST_SEEDS>)]
    pub seeds: Option<u64>,
    /// The first of the seeds [default: 0].
    #[arg(long, value_name = "N", allow_negative_numbers = true,
          value_parser = whole::<u64, 0, { u64::MAX - MOST_SEEDS }>)]
    pub first_seed: Option<u64>,
    /// Choose plugins and settings of all variants that belong together, `paper` or `default`; `--use`,
    /// `--set` and `--vary` change them.
    #[arg(long, value_name = "NAME")]
    pub preset: Option<String>,
    /// Compare each variant with the first (`baseline`), or each with each (`all`); [default: baseline]. All
    /// hypotheses of a study are corrected together, so that more of them show less.
    #[arg(long, value_name = "baseline|all", value_parser = pairs)]
    pub pairs: Option<Pairs>,
    /// Compare in these measures alone, such as `solved,planning`; by default in all that the runs have.
    #[arg(long, value_name = "NAME,…", value_delimiter = ',', value_parser = measure)]
    pub measures: Vec<MeasureName>,
    /// Take differences within this share of the first variant's median for practically none (%), 0 to 100
    /// [default: 10].
    #[arg(long, value_name = "%", allow_negative_numbers = true, value_parser = percent)]
    pub equivalence: Option<f64>,
    /// Fill a slot of all variants with another plugin; can be repeated.
    #[arg(long = "use", value_name = "SLOT=ID")]
    pub uses: Vec<String>,
    /// Change a setting of the plugin in a slot of all variants; can be repeated.
    #[arg(long = "set", value_name = "SLOT.KEY=VALUE")]
    pub sets: Vec<String>,
    #[command(flatten)]
    pub libraries: LibraryArgs,
    /// Stop each run after this many seconds; by default when its scenario says, or never.
    #[arg(long, value_name = "S", allow_negative_numbers = true, value_parser = seconds)]
    pub time_limit: Option<f64>,
    /// Generate at most this many nodes for each goal; by default as many as the scenario says.
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = whole::<u64, 1, 10_000_000>)]
    pub max_nodes: Option<u64>,
    /// Make this many runs at once, 1 to 1024, each on one thread [default: one for each core].
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = whole::<u16, 1, 1024>)]
    pub threads: Option<u16>,
    /// Make every run in a process of its own, so that one that ends its process is a row like any other.
    #[arg(long)]
    pub isolate: bool,
    /// Hold every call of a plugin against the laws of its role; a run in which one is broken is a failed
    /// row. Runs take several times as long, so their times say nothing.
    #[arg(long)]
    pub audit: bool,
    /// Keep the plan of every run: `plans/SCENARIO.json` the baseline's with the first seed, as always, and
    /// `plans/SCENARIO/VARIANT-SEED.json` all others, variants counted from 0.
    #[arg(long)]
    pub keep_plans: bool,
    /// Make this run alone and print it: what `--isolate` starts.
    #[arg(long, hide = true, value_name = "SCENARIO/VARIANT/SEED", value_parser = only)]
    pub only: Option<RunKey>,
    /// Leave out scenarios that a variant's plugins do not support, instead of refusing the study.
    #[arg(long)]
    pub skip_unsupported: bool,
    /// Show the growing report as a page on the loopback address of this machine, whose address is printed to
    /// standard error; it ends with the study.
    #[arg(long)]
    pub watch: bool,
    /// Make only the I-th of N parts of the study.
    #[arg(long, value_name = "I/N", value_parser = shard)]
    pub shard: Option<Shard>,
    /// Join the parts in these folders.
    #[arg(long, value_name = "DIR", num_args = 1.., conflicts_with_all = [
        "scenarios", "suite", "study", "vary", "seeds", "first_seed", "preset", "uses", "sets", "load",
        "time_limit", "max_nodes", "threads", "skip_unsupported", "shard",
    ])]
    pub merge: Vec<PathBuf>,
    /// Set the finished study in the output folder beside this older one: another commit, another machine. No
    /// run is made; the folder gets `against.csv` and `against.md`.
    #[arg(long, value_name = "DIR", conflicts_with_all = [
        "scenarios", "suite", "study", "vary", "seeds", "first_seed", "preset", "uses", "sets", "load",
        "time_limit", "max_nodes", "threads", "skip_unsupported", "shard", "merge", "pairs", "watch",
    ])]
    pub against: Option<PathBuf>,
    /// The folder of the study. If the same command began it before, the command continues it.
    #[arg(short, long, value_name = "DIR")]
    pub output: PathBuf,
    /// Print one JSON object instead of text.
    #[arg(long)]
    pub json: bool,
}

impl CompareArgs {
    /// The command, word by word, without what changes nothing in the results.
    pub fn command(&self) -> Vec<String> {
        let mut words = ["regrasp", "compare"].map(str::to_owned).to_vec();
        words.extend(self.scenarios.iter().cloned());
        let mut option = |name: &str, value: Option<String>| {
            words.extend(value.into_iter().flat_map(|value| [format!("--{name}"), value]));
        };
        option("suite", self.suite.map(|suite| suite.name().to_owned()));
        option("study", self.study.as_ref().map(|path| path.display().to_string()));
        self.vary.iter().for_each(|text| option("vary", Some(text.clone())));
        option("seeds", self.seeds.map(|seeds| seeds.to_string()));
        option("first-seed", self.first_seed.map(|seed| seed.to_string()));
        option("preset", self.preset.clone());
        self.uses.iter().for_each(|text| option("use", Some(text.clone())));
        self.sets.iter().for_each(|text| option("set", Some(text.clone())));
        self.libraries.load.iter().for_each(|path| option("load", Some(path.display().to_string())));
        option("time-limit", self.time_limit.map(|limit| limit.to_string()));
        option("max-nodes", self.max_nodes.map(|nodes| nodes.to_string()));
        option("pairs", self.pairs.map(|pairs| pairs.name().to_owned()));
        let measures: Vec<&str> = self.measures.iter().map(|measure| measure.name()).collect();
        option("measures", (!measures.is_empty()).then(|| measures.join(",")));
        option("equivalence", self.equivalence.map(|percent| percent.to_string()));
        words.extend(self.audit.then(|| "--audit".to_owned()));
        words.extend(self.skip_unsupported.then(|| "--skip-unsupported".to_owned()));
        words
    }
}

fn suite(text: &str) -> Result<Suite, String> {
    let named = |suite: &Suite| suite.name() == text;
    Suite::ALL
        .into_iter()
        .find(named)
        .ok_or_else(|| "it must be `paper`, `strict`, `harder` or `all`".to_owned())
}

fn pairs(text: &str) -> Result<Pairs, String> {
    let named = |pairs: &Pairs| pairs.name() == text;
    Pairs::ALL.into_iter().find(named).ok_or_else(|| "it must be `baseline` or `all`".to_owned())
}

fn measure(text: &str) -> Result<MeasureName, String> {
    let names = MeasureName::ALL.map(MeasureName::name).join("`, `");
    let named = |measure: &MeasureName| measure.name() == text;
    MeasureName::ALL.into_iter().find(named).ok_or_else(|| format!("it must be among `{names}`"))
}

fn percent(text: &str) -> Result<f64, String> {
    let number = text.parse::<f64>().ok().filter(|percent| (0.0..=100.0).contains(percent));
    number.ok_or_else(|| "it must be a number in 0..=100, such as 10".to_owned())
}

fn only(text: &str) -> Result<RunKey, String> {
    let numbers: Option<Vec<u64>> = text.split('/').map(|part| part.parse().ok()).collect();
    match numbers.as_deref() {
        Some(&[scenario, variant, seed]) => {
            Ok(RunKey { scenario: scenario as usize, variant: variant as usize, seed })
        }
        _ => Err("it must be SCENARIO/VARIANT/SEED, three numbers".into()),
    }
}

fn shard(text: &str) -> Result<Shard, String> {
    let number = |text: &str| text.parse::<u64>().ok();
    let parts = text.split_once('/').and_then(|(part, of)| Some((number(part)?, number(of)?)));
    match parts {
        Some((part, of)) if (1..=of).contains(&part) && of <= MOST_SEEDS => Ok(Shard { part, of }),
        _ => Err(format!("it must be I/N with I in 1..=N and N in 1..={MOST_SEEDS}, such as 2/8")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_are_counted_from_one() {
        assert_eq!(shard("2/8"), Ok(Shard { part: 2, of: 8 }));
        for bad in ["0/8", "9/8", "8", "a/b", "1/0", "-1/3", "1/2/3"] {
            assert!(shard(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn suites_are_named() {
        assert_eq!(suite("paper"), Ok(Suite::Paper));
        assert!(suite("papers").is_err());
        assert_eq!(
            (pairs("all"), measure("collision-tests")),
            (Ok(Pairs::All), Ok(MeasureName::CollisionTests))
        );
        assert!(measure("speed").unwrap_err().contains("`planning`"));
        assert!(percent("-1").is_err() && percent("nan").is_err() && percent("5") == Ok(5.0));
    }
}
