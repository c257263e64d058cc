//! What of a URDF has no say: every element and attribute is used, listed with its line, or refused.

use crate::error::RobotFault as Fault;
use crate::xml::{EXPAND, Element, children, line, places};
use std::collections::BTreeMap;

/// What was not used.
#[derive(Debug, Default)]
pub(super) struct Ledger {
    /// What is not known and might have been meant to change the hand.
    pub remarks: Vec<String>,
    /// What is known, and says nothing that planning needs.
    pub ignored: Vec<String>,
}

/// What is known of one kind of element.
struct Known {
    name: &'static str,
    /// Attributes that are used.
    attributes: &'static [&'static str],
    /// Elements inside that are used.
    elements: &'static [&'static str],
    /// Attributes and elements that say nothing that planning needs.
    idle: &'static [&'static str],
}

const SHAPES: &[&str] = &["box", "sphere", "cylinder", "capsule", "mesh"];

#[rustfmt::skip]
const KNOWN: &[Known] = &[
    Known { name: "robot", attributes: &["name"], elements: &["link", "joint"],
        idle: &["version", "material", "transmission", "gazebo", "ros2_control", "sensor", "group",
            "disable_collisions"] },
    Known { name: "link", attributes: &["name"], elements: &["collision", "visual", "inertial"],
        idle: &["type"] },
    Known { name: "inertial", attributes: &[], elements: &["mass"], idle: &["origin", "inertia"] },
    Known { name: "mass", attributes: &["value"], elements: &[], idle: &[] },
    Known { name: "collision", attributes: &[], elements: &["origin", "geometry"],
        idle: &["name", "group", "material"] },
    Known { name: "visual", attributes: &[], elements: &["origin", "geometry"],
        idle: &["name", "group", "material"] },
    Known { name: "geometry", attributes: &[], elements: SHAPES, idle: &["name"] },
    Known { name: "box", attributes: &["size"], elements: &[], idle: &[] },
    Known { name: "sphere", attributes: &["radius"], elements: &[], idle: &[] },
    Known { name: "cylinder", attributes: &["radius", "length"], elements: &[], idle: &[] },
    Known { name: "capsule", attributes: &["radius", "length"], elements: &[], idle: &[] },
    Known { name: "mesh", attributes: &["filename", "scale"], elements: &[], idle: &["name"] },
    Known { name: "origin", attributes: &["xyz", "rpy", "quat_xyzw"], elements: &[], idle: &[] },
    Known { name: "joint", attributes: &["name", "type"],
        elements: &["origin", "parent", "child", "axis", "limit", "mimic", "safety_controller"],
        idle: &["dynamics", "calibration", "hardwareInterface"] },
    Known { name: "parent", attributes: &["link"], elements: &[], idle: &[] },
    Known { name: "child", attributes: &["link"], elements: &[], idle: &[] },
    Known { name: "axis", attributes: &["xyz"], elements: &[], idle: &[] },
    Known { name: "limit", attributes: &["lower", "upper", "velocity", "effort", "acceleration"],
        elements: &[], idle: &[] },
    Known { name: "mimic", attributes: &["joint", "multiplier", "offset"], elements: &[], idle: &[] },
    Known { name: "safety_controller", attributes: &["soft_lower_limit", "soft_upper_limit"], elements: &[],
        idle: &["k_position", "k_velocity"] },
];

/// Names of xacro's own elements, which old files write without its prefix.
const MACROS: &[&str] =
    &["macro", "include", "property", "arg", "insert_block", "if", "unless", "call", "attribute"];

/// Goes through the whole file; what a macro left behind is refused.
pub(super) fn account(root: &Element<'_>) -> Result<Ledger, Fault> {
    let mut lines = Lines::default();
    visit(root, &mut lines)?;
    let say = |(what, lines): (String, Vec<usize>)| format!("{what} ({})", places(&lines));
    Ok(Ledger {
        remarks: lines.unknown.into_iter().map(say).collect(),
        ignored: lines.idle.into_iter().map(say).collect(),
    })
}

