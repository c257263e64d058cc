//! Scenario files: from TOML text to a checked problem with its plugins.
//!
//! A scenario is a file, or the name of a built-in one. Everything that a file can have wrong is a
//! [`ScenarioError`] with its place; start and goal grasps alone are left to the planner, which knows
//! stability and collision.

mod contact_surface;
mod document;
mod error;
mod file;
mod goals;
mod hand;
mod hold;
mod json;
mod library;

pub use error::*;
pub use file::*;
pub use goals::GoalList;
pub use hand::{LoadedHand, load_hand};
pub(crate) use hold::other_test;
pub use library::*;

pub use document::{Document, is_json, key_path};
use regrasp_api::{
    Hand, HandDescription, MeshSource, ObjectDescription, ObjectModel, ObjectShape, Problem, Refuse,
    SettingsError, Slot, Step, near,
};
use regrasp_formats::{embed_obstacles, read_mesh};
use regrasp_host::{Choices, HostError, Registry};
use regrasp_world::{
    ChainHand, WorldError, check_problem, check_size, check_units, load_object, object_of_mesh, rigid_body,
};
use serde_json::{Value, json};
use std::io::ErrorKind;
use std::path::Path;
use std::sync::Arc;

/// A checked scenario: it stands alone, with no file left to read.
#[derive(Clone)]
pub struct Scenario {
    /// What it is called.
    pub name: String,
    /// What it shows, in one line.
    pub summary: String,
    /// Where the problem comes from.
    pub source: String,
    /// What was published about it.
    pub paper: Option<PaperFigures>,
    /// The problem as plain data, meshes inside.
    pub problem: Problem,
    /// The problem's hand.
    pub hand: Arc<ChainHand>,
    /// The problem's object.
    pub object: ObjectModel,
    /// The plugins; those that the file names or sets have full ids and complete settings.
    pub choices: Choices,
    /// What was chosen because neither the scenario nor the files that it names say it: for a user to see.
    pub remarks: Vec<String>,
    document: Document,
}

impl Scenario {
    /// The place of a key in the scenario's file, for errors that are found later.
    pub fn place(&self, key: &str) -> Box<Place> {
        self.document.place(&key_path(key))
    }

    /// The refusal of something that was found wrong later, with the place of its key.
    pub fn refuse(&self, error: &impl Refuse) -> ScenarioError {
        self.document.refused(error)
    }
}

/// Loads the built-in scenario of this name, or else the file.
pub fn load(name: &str, registry: &Registry) -> Result<Scenario, ScenarioError> {
    with_text(name, |file, text, folder| from_text(file, text, folder, registry))
}

/// Loads it for work on grasps: start and goals may be missing, and `mesh`, a file, takes the place of the
/// object's shape where it is given. A scale that the scenario gives for a mesh stays.
pub fn load_for_grasps(
    name: &str,
    mesh: Option<&Path>,
    registry: &Registry,
) -> Result<Scenario, ScenarioError> {
    with_text(name, |file, text, folder| {
        let mut document = Document::parse(file, text)?;
        document.fill("start", json!({ "pose": {} }));
        document.fill("goal", json!([{ "pose": { "position": [1.0, 0.0, 0.0] } }]));
        if let Some(mesh) = mesh {
            document.put_mesh(mesh);
        }
        from_document(file, document, folder, registry)
    })
}

/// Hands the scenario's text on, with what messages call it, and the folder of the files that it names.
fn with_text(
    name: &str,
    read_text: impl Fn(&str, &str, &Path) -> Result<Scenario, ScenarioError>,
) -> Result<Scenario, ScenarioError> {
    if let Some(built_in) = find_scenario(name) {
        return read_text(built_in.name, built_in.text, Path::new(""));
    }
    let path = Path::new(name);
    let is_path = path.extension().is_some() || path.components().count() > 1 || path.exists();
    if !is_path {
        return Err(unknown("scenario", name, SCENARIOS));
    }
    let text = read(path).map_err(|error| with_hint(error, path))?;
    // The likeliest mistake: what a plan was made of, and the plan, are easily mixed up.
    if is_plan(&text) {
        let cause =
            "it is a plan, not a scenario; plan files are for `verify`, `view`, `export` and `replay`";
        return Err(ScenarioError::Unreadable { place: Place::file(name), cause: cause.into() });
    }
    read_text(name, &text, path.parent().unwrap_or(Path::new("")))
}

/// Whether a text is a plan file's.
fn is_plan(text: &str) -> bool {
    let format = |value: Value| value.get("format").and_then(Value::as_str) == Some("regrasp-plan");
    is_json(text) && serde_json::from_str(text).is_ok_and(format)
}

/// Reads a scenario from TOML or JSON text; `file` is what messages call it, `folder` where the files that
/// it names are looked for.
pub fn from_text(
    file: &str,
    text: &str,
    folder: &Path,
    registry: &Registry,
) -> Result<Scenario, ScenarioError> {
    from_document(file, Document::parse(file, text)?, folder, registry)
}

