//! `regrasp export`

use crate::outputs::{self, Kind, OverwriteArgs};
use crate::table::Table;
use crate::{Failure, say, say_json};
use clap::builder::{PossibleValuesParser, TypedValueParser};
use regrasp::export::{ExportError, File, Format, Scene};
use serde_json::json;
use std::fs;
use std::path::{Path, PathBuf};

/// Write a plan in the formats of other programs.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
gltf  an animated scene (.glb) for Blender and web viewers\n\
urdf  hand and object as URDF with their meshes, and the joints' trajectory as CSV\n\
mjcf  a MuJoCo model, and a trajectory of what its motors aim at, the grasp forces fed forward\n\
csv   a table, one row a state: time, joints by name, object pose, contacts, forces\n\
npz   the same as NumPy arrays\n\n\
Lengths are metres, angles radians, forces newtons; H is the hand's frame, O the object's. Forces are what \
the fingertips exert on the object to hold it against \
gravity, with the least share of the friction that the joints' efforts allow. Files are named after the \
plan.\n\n\
Examples:\n  regrasp export plan.json --to gltf\n  regrasp export plan.json --to mjcf,npz -o exported")]
pub struct ExportArgs {
    /// A plan file.
    pub plan: PathBuf,
    /// The formats, with commas between.
    #[arg(long, required = true, value_name = "FORMAT", value_delimiter = ',', value_parser = format())]
    pub to: Vec<Format>,
    /// Write the files into this folder, which is made where there is none.
    #[arg(short, long, value_name = "DIR", default_value = ".")]
    pub output: PathBuf,
    #[command(flatten)]
    pub overwrite: OverwriteArgs,
    /// Most normal force of one contact (N), 0.01 to 10000; by default what the plan claims to hold by, or
    /// else what the joints can.
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = grip())]
    pub grip: Option<f64>,
    /// Print one JSON object instead of text.
    #[arg(long)]
    pub json: bool,
}

/// Takes a normal force (N).
fn grip() -> impl TypedValueParser<Value = f64> {
    clap::builder::NonEmptyStringValueParser::new().try_map(|text: String| match text.trim().parse::<f64>() {
        Ok(force) if (0.01..=1e4).contains(&force) => Ok(force),
        _ => Err("it must be a number in 0.01..=10000"),
    })
}

/// Takes the formats by their names.
fn format() -> impl TypedValueParser<Value = Format> {
    let named = |name: String| Format::ALL.into_iter().find(|format| format.name() == name);
    PossibleValuesParser::new(Format::ALL.map(Format::name))
        .try_map(move |name| named(name).ok_or("no such format"))
}

pub fn run(args: &ExportArgs) -> Result<(), Failure> {
    outputs::check_folder(&args.output)?;
    let plan = regrasp::plan::read(&args.plan).map_err(Failure::refused)?;
    let refuse = |error: ExportError| {
        Failure::bad_input(format!("`{}` cannot be exported: {error}", args.plan.display()))
    };
    let scene = Scene::with_grip(&plan, args.grip).map_err(refuse)?;
    let stem = args.plan.file_stem().map_or("plan".into(), |stem| stem.to_string_lossy());
    let mut files: Vec<(Format, File)> = Vec::new();
    for &format in &args.to {
        if files.iter().all(|(done, _)| *done != format) {
            let made = scene.export(format, &stem).map_err(refuse)?;
            files.extend(made.into_iter().map(|file| (format, file)));
        }
    }
    // Everything is made before anything is written.
    make_folder(&args.output)?;
    for (_, file) in &files {
        let path = args.output.join(&file.name);
        outputs::check(
            std::slice::from_ref(&args.plan),
            &[(&path, Kind::Export)],
            OverwriteArgs { force: true },
        )?;
        outputs::check_export(&path, &file.bytes, args.overwrite)?;
    }
    for (_, file) in &files {
        write(&args.output.join(&file.name), &file.bytes)?;
    }
    tell(args, &files, &scene.notes())
}

/// Makes a folder where there is none.
pub fn make_folder(folder: &Path) -> Result<(), Failure> {
    let refuse = |reason: &dyn std::fmt::Display| {
        Failure::bad_input(format!("`{}` cannot take the files: {reason}", folder.display()))
    };
    if folder.exists() && !folder.is_dir() {
        return Err(refuse(&"it is a file; give a folder"));
    }
    fs::create_dir_all(folder).map_err(|error| refuse(&error))
}

pub fn write(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    regrasp::plan::write_file(path, |writer| writer.write_all(bytes)).map_err(Failure::refused)
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
    crate::terminal::remark(notes);
    let mut table = Table::new("<<>", &["format", "file", "kB"]);
    for (format, file) in files {
        let name = args.output.join(&file.name).display().to_string();
        table.row([format.name().to_owned(), name, format!("{:.1}", file.bytes.len() as f64 / 1e3)]);
    }
    say(&table.text())
}
