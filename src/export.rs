//! `regrasp export`, and the grasps that `regrasp plan --grasps` keeps.

use crate::table::Table;
use crate::{Failure, say, say_json};
use regrasp::api::Slot;
use regrasp::export::{ExportError, File, Format, GraspRecord, Grasps, Scene};
use regrasp::study::{Run, Setup, scenario::Scenario};
use serde_json::json;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Write a plan in the formats of other programs.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
gltf  an animated scene (.glb) for Blender and web viewers\n\
urdf  hand and object as URDF with their meshes, and the joints' trajectory as CSV\n\
mjcf  a MuJoCo model, and a trajectory of what its motors aim at, the grasp forces fed forward\n\
csv   a table, one row a state: time, joints by name, object pose, contacts, forces\n\
npz   the same as NumPy arrays\n\n\
Lengths are metres, angles radians, forces newtons; H is the hand's frame, O the object's. Forces are what the fingertips exert on the object to hold it against \
gravity, inside the friction cones that the plan claims. Files are named after the plan.\n\n\
Examples:\n  regrasp export plan.json --to gltf\n  regrasp export plan.json --to mjcf,npz -o exported")]
pub struct ExportArgs {
    /// A plan file.
    pub plan: PathBuf,
    /// The formats, with commas between.
    #[arg(long, required = true, value_name = "FORMAT", value_delimiter = ',', value_enum)]
    pub to: Vec<To>,
    /// Write the files into this folder, which is made where there is none.
    #[arg(short, long, value_name = "DIR", default_value = ".")]
    pub output: PathBuf,
    /// Print one JSON object instead of text.
    #[arg(long)]
    pub json: bool,
}

/// A format as the command line knows it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum To {
    Gltf,
    Urdf,
    Mjcf,
    Csv,
    Npz,
}

impl From<To> for Format {
    fn from(to: To) -> Self {
        match to {
            To::Gltf => Self::Gltf,
            To::Urdf => Self::Urdf,
            To::Mjcf => Self::Mjcf,
            To::Csv => Self::Csv,
            To::Npz => Self::Npz,
        }
    }
}

pub fn run(args: &ExportArgs) -> Result<(), Failure> {
    let plan = regrasp::plan::read(&args.plan).map_err(Failure::bad_input)?;
    let refuse = |error: ExportError| {
        Failure::bad_input(format!("`{}` cannot be exported: {error}", args.plan.display()))
    };
    let scene = Scene::new(&plan).map_err(refuse)?;
    let stem = args.plan.file_stem().map_or("plan".into(), |stem| stem.to_string_lossy());
    let mut files: Vec<(Format, File)> = Vec::new();
    for &to in &args.to {
        let format = Format::from(to);
        if files.iter().all(|(done, _)| *done != format) {
            let made = scene.export(format, &stem).map_err(refuse)?;
            files.extend(made.into_iter().map(|file| (format, file)));
        }
    }
    // Everything is made before anything is written.
    make_folder(&args.output)?;
    for (_, file) in &files {
        write(&args.output.join(&file.name), &file.bytes)?;
    }
    tell(args, &files, &scene.notes())
}

fn make_folder(folder: &Path) -> Result<(), Failure> {
    let refuse = |reason: &dyn std::fmt::Display| {
        Failure::bad_input(format!("`{}` cannot take the files: {reason}", folder.display()))
    };
    if folder.exists() && !folder.is_dir() {
        return Err(refuse(&"it is a file; give a folder"));
    }
    fs::create_dir_all(folder).map_err(|error| refuse(&error))
}

fn write(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    regrasp::plan::write_file(path, |writer| writer.write_all(bytes)).map_err(Failure::bad_input)
}

fn tell(args: &ExportArgs, files: &[(Format, File)], notes: &[String]) -> Result<(), Failure> {
    if args.json {
        let list: Vec<_> = files
            .iter()
            .map(|(format, file)| {
                json!({
                    "format": format.name(),
                    "file": args.output.join(&file.name),
                    "bytes": file.bytes.len(),
                })
            })
            .collect();
        return say_json(&json!({ "files": list, "notes": notes }));
    }
    for note in notes {
        // A reader of standard error that has gone away is no failure.
        let _ = writeln!(io::stderr(), "note: {note}");
    }
    let mut table = Table::new("<<>", &["format", "file", "kB"]);
    for (format, file) in files {
        let name = args.output.join(&file.name).display().to_string();
        table.row([format.name().to_owned(), name, format!("{:.1}", file.bytes.len() as f64 / 1e3)]);
    }
    say(&table.text())
}

/// Refuses a place for grasps before any work is done.
pub fn check_grasps(path: Option<&Path>) -> Result<(), Failure> {
    let Some(path) = path else { return Ok(()) };
    match path.extension().and_then(|extension| extension.to_str()) {
        Some("json" | "npz") => regrasp::plan::check_place(path).map_err(Failure::bad_input),
        _ => Err(Failure::bad_input(format!(
            "`--grasps {}`: the file's name must end with `.json` or `.npz`",
            path.display()
        ))),
    }
}

/// Keeps the stable grasps of the run's manipulation graph.
pub fn save_grasps(path: &Path, scenario: &Scenario, setup: &Setup<'_>, run: &Run) -> Result<usize, Failure> {
    let graph = &run.outcome.graph;
    let mut records = Vec::new();
    for (number, q) in graph.nodes().iter().enumerate() {
        let margin = setup.margin(q).map_err(Failure::bad_input)?;
        // A given start may be no stable grasp of the stability test at rest; the cache holds stable ones alone.
        if margin > 0.0 {
            let component = graph.component(regrasp::api::NodeId(number as u32)).0 as usize;
            records.push(GraspRecord { q: q.clone(), component, margin });
        }
    }
    let id = |slot: Slot| setup.choices().choice(slot).id.as_str();
    let grasps = Grasps {
        scenario: &scenario.name,
        hand: &scenario.problem.hand,
        stability_test: id(Slot::StabilityTest),
        contact_model: id(Slot::ContactModel),
        grasps: &records,
    };
    let name = path.display().to_string();
    let file = match path.extension().and_then(|extension| extension.to_str()) {
        Some("npz") => grasps.npz(&name).map_err(Failure::bad_input)?,
        _ => grasps.json(&name),
    };
    write(path, &file.bytes)?;
    Ok(records.len())
}
