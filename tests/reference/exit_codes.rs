//! The page of exit codes: each of its commands ends as it says.

use crate::page;
use std::path::Path;
use std::process::Command;

/// The commands of every console block, with the code of the section that it stands in.
fn examples() -> Vec<(i32, String)> {
    let text = page("exit-codes.md");
    let mut examples = Vec::new();
    for section in text.split("\n## ").skip(1) {
        let code = section
            .split(':')
            .next()
            .and_then(|code| code.parse().ok())
            .expect("a section begins with its code");
        for block in section.split("```console\n").skip(1).filter_map(|rest| rest.split("```").next()) {
            let lines: Vec<&str> = block.lines().filter_map(|line| line.strip_prefix("$ ")).collect();
            examples.push((code, lines.join("\n")));
        }
    }
    examples
}

#[test]
#[cfg(target_os = "linux")]
fn every_command_ends_as_the_page_says() {
    let examples = examples();
    let codes: std::collections::BTreeSet<i32> = examples.iter().map(|(code, _)| *code).collect();
    assert_eq!(codes.into_iter().collect::<Vec<_>>(), [0, 2, 3, 4, 130]);
    let program = Path::new(env!("CARGO_BIN_EXE_regrasp")).parent().expect("the program has a folder");
    let path = std::env::var("PATH").unwrap_or_default();
    for (code, commands) in examples {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let output = Command::new("sh")
            .args(["-c", &commands])
            .env("PATH", format!("{}:{path}", program.display()))
            .current_dir(folder.path())
            .output()
            .expect("a shell is part of Linux systems");
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(code), "{commands}\n{said}");
        assert!(code == 0 || !said.trim().is_empty(), "{commands} says nothing");
        assert!(!said.contains("panicked"), "{commands}\n{said}");
    }
}
