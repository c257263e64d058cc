//! The joints of a finger with their limits, drivers and frames.

use crate::fingers::Chain;
use crate::needs::{Needs, What};
use crate::options::HandOptions;
use crate::posture::{Posture, drive};
use crate::tree::Tree;
use regrasp_api::{JointDescription, JointKind, Mimic, Pose, PoseDescription};
use regrasp_formats::RobotFault as Fault;
use regrasp_formats::{Joint, Limit};
use std::f64::consts::PI;

/// The largest acceleration (rad/s²) of joints for which the file says none.
pub(crate) const ACCELERATION: f64 = 20.0;

/// The joints of one finger, without shapes; the first one's frame is the base's.
pub(crate) struct FingerJoints {
    pub base: PoseDescription,
    pub joints: Vec<JointDescription>,
    /// The tip link in the last joint's moved frame.
    pub X_LTip: Pose,
}

/// What the joints of a finger are read with.
pub(crate) struct JointReader<'a> {
    pub tree: &'a Tree<'a>,
    pub posture: &'a Posture,
    pub options: &'a HandOptions,
    pub notes: &'a mut Vec<String>,
    pub needs: &'a mut Needs,
}

impl JointReader<'_> {
    /// The joints of a chain.
    pub fn joints(&mut self, chain: &Chain) -> Result<FingerJoints, Fault> {
        let (mut joints, mut X) = (Vec::new(), Pose::identity());
        let mut base = Pose::identity();
        for &index in &chain.path {
            let joint = self.tree.joint(index);
            if !chain.moving.contains(&index) {
                X *= self.posture.pose(self.tree, index);
                continue;
            }
            X *= joint.X_PJ;
            let mut origin = X;
            if joints.is_empty() {
                (base, origin) = (X, Pose::identity());
            }
            joints.push(self.description(chain, joint, &origin)?);
            X = Pose::identity();
        }
        narrow(&mut joints, chain, self.tree, self.notes)?;
        Ok(FingerJoints { base: PoseDescription::from(&base), joints, X_LTip: X })
    }

    fn description(
        &mut self,
        chain: &Chain,
        joint: &Joint,
        origin: &Pose,
    ) -> Result<JointDescription, Fault> {
        let mimic = self.mimic(chain, joint)?;
        let has_range = joint.limit.is_some_and(|limit| limit.lower.is_some() && limit.upper.is_some());
        let limits = match &mimic {
            Some(mimic) if !has_range => self.driven_limits(mimic, joint),
            _ => self.own_limits(joint)?,
        };
        let still = *origin == Pose::identity();
        Ok(JointDescription {
            name: joint.name.clone(),
            kind: JointKind::Revolute,
            origin: if still { PoseDescription::default() } else { PoseDescription::from(origin) },
            axis: joint.axis.into(),
            lower: limits.lower,
            upper: limits.upper,
            velocity: limits.velocity,
            acceleration: self.options.acceleration.or(limits.acceleration).unwrap_or(ACCELERATION),
            effort: limits.effort,
            mimic,
            link: Vec::new(),
        })
    }

    /// Which joint of the same finger drives this one in the end.
    fn mimic(&self, chain: &Chain, joint: &Joint) -> Result<Option<Mimic>, Fault> {
        let (Some(first), Some(drive)) = (&joint.mimic, drive(self.tree, joint)?) else { return Ok(None) };
        let driver = &self.tree.joint(drive.joint).name;
        if chain.moving.contains(&drive.joint) {
            let (multiplier, offset) = (drive.multiplier, drive.offset);
            return Ok(Some(Mimic { joint: driver.clone(), multiplier, offset }));
        }
        let message = format!(
            "joint `{}` mimics `{driver}`, a joint of another finger; fingers must move on their own: \
             remove the <mimic>, make the joint \
             fixed, or leave one of the fingers out (`tips`)",
            joint.name
        );
        Err(Fault::at(first.line, message))
    }

    /// A joint's own limits: all must be given, in the file or by the options.
    fn own_limits(&mut self, joint: &Joint) -> Result<Limits, Fault> {
        let limit = joint.limit.unwrap_or(Limit { line: joint.line, ..Limit::default() });
        let (name, line) = (&joint.name, limit.line);
        let whole = joint.limit.is_none_or(|limit| limit.lower.is_none() && limit.upper.is_none());
        let mut need = |value: Option<f64>, what: What| {
            if value.is_none() {
                self.needs.joint(what, name, line);
            }
        };
        if whole {
            need(None, What::Limits);
        } else {
            need(limit.lower, What::Lower);
            need(limit.upper, What::Upper);
        }
        let (lower, upper) = (limit.lower.unwrap_or(-1.0), limit.upper.unwrap_or(1.0));
        let (lower, upper) = if whole { (-1.0, 1.0) } else { (lower, upper) };
        if lower >= upper || lower.abs().max(upper.abs()) > 4.0 * PI {
            let message = format!(
                "joint `{name}`: limits from {lower} to {upper} rad; `lower` must be less than `upper`, \
                 both within two turns (are they degrees?)"
            );
            return Err(Fault::at(line, message));
        }
        let velocity = self.rate(joint, line, "velocity", (limit.velocity, self.options.velocity))?;
        let effort = self.rate(joint, line, "effort", (limit.effort, self.options.effort))?;
        Ok(Limits { lower, upper, velocity, effort, acceleration: limit.acceleration.filter(|a| *a > 0.0) })
    }

    /// A joint's velocity or effort; where the file says none, or zero, as some exporters write for
    /// "unknown", what the options say.
    fn rate(
        &mut self,
        joint: &Joint,
        line: usize,
        what: &str,
        (own, given): (Option<f64>, Option<f64>),
    ) -> Result<f64, Fault> {
        let name = &joint.name;
        match (own, given) {
            (None | Some(0.0), Some(given)) => {
                self.notes
                    .push(format!("joint `{name}`: the file says no {what}; {given} is taken, as given"));
                Ok(given)
            }
            (Some(own), _) if own > 0.0 => Ok(own),
            (Some(own), _) if own < 0.0 => {
                Err(Fault::at(line, format!("joint `{name}`: `{what}` = {own} must be positive")))
            }
            (own, None | Some(_)) => {
                let what = match (what, own) {
                    ("velocity", None) => What::Velocity,
                    ("velocity", Some(_)) => What::NoVelocity,
                    (_, None) => What::Effort,
                    (_, Some(_)) => What::NoEffort,
                };
                self.needs.joint(what, name, line);
                Ok(1.0)
            }
        }
    }

    /// The limits of a driven joint for which the file gives no range: those of its driver, multiplied.
    fn driven_limits(&mut self, mimic: &Mimic, joint: &Joint) -> Limits {
        let driver =
            self.tree.joint(self.tree.joint_named(&mimic.joint).expect("the driver was looked up before"));
        let limit = driver.limit.unwrap_or_default();
        let at = |q: f64| mimic.multiplier * q + mimic.offset;
        let (a, b) = (at(limit.lower.unwrap_or(-1.0)), at(limit.upper.unwrap_or(1.0)));
        self.notes.push(format!(
            "joint `{}` has no limits of its own: those of `{}`, which drives it, are taken",
            joint.name, mimic.joint
        ));
        let times = mimic.multiplier.abs().max(1e-3);
        let own = joint.limit.unwrap_or_default();
        let filled = |own: Option<f64>, driver: Option<f64>, given: Option<f64>, times: f64| {
            let positive = |x: &f64| *x > 0.0;
            own.filter(positive).or(driver.filter(positive).or(given).map(|x| x * times)).unwrap_or(1.0)
        };
        Limits {
            lower: a.min(b) - 1e-9,
            upper: a.max(b) + 1e-9,
            velocity: filled(own.velocity, limit.velocity, self.options.velocity, times),
            effort: filled(own.effort, limit.effort, self.options.effort, 1.0 / times),
            acceleration: limit.acceleration.filter(|a| *a > 0.0).map(|acceleration| acceleration * times),
        }
    }
}

