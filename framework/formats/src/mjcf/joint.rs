//! `<joint>`, and what equality constraints and actuators say of joints.

use super::Reader;
use super::classes::Styled;
use super::tag::Tag;
use crate::error::RobotFault as Fault;
use crate::robot::{Kind, Limit, Mimic};
use regrasp_api::Vec3;
use std::collections::BTreeMap;

/// A joint as it stands in its body.
#[derive(Debug)]
pub(super) struct Hinge {
    pub name: String,
    pub line: usize,
    pub kind: Kind,
    /// In the body's frame (m).
    pub anchor: Vec3,
    pub axis: Vec3,
    /// The position (rad; m) at which the body stands as the file has it.
    pub reference: f64,
    pub limit: Option<Limit>,
    /// How many numbers of a keyframe it takes.
    pub coordinates: usize,
}

pub(super) fn hinge(styled: &Styled<'_>, fallback: String, reader: &Reader<'_>) -> Result<Hinge, Fault> {
    let tag = styled.tag;
    let name = tag.own("name").map_or(fallback, str::to_owned);
    let (kind, coordinates) = match (tag.name.as_str(), styled.text("type").unwrap_or("hinge")) {
        ("freejoint", _) | (_, "free") => (Kind::Other, 7),
        (_, "ball") => (Kind::Other, 4),
        (_, "slide") => (Kind::Prismatic, 1),
        (_, "hinge") => (Kind::Revolute, 1),
        (_, other) => return Err(tag.fault(format!("joint `{name}`: type=\"{other}\" is not known"))),
    };
    let axis = Vec3::from(styled.numbers::<3>("axis")?.unwrap_or([0.0, 0.0, 1.0]));
    let axis =
        axis.try_normalize(1e-9).ok_or_else(|| tag.fault(format!("joint `{name}`: its axis is zero")))?;
    let unit = |x: f64| if kind == Kind::Revolute { reader.compiler.angle(x) } else { x };
    let range = styled.numbers::<2>("range")?.filter(|_| is_limited(styled, "limited", "range", reader));
    let force = styled
        .numbers::<2>("actuatorfrcrange")?
        .filter(|_| is_limited(styled, "actuatorfrclimited", "actuatorfrcrange", reader));
    let limit = Limit {
        line: tag.line,
        lower: range.map(|[low, _]| unit(low)),
        upper: range.map(|[_, high]| unit(high)),
        effort: force.map(|[low, high]| low.abs().max(high.abs())),
        ..Limit::default()
    };
    Ok(Hinge {
        line: tag.line,
        kind: if kind == Kind::Revolute && range.is_none() { Kind::Continuous } else { kind },
        anchor: Vec3::from(styled.numbers::<3>("pos")?.unwrap_or_default()),
        axis,
        reference: unit(styled.number("ref")?.unwrap_or(0.0)),
        limit: Some(limit),
        coordinates,
        name,
    })
}

/// Whether a range counts: said so, or given while limits are automatic.
fn is_limited(styled: &Styled<'_>, flag: &str, range: &str, reader: &Reader<'_>) -> bool {
    match styled.text(flag) {
        Some("true") => true,
        Some("false") => false,
        _ => reader.compiler.auto_limits && styled.text(range).is_some(),
    }
}

/// What `<equality>` couples, by the joint that follows; what it holds still, with where.
#[derive(Debug, Default)]
pub(super) struct Couplings {
    pub mimic: BTreeMap<String, Mimic>,
    pub still: BTreeMap<String, f64>,
}

pub(super) fn couplings(
    root: &Tag,
    reader: &Reader<'_>,
    references: &BTreeMap<String, f64>,
) -> Result<Couplings, Fault> {
    let mut couplings = Couplings::default();
    for tag in root.all("equality").flat_map(|equality| equality.all("joint")) {
        let styled = reader.classes.of(tag, None)?;
        if styled.text("active") == Some("false") {
            continue;
        }
        let first = tag.own("joint1").ok_or_else(|| tag.fault("<joint> in <equality> lacks `joint1`"))?;
        let given = styled.list("polycoef")?.unwrap_or_else(|| vec![0.0, 1.0]);
        let c = |i: usize| given.get(i).copied().unwrap_or(0.0);
        let reference = |name: &str| {
            references
                .get(name)
                .copied()
                .ok_or_else(|| tag.fault(format!("there is no joint `{name}` to couple")))
        };
        let own = reference(first)?;
        if (2..5).any(|i| c(i) != 0.0) {
            let message = format!(
                "joint `{first}` follows another by a curve (`polycoef`); only straight lines are read"
            );
            return Err(tag.fault(message));
        }
        match tag.own("joint2") {
            None => {
                couplings.still.insert(first.to_owned(), own + c(0));
            }
            Some(second) => {
                let offset = own + c(0) - c(1) * reference(second)?;
                let mimic = Mimic { line: tag.line, joint: second.to_owned(), multiplier: c(1), offset };
                couplings.mimic.insert(first.to_owned(), mimic);
            }
        }
    }
    Ok(couplings)
}

