//! The command lines that the pages show: `$ regrasp SUBCOMMAND --option …`.

use crate::tree::Tree;
use std::collections::{BTreeMap, BTreeSet};
use std::process::Command;

/// Which options each subcommand has.
pub struct Help(pub BTreeMap<String, BTreeSet<String>>);

impl Help {
    /// Asks the program itself.
    pub fn of_the_program() -> Self {
        let help = |arguments: &[&str]| {
            let output = Command::new(env!("CARGO_BIN_EXE_regrasp")).args(arguments).output();
            String::from_utf8(output.expect("the program was built").stdout).expect("help is UTF-8")
        };
        let all = help(&["--help"]);
        let commands =
            all.lines().skip_while(|line| *line != "Commands:").skip(1).take_while(|line| !line.is_empty());
        let names: Vec<_> = commands.filter_map(|line| line.split_whitespace().next()).collect();
        assert!(names.len() > 8, "the program's help has changed its form:\n{all}");
        let options = |name: &&str| ((*name).to_owned(), options(&help(&["help", name])));
        let mut commands: BTreeMap<_, _> = names.iter().map(options).collect();
        commands.insert(String::new(), self::options(&all));
        Self(commands)
    }
}

/// The words of a help text that are options.
fn options(help: &str) -> BTreeSet<String> {
    let lines = help.lines().map(str::trim_start).filter(|line| line.starts_with('-'));
    let words = lines
        .flat_map(|line| line.split([' ', ',']).take_while(|word| word.is_empty() || word.starts_with('-')));
    words.filter(|word| !word.is_empty()).map(str::to_owned).collect()
}

/// Command lines with a subcommand or an option that does not exist.
pub fn faults(tree: &Tree, help: &Help) -> Vec<String> {
    let mut faults = Vec::new();
    let mut seen = 0;
    for (file, page) in &tree.pages {
        for (line, block) in &page.blocks {
            for command in commands(block) {
                seen += 1;
                let fault = wrong(&command, help);
                faults.extend(fault.map(|fault| {
                    format!("{}:{line}: `regrasp {}`: {fault}", file.display(), command.join(" "))
                }));
            }
        }
    }
    assert!(seen > 0, "no page shows a command");
    faults
}

fn wrong(words: &[String], help: &Help) -> Option<String> {
    let name = words.first().filter(|word| !word.starts_with('-')).map_or("", String::as_str);
    let Some(options) = help.0.get(name) else { return Some(format!("there is no subcommand `{name}`")) };
    let mut given = words.iter().filter(|word| word.starts_with('-') && word.len() > 1);
    let unknown = given.find(|word| {
        let option = word.split_once('=').map_or(word.as_str(), |(option, _)| option);
        !options.contains(option) && option.parse::<f64>().is_err()
    });
    unknown.map(|option| format!("it has no option `{option}`"))
}

/// The words after `regrasp` of each command of a block; of a line with `&&`, `|`, `;` or `>` each command,
/// what follows `#` aside.
fn commands(block: &str) -> Vec<Vec<String>> {
    let joined = block.replace("\\\n", " ");
    let mut found = Vec::new();
    for line in joined.lines().filter_map(|line| line.strip_prefix("$ ")) {
        let line = line.split(" #").next().unwrap_or_default();
        for part in line.split(['&', '|', ';', '>']) {
            let mut words = part.split_whitespace().map(|word| word.trim_matches(['\'', '"']).to_owned());
            if words.next().is_some_and(|word| word == "regrasp") {
                found.push(words.collect());
            }
        }
    }
    found
}
