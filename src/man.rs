//! `regrasp man`

use crate::args::Arguments;
use crate::{Failure, export, say};
use clap::{Args, Command, CommandFactory};
use clap_mangen::Man;
use std::path::PathBuf;

/// Print the program's manual page, or write it and a page for each command to a folder.
#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  regrasp man | man -l -\n  regrasp man -o ~/.local/share/man/man1 && man \
        regrasp-plan"
)]
pub struct ManArgs {
    /// Write all pages into this folder, which is made where there is none.
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
}

pub fn run(args: &ManArgs) -> Result<(), Failure> {
    let mut program = Arguments::command();
    program.build();
    let Some(folder) = &args.output else { return say(&page(program)?) };
    crate::outputs::check_folder(folder)?;
    export::make_folder(folder)?;
    let pages =
        program.get_subcommands().filter(|command| !command.is_hide_set() && command.get_name() != "help");
    let mut pages: Vec<(String, String)> = pages.map(subpage).collect::<Result<_, _>>()?;
    pages.insert(0, ("regrasp.1".into(), page(program)?));
    for (name, text) in pages {
        let path = folder.join(name);
        export::write(&path, text.as_bytes())?;
        say(&format!("{}\n", path.display()))?;
    }
    Ok(())
}

/// The name and text of a command's page.
fn subpage(command: &Command) -> Result<(String, String), Failure> {
    let name = format!("regrasp-{}", command.get_name());
    // In the synopsis a command is `regrasp plan`, its page is `regrasp-plan`.
    let command =
        command.clone().bin_name(format!("regrasp {}", command.get_name())).display_name(name.clone());
    Ok((format!("{name}.1"), page(command)?))
}

fn page(command: Command) -> Result<String, Failure> {
    let mut text = Vec::new();
    let man = Man::new(command).source(concat!("regrasp ", env!("CARGO_PKG_VERSION"))).manual("Regrasp");
    man.render(&mut text).map_err(Failure::bad_input)?;
    let text = String::from_utf8_lossy(&text).replace(".SH EXTRA\n", ".SH NOTES AND EXAMPLES\n");
    // A page without a date says so with an empty word, or else the version would be taken for it.
    Ok(text.replacen(" 1  \"", " 1 \"\" \"", 1))
}
