//! What the pages show of the program's output: a comment `<!-- output of: regrasp … -->` before a block
//! names the command that printed it.

use crate::tree::Tree;
use std::path::Path;
use std::process::Command;

/// How many lines of the output are said to be missing, at most, for each block.
const MOST: usize = 3;

/// Runs a command in a folder: what it prints, errors included.
pub type Run<'a> = &'a dyn Fn(&[&str], &Path) -> String;

/// The program itself.
pub fn run_program(arguments: &[&str], folder: &Path) -> String {
    let output = Command::new(env!("CARGO_BIN_EXE_regrasp")).args(arguments).current_dir(folder).output();
    let output = output.expect("the program was built");
    [output.stdout, output.stderr].map(|text| String::from_utf8_lossy(&text).into_owned()).join("\n")
}

/// Blocks with a line that their command does not print, or not in that order. Times are not compared, `...`
/// stands for lines left out.
///
/// The commands of a page share a folder, so that one can use what the one before has written.
pub fn faults(tree: &Tree, run: Run<'_>) -> Vec<String> {
    let mut faults = Vec::new();
    for (file, page) in &tree.pages {
        let folder = tempfile::tempdir().expect("a folder for what the commands write");
        for output in &page.outputs {
            let mut printed = String::new();
            for command in output.command.split("&&") {
                let words: Vec<&str> = command.split_whitespace().skip(1).collect();
                printed = run(&words, folder.path());
            }
            let place = format!("{}:{}: `{}`", file.display(), output.line, output.command);
            let missing = missing(&output.text, &printed);
            faults
                .extend(missing.iter().take(MOST).map(|line| format!("{place} does not print here: {line}")));
        }
    }
    faults
}

/// The lines that are not in the output, or not where they are shown.
fn missing<'t>(shown: &'t str, printed: &str) -> Vec<&'t str> {
    let mut rest = printed.lines().map(str::trim_end);
    let mut all = Vec::new();
    for line in shown.lines().map(str::trim_end).filter(|line| !is_left_out(line)) {
        let before = rest.clone();
        if !rest.any(|other| other == line) {
            all.push(line);
            rest = before;
        }
    }
    all
}

/// Empty lines, dots, and the lines of times, which no two runs have in common.
fn is_left_out(line: &str) -> bool {
    let line = line.trim_start();
    line.is_empty() || line == "..." || line.starts_with("planning ") || line.starts_with("verification ")
}