fn from_document(
    file: &str,
    document: Document,
    folder: &Path,
    registry: &Registry,
) -> Result<Scenario, ScenarioError> {
    let content: ScenarioFile = document.read()?;
    let mut choices = choices(&document, &content.plugins, registry)?;
    hold::apply(&document, &content, &mut choices)?;
    let hand::LoadedHand { hand, description, mut remarks, effortless } =
        hand::load(&document, &content.hand, folder)?;
    hold::ask_for_efforts(&document, &content, effortless)?;
    let mut problem = problem(&content, description);
    check_problem(&problem).map_err(|error| document.refused(&error))?;
    embed_obstacles(&mut problem.obstacle, folder).map_err(|error| document.refused(&error))?;
    let mut object = object(&document, &mut problem.object, folder, &mut remarks)?;
    check_units(&hand, &object, &content.object.shape).map_err(|error| document.refused(&error))?;
    let size = check_size(&hand, &object, &content.object.shape);
    remarks.extend(size.map_err(|error| document.refused(&error))?);
    remarks.extend(contact_surface::settle(&mut object, &content.object, hand.fingertip_radius(), folder));
    Ok(Scenario {
        name: content.name.clone().unwrap_or_else(|| stem(file)),
        summary: content.summary,
        source: content.source,
        paper: content.paper,
        problem,
        hand: Arc::new(hand),
        object,
        choices,
        remarks,
        document,
    })
}

/// The object; a mesh's file is looked for in `folder`, and written out in the description.
fn object(
    document: &Document,
    description: &mut ObjectDescription,
    folder: &Path,
    remarks: &mut Vec<String>,
) -> Result<ObjectModel, ScenarioError> {
    let ObjectShape::Mesh(source) = &mut description.shape else {
        return load_object(description).map_err(|error| document.refused(&error));
    };
    let read = read_mesh(source, folder, "object.shape").map_err(|error| document.refused(&error))?;
    let mut done = read.remarks();
    let body = rigid_body(read.mesh, description.assembly)
        .map_err(|fault| document.refused(&WorldError::Body { key: "object.shape".into(), fault }))?;
    done.extend(body.remarks());
    remarks.extend(done.into_iter().map(|remark| format!("the object's mesh: {remark}")));
    *source = MeshSource::of(&body.mesh);
    object_of_mesh(description, body.mesh).map_err(|error| document.refused(&error))
}

fn stem(file: &str) -> String {
    Path::new(file).file_stem().map_or(file.into(), |stem| stem.to_string_lossy().into_owned())
}

/// Says of a scenario file that is not there where to get one.
fn with_hint(error: ScenarioError, path: &Path) -> ScenarioError {
    let ScenarioError::Unreadable { place, cause } = error else { return error };
    if path.exists() {
        return ScenarioError::Unreadable { place, cause };
    }
    let stem = path.file_stem().and_then(|stem| stem.to_str()).unwrap_or_default();
    let hint = match find_scenario(stem) {
        Some(_) => format!("the built-in scenario is called `{stem}`"),
        None => "`scenarios sphere` prints a built-in one to start from".to_owned(),
    };
    ScenarioError::Unreadable { place, cause: format!("{cause}; {hint}") }
}

/// The largest scenario or hand file that is read (bytes): meshes may stand in them.
const MAX_BYTES: u64 = 256 << 20;

/// The text of a file, which must be UTF-8.
pub fn read(path: &Path) -> Result<String, ScenarioError> {
    let unreadable =
        |cause: String| ScenarioError::Unreadable { place: Place::file(&path.display().to_string()), cause };
    let bytes = regrasp_api::read_at_most(path, MAX_BYTES).map_err(|error| match error.kind() {
        ErrorKind::IsADirectory => unreadable("it is a folder; name the file in it".into()),
        _ => unreadable(error.to_string()),
    })?;
    String::from_utf8(bytes).map_err(|_| unreadable("it is not UTF-8 text".into()))
}

fn unknown(what: &'static str, name: &str, files: &'static [BuiltIn]) -> ScenarioError {
    let known: Vec<String> = files.iter().map(|file| file.name.to_owned()).collect();
    let near = near(name, known.iter().map(String::as_str));
    ScenarioError::Unknown { what, name: name.to_owned(), near, known }
}

fn problem(content: &ScenarioFile, hand: HandDescription) -> Problem {
    Problem {
        hand,
        object: content.object.clone(),
        obstacle: content.obstacle.clone(),
        gravity: content.gravity,
        start: content.start.clone(),
        goal: content.goal.clone(),
        workspace: content.workspace,
        hold: content.hold,
        limits: hold::limits(content),
    }
}

/// The plugins, each table checked so that an error has its line.
fn choices(
    document: &Document,
    tables: &PluginTables,
    registry: &Registry,
) -> Result<Choices, ScenarioError> {
    let mut choices = Choices::default();
    if let Some(name) = &tables.preset {
        let preset = regrasp_host::preset(name)
            .map_err(|error| document.refused(&error.refusal().told(&error).key("plugins.preset")))?;
        preset.apply(&mut choices);
    }
    for slot in Slot::ALL {
        let table = tables.table(slot);
        if table.id.is_none() && table.settings.is_empty() {
            continue;
        }
        if let Some(id) = &table.id {
            choices.use_plugin(slot, id);
        }
        for (key, value) in &table.settings {
            choices.set(slot, key, value.clone());
        }
        choices =
            choices.resolve_slot(registry, slot).map_err(|error| plugin_error(document, slot, error))?;
    }
    Ok(choices)
}

fn plugin_error(document: &Document, slot: Slot, error: HostError) -> ScenarioError {
    let mut path = key_path(&format!("plugins.{}", slot.name()));
    match &error {
        HostError::Settings { error: SettingsError::Departs(departure), .. } => {
            path.0.extend(departure.path.0.iter().cloned());
        }
        HostError::Settings { error: SettingsError::Value { key, .. }, .. } => path = path.key(key),
        HostError::UnknownPlugin { .. } | HostError::WrongSlot { .. } => path.0.push(Step::Key("use".into())),
        _ => {}
    }
    ScenarioError::Plugin { place: document.place(&path), error: Box::new(error) }
}

#[cfg(test)]
mod tests;
