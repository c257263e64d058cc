//! A run of a study in a process of its own.

use super::CompareArgs;
use crate::memory::Counted;
use crate::watch::Watch;
use crate::{Failure, say};
use regrasp::api::Interrupt;
use regrasp::study::compare::{self, Isolate, Isolated, Means, Prepared, RunKey};
use std::process::{Command, ExitStatus, Stdio};

/// Starts this program again for one run, with the words that it was started with.
pub struct Processes<'a> {
    interrupt: &'a dyn Interrupt,
}

impl<'a> Processes<'a> {
    /// Processes whose runs are dropped once `interrupt` says so; Ctrl-C reaches them as it does this one.
    pub fn new(interrupt: &'a dyn Interrupt) -> Self {
        Self { interrupt }
    }

    fn start(&self, key: RunKey) -> std::io::Result<std::process::Output> {
        let only = format!("{}/{}/{}", key.scenario, key.variant, key.seed);
        let mut command = Command::new(std::env::current_exe()?);
        command.args(std::env::args_os().skip(1)).args(["--only", &only]);
        command.stdin(Stdio::null()).stderr(Stdio::piped()).output()
    }
}

impl Isolate for Processes<'_> {
    fn run(&self, key: RunKey) -> Isolated {
        let output = match self.start(key) {
            Ok(output) => output,
            Err(error) => return Isolated::Died(format!("no process could be started: {error}")),
        };
        if self.interrupt.interrupted() {
            return Isolated::Interrupted;
        }
        // A plugin may print: the run is the last line.
        let line = output.stdout.split(|byte| *byte == b'\n').rfind(|line| !line.is_empty());
        match line.and_then(|line| serde_json::from_slice(line).ok()) {
            Some(made) if output.status.success() => Isolated::Made(made),
            _ => Isolated::Died(how(output.status, &output.stderr)),
        }
    }
}

/// How a process ended, and the last that it said.
fn how(status: ExitStatus, said: &[u8]) -> String {
    let said = String::from_utf8_lossy(said);
    match said.lines().rfind(|line| !line.trim().is_empty()) {
        Some(last) => format!("{status}; it last said: {}", last.trim()),
        None => status.to_string(),
    }
}

/// Makes one run of the study and prints it.
pub fn make_one(args: &CompareArgs, prepared: &Prepared<'_>, key: RunKey) -> Result<(), Failure> {
    super::hush_runs();
    let watch = Watch::start(None);
    let means = Means { clock: &watch, memory: Some(&Counted), interrupt: &watch, audit: args.audit };
    let made = compare::make_run(prepared, key, means);
    let made =
        made.ok_or_else(|| Failure::interrupted("the run was interrupted, or is none of the study".into()))?;
    let line = serde_json::to_string(&made).map_err(Failure::bad_input)?;
    say(&format!("{line}\n"))
}
