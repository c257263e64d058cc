//! The page of commands, from their `--help`.

use super::GENERATED;
use super::markdown::{block, code, heading, prose, table};
use clap::{Arg, ArgAction, Command};

pub fn page(mut program: Command) -> String {
    program.build();
    let mut text = format!("{GENERATED}# Commands\n\n{}.\n\n", described(&program));
    text += "Every command has `--help`, which says the same as this page. What went wrong is said on \
        standard error; standard output has the \
             results alone. Every command takes `--color auto|always|never`: `auto` colours what goes to a \
             terminal, and heeds `NO_COLOR`, `CLICOLOR` and `CLICOLOR_FORCE`. [Exit codes](exit-codes.md) tell a \
             script how a command ended.\n\n";
    let shown =
        || program.get_subcommands().filter(|command| !command.is_hide_set() && command.get_name() != "help");
    let rows: Vec<Vec<String>> =
        shown().map(|one| vec![format!("[`{0}`](#{0})", one.get_name()), described(one)]).collect();
    text += &table(&["command", "what it does"], &rows);
    text + &shown().map(section).collect::<String>()
}

fn described(command: &Command) -> String {
    prose(command.get_about().map(ToString::to_string).unwrap_or_default().trim_end_matches('.'))
}

fn section(command: &Command) -> String {
    let mut text = heading(2, &code(&format!("regrasp {}", command.get_name())), command.get_name());
    text += &format!("{}.\n\n", described(command));
    let usage = command.clone().render_usage().to_string();
    text += &block("text", usage.trim_start_matches("Usage: "));
    let help = |arg: &&Arg| arg.get_id() != "help" && !arg.is_hide_set() && !arg.is_global_set();
    let arguments: Vec<Vec<String>> = command.get_positionals().filter(help).map(argument).collect();
    if !arguments.is_empty() {
        text += &table(&["argument", "meaning"], &arguments);
    }
    let options: Vec<Vec<String>> =
        command.get_opts().chain(flags(command)).filter(help).map(option).collect();
    if !options.is_empty() {
        text += &table(&["option", "default", "meaning"], &options);
    }
    text + &remarks(&command.get_after_help().map(ToString::to_string).unwrap_or_default())
}

/// Options that take no value.
fn flags(command: &Command) -> impl Iterator<Item = &Arg> {
    command.get_arguments().filter(|arg| !arg.is_positional() && !arg.get_action().takes_values())
}

fn argument(arg: &Arg) -> Vec<String> {
    let name = value_names(arg);
    let name = if matches!(arg.get_action(), ArgAction::Append) { format!("{name}...") } else { name };
    let name = if arg.is_required_set() { name } else { format!("[{name}]") };
    vec![code(&name), meaning(arg)]
}

fn option(arg: &Arg) -> Vec<String> {
    let short = arg.get_short().map(|letter| format!("-{letter}, ")).unwrap_or_default();
    let long = arg.get_long().map(|word| format!("--{word}")).unwrap_or_default();
    let value =
        if arg.get_action().takes_values() { format!(" <{}>", value_names(arg)) } else { String::new() };
    let defaults: Vec<String> =
        arg.get_default_values().iter().map(|value| value.to_string_lossy().into_owned()).collect();
    let shown = if arg.get_action().takes_values() { code(&defaults.join(" ")) } else { String::new() };
    vec![code(&format!("{short}{long}{value}")), shown, meaning(arg)]
}

fn value_names(arg: &Arg) -> String {
    let names = arg.get_value_names().unwrap_or_default();
    names.iter().map(ToString::to_string).collect::<Vec<_>>().join(" ")
}

fn meaning(arg: &Arg) -> String {
    let help = arg.get_help().map(ToString::to_string).unwrap_or_default();
    let values = arg.get_possible_values();
    let words: Vec<String> =
        values.iter().filter(|value| !value.is_hide_set()).map(|value| code(value.get_name())).collect();
    let words = match arg.get_action().takes_values() && !words.is_empty() {
        true => format!(" One of {}.", words.join(", ")),
        false => String::new(),
    };
    let end = if help.ends_with(['.', '?', ']']) { "" } else { "." };
    format!("{}{end}{words}", prose(&help))
}

/// What stands under a command's options: paragraphs, lists and, last, its examples.
fn remarks(help: &str) -> String {
    let mut text = String::new();
    for paragraph in help.split("\n\n").filter(|paragraph| !paragraph.is_empty()) {
        let (first, rest) = paragraph.split_once('\n').unwrap_or((paragraph, ""));
        if first.starts_with("Example") {
            let lines: Vec<String> = rest.lines().map(|line| format!("$ {}", line.trim())).collect();
            text += &block("console", &lines.join("\n"));
        } else if rest.is_empty() {
            text += &format!("{}\n\n", prose(paragraph));
        } else {
            text += &block("text", paragraph);
        }
    }
    text
}
