//! `regrasp completions`

use crate::args::Arguments;
use crate::{Failure, say};
use clap::builder::PossibleValuesParser;
use clap::{Args, Command, CommandFactory};
use clap_complete::Shell;
use regrasp::api::Role;
use regrasp::host::Registry;
use regrasp::run::scenario::{HANDS, SCENARIOS};

/// Print a script that completes commands, options and their values in a shell.
#[derive(Debug, Args)]
#[command(after_help = "\
Where the script goes depends on the shell; the examples write it where a new shell finds it.\n\n\
Examples:\n  regrasp completions bash > ~/.local/share/bash-completion/completions/regrasp\n  \
regrasp completions zsh > ~/.zfunc/_regrasp      # with `fpath+=~/.zfunc` before `compinit` in ~/.zshrc\n  \
regrasp completions fish > ~/.config/fish/completions/regrasp.fish")]
pub struct CompletionsArgs {
    /// The shell.
    #[arg(value_enum)]
    pub shell: Shell,
}

pub fn run(args: &CompletionsArgs) -> Result<(), Failure> {
    let mut script = Vec::new();
    let mut program = with_names(shown(&Arguments::command()), args.shell)?;
    clap_complete::generate(args.shell, &mut program, "regrasp", &mut script);
    say(&String::from_utf8_lossy(&script))
}

/// The program without its hidden commands: clap's scripts would offer them too.
fn shown(program: &Command) -> Command {
    let commands = program.get_subcommands().filter(|command| !command.is_hide_set());
    Command::new("regrasp").version(env!("CARGO_PKG_VERSION")).subcommands(commands.cloned())
}

/// The program with the names that its arguments can have. A scenario can be a file too: bash offers files
/// beside names, other shells would not.
fn with_names(program: Command, shell: Shell) -> Result<Command, Failure> {
    let registry = Registry::linked().map_err(Failure::refused)?;
    let roles = Role::ALL.map(Role::name).to_vec();
    let scenarios: Vec<&'static str> = SCENARIOS.iter().map(|file| file.name).collect();
    let plugins = roles.iter().copied().chain(registry.entries().map(|entry| entry.id)).collect();
    let printed = scenarios.iter().copied().chain(HANDS.iter().map(|file| file.name)).collect();
    let program = name(program, "new-plugin", "role", roles);
    let program = name(name(program, "plugins", "what", plugins), "scenarios", "name", printed);
    Ok(match shell {
        Shell::Bash => {
            name(name(program, "plan", "scenario", scenarios.clone()), "compare", "scenarios", scenarios)
        }
        _ => program,
    })
}

/// Tells of an argument of a command which names it can have.
fn name(
    program: Command,
    command: &'static str,
    argument: &'static str,
    names: Vec<&'static str>,
) -> Command {
    let parser = PossibleValuesParser::new(names);
    program.mut_subcommand(command, |command| {
        command.mut_arg(argument, |argument| argument.value_parser(parser))
    })
}
