//! Where grasps go, in which form, and what is kept beside them on the way.

use super::report::Report;
use crate::Failure;
use crate::outputs::{self, OverwriteArgs};
use regrasp::grasps::write::{Set, keyframes, lines, npz, resets};
use regrasp::grasps::{GraspSource, Journal};
use serde_json::json;
use std::fs;
use std::path::{Path, PathBuf};

/// The forms of files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Form {
    Npz,
    Resets,
    Lines,
    Mjcf,
}

/// A file of grasps.
pub struct Output {
    path: PathBuf,
    form: Form,
}

impl Output {
    /// Refuses a name that tells no form.
    pub fn new(path: &Path) -> Result<Self, Failure> {
        let refuse = |why: &str| Failure::bad_input(format!("`-o {}`: {why}", path.display()));
        if outputs::is_standard(path) {
            return Err(refuse("grasps need a file, and `-` is standard output; name a file"));
        }
        let name = path.file_name().unwrap_or_default().to_string_lossy().to_lowercase();
        let ends = [
            (".reset.npz", Form::Resets),
            (".npz", Form::Npz),
            (".jsonl", Form::Lines),
            (".xml", Form::Mjcf),
        ];
        let form = ends.into_iter().find(|(end, _)| name.ends_with(end)).map(|(_, form)| form);
        let form = form.or_else(|| is_special(path).then_some(Form::Npz));
        match form {
            Some(form) => Ok(Self { path: path.to_owned(), form }),
            None => Err(refuse("the file's name must end with `.npz`, `.jsonl`, `.xml` or `.reset.npz`")),
        }
    }

    /// The file of one object of a folder.
    pub fn of_object(&self, mesh: &Path) -> Self {
        let stem = mesh.file_stem().unwrap_or_default().to_string_lossy();
        Self { path: self.beside(&stem), form: self.form }
    }

    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Whether the output is a device or a pipe, beside which nothing can be kept.
    pub fn is_special(&self) -> bool {
        is_special(&self.path)
    }

    /// Where less than was asked for goes: `grasps.npz` becomes `grasps.partial.npz`.
    pub fn partial(&self) -> PathBuf {
        self.beside("partial")
    }

    /// Where grasps are kept while more are looked for.
    pub fn journal(&self) -> PathBuf {
        if self.is_special() {
            return std::env::temp_dir().join(format!("regrasp-{}.part", std::process::id()));
        }
        let mut name = self.path.clone().into_os_string();
        name.push(".part");
        name.into()
    }

    /// A word before the name's ending.
    fn beside(&self, word: &str) -> PathBuf {
        let name = self.path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let end = if self.form == Form::Resets {
            ".reset.npz".len()
        } else {
            name.len() - name.rfind('.').unwrap_or(0)
        };
        let (stem, end) = name.split_at(name.len().saturating_sub(end));
        self.path.with_file_name(format!("{stem}.{word}{end}"))
    }

    /// Writes the grasps of a journal.
    pub fn write(
        &self,
        path: &Path,
        report: &Report<'_>,
        journal: &Journal,
        overwrite: OverwriteArgs,
    ) -> Result<(), Failure> {
        let (source, info) = (report.source, report.info().to_string());
        let problem = json!(source.plan()).to_string();
        let layout = source.layout();
        let set = Set {
            rows: journal,
            grasps: report.ending.grasps,
            edges: source.wish().graph.then_some(report.ending.edges),
            hand: &report.scenario.problem.hand,
            layout: &layout,
            info: &info,
            problem: &problem,
        };
        let done = match self.form {
            Form::Npz => regrasp::plan::write_file(path, |out| npz(&set, out)),
            Form::Resets => regrasp::plan::write_file(path, |out| resets(&set, out)),
            Form::Lines => regrasp::plan::write_file(path, |out| lines(&set, out)),
            Form::Mjcf => {
                let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
                let model = keyframes(&set, source.plan(), &stem).map_err(Failure::refused)?;
                for mesh in model.meshes() {
                    let place = path.with_file_name(&mesh.name);
                    outputs::check_export(&place, &mesh.bytes, overwrite)?;
                    crate::export::write(&place, &mesh.bytes)?;
                }
                regrasp::plan::write_file(path, |out| model.write(&set, out))
            }
        };
        done.map_err(Failure::refused)
    }
}

fn is_special(path: &Path) -> bool {
    fs::metadata(path).is_ok_and(|found| !found.is_file() && !found.is_dir())
}

/// One line that tells this search from every other: the whole problem, and all that is asked for but how
/// many.
pub fn identity(source: &GraspSource<'_>) -> String {
    let wish = source.wish();
    let value = json!({
        "format": "regrasp-grasps-part",
        "version": 1,
        "wish": {
            "spread": wish.spread, "per_pose": wish.per_pose, "per_facets": wish.per_facets,
            "fingers": wish.fingers, "graph": wish.graph,
        },
        "problem": source.plan(),
    });
    value.to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_tell_the_form_and_keep_it() {
        let named = |name: &str| Output::new(Path::new(name));
        let object =
            |name: &str| named(name).map(|output| output.of_object(Path::new("parts/bolt.stl")).path);
        assert_eq!(object("a/g.npz").ok(), Some("a/g.bolt.npz".into()));
        assert_eq!(object("g.reset.npz").ok(), Some("g.bolt.reset.npz".into()));
        assert_eq!(named("g.v2.jsonl").unwrap().partial(), Path::new("g.v2.partial.jsonl"));
        assert_eq!(named("a/g.xml").unwrap().journal(), Path::new("a/g.xml.part"));
        for bad in ["-", "g", "g.json", "g.csv"] {
            assert!(named(bad).is_err(), "{bad}");
        }
    }
}