struct Limits {
    lower: f64,
    upper: f64,
    velocity: f64,
    effort: f64,
    acceleration: Option<f64>,
}

/// Narrows drivers whose range would push a driven joint beyond its limits.
fn narrow(
    joints: &mut [JointDescription],
    chain: &Chain,
    tree: &Tree<'_>,
    notes: &mut Vec<String>,
) -> Result<(), Fault> {
    for driven in 0..joints.len() {
        let Some(mimic) = joints[driven].mimic.clone() else { continue };
        let (name, ends) = (joints[driven].name.clone(), [joints[driven].lower, joints[driven].upper]);
        if mimic.multiplier == 0.0 {
            continue;
        }
        let driver =
            joints.iter_mut().find(|joint| joint.name == mimic.joint).expect("the driver is in the chain");
        let wanted = ends.map(|end| (end - mimic.offset) / mimic.multiplier);
        let (low, high) = (wanted[0].min(wanted[1]), wanted[0].max(wanted[1]));
        if low > driver.lower + 1e-9 || high < driver.upper - 1e-9 {
            (driver.lower, driver.upper) = (driver.lower.max(low), driver.upper.min(high));
            notes.push(format!(
                "the limits of joint `{}` are narrowed to {:.4}..={:.4} rad, so that `{name}`, which it \
                 drives, keeps its own",
                driver.name, driver.lower, driver.upper
            ));
        }
        if driver.lower >= driver.upper {
            let line = tree.joint(chain.moving[driven]).line;
            let message =
                format!("joint `{name}` cannot follow `{}` anywhere within its limits", driver.name);
            return Err(Fault::at(line, message));
        }
    }
    Ok(())
}