/// What is not used, each kind with the lines where it stands.
#[derive(Default)]
struct Lines {
    unknown: BTreeMap<String, Vec<usize>>,
    idle: BTreeMap<String, Vec<usize>>,
}

fn visit(element: &Element<'_>, lines: &mut Lines) -> Result<(), Fault> {
    let tag = element.tag_name().name();
    let known = KNOWN.iter().find(|known| known.name == tag).expect("only known elements are visited");
    refuse_unfilled(element)?;
    for attribute in element.attributes() {
        let name = attribute.name();
        if known.attributes.contains(&name) {
            continue;
        }
        let what = format!("`{name}` of <{tag}>");
        lines.note(what, known.idle.contains(&name), nearest(name, known.attributes), line(element));
    }
    if let Some(second) = children(element, "inertial").nth(1) {
        lines
            .unknown
            .entry("a second <inertial> in one <link>: the first counts".into())
            .or_default()
            .push(line(&second));
    }
    let inside = element.children().filter(|child| child.is_element());
    for child in inside {
        refuse_macro(&child, tag)?;
        let name = child.tag_name().name();
        // What is no shape at all is refused where it is read.
        if known.elements.contains(&name) || (tag == "geometry" && !KNOWN.iter().any(|k| k.name == name)) {
            if KNOWN.iter().any(|known| known.name == name) {
                visit(&child, lines)?;
            }
            continue;
        }
        for below in child.descendants().filter(|below| below.is_element()) {
            refuse_prefixed(&below, tag)?;
            refuse_unfilled(&below)?;
        }
        let what = format!("<{name}> in <{tag}>");
        lines.note(what, known.idle.contains(&name), nearest(name, known.elements), line(&child));
    }
    Ok(())
}

impl Lines {
    fn note(&mut self, what: String, idle: bool, near: Option<&str>, line: usize) {
        let what = match near {
            Some(near) if !idle => format!("{what}: not known, not used; is `{near}` meant?"),
            _ if !idle => format!("{what}: not known, not used"),
            _ => what,
        };
        let list = if idle { &mut self.idle } else { &mut self.unknown };
        list.entry(what).or_default().push(line);
    }
}

/// A known name that differs by little more than case or two letters.
fn nearest<'n>(name: &str, known: &[&'n str]) -> Option<&'n str> {
    let lower = name.to_ascii_lowercase();
    let apart = |other: &&str| strsim::damerau_levenshtein(&lower, other);
    known.iter().copied().min_by_key(apart).filter(|best| apart(best) <= 2 && best.len() > 2)
}

/// Refuses attributes that a macro should have filled in.
fn refuse_unfilled(element: &Element<'_>) -> Result<(), Fault> {
    let unfilled = element.attributes().find(|attribute| {
        attribute.namespace().is_some_and(|space| space.contains("xacro")) || is_macro_text(attribute.value())
    });
    let Some(attribute) = unfilled else { return Ok(()) };
    let (tag, name, value) = (element.tag_name().name(), attribute.name(), attribute.value());
    let message = format!("<{tag} {name}=\"{value}\">: what a macro should have filled in; {EXPAND}");
    Err(Fault::at(line(element), message))
}

fn is_macro_text(value: &str) -> bool {
    value.contains("${") || value.contains("$(")
}

fn refuse_macro(element: &Element<'_>, around: &str) -> Result<(), Fault> {
    refuse_prefixed(element, around)?;
    let name = element.tag_name().name();
    if MACROS.contains(&name) { Err(left_behind(element, around)) } else { Ok(()) }
}

fn refuse_prefixed(element: &Element<'_>, around: &str) -> Result<(), Fault> {
    let space = element.tag_name().namespace().unwrap_or_default();
    let prefixed = space.contains("xacro") || element.lookup_prefix(space) == Some("xacro");
    if prefixed { Err(left_behind(element, around)) } else { Ok(()) }
}

fn left_behind(element: &Element<'_>, around: &str) -> Fault {
    let name = element.tag_name().name();
    Fault::at(line(element), format!("a xacro macro, `{name}`, is left in the <{around}>: {EXPAND}"))
}