/// The largest efforts (N·m; N) that actuators give, by joint; remarks on tendons.
pub(super) fn efforts(
    root: &Tag,
    reader: &Reader<'_>,
    remarks: &mut Vec<String>,
) -> Result<BTreeMap<String, f64>, Fault> {
    let tendons = tendons(root)?;
    let mut efforts: BTreeMap<String, f64> = BTreeMap::new();
    let mut aiming = Vec::new();
    for tag in root.all("actuator").flat_map(|actuator| &actuator.children) {
        let styled = reader.classes.of(tag, None)?;
        let Some((force, by_aim)) = force(&styled, reader)? else { continue };
        let joint = tag.own("joint").or(tag.own("jointinparent"));
        if by_aim {
            aiming.extend(joint.map(|joint| format!("`{joint}`")));
        }
        if let Some(joint) = joint {
            *efforts.entry(joint.to_owned()).or_default() += force;
        } else if let Some(tendon) = tag.own("tendon") {
            for (joint, coefficient) in tendons.get(tendon).into_iter().flatten() {
                *efforts.entry(joint.clone()).or_default() += force * coefficient.abs();
            }
        }
    }
    if let Some(first) = aiming.first() {
        let count = aiming.len();
        remarks.push(format!(
            "the motor of joint {first}{} has no `forcerange`: its gain times its range is taken as its \
             effort; \
             `--effort '*=…'` sets it (`joint` under `[hand]`)",
            if count > 1 { format!(" and of {} more", count - 1) } else { String::new() }
        ));
    }
    for (name, joints) in tendons.iter().filter(|(_, joints)| joints.len() > 1) {
        let names: Vec<String> = joints.iter().map(|(joint, _)| format!("`{joint}`")).collect();
        remarks.push(format!(
            "the tendon `{name}` pulls the joints {} together; they are taken as moving on their own, and \
             the hand must be able to do that",
            names.join(", ")
        ));
    }
    Ok(efforts)
}

/// Joints and coefficients of fixed tendons, by name.
fn tendons(root: &Tag) -> Result<BTreeMap<String, Vec<(String, f64)>>, Fault> {
    let mut tendons = BTreeMap::new();
    for tag in root.all("tendon").flat_map(|tendon| tendon.all("fixed")) {
        let joints = tag.all("joint").map(|joint| {
            let given = joint.own("coef").map(|text| joint.numbers_of("coef", text)).transpose()?;
            let coefficient = given.and_then(|numbers| numbers.first().copied()).unwrap_or(1.0);
            Ok((joint.own("joint").unwrap_or_default().to_owned(), coefficient))
        });
        let joints = joints.collect::<Result<_, Fault>>()?;
        tendons.insert(tag.own("name").unwrap_or_default().to_owned(), joints);
    }
    Ok(tendons)
}

/// The largest effort that an actuator puts on its joint (N·m; N), and whether it is bounded by its aim
/// alone; `None` where the file does not say.
fn force(styled: &Styled<'_>, reader: &Reader<'_>) -> Result<Option<(f64, bool)>, Fault> {
    let gear = styled.list("gear")?.and_then(|gear| gear.first().copied()).unwrap_or(1.0).abs();
    let most = |[low, high]: [f64; 2]| low.abs().max(high.abs()) * gear;
    let force = styled.numbers::<2>("forcerange")?;
    if let Some(range) = force.filter(|_| is_limited(styled, "forcelimited", "forcerange", reader)) {
        return Ok(Some((most(range), false)));
    }
    let control = styled.numbers::<2>("ctrlrange")?;
    let Some(control) = control.filter(|_| is_limited(styled, "ctrllimited", "ctrlrange", reader)) else {
        return Ok(None);
    };
    // A motor's control is its force; one that aims at a position pulls with what it is away times its gain,
    // at most the whole range.
    Ok(match styled.tag.name.as_str() {
        "motor" => Some((most(control), false)),
        _ => gain(styled)?.map(|gain| (gain.abs() * (control[1] - control[0]).abs() * gear, true)),
    })
}

/// The gain (N·m/rad; N/m) of an actuator that aims at a position.
fn gain(styled: &Styled<'_>) -> Result<Option<f64>, Fault> {
    Ok(match styled.tag.name.as_str() {
        "position" => Some(styled.number("kp")?.unwrap_or(1.0)),
        "general" if styled.text("biastype") == Some("affine") => {
            styled.list("gainprm")?.and_then(|gain| gain.first().copied())
        }
        _ => None,
    })
}
