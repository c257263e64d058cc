//! From XML to links and joints, each with its line: only what a hand needs.
//!
//! Format: "XML Robot Description Format (URDF)", ROS wiki, elements `robot`, `link`, `joint`. Numbers that are missing stay missing: what may be
//! left out, and what then holds, is decided by those who use them.

use crate::error::RobotFault as Fault;
use crate::robot::{Geometry, Joint, Kind, Limit, Link, Mimic, Robot, Solid};
use regrasp_api::{Pose, Rotation, Vec3};
use roxmltree::{Document, Node};

/// What to do with a file of macros.
const EXPAND: &str = "a xacro file must be expanded first, as by `xacro hand.urdf.xacro > hand.urdf`";

type Element<'a> = Node<'a, 'a>;

/// Reads the text of a URDF.
pub fn parse_urdf(text: &str) -> Result<Robot, Fault> {
    let document = Document::parse(text).map_err(|error| {
        let message = format!("not well-formed XML: {error}; {EXPAND}");
        Fault::at(error.pos().row as usize, message)
    })?;
    let root = document.root_element();
    if root.tag_name().name() != "robot" {
        let name = root.tag_name().name();
        return Err(Fault::at(
            line(&root),
            format!("the outermost element is <{name}>, a URDF's is <robot>"),
        ));
    }
    let name = root.attribute("name").unwrap_or("hand").to_owned();
    let mut model = Robot { name, links: Vec::new(), joints: Vec::new(), skipped: Vec::new() };
    for element in root.children().filter(Node::is_element) {
        if element.tag_name().namespace().is_some_and(|space| space.contains("xacro")) {
            return Err(Fault::at(line(&element), format!("a xacro macro is left in the file: {EXPAND}")));
        }
        match element.tag_name().name() {
            "link" => model.links.push(link(&element)?),
            "joint" => model.joints.push(joint(&element)?),
            other => model.skipped.push(other.to_owned()),
        }
    }
    Ok(model)
}

fn line(element: &Element<'_>) -> usize {
    element.document().text_pos_at(element.range().start).row as usize
}

fn child<'a>(element: &Element<'a>, name: &str) -> Option<Element<'a>> {
    element.children().find(|child| child.has_tag_name(name))
}

/// A required attribute.
fn text(element: &Element<'_>, name: &str) -> Result<String, Fault> {
    element.attribute(name).map(|text| text.trim().to_owned()).filter(|text| !text.is_empty()).ok_or_else(
        || {
            let tag = element.tag_name().name();
            Fault::at(line(element), format!("<{tag}> lacks the attribute `{name}`"))
        },
    )
}

/// Numbers of an attribute, exactly `N` of them and all finite; `None` where it is absent.
fn numbers<const N: usize>(element: &Element<'_>, name: &str) -> Result<Option<[f64; N]>, Fault> {
    let Some(text) = element.attribute(name) else { return Ok(None) };
    let read = text.split_whitespace().map(|word| word.parse::<f64>().ok().filter(|x| x.is_finite()));
    let numbers: Option<Vec<f64>> = read.collect();
    numbers.and_then(|numbers| numbers.try_into().ok()).map(Some).ok_or_else(|| {
        let (tag, count) =
            (element.tag_name().name(), if N == 1 { "one finite number" } else { "three finite numbers" });
        let hint = if text.contains(',') { ", with blanks between them, no commas" } else { "" };
        Fault::at(line(element), format!("<{tag} {name}=\"{text}\">: it must be {count}{hint}"))
    })
}

fn number(element: &Element<'_>, name: &str) -> Result<Option<f64>, Fault> {
    Ok(numbers::<1>(element, name)?.map(|[x]| x))
}

/// A length that must be there and positive (m).
fn length(element: &Element<'_>, name: &str) -> Result<f64, Fault> {
    text(element, name)?;
    let value = number(element, name)?.unwrap_or_default();
    positive(element, name, value)
}

fn positive(element: &Element<'_>, name: &str, value: f64) -> Result<f64, Fault> {
    if value > 0.0 && value < 1e3 {
        return Ok(value);
    }
    let tag = element.tag_name().name();
    Err(Fault::at(
        line(element),
        format!("<{tag}>: `{name}` = {value} m is outside (0, 1000); lengths are in metres"),
    ))
}

/// The pose that `<origin>` gives; the identity where there is none.
fn origin(element: &Element<'_>) -> Result<Pose, Fault> {
    let Some(origin) = child(element, "origin") else { return Ok(Pose::identity()) };
    let p = Vec3::from(numbers(&origin, "xyz")?.unwrap_or_default());
    let rotation = match numbers::<4>(&origin, "quat_xyzw")? {
        Some([x, y, z, w]) => {
            let q = nalgebra::Quaternion::new(w, x, y, z);
            if q.norm() < 1e-9 {
                return Err(Fault::at(line(&origin), "<origin>: `quat_xyzw` must not be zero"));
            }
            Rotation::from_quaternion(q)
        }
        None => {
            let [roll, pitch, yaw] = numbers(&origin, "rpy")?.unwrap_or_default();
            Rotation::from_euler_angles(roll, pitch, yaw)
        }
    };
    Ok(Pose::from_parts(p.into(), rotation))
}

