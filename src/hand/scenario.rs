//! A scenario to start from: the hand as it was read, a ball where the fingers surround it best, turned by
//! 20°.

use super::{HandArgs, Understood, hand_file, options, write, xacro};
use crate::args::LibraryArgs;
use crate::outputs::SCENARIO_MARK;
use crate::{Failure, place, plugins};
use regrasp::api::{Hand, Vec3};
use regrasp::hands::HandOptions;
use regrasp::world::ObjectPlace;
use std::io::Write;
use std::path::{Path, PathBuf};

/// The hand file of a scenario that is written to `output`.
pub(super) fn beside(output: &Path) -> PathBuf {
    output.with_extension("hand.toml")
}

impl Understood<'_> {
    /// A scenario to start from, to be written to `output`; a hand that a xacro describes is written beside
    /// it.
    pub(super) fn scenario(&self, args: &HandArgs, output: &Path) -> Result<String, Failure> {
        if self.places.is_empty() {
            let message = format!(
                "no place was found at which all fingertips reach a ball of {:.0} mm; give the radius of \
                 another one (`--ball`)",
                2e3 * self.ball
            );
            return Err(Failure::bad_input(message));
        }
        let (options, hand_file_path) = (options(args), beside(output));
        let source = match xacro::is_needed(&args.file) {
            true => {
                write(&hand_file_path, &hand_file(self.hand.description())?)?;
                HandSource::HandFile(&hand_file_path)
            }
            false => HandSource::Robot(&args.file, &options),
        };
        let unplaced = Unplaced { source, output, ball: self.ball, fingers: self.hand.finger_count() };
        let (text, is_planned) = unplaced.placed(&self.places)?;
        if !is_planned {
            let note = "note: at none of the places that were tried a plan was found; change the ball's \
                        position, its radius (`--ball`) or the limits of the joints\n";
            let _ = std::io::stderr().write_all(note.as_bytes());
        }
        Ok(text)
    }
}

/// What the plan of such a scenario bears where the hand's efforts allow it.
const HOLD: &str = "\n[hold]\nfriction_factor = 0.8\n";

/// Where a scenario's hand comes from.
pub enum HandSource<'a> {
    /// The robot's own file, read with these options.
    Robot(&'a Path, &'a HandOptions),
    /// A hand file.
    HandFile(&'a Path),
}

/// A scenario that is yet to be placed.
pub struct Unplaced<'a> {
    pub source: HandSource<'a>,
    /// Where it will be written.
    pub output: &'a Path,
    /// Radius of the ball (m).
    pub ball: f64,
    /// Fingers that can hold.
    pub fingers: usize,
}

impl Unplaced<'_> {
    /// Its text with the ball at the best place that a plan is found for, and whether one was found; the best
    /// place by reach where none is.
    pub fn placed(&self, places: &[ObjectPlace]) -> Result<(String, bool), Failure> {
        let registry = plugins::registry(&LibraryArgs { load: Vec::new() })?;
        let name = self.output.display().to_string();
        let folder = self.output.parent().unwrap_or(Path::new(""));
        for hold in [HOLD, ""] {
            let text = |place| self.text(place, hold);
            if let Some(text) = place::that_plans((&name, folder), &registry, places, text)? {
                return Ok((text, true));
            }
        }
        let best = places.first().map(|place| place.p_HO).unwrap_or_default();
        Ok((self.text(best, ""), false))
    }

    fn text(&self, p: Vec3, hold: &str) -> String {
        let position = format!("[{:.4}, {:.4}, {:.4}]", p.x, p.y, p.z);
        let soft = match self.fingers {
            3 => {
                "\n# Three fingers: two hold while one moves, which takes soft contacts.\n\
                 [plugins.contact-model]\nuse = \"soft-finger\"\n"
            }
            _ => "",
        };
        format!(
            "{SCENARIO_MARK}\n[hand]\n{hand}\n[object]\nshape = {{ kind = \"sphere\", radius = {ball} }}\n\
             mass = 0.05\nfriction = 0.8\n{hold}\n[start]\npose = {{ position = {position} }}\n\n\
             [[goal]]\npose = {{ position = {position}, axis = [0.0, 0.0, 1.0], angle_deg = 20.0 }}\n{soft}",
            hand = self.hand(),
            ball = self.ball,
        )
    }

    /// The keys of `[hand]`.
    fn hand(&self) -> String {
        match self.source {
            HandSource::HandFile(file) => format!("file = {}\n", quoted(&seen_from(file, self.output))),
            HandSource::Robot(file, options) => {
                let is_mjcf = file.extension().is_some_and(|e| e.eq_ignore_ascii_case("xml"));
                let key = if is_mjcf { "mjcf" } else { "urdf" };
                let mut text = format!("{key} = {}\n", quoted(&seen_from(file, self.output)));
                given(&mut text, options, self.output);
                text
            }
        }
    }
}

/// The path of a file as one in the folder of `output` must name it.
fn seen_from(file: &Path, output: &Path) -> String {
    let beside = |path: &Path| path.parent().is_none_or(|folder| folder.as_os_str().is_empty());
    if beside(output) || file.is_absolute() {
        return file.display().to_string();
    }
    std::path::absolute(file).unwrap_or_else(|_| file.to_owned()).display().to_string()
}

fn quoted(text: &str) -> String {
    serde_json::to_string(text).unwrap_or_default()
}

/// The keys of `[hand]` that the command line gave.
fn given(text: &mut String, options: &HandOptions, output: &Path) {
    let mut put = |key: &str, value: Option<String>| {
        if let Some(value) = value {
            *text += &format!("{key} = {value}\n");
        }
    };
    let list = |all: &[String]| {
        let all: Vec<String> = all.iter().map(|one| quoted(one)).collect();
        (!all.is_empty()).then(|| format!("[{}]", all.join(", ")))
    };
    let number = |x: Option<f64>| x.map(|x| format!("{x:?}"));
    put("tips", list(&options.tips));
    put("fingertip_radius", number(options.fingertip_radius));
    put("tip_offset", (!options.tip_offset.is_empty()).then(|| format!("{:?}", options.tip_offset)));
    put("palm", options.palm.as_deref().map(quoted));
    put("keyframe", options.keyframe.as_deref().map(quoted));
    let packages: Vec<String> = options.packages.iter().map(|folder| seen_from(folder, output)).collect();
    put("packages", list(&packages));
    put("mesh_pieces", options.mesh_pieces.map(|n| n.to_string()));
    put("scale", number(options.scale));
    put("mesh_scale", number(options.mesh_scale));
    put("acceleration", number(options.acceleration));
    put("velocity", number(options.velocity));
    put("effort", number(options.effort));
    put("limits", options.limits.map(|range| format!("{range:?}")));
    for joint in &options.joints {
        *text += &format!("\n[[hand.joint]]\nname = {}\n", quoted(&joint.name));
        let each = [
            ("lower", joint.lower),
            ("upper", joint.upper),
            ("velocity", joint.velocity),
            ("effort", joint.effort),
            ("acceleration", joint.acceleration),
            ("position", joint.position),
        ];
        each.iter().filter_map(|(key, value)| Some((key, (*value)?))).for_each(|(key, value)| {
            *text += &format!("{key} = {value:?}\n");
        });
    }
}
