//! `<origin>`.

use crate::error::RobotFault as Fault;
use crate::xml::{Element, child, line, numbers};
use regrasp_api::{Pose, Rotation, Vec3};

/// The farthest (m) that anything lies from what it hangs on.
const FARTHEST: f64 = 1e4;
/// The largest angle (rad), some hundred turns: beyond, nobody means an angle.
const LARGEST_ANGLE: f64 = 1e3;

/// The pose that `<origin>` gives; the identity where there is none.
pub(super) fn origin(element: &Element<'_>) -> Result<Pose, Fault> {
    let Some(origin) = child(element, "origin")? else { return Ok(Pose::identity()) };
    let p = Vec3::from(within(&origin, "xyz", FARTHEST, "lengths are in metres")?.unwrap_or_default());
    let rotation = match numbers::<4>(&origin, "quat_xyzw")? {
        Some(_) if origin.has_attribute("rpy") => {
            return Err(Fault::at(line(&origin), "<origin>: give `rpy` or `quat_xyzw`, not both"));
        }
        Some([x, y, z, w]) => {
            let q = nalgebra::Quaternion::new(w, x, y, z);
            if !(1e-9..1e9).contains(&q.norm()) {
                return Err(Fault::at(line(&origin), "<origin>: `quat_xyzw` must be of about length 1"));
            }
            Rotation::from_quaternion(q)
        }
        None => {
            let [roll, pitch, yaw] =
                within(&origin, "rpy", LARGEST_ANGLE, "angles are in radians")?.unwrap_or_default();
            Rotation::from_euler_angles(roll, pitch, yaw)
        }
    };
    Ok(Pose::from_parts(p.into(), rotation))
}

fn within(element: &Element<'_>, name: &str, most: f64, hint: &str) -> Result<Option<[f64; 3]>, Fault> {
    let Some(values) = numbers::<3>(element, name)? else { return Ok(None) };
    match values.iter().find(|x| x.abs() > most) {
        None => Ok(Some(values)),
        Some(x) => {
            let message = format!("<origin {name}>: {x} is outside -{most}..={most}; {hint}");
            Err(Fault::at(line(element), message))
        }
    }
}
