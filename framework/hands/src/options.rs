//! What a file does not say about a hand, or says wrongly.

use regrasp_formats::RobotFault as Fault;
use std::fmt;
use std::path::PathBuf;

/// What a robot's file does not say about a hand.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct HandOptions {
    /// The fingertip links, one a finger, in the order in which the fingers are counted; guessed where empty.
    pub tips: Vec<String>,
    /// Radius of the balls that stand for the fingertips (m); where absent, that of the tip links' own
    /// balls, or fitted to their shapes.
    pub fingertip_radius: Option<f64>,
    /// Centres of these balls in the tip links' frames (m): none (they are fitted), one for all, or one for
    /// each finger.
    pub tip_offset: Vec<[f64; 3]>,
    /// The link whose frame is the hand's; where absent, the last one that all fingertips hang on.
    pub palm: Option<String>,
    /// The posture of the file (key frame of an MJCF) in which joints stand that no finger has, and the
    /// fingers rest.
    pub keyframe: Option<String>,
    /// Folders in which packages are looked for.
    pub packages: Vec<PathBuf>,
    /// The most convex pieces that a mesh is taken apart into; its convex hull where absent or 1.
    pub mesh_pieces: Option<usize>,
    /// What all lengths of the file are multiplied with (no unit).
    pub scale: Option<f64>,
    /// What the coordinates of all meshes are multiplied with (no unit).
    pub mesh_scale: Option<f64>,
    /// The largest acceleration of every joint (rad/s²); where absent, what the file says, or else 20.
    pub acceleration: Option<f64>,
    /// The largest velocity (rad/s) of joints for which the file says none, or 0.
    pub velocity: Option<f64>,
    /// The largest effort (N·m) of joints for which the file says none, or 0.
    pub effort: Option<f64>,
    /// The range (rad) of joints for which the file says none, or one of no width.
    pub limits: Option<[f64; 2]>,
    /// What holds for joints by name, whatever the file says.
    pub joints: Vec<JointChoice>,
}

/// What holds for the joints of some names.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct JointChoice {
    /// A joint's name; `*` stands for any letters.
    pub name: String,
    /// Lowest position (rad; m), together with `upper`.
    pub lower: Option<f64>,
    /// Highest position (rad; m), together with `lower`.
    pub upper: Option<f64>,
    /// Largest speed (rad/s; m/s).
    pub velocity: Option<f64>,
    /// Largest effort (N·m; N).
    pub effort: Option<f64>,
    /// Largest acceleration (rad/s²; m/s²).
    pub acceleration: Option<f64>,
    /// Where the joint stands (rad; m) if it belongs to no finger.
    pub position: Option<f64>,
}

impl JointChoice {
    /// Whether it says no more than where a joint stands.
    pub(crate) fn is_position_only(&self) -> bool {
        let position = Self { name: self.name.clone(), position: self.position, ..Self::default() };
        *self == position
    }

    /// Whether a joint of this name is meant.
    pub fn matches(&self, name: &str) -> bool {
        is_like(self.name.as_bytes(), name.as_bytes())
    }
}

/// Whether a name fits a pattern in which `*` stands for any letters.
fn is_like(pattern: &[u8], name: &[u8]) -> bool {
    match pattern.split_first() {
        None => name.is_empty(),
        Some((b'*', rest)) => (0..=name.len()).any(|skipped| is_like(rest, &name[skipped..])),
        Some((letter, rest)) => name.first() == Some(letter) && is_like(rest, &name[1..]),
    }
}

impl fmt::Display for JointChoice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "`{}`", self.name)?;
        if let (Some(lower), Some(upper)) = (self.lower, self.upper) {
            write!(f, " from {lower} to {upper}")?;
        }
        let each = [
            ("velocity", self.velocity),
            ("effort", self.effort),
            ("acceleration", self.acceleration),
            ("position", self.position),
        ];
        each.iter().try_for_each(|(what, value)| match value {
            Some(value) => write!(f, " {what} {value}"),
            None => Ok(()),
        })
    }
}

/// Refuses numbers outside their ranges.
pub(crate) fn check(options: &HandOptions) -> Result<(), Fault> {
    within("fingertip_radius", options.fingertip_radius, (1e-4, 0.2), " m")?;
    within("scale", options.scale, (1e-6, 1e6), "")?;
    within("mesh_scale", options.mesh_scale, (1e-6, 1e6), "")?;
    within("acceleration", options.acceleration, (1e-3, 1e6), " rad/s²")?;
    within("velocity", options.velocity, (1e-3, 1e6), " rad/s")?;
    within("effort", options.effort, (1e-6, 1e6), " N·m")?;
    within("mesh_pieces", options.mesh_pieces.map(|n| n as f64), (1.0, 64.0), "")?;
    for offset in options.tip_offset.iter().flatten() {
        within("tip_offset", Some(*offset), (-10.0, 10.0), " m")?;
    }
    if let Some([lower, upper]) = options.limits {
        check_joint(&JointChoice {
            name: "*".into(),
            lower: Some(lower),
            upper: Some(upper),
            ..Default::default()
        })?;
    }
    options.joints.iter().try_for_each(check_joint)
}

fn check_joint(choice: &JointChoice) -> Result<(), Fault> {
    const TURNS: f64 = 4.0 * std::f64::consts::PI;
    of_joint("lower", choice.lower, (-TURNS, TURNS), " rad")?;
    of_joint("upper", choice.upper, (-TURNS, TURNS), " rad")?;
    of_joint("position", choice.position, (-TURNS, TURNS), " rad")?;
    of_joint("velocity", choice.velocity, (1e-3, 1e6), " rad/s")?;
    of_joint("effort", choice.effort, (1e-6, 1e6), " N·m")?;
    of_joint("acceleration", choice.acceleration, (1e-3, 1e6), " rad/s²")?;
    match (choice.lower, choice.upper) {
        (None, None) => Ok(()),
        (Some(lower), Some(upper)) if lower < upper => Ok(()),
        _ => Err(Fault::of_key(
            "joint",
            format!(
                "`joint.lower`: give `lower` and `upper` of `{}`, the first less than the second",
                choice.name
            ),
        )),
    }
}

fn within(key: &'static str, value: Option<f64>, range: (f64, f64), unit: &str) -> Result<(), Fault> {
    outside(key, value, range, unit).map_or(Ok(()), |message| Err(Fault::of_key(key, message)))
}

fn of_joint(name: &str, value: Option<f64>, range: (f64, f64), unit: &str) -> Result<(), Fault> {
    let message = outside(&format!("joint.{name}"), value, range, unit);
    message.map_or(Ok(()), |message| Err(Fault::of_key("joint", message)))
}

fn outside(key: &str, value: Option<f64>, (low, high): (f64, f64), unit: &str) -> Option<String> {
    let value = value.filter(|value| !(low..=high).contains(value))?;
    Some(format!("`{key}` = {value} is outside {low}..={high}{unit}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_star_stands_for_any_letters() {
        let matches = |pattern: &str, name: &str| {
            JointChoice { name: pattern.into(), ..Default::default() }.matches(name)
        };
        for (pattern, name) in
            [("*", "a"), ("f*", "f0"), ("*_j1", "thumb_j1"), ("f*_j*", "f0_j2"), ("a", "a"), ("*1*1", "111")]
        {
            assert!(matches(pattern, name), "{pattern} {name}");
        }
        for (pattern, name) in [("a", "ab"), ("f*", "g0"), ("*_j1", "thumb_j12"), ("", "a"), ("*1*1", "1")] {
            assert!(!matches(pattern, name), "{pattern} {name}");
        }
    }
}
