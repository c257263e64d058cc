//! `regrasp completions`

use crate::args::Arguments;
use crate::{Failure, say};
use clap::{Args, Command, CommandFactory};
use clap_complete::Shell;

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
    clap_complete::generate(args.shell, &mut shown(&Arguments::command()), "regrasp", &mut script);
    say(&String::from_utf8_lossy(&script))
}

/// The program without its hidden commands: clap's scripts would offer them too.
fn shown(program: &Command) -> Command {
    let commands = program.get_subcommands().filter(|command| !command.is_hide_set());
    Command::new("regrasp").version(env!("CARGO_PKG_VERSION")).subcommands(commands.cloned())
}
