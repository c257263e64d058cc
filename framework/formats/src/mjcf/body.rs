//! `<body>`: links, and the joints between them.

use super::Reader;
use super::geom::{Role, role, solid};
use super::joint::{Hinge, hinge};
use super::tag::Tag;
use crate::error::RobotFault as Fault;
use crate::robot::{Joint, Kind, Link};
use regrasp_api::{Pose, Vec3};

/// What a body is in: its parent link, the frame of what holds it there, the class of what names none.
#[derive(Clone, Copy)]
pub(super) struct Place<'t> {
    pub parent: &'t str,
    pub X_PF: Pose,
    pub class: Option<&'t str>,
}

/// Elements inside bodies that planning does not need.
const IDLE: &[&str] = &["site", "camera", "light", "plugin", "inertial"];

/// The shapes of the world or a body, and the bodies in it.
pub(super) fn inside(
    tag: &Tag,
    place: Place<'_>,
    link: &mut Link,
    reader: &mut Reader<'_>,
) -> Result<(), Fault> {
    let class = tag.own("childclass").or(place.class);
    for child in &tag.children {
        match child.name.as_str() {
            "geom" => geom(child, class, &place.X_PF, link, reader)?,
            "body" => body(child, Place { class, ..place }, reader)?,
            "frame" => {
                let X_PF = place.X_PF * reader.compiler.pose(&reader.classes.of(child, None)?)?;
                inside(child, Place { X_PF, class, ..place }, link, reader)?;
            }
            "joint" | "freejoint" => {}
            "inertial" => {
                let mass = child.own("mass").map(|text| child.numbers_of("mass", text)).transpose()?;
                link.mass = mass.and_then(|numbers| numbers.first().copied());
            }
            name if IDLE.contains(&name) => reader.idle(child),
            "replicate" | "composite" | "flexcomp" | "attach" => {
                return Err(child.fault(format!("<{}> is not read: write out what it makes", child.name)));
            }
            _ => reader.unknown(child, &tag.name),
        }
    }
    Ok(())
}

fn geom(
    tag: &Tag,
    class: Option<&str>,
    X_LF: &Pose,
    link: &mut Link,
    reader: &mut Reader<'_>,
) -> Result<(), Fault> {
    let styled = reader.classes.of(tag, class)?;
    let place = |solid: crate::robot::Solid| crate::robot::Solid { X_LS: X_LF * solid.X_LS, ..solid };
    let list = match role(&styled)? {
        Role::Touches => &mut link.collision,
        Role::Seen => &mut link.visual,
        Role::None(kind) => {
            reader.remarks.push(format!(
                "a <geom type=\"{kind}\"> is no part of a hand and left out (line {})",
                tag.line
            ));
            return Ok(());
        }
    };
    let solid = solid(&styled, &reader.meshes, &reader.compiler).map(place);
    match (list.as_mut(), solid) {
        (Ok(all), Ok(solid)) => all.push(solid),
        (Ok(_), Err(fault)) => *list = Err(fault),
        (Err(_), _) => {}
    }
    Ok(())
}

fn body(tag: &Tag, place: Place<'_>, reader: &mut Reader<'_>) -> Result<(), Fault> {
    let name = tag.own("name").map_or_else(|| reader.nameless(tag.line), str::to_owned);
    let X_PB = place.X_PF * reader.compiler.pose(&reader.classes.of(tag, None)?)?;
    let class = tag.own("childclass").or(place.class);
    let mut hinges = Vec::new();
    for child in tag.children.iter().filter(|child| ["joint", "freejoint"].contains(&child.name.as_str())) {
        let styled = reader.classes.of(child, class)?;
        let fallback = format!("{name} joint {}", hinges.len() + 1);
        hinges.push(hinge(&styled, fallback, reader)?);
    }
    join(&hinges, &name, tag.line, place.parent, X_PB, reader);
    let mut link = link(&name, tag.line);
    let within = Place { parent: &name, X_PF: Pose::identity(), class: place.class };
    // The body stands before those in it, as in the file.
    let at = reader.robot.links.len();
    inside(tag, within, &mut link, reader)?;
    reader.robot.links.insert(at, link);
    Ok(())
}

/// The joints between a body and its parent, one after the other about their anchors; a fixed one where it
/// has none.
fn join(hinges: &[Hinge], body: &str, line: usize, parent: &str, X_PB: Pose, reader: &mut Reader<'_>) {
    let (mut parent, mut X) = (parent.to_owned(), X_PB);
    let last_anchor = hinges.last().map_or(Vec3::zeros(), |hinge| hinge.anchor);
    for (k, hinge) in hinges.iter().enumerate() {
        let is_last = k + 1 == hinges.len() && last_anchor == Vec3::zeros();
        let child = if is_last { body.to_owned() } else { format!("{body} behind {}", hinge.name) };
        if !is_last {
            reader.robot.links.push(link(&child, hinge.line));
        }
        let shift = Pose::from_parts(hinge.anchor.into(), Default::default());
        reader.robot.joints.push(joint(hinge, &parent, &child, X * shift));
        reader.coordinates.push((hinge.name.clone(), hinge.coordinates));
        reader.references.insert(hinge.name.clone(), hinge.reference);
        (parent, X) = (child, shift.inverse());
    }
    if hinges.is_empty() || last_anchor != Vec3::zeros() {
        let name = format!("{body} mount");
        let fixed = Joint {
            name,
            line,
            kind: Kind::Fixed,
            parent,
            child: body.to_owned(),
            X_PJ: X,
            axis: Vec3::x(),
            limit: None,
            soft: None,
            mimic: None,
        };
        reader.robot.joints.push(fixed);
    }
}

fn joint(hinge: &Hinge, parent: &str, child: &str, X_PJ: Pose) -> Joint {
    // The file's pose is that at the reference position.
    let back = match hinge.kind {
        Kind::Prismatic => Pose::from_parts((hinge.axis * -hinge.reference).into(), Default::default()),
        _ => Pose::from_parts(
            Default::default(),
            regrasp_api::Rotation::from_scaled_axis(hinge.axis * -hinge.reference),
        ),
    };
    Joint {
        name: hinge.name.clone(),
        line: hinge.line,
        kind: hinge.kind,
        parent: parent.to_owned(),
        child: child.to_owned(),
        X_PJ: X_PJ * back,
        axis: hinge.axis,
        limit: hinge.limit,
        soft: None,
        mimic: None,
    }
}

/// A link without shapes.
pub(super) fn link(name: &str, line: usize) -> Link {
    Link { name: name.to_owned(), line, collision: Ok(Vec::new()), visual: Ok(Vec::new()), mass: None }
}
