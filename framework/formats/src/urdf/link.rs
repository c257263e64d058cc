//! `<link>`: shapes and mass.

use super::pose::origin;
use crate::error::RobotFault as Fault;
use crate::robot::{Geometry, Link, Solid};
use crate::xml::{Element, child, children, line, number, numbers, positive, text};
use roxmltree::Node;

pub(super) fn link(element: &Element<'_>) -> Result<Link, Fault> {
    let solids = |name: &'static str| {
        children(element, name).map(|child| solid(&child)).collect::<Result<Vec<_>, _>>()
    };
    Ok(Link {
        name: text(element, "name")?,
        line: line(element),
        collision: solids("collision"),
        visual: solids("visual"),
        mass: mass(element)?,
    })
}

/// The mass (kg) that the first `<inertial>` gives; ROS's own reader takes the first, too, and the ledger
/// tells of others.
fn mass(element: &Element<'_>) -> Result<Option<f64>, Fault> {
    let Some(inertial) = children(element, "inertial").next() else { return Ok(None) };
    child(&inertial, "mass")?.map_or(Ok(None), |mass| number(&mass, "value"))
}

fn solid(element: &Element<'_>) -> Result<Solid, Fault> {
    let tag = element.tag_name().name();
    let geometry = child(element, "geometry")?;
    let mut shapes = geometry.iter().flat_map(|geometry| geometry.children().filter(Node::is_element));
    let Some(shape) = shapes.next() else {
        return Err(Fault::at(line(element), format!("<{tag}> lacks a <geometry> with a shape in it")));
    };
    if let Some(second) = shapes.next() {
        let message = format!(
            "a second shape, <{}>, in one <geometry>: a geometry is one shape; give each a <{tag}> of its \
             own",
            second.tag_name().name()
        );
        return Err(Fault::at(line(&second), message));
    }
    Ok(Solid { line: line(&shape), X_LS: origin(element)?, geometry: self::geometry(&shape)? })
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

/// A length that must be there and positive (m).
fn length(element: &Element<'_>, name: &str) -> Result<f64, Fault> {
    text(element, name)?;
    positive(element, name, number(element, name)?.unwrap_or_default())
}
