//! `<joint>`: frame, axis, limits and drivers.

use super::pose::origin;
use crate::error::RobotFault as Fault;
use crate::robot::{Joint, Kind, Limit, Mimic, Soft};
use crate::xml::{Element, child, line, number, numbers, text};
use regrasp_api::Vec3;

/// By what a driver's position is multiplied at most.
const MULTIPLIER: f64 = 1e4;
/// What is added at most (rad; m).
const OFFSET: f64 = 1e3;

pub(super) fn joint(element: &Element<'_>) -> Result<Joint, Fault> {
    let name = text(element, "name")?;
    let kind = kind(element, &name)?;
    let end = |tag: &'static str| {
        let missing = || Fault::at(line(element), format!("joint `{name}` lacks its <{tag} link=\"…\"/>"));
        text(&child(element, tag)?.ok_or_else(missing)?, "link")
    };
    let axis = axis(element)?;
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
        limit: child(element, "limit")?.map(|limit| self::limit(&limit)).transpose()?,
        soft: child(element, "safety_controller")?.map(|soft| self::soft(&soft)).transpose()?,
        mimic: child(element, "mimic")?.map(|mimic| self::mimic(&mimic)).transpose()?,
        name,
    })
}

fn axis(element: &Element<'_>) -> Result<Vec3, Fault> {
    let Some(axis) = child(element, "axis")? else { return Ok(Vec3::x()) };
    text(&axis, "xyz")?;
    let xyz = Vec3::from(numbers::<3>(&axis, "xyz")?.unwrap_or_default());
    if xyz.amax() > 1e9 {
        let message = "<axis>: its numbers are a direction and should be about 1";
        return Err(Fault::at(line(&axis), message));
    }
    Ok(xyz)
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
            let message = format!("joint `{name}`: `type` = \"{other}\" is none of {known}");
            return Err(Fault::at(line(element), message));
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

fn soft(element: &Element<'_>) -> Result<Soft, Fault> {
    Ok(Soft {
        line: line(element),
        lower: number(element, "soft_lower_limit")?,
        upper: number(element, "soft_upper_limit")?,
    })
}

fn mimic(element: &Element<'_>) -> Result<Mimic, Fault> {
    Ok(Mimic {
        line: line(element),
        joint: text(element, "joint")?,
        multiplier: within(element, "multiplier", MULTIPLIER, "")?.unwrap_or(1.0),
        offset: within(element, "offset", OFFSET, "; angles are in radians, lengths in metres")?
            .unwrap_or(0.0),
    })
}

fn within(element: &Element<'_>, name: &str, most: f64, hint: &str) -> Result<Option<f64>, Fault> {
    match number(element, name)? {
        Some(x) if x.abs() > most => {
            let message = format!("<mimic {name}>: {x} is outside -{most}..={most}{hint}");
            Err(Fault::at(line(element), message))
        }
        given => Ok(given),
    }
}
