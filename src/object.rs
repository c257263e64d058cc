//! `regrasp object`: how a mesh is understood, and the clean mesh that it becomes.

use crate::outputs::{self, Kind, OverwriteArgs};
use crate::terminal::printable;
use crate::view::PageArgs;
use crate::{Failure, say, say_json};
use clap::Args;
use regrasp::api::{MassProperties, Mesh, MeshError, MeshSource, Twin, Vec3};
use regrasp::formats::{FormatError, ReadMesh, read_mesh, read_points};
use regrasp::view::{ObjectView, object_page};
use regrasp::world::{Measures, automatic_twin, measure, outward_bodies, remake, rigid_body, roughness};
use serde_json::{Value, json};
use std::io::Write;
use std::path::{Path, PathBuf};

/// Show how an object's mesh is understood: size, mass, bodies, walls, and the surface that a fingertip
/// feels.
#[derive(Debug, Args)]
#[command(after_help = "\
A scenario names the file itself: `shape = { kind = \"mesh\", file = \"part.stl\", scale = 0.001 }`. \
`--repair` makes what differs by rounding \
one, leaves facets without area out and turns bodies the right way round. Where that is not enough, it makes \
the surface anew: closed, \
through the file's facets where they are, with holes closed and details lost that are finer than a \
hundredth of the size; it says so.\n\n\
Examples:\n  regrasp object part.stl --scale 0.001\n  regrasp object scan.ply --fingertip-radius 0.008\n  \
regrasp object part.stl --scale 0.001 --repair -o clean.stl")]
pub struct ObjectArgs {
    /// A mesh: an STL, OBJ, PLY or COLLADA file.
    pub file: PathBuf,
    /// What lengths are multiplied with: 0.001 for a file in millimetres.
    #[arg(long, value_name = "S", default_value_t = 1.0, allow_negative_numbers = true)]
    pub scale: f64,
    /// Mass (kg), uniformly spread.
    #[arg(long, value_name = "KG", default_value_t = 0.1, allow_negative_numbers = true, value_parser = mass)]
    pub mass: f64,
    /// Radius (m) of the fingertips that are to touch it.
    #[arg(long, value_name = "M", default_value_t = 0.01, allow_negative_numbers = true, value_parser = radius)]
    pub fingertip_radius: f64,
    /// Bodies that do not touch are fixed to each other all the same.
    #[arg(long)]
    pub assembly: bool,
    /// Turn what is inside out, and make a closed surface of what is none.
    #[arg(long)]
    pub repair: bool,
    /// Write the mesh as it was understood, as a binary STL file in metres; `-` is standard output.
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    #[command(flatten)]
    pub page: PageArgs,
    #[command(flatten)]
    pub overwrite: OverwriteArgs,
    /// Print one JSON object instead of text.
    #[arg(long)]
    pub json: bool,
}

fn mass(text: &str) -> Result<f64, String> {
    number(text, 1e-6, 1e3, "kilograms in 1e-6..=1000")
}

fn radius(text: &str) -> Result<f64, String> {
    number(text, 0.0, 1.0, "metres in 0..=1")
}

fn number(text: &str, low: f64, high: f64, what: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(number) if (low..=high).contains(&number) => Ok(number),
        _ => Err(format!("it must be a number of {what}")),
    }
}

pub fn run(args: &ObjectArgs) -> Result<(), Failure> {
    let wished = args.output.as_deref().map(|path| (path, Kind::Export));
    args.page.check(std::slice::from_ref(&args.file), wished.as_slice(), args.overwrite)?;
    let (mesh, notes) = match understood(args) {
        Err(refused) if args.repair => anew(args).ok_or(refused)?,
        answer => answer?,
    };
    let standard = args.output.as_deref().is_some_and(outputs::is_standard);
    if let Some(path) = &args.output {
        write(path, &mesh)?;
        if standard && !args.page.wanted() {
            return Ok(());
        }
    }
    let understood = Understood {
        measures: measure(&mesh),
        mass: mesh.mass_properties(),
        roughness: roughness(&mesh, args.fingertip_radius),
        twin: automatic_twin(&mesh, args.fingertip_radius),
        mesh: &mesh,
        notes,
        args,
    };
    if args.page.wanted() {
        args.page.show(&understood.page()?, args.output.as_deref())?;
    }
    if standard {
        return Ok(());
    }
    if args.page.is_standard() {
        // Standard output is the page's.
        let _ = std::io::stderr().write_all(printable(&understood.text()).as_bytes());
        return Ok(());
    }
    if args.json { say_json(&understood.json()) } else { say(&printable(&understood.text())) }
}

