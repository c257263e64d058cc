//! The command line.
//!
//! Exit codes: 0 done; 2 bad input; 3 no plan within the budget; 4 a plan that does not verify, or a replay
//! that does not arrive; 130 interrupted.

mod args;
mod atlas;
mod compare;
mod completions;
mod doctor;
mod export;
mod failure;
mod gallery;
mod goals;
mod grasps;
mod hand;
mod holds;
mod inputs;
mod man;
mod memory;
mod new;
mod new_plugin;
mod numbers;
mod object;
mod output;
mod outputs;
mod overrides;
mod place;
mod plan;
mod plugins;
mod progress;
mod property;
mod quantity;
mod reference;
mod replay;
mod report;
mod roadmap;
mod scenarios;
mod schema;
mod serve;
mod suite;
mod table;
mod terminal;
mod verify;
mod view;
mod watch;
mod watchdog;
mod work;

use args::{Arguments, Command};
use clap::Parser;
use failure::Failure;
use std::io::{self, Write};
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, Ordering};

// The library links the built-in plugins; a program that did not name it would have none.
use regrasp as _;

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    terminal::choose(arguments.color);
    output::keep();
    let done = match &arguments.command {
        Command::Plan(args) => plan::run(args),
        Command::Verify(args) => verify::run(args),
        Command::Compare(args) => compare::run(args),
        Command::View(args) => view::run(args),
        Command::Serve(args) => serve::run(args),
        Command::Export(args) => export::run(args),
        Command::Grasps(args) => grasps::run(args),
        Command::Roadmap(args) => roadmap::run(args),
        Command::Atlas(args) => atlas::run(args),
        Command::Suite(args) => suite::run(args),
        Command::Gallery(args) => gallery::run(args),
        Command::Replay(args) => replay::run(args),
        Command::Hand(args) => hand::run(args),
        Command::Object(args) => object::run(args),
        Command::Plugins(args) => plugins::run(args),
        Command::Scenarios(args) => scenarios::run(args),
        Command::Schema(args) => schema::run(args),
        Command::New(args) => new::run(args),
        Command::NewPlugin(args) => new_plugin::run(args),
        Command::Doctor(args) => doctor::run(args),
        Command::Completions(args) => completions::run(args),
        Command::Man(args) => man::run(args),
        Command::Reference(args) => reference::run(args),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            // One JSON object goes to standard output: the error where there was no answer.
            if arguments.command.is_json() && !ANSWERED.load(Ordering::Relaxed) {
                let _ = say_json(&failure.json());
            }
            failure.exit()
        }
    }
}

/// Whether something was written to standard output.
static ANSWERED: AtomicBool = AtomicBool::new(false);

/// Writes to standard output; a reader that has gone away, as in `regrasp plugins | head`, is no failure.
fn say(text: &str) -> Result<(), Failure> {
    write(&terminal::for_standard_output(text))
}

fn write(text: &str) -> Result<(), Failure> {
    ANSWERED.store(true, Ordering::Relaxed);
    let mut out = output::standard();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            Err(Failure::bad_input(format!("cannot write to standard output: {error}")))
        }
        _ => Ok(()),
    }
}

/// Writes a value as JSON to standard output.
fn say_json(value: &serde_json::Value) -> Result<(), Failure> {
    write(&terminal::printable(&format!("{value:#}\n")))
}
