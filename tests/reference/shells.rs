//! Completions and manual pages.

use crate::{page, printed, regrasp};
use std::path::Path;

/// Every command that a user is shown, as the page of commands lists them.
fn commands() -> Vec<String> {
    let text = page("commands.md");
    let names = text
        .lines()
        .filter_map(|line| Some(line.strip_prefix("## `regrasp ")?.split_once('`')?.0.to_owned()));
    let names: Vec<String> = names.collect();
    assert!(names.len() >= 13 && names.contains(&"plan".to_owned()), "{names:?}");
    names
}

#[test]
fn every_shell_has_completions_of_every_command() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let script = printed(folder.path(), &format!("completions {shell}"));
        for command in commands() {
            assert!(script.contains(&command), "{shell} does not know {command}");
        }
        assert!(script.contains("time-limit"), "{shell} knows no option");
        // The other shells' scripts have no values of arguments.
        let names = ["bash", "zsh"].contains(&shell);
        assert!(!names || script.contains("local-planner"), "{shell} knows no role");
    }
    let output = regrasp(folder.path(), "completions bsh");
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("'bash'"));
}

/// What bash offers after `words`, the last of which is being typed.
#[cfg(target_os = "linux")]
fn offered(folder: &Path, words: &str) -> Vec<String> {
    let script = format!(
        "set -eu; source completions.bash; COMP_WORDS=({words}); COMP_CWORD=$((${{#COMP_WORDS[@]}} - 1)); \
         _regrasp regrasp \"${{COMP_WORDS[$COMP_CWORD]}}\" \"${{COMP_WORDS[$((COMP_CWORD - 1))]}}\"; printf \
         '%s\\n' \"${{COMPREPLY[@]}}\""
    );
    let output = std::process::Command::new("bash")
        .args(["--norc", "--noprofile", "-c", &script])
        .current_dir(folder)
        .output()
        .expect("bash is part of Linux systems");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let mut offers: Vec<String> =
        String::from_utf8_lossy(&output.stdout).lines().map(str::to_owned).collect();
    offers.sort();
    offers
}

#[test]
#[cfg(target_os = "linux")]
fn bash_completes_commands_options_and_values() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let script = printed(folder.path(), "completions bash");
    std::fs::write(folder.path().join("completions.bash"), script).expect("the folder is ours");
    assert_eq!(offered(folder.path(), "regrasp ver"), ["verify"]);
    assert_eq!(offered(folder.path(), "regrasp plan --time"), ["--time-limit"]);
    assert_eq!(offered(folder.path(), "regrasp schema st"), ["study"]);
    assert_eq!(offered(folder.path(), "regrasp plan cub"), ["cube-free", "cubic"]);
    assert_eq!(offered(folder.path(), "regrasp scenarios four"), ["four-finger"]);
    assert_eq!(offered(folder.path(), "regrasp new-plugin graph"), ["graph-strategy"]);
    assert!(offered(folder.path(), "regrasp plugins sampler/").contains(&"sampler/rlg".to_owned()));
    // What is for those who write the book is not offered.
    assert!(!offered(folder.path(), "regrasp \"\"").contains(&"reference".to_owned()));
}

#[test]
fn the_manual_has_a_page_for_every_command() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    printed(folder.path(), "man -o pages/man1");
    let read = |name: &str| {
        let path = folder.path().join("pages/man1").join(name);
        std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
    };
    let program = read("regrasp.1");
    assert!(program.starts_with(".ie ") || program.contains(".TH regrasp 1"), "{program}");
    assert!(program.contains(".TH regrasp 1 \"\" \"regrasp "), "{program}");
    assert_eq!(program, printed(folder.path(), "man"));
    for command in commands() {
        let name = command.replace('-', "\\-");
        assert!(program.contains(&format!("regrasp\\-{name}(1)")), "regrasp.1 does not name {command}");
        let text = read(&format!("regrasp-{command}.1"));
        assert!(
            text.contains(&format!("regrasp {name}")) || text.contains(&format!("regrasp\\ {name}")),
            "{text}"
        );
        assert!(
            text.contains("SYNOPSIS") && text.contains("OPTIONS") && text.contains("Example"),
            "{command}:\n{text}"
        );
    }
    let count = std::fs::read_dir(folder.path().join("pages/man1")).expect("the folder was made").count();
    assert_eq!(count, commands().len() + 1);
}

#[test]
fn manual_pages_that_cannot_be_written_are_refused() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    std::fs::write(folder.path().join("taken"), "").expect("the folder is ours");
    let output = regrasp(folder.path(), "man -o taken");
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("`taken` cannot take the files: it is a file"));
}