/// The mesh as one body, and what was done for that.
fn understood(args: &ObjectArgs) -> Result<(Mesh, Vec<String>), Failure> {
    let read = load(args)?;
    let mut notes = read.remarks();
    let mesh = if args.repair { outward_bodies(read.mesh) } else { read.mesh };
    let body = rigid_body(mesh, args.assembly).map_err(|fault| {
        Failure::bad_input(format!("the mesh of `{}` is refused: {fault}", args.file.display()))
    })?;
    notes.extend(body.remarks());
    Ok((body.mesh, notes))
}

/// A closed surface around the facets of a file that do not make one.
fn anew(args: &ObjectArgs) -> Option<(Mesh, Vec<String>)> {
    let (mut vertices, facets) = read_points(&args.file).ok()?;
    vertices.iter_mut().for_each(|v| *v *= args.scale);
    let remade = remake(&vertices, &facets)?;
    let remark = remade.remark();
    Some((remade.mesh, vec![remark]))
}

fn write(path: &Path, mesh: &Mesh) -> Result<(), Failure> {
    let bytes = regrasp::export::stl(mesh);
    if outputs::is_standard(path) {
        return crate::output::standard().write_all(&bytes).map_err(Failure::bad_input);
    }
    regrasp::plan::write_file(path, |out| out.write_all(&bytes)).map_err(Failure::bad_input)
}

/// The mesh; `--repair` turns one round whose facets all look inward.
fn load(args: &ObjectArgs) -> Result<ReadMesh, Failure> {
    let file = args.file.to_string_lossy().into_owned();
    let mut source = MeshSource { file: Some(file), scale: Some(args.scale), ..Default::default() };
    let read = read_mesh(&source, Path::new(""), "object.shape");
    let inside_out = matches!(&read, Err(FormatError::FileMesh { source, .. }) if matches!(**source, MeshError::InsideOut { .. }));
    if inside_out && args.repair {
        source.flip = Some(true);
        return read_mesh(&source, Path::new(""), "object.shape").map_err(Failure::bad_input);
    }
    read.map_err(Failure::bad_input)
}

/// A mesh and everything that is told about it.
struct Understood<'a> {
    args: &'a ObjectArgs,
    mesh: &'a Mesh,
    measures: Measures,
    /// For a density of 1 kg/m³.
    mass: MassProperties,
    roughness: f64,
    twin: Option<Twin>,
    /// What was done to the file's mesh.
    notes: Vec<String>,
}

