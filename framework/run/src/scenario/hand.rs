//! The hand of a scenario: a built-in one, a hand file, or a URDF.

use super::document::{Document, key_path};
use super::{HANDS, HandChoice, JointTable, Place, ScenarioError, find, read, unknown};
use regrasp_api::{HandDescription, Refuse};
use regrasp_formats::{RobotFileError, embed_hand};
use regrasp_hands::{HandOptions, HandReport, JointChoice, ReadHand, implausible_rates, read_hand};
use regrasp_world::ChainHand;
use schemars::JsonSchema;
use serde::Deserialize;
use std::path::{Path, PathBuf};

/// A hand that was built and checked.
pub struct LoadedHand {
    /// Its kinematics.
    pub hand: ChainHand,
    /// With all meshes inside.
    pub description: HandDescription,
    /// What a user should know of how the file was understood.
    pub remarks: Vec<String>,
    /// The first joint to which its file gives no effort, as a sentence calls it: what it can do is a guess.
    pub effortless: Option<String>,
}

/// A hand by itself.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct HandAlone {
    hand: HandChoice,
}

/// A hand by itself: `text` is the table `hand` of a scenario under that key, as JSON or TOML; files are
/// looked for in `folder`.
pub fn load_hand(text: &str, folder: &Path) -> Result<LoadedHand, ScenarioError> {
    let document = Document::parse("hand", text)?;
    let HandAlone { hand } = document.read()?;
    // The text is nobody's file: a wrong name is told without a place in it.
    if let Some(name) = hand.builtin.as_deref().filter(|name| find(HANDS, name).is_none()) {
        return Err(unknown("hand", name, HANDS));
    }
    load(&document, &hand, folder)
}

/// The hand that the scenario names; files are looked for in `folder`.
pub(super) fn load(
    scenario: &Document,
    choice: &HandChoice,
    folder: &Path,
) -> Result<LoadedHand, ScenarioError> {
    if choice.robot().is_none()
        && let Some(key) = choice.reading_key()
    {
        let message =
            format!("`{key}` says how a URDF or MJCF is to be read; give `urdf` or `mjcf` too, or remove it");
        return Err(scenario.refuse(&key_path(&format!("hand.{key}")), message));
    }
    match (&choice.builtin, &choice.file, choice.robot()) {
        (Some(name), None, None) => {
            let built_in =
                find(HANDS, name).ok_or_else(|| scenario.refused(&unknown("hand", name, HANDS)))?;
            described(Document::parse(built_in.name, built_in.text)?, Path::new(""))
        }
        (None, Some(file), None) => {
            let path = folder.join(file);
            let document = Document::parse(&path.display().to_string(), &read(&path)?)?;
            let mut loaded = described(document, path.parent().unwrap_or(Path::new("")))?;
            let file = path.display();
            let unlikely = implausible_rates(&loaded.description);
            loaded.remarks.extend(unlikely.into_iter().map(|remark| format!("{file}: {remark}")));
            Ok(loaded)
        }
        (None, None, Some(file)) => from_robot(scenario, choice, &folder.join(file), folder),
        _ => {
            let message = "give one of `builtin` (the name of a built-in hand), `file` (a hand file), \
             `urdf` and `mjcf`"
                .to_owned();
            Err(scenario.refuse(&key_path("hand"), message))
        }
    }
}

fn described(document: Document, folder: &Path) -> Result<LoadedHand, ScenarioError> {
    let mut description: HandDescription = document.read()?;
    embed_hand(&mut description, folder).map_err(|error| document.refused(&error))?;
    let hand = ChainHand::new(description.clone()).map_err(|error| document.refused(&error))?;
    let effortless = effortless(&document, &description);
    Ok(LoadedHand { hand, description, remarks: Vec::new(), effortless })
}

/// The first joint that moves by itself and has no effort in the file.
fn effortless(document: &Document, description: &HandDescription) -> Option<String> {
    let fingers = description.finger.iter().enumerate();
    let mut joints = fingers.flat_map(|(f, finger)| {
        finger
            .joint
            .iter()
            .enumerate()
            .map(move |(j, joint)| (format!("finger[{f}].joint[{j}].effort"), joint))
    });
    let (key, joint) = joints.find(|(key, joint)| joint.mimic.is_none() && !document.has(&key_path(key)))?;
    Some(format!("joint `{}` of `{}` (`{key}`)", joint.name, description.name))
}

