//! A folder of objects: every mesh in it takes the place of the scenario's object.

use super::Job;
use super::output::Output;
use crate::Failure;
use crate::terminal::printable;
use regrasp::plan::StoppedBy;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// How the names of meshes end.
const MESHES: [&str; 4] = ["stl", "obj", "ply", "dae"];

/// The grasps of each; what goes wrong with one is told, and the others are done.
pub fn each(job: &Job<'_>, folder: &Path, output: &Output) -> Result<(), Failure> {
    let entries = entries(folder)?;
    let mut wrong = Vec::new();
    for entry in &entries {
        if job.is_stopped() {
            break;
        }
        let done = if is_mesh(entry) {
            let _ = writeln!(io::stderr(), "{}", printable(&entry.display().to_string()));
            job.one(&output.of_object(entry), Some(entry))
        } else {
            Err(Failure::bad_input(format!("it is no mesh ({})", MESHES.join(", "))))
        };
        if let Err(failure) = done {
            let line = format!("`{}`: {}", entry.display(), failure.message());
            let _ = writeln!(io::stderr(), "{}", printable(&line));
            wrong.push(line);
        }
    }
    ending(job, entries.len(), &wrong)
}

fn ending(job: &Job<'_>, count: usize, wrong: &[String]) -> Result<(), Failure> {
    if job.is_stopped() && job.cause() == StoppedBy::Interrupt {
        return Err(Failure::interrupted("interrupted; the same command goes on".into()));
    }
    if wrong.is_empty() {
        return Ok(());
    }
    let list = wrong.join("\n  ");
    Err(Failure::bad_input(format!("{} of {count} entries did not give all grasps:\n  {list}", wrong.len())))
}

/// The folder's entries in the order of their names, but for hidden ones.
fn entries(folder: &Path) -> Result<Vec<PathBuf>, Failure> {
    let refuse = |why: String| Failure::bad_input(format!("`--objects {}`: {why}", folder.display()));
    let listed = std::fs::read_dir(folder).map_err(|error| refuse(error.to_string()))?;
    let mut entries = Vec::new();
    for entry in listed {
        let path = entry.map_err(|error| refuse(error.to_string()))?.path();
        let is_hidden = path.file_name().is_some_and(|name| name.to_string_lossy().starts_with('.'));
        // Full paths: a scenario's own files are looked for beside the scenario.
        entries.extend((!is_hidden).then(|| std::fs::canonicalize(&path).unwrap_or(path)));
    }
    entries.sort();
    if entries.iter().any(|entry| is_mesh(entry)) {
        return Ok(entries);
    }
    Err(refuse(format!("there is no mesh in it ({})", MESHES.join(", "))))
}

fn is_mesh(path: &Path) -> bool {
    let extension = path.extension().map(|extension| extension.to_string_lossy().to_lowercase());
    path.is_file() && extension.is_some_and(|extension| MESHES.contains(&extension.as_str()))
}
