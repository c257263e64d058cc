//! Whether a plugin prints: tried in a child process, whose output is looked at.

use crate::{Report, check};
use regrasp_api::Entry;
use std::io::Write;
use std::process::Command;

/// Set for the child process that runs the plugin.
const CHILD: &str = "REGRASP_CONFORMANCE_CHILD";
/// What the child writes before and after running the plugin, to both streams.
const MARK: &str = "\n<<<regrasp-conformance>>>\n";

/// Panics if a registered plugin prints anything while it goes through its checks.
///
/// `test` is the path of the calling test, `concat!(module_path!(), "::name")`: the child process runs that
/// test alone.
pub fn registered_are_silent(test: &str) {
    assert_silent(test, &crate::registered());
}

/// Panics if one of `entries` prints anything, to standard output or standard error, while it goes through
/// its checks.
pub fn assert_silent(test: &str, entries: &[&Entry]) {
    if std::env::var_os(CHILD).is_some() {
        mark();
        let _reports: Vec<Report> = entries.iter().map(|entry| check(entry)).collect();
        mark();
        return;
    }
    // libtest names a test by its path without the crate.
    let name = test.split_once("::").map_or(test, |(_, rest)| rest);
    let exe = std::env::current_exe().expect("a running test knows its own file");
    let output = Command::new(exe)
        .args(["--exact", name, "--nocapture", "--test-threads", "1"])
        .env(CHILD, "1")
        .output()
        .expect("a test can start its own file again");
    for (stream, bytes) in [("standard output", output.stdout), ("standard error", output.stderr)] {
        let text = String::from_utf8_lossy(&bytes).into_owned();
        let parts: Vec<&str> = text.split(MARK).collect();
        assert_eq!(parts.len(), 3, "the child process did not run `{name}` to its end:\n{text}");
        assert!(parts[1].is_empty(), "a plugin wrote to {stream}:\n{}", parts[1]);
    }
}

fn mark() {
    let (mut out, mut err) = (std::io::stdout(), std::io::stderr());
    for stream in [&mut out as &mut dyn Write, &mut err] {
        stream
            .write_all(MARK.as_bytes())
            .and_then(|()| stream.flush())
            .expect("the parent reads both streams");
    }
}
