//! A scenario to start from: the hand as it was read, a ball where the fingers surround it best, turned by
//! 20°.

use crate::outputs::SCENARIO_MARK;
use regrasp::hands::HandOptions;
use regrasp::world::ObjectPlace;
use std::fmt::Write;
use std::path::Path;

/// The text of a scenario that lies at `output`; `fingers` can hold.
pub fn text(
    file: &Path,
    output: &Path,
    options: &HandOptions,
    place: &ObjectPlace,
    (ball, fingers): (f64, usize),
) -> String {
    let p = place.p_HO;
    let position = format!("[{:.4}, {:.4}, {:.4}]", p.x, p.y, p.z);
    let key = if file.extension().is_some_and(|e| e.eq_ignore_ascii_case("xml")) { "mjcf" } else { "urdf" };
    let mut text = format!("{SCENARIO_MARK}\n[hand]\n{key} = {}\n", quoted(&seen_from(file, output)));
    given(&mut text, options, output);
    write!(
        text,
        "\n[object]\nshape = {{ kind = \"sphere\", radius = {ball} }}\nmass = 0.05\nfriction = \
         0.8\n\n[start]\npose = {{ position = {position} }}\n\n\
         [[goal]]\npose = {{ position = {position}, axis = [0.0, 0.0, 1.0], angle_deg = 20.0 }}\n"
    )
    .expect("writing to a text does not fail");
    if fingers == 3 {
        text += "\n# Three fingers: two hold while one moves, which takes soft \
         contacts.\n[plugins.contact-model]\nuse = \"soft-finger\"\n";
    }
    text
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