impl Understood<'_> {
    fn size(&self) -> Vec3 {
        self.measures.upper - self.measures.lower
    }

    /// Inertia about the centre of mass (kg·m²).
    fn inertia(&self) -> [[f64; 3]; 3] {
        (self.mass.inertia_OCm * (self.args.mass / self.mass.volume)).into()
    }

    fn json(&self) -> Value {
        let Measures { lower, upper, surfaces, genus, sharp_edges, sharp_length, thinnest } = &self.measures;
        json!({
            "facets": self.mesh.facets().len(),
            "vertices": self.mesh.vertices().len(),
            "lower": lower.as_slice(),
            "upper": upper.as_slice(),
            "volume": self.mass.volume,
            "mass": self.args.mass,
            "center_of_mass": self.mass.p_OCm.as_slice(),
            "inertia": self.inertia(),
            "surfaces": surfaces,
            "genus": genus,
            "sharp_edges": { "count": sharp_edges, "length": sharp_length },
            "thinnest_wall": thinnest.map(|(wall, at)| json!({ "thickness": wall, "at": at.as_slice() })),
            "roughness": self.roughness,
            "contact_surface": self.twin.as_ref().map(|twin| json!({
                "facets": twin.mesh.facets().len(), "bound": twin.bound, "tolerance": twin.tolerance,
            })),
            "notes": self.notes,
        })
    }

    fn text(&self) -> String {
        let mut text = format!("{}: {} facets\n", self.args.file.display(), self.mesh.facets().len());
        for (name, value) in self.facts() {
            text += &format!("  {name:<17}{value}\n");
        }
        if let Some(path) = self.args.output.as_deref() {
            text += &format!("  written to       {}\n", path.display());
        }
        text
    }

    /// What is told in a few words each.
    fn facts(&self) -> Vec<(&'static str, String)> {
        let Measures { surfaces, genus, sharp_edges, sharp_length, thinnest, .. } = &self.measures;
        let (size, center) = (self.size() * 1e3, self.mass.p_OCm * 1e3);
        let [[xx, ..], [_, yy, _], [.., zz]] = self.inertia();
        let mut facts = vec![
            ("size", format!("{:.2} × {:.2} × {:.2} mm", size.x, size.y, size.z)),
            ("volume", format!("{:.3} cm³", self.mass.volume * 1e6)),
            ("centre of mass", format!("{:.3}, {:.3}, {:.3} mm", center.x, center.y, center.z)),
            ("inertia", format!("{xx:.4e}, {yy:.4e}, {zz:.4e} kg·m² for {} kg", self.args.mass)),
            ("surfaces", format!("{surfaces}, with {genus} handles")),
            ("sharp edges", format!("{sharp_edges} of {:.1} mm together", sharp_length * 1e3)),
        ];
        facts.extend(thinnest.map(|(wall, at)| {
            let at = at * 1e3;
            let wall = wall * 1e3;
            ("thinnest wall", format!("{wall:.3} mm, near {:.1}, {:.1}, {:.1} mm", at.x, at.y, at.z))
        }));
        facts.push(("contact surface", self.felt()));
        facts.extend(self.notes.iter().cloned().chain(self.note()).map(|note| ("note", note)));
        facts
    }

    /// What a fingertip feels.
    fn felt(&self) -> String {
        let rough = format!(
            "{:.0} % of the places that a fingertip of {:.1} mm can touch lie at a concave edge",
            100.0 * self.roughness,
            1e3 * self.args.fingertip_radius
        );
        let surface = match &self.twin {
            Some(twin) => format!(
                "a twin of {} facets; a fingertip on it is within {:.2} mm of touching the mesh",
                twin.mesh.facets().len(),
                (twin.bound * 1e5).ceil() / 100.0
            ),
            None => "the mesh itself".to_owned(),
        };
        format!("{surface} ({rough})")
    }

    /// What is likely to be meant where no hand spans the object.
    fn note(&self) -> Option<String> {
        let width = self.size().iter().copied().fold(f64::INFINITY, f64::min);
        let scale = self.args.scale * 0.06 / width;
        (width > 0.15).then(|| format!("no hand spans it; `scale = {scale:.2e}` makes its width 60 mm"))
    }

    /// The page that shows the object.
    fn page(&self) -> Result<String, Failure> {
        let name = self.args.file.file_name().unwrap_or_default().to_string_lossy();
        let facts = self.facts();
        object_page(&ObjectView {
            name: &name,
            mesh: self.mesh,
            twin: self.twin.as_ref(),
            p_OCm: self.mass.p_OCm.into(),
            fingertip_radius: self.args.fingertip_radius,
            facts: facts.into_iter().map(|(name, value)| (name.to_owned(), value)).collect(),
        })
        .map_err(Failure::bad_input)
    }
}