fn from_robot(
    scenario: &Document,
    choice: &HandChoice,
    path: &Path,
    folder: &Path,
) -> Result<LoadedHand, ScenarioError> {
    let ReadHand { description, report } =
        read_hand(path, &choice.options(folder)).map_err(|error| robot_refused(scenario, error))?;
    let hand = ChainHand::new(description.clone()).map_err(|error| scenario.refused(&error))?;
    Ok(LoadedHand { hand, description, remarks: remarks(path, &report), effortless: None })
}

/// What was chosen because the scenario does not say it.
fn remarks(path: &Path, report: &HandReport) -> Vec<String> {
    let file = path.display();
    let guess = report.tips_guessed.then(|| {
        format!(
            "{file}: fingertips guessed: tips = {:?}; `regrasp hand {file}` shows the whole hand",
            report.tips
        )
    });
    let notes = report.notes.iter().map(|note| format!("{file}: {note}"));
    guess.into_iter().chain(notes).collect()
}

/// A robot file's fault with its own place; what concerns the file as a whole, with the scenario's key.
fn robot_refused(scenario: &Document, error: RobotFileError) -> ScenarioError {
    let file = error.file.display().to_string();
    let refusal = error.refusal();
    let Some(line) = error.line else {
        let message = format!("{} (reading {file})", error.message);
        let file_key = if scenario.has(&key_path("hand.mjcf")) { "mjcf" } else { "urdf" };
        let key = format!("hand.{}", error.key.unwrap_or(file_key));
        return scenario.refused(&refusal.told(&message).key(key));
    };
    let text = std::fs::read_to_string(&error.file).unwrap_or_default();
    let excerpt = text.lines().nth(line - 1).unwrap_or_default().trim_end().chars().take(120).collect();
    let place = Box::new(Place { file, key: String::new(), line: Some(line), excerpt });
    ScenarioError::Value { place, refusal: Box::new(refusal) }
}

impl HandChoice {
    /// The keys that say how a URDF or MJCF is read.
    const READING_KEYS: [&'static str; 14] = [
        "tips",
        "fingertip_radius",
        "tip_offset",
        "palm",
        "keyframe",
        "packages",
        "mesh_pieces",
        "scale",
        "mesh_scale",
        "acceleration",
        "velocity",
        "effort",
        "limits",
        "joint",
    ];

    /// The robot's file, URDF or MJCF; `None` where there is none, or both.
    fn robot(&self) -> Option<&String> {
        match (&self.urdf, &self.mjcf) {
            (Some(_), Some(_)) => None,
            (urdf, mjcf) => urdf.as_ref().or(mjcf.as_ref()),
        }
    }

    /// The first of these keys that is given.
    fn reading_key(&self) -> Option<&'static str> {
        let given = [
            !self.tips.is_empty(),
            self.fingertip_radius.is_some(),
            !self.tip_offset.is_empty(),
            self.palm.is_some(),
            self.keyframe.is_some(),
            !self.packages.is_empty(),
            self.mesh_pieces.is_some(),
            self.scale.is_some(),
            self.mesh_scale.is_some(),
            self.acceleration.is_some(),
            self.velocity.is_some(),
            self.effort.is_some(),
            self.limits.is_some(),
            !self.joint.is_empty(),
        ];
        Self::READING_KEYS.into_iter().zip(given).find_map(|(key, given)| given.then_some(key))
    }

    fn options(&self, folder: &Path) -> HandOptions {
        HandOptions {
            tips: self.tips.clone(),
            fingertip_radius: self.fingertip_radius,
            tip_offset: self.tip_offset.clone(),
            palm: self.palm.clone(),
            keyframe: self.keyframe.clone(),
            packages: self.packages.iter().map(|package| -> PathBuf { folder.join(package) }).collect(),
            mesh_pieces: self.mesh_pieces,
            scale: self.scale,
            mesh_scale: self.mesh_scale,
            acceleration: self.acceleration,
            velocity: self.velocity,
            effort: self.effort,
            limits: self.limits,
            joints: self.joint.iter().map(JointTable::choice).collect(),
        }
    }
}

impl JointTable {
    fn choice(&self) -> JointChoice {
        let Self { name, lower, upper, velocity, effort, acceleration, position } = self.clone();
        JointChoice { name, lower, upper, velocity, effort, acceleration, position }
    }
}
