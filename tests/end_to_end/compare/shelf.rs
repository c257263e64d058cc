//! What a study's folder holds, with and without the times.

use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// The runs of a study in the order of its journal, each as a JSON object.
pub fn runs(folder: &Path) -> Vec<Value> {
    let text = fs::read_to_string(folder.join("runs.jsonl")).expect("a study has a journal");
    text.lines().map(|line| serde_json::from_str(line).expect("a line of the journal is JSON")).collect()
}

/// Everything of a study that does not depend on the clock: the runs, the table of them, what the study is,
/// the plans, the names of all files.
pub fn timeless(folder: &Path) -> BTreeMap<String, Value> {
    let mut all = BTreeMap::from([("runs.jsonl".to_owned(), Value::Array(runs(folder)))]);
    all.insert("runs.csv".into(), Value::Array(table(folder).into_iter().map(Value::from).collect()));
    all.insert("study.json".into(), json(&folder.join("study.json")));
    for name in files(&folder.join("plans")) {
        all.insert(format!("plans/{name}"), json(&folder.join("plans").join(&name)));
    }
    all.insert("files".into(), files(folder).into());
    all.insert("logs".into(), files(&folder.join("ompl")).into());
    all.values_mut().for_each(forget_times);
    all
}

fn json(path: &Path) -> Value {
    serde_json::from_slice(&fs::read(path).expect("the file was written")).expect("it is JSON")
}

fn files(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).into_iter().flatten();
    let mut names: Vec<String> =
        entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

/// The rows of `runs.csv`, those cells left out whose column names something measured.
fn table(folder: &Path) -> Vec<String> {
    let text = fs::read_to_string(folder.join("runs.csv")).expect("a study has a table of runs");
    let mut rows = csv(&text);
    let measured = |name: &String| {
        name.starts_with("phase.")
            || name.starts_with("self.")
            || ["planning_s", "verification_s", "memory_bytes"].contains(&name.as_str())
    };
    let kept: Vec<bool> = rows[0].iter().map(|name| !measured(name)).collect();
    assert_eq!(kept.iter().filter(|kept| !**kept).count(), 3 + 5 + 10, "the columns of times and memory");
    let row = |row: &mut Vec<String>| {
        let cells = row.iter().zip(&kept).filter(|(_, kept)| **kept).map(|(cell, _)| cell.as_str());
        cells.collect::<Vec<_>>().join("|")
    };
    rows.iter_mut().map(row).collect()
}

/// Reads comma-separated values with their quotes; every row must be as long as the first.
pub fn csv(text: &str) -> Vec<Vec<String>> {
    let (mut rows, mut row, mut cell, mut quoted) = (Vec::new(), Vec::new(), String::new(), false);
    let mut letters = text.chars().peekable();
    while let Some(letter) = letters.next() {
        match letter {
            '"' if quoted && letters.peek() == Some(&'"') => cell.extend(letters.next()),
            '"' => quoted = !quoted,
            ',' if !quoted => row.push(std::mem::take(&mut cell)),
            '\n' if !quoted => {
                row.push(std::mem::take(&mut cell));
                rows.push(std::mem::take(&mut row));
            }
            letter => cell.push(letter),
        }
    }
    assert!(cell.is_empty() && row.is_empty() && !quoted, "the last line has its end");
    assert!(rows.iter().all(|row| row.len() == rows[0].len()), "rows of unequal length");
    rows
}

/// Takes out what a repeated run may change.
fn forget_times(value: &mut Value) {
    match value {
        Value::Object(map) => {
            ["times", "time_s", "started_s"].iter().for_each(|key| drop(map.remove(*key)));
            map.values_mut().for_each(forget_times);
        }
        Value::Array(items) => items.iter_mut().for_each(forget_times),
        _ => {}
    }
}