fn link(element: &Element<'_>) -> Result<Link, Fault> {
    let solids = |name: &'static str| {
        let all = element.children().filter(move |child| child.has_tag_name(name));
        all.map(|child| solid(&child)).collect::<Result<Vec<_>, _>>()
    };
    Ok(Link {
        name: text(element, "name")?,
        line: line(element),
        collision: solids("collision"),
        visual: solids("visual"),
    })
}

fn solid(element: &Element<'_>) -> Result<Solid, Fault> {
    let shape = child(element, "geometry").and_then(|geometry| geometry.children().find(Node::is_element));
    let Some(shape) = shape else {
        let tag = element.tag_name().name();
        return Err(Fault::at(line(element), format!("<{tag}> lacks a <geometry> with a shape in it")));
    };
    Ok(Solid { line: line(&shape), X_LS: origin(element)?, geometry: geometry(&shape)? })
}

fn geometry(shape: &Element<'_>) -> Result<Geometry, Fault> {
    Ok(match shape.tag_name().name() {
        "box" => {
            text(shape, "size")?;
            let size = numbers(shape, "size")?.unwrap_or_default();
            size.iter().try_for_each(|&edge| positive(shape, "size", edge).map(|_| ()))?;
            Geometry::Box { size }
        }
        "sphere" => Geometry::Sphere { radius: length(shape, "radius")? },
        "cylinder" => {
            Geometry::Cylinder { radius: length(shape, "radius")?, length: length(shape, "length")? }
        }
        "capsule" => Geometry::Capsule { radius: length(shape, "radius")?, length: length(shape, "length")? },
        "mesh" => {
            let scale = numbers(shape, "scale")?.unwrap_or([1.0; 3]);
            if scale.contains(&0.0) {
                return Err(Fault::at(line(shape), "<mesh>: no number of `scale` may be zero"));
            }
            Geometry::Mesh { file: text(shape, "filename")?, scale }
        }
        other => {
            let message = format!("<{other}> is no shape; known are box, sphere, cylinder, capsule and mesh");
            return Err(Fault::at(line(shape), message));
        }
    })
}

fn joint(element: &Element<'_>) -> Result<Joint, Fault> {
    let name = text(element, "name")?;
    let kind = kind(element, &name)?;
    let end = |tag: &str| {
        let missing = || Fault::at(line(element), format!("joint `{name}` lacks its <{tag} link=\"…\"/>"));
        text(&child(element, tag).ok_or_else(missing)?, "link")
    };
    let axis = match child(element, "axis") {
        Some(axis) => {
            text(&axis, "xyz")?;
            Vec3::from(numbers(&axis, "xyz")?.unwrap_or_default())
        }
        None => Vec3::x(),
    };
    if kind != Kind::Fixed && axis.norm() < 1e-9 {
        let message = format!("joint `{name}`: its axis is zero; give a direction, such as xyz=\"0 1 0\"");
        return Err(Fault::at(line(element), message));
    }
    Ok(Joint {
        line: line(element),
        kind,
        parent: end("parent")?,
        child: end("child")?,
        X_PJ: origin(element)?,
        axis: axis.try_normalize(1e-9).unwrap_or_else(Vec3::x),
        limit: child(element, "limit").map(|limit| self::limit(&limit)).transpose()?,
        mimic: child(element, "mimic").map(|mimic| self::mimic(&mimic)).transpose()?,
        name,
    })
}

fn kind(element: &Element<'_>, name: &str) -> Result<Kind, Fault> {
    Ok(match text(element, "type")?.as_str() {
        "fixed" => Kind::Fixed,
        "revolute" => Kind::Revolute,
        "continuous" => Kind::Continuous,
        "prismatic" => Kind::Prismatic,
        "floating" | "planar" | "spherical" => Kind::Other,
        other => {
            let known = "fixed, revolute, continuous, prismatic, floating, planar";
            return Err(Fault::at(
                line(element),
                format!("joint `{name}`: `type` = \"{other}\" is none of {known}"),
            ));
        }
    })
}

fn limit(element: &Element<'_>) -> Result<Limit, Fault> {
    Ok(Limit {
        line: line(element),
        lower: number(element, "lower")?,
        upper: number(element, "upper")?,
        velocity: number(element, "velocity")?,
        effort: number(element, "effort")?,
        acceleration: number(element, "acceleration")?,
    })
}

fn mimic(element: &Element<'_>) -> Result<Mimic, Fault> {
    Ok(Mimic {
        line: line(element),
        joint: text(element, "joint")?,
        multiplier: number(element, "multiplier")?.unwrap_or(1.0),
        offset: number(element, "offset")?.unwrap_or(0.0),
    })
}
