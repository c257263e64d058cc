//! What is out of all proportion: told, with what it probably is and the key that mends it; never mended in
//! silence.

use crate::fingers::Fingers;
use crate::tree::Tree;
use regrasp_api::{Form, HandDescription, JointDescription, JointKind, Shape, Vec3};
use regrasp_formats::{Geometry, Link, RobotFault as Fault};

/// Fingers reach no farther (m), and no less.
const REACH: (f64, f64) = (5e-3, 1.5);
/// A length this many times the others' is told, and refused if it is also longer than [`LONG`].
const OUT_OF_PROPORTION: f64 = 8.0;
/// No link of a hand is as long (m).
const LONG: f64 = 0.5;
/// A length this many times less than the others' is told.
const TINY: f64 = 60.0;
/// Force (N) at its tip that no finger of a hand gives, and speed (rad/s) that no joint of one has.
const STRONG: f64 = 60.0;
const FAST: f64 = 20.0;
/// What is too weak or slow (N; rad/s) to be meant.
const WEAK: f64 = 0.05;
const SLOW: f64 = 0.02;
/// The heaviest link of a finger (kg).
const HEAVY: f64 = 2.0;

/// A length of the file, with its place.
struct Length {
    /// What it is, in words.
    what: String,
    line: usize,
    /// (m).
    value: f64,
    /// What to write to mend it, before the factor.
    remedy: Remedy,
}

#[derive(Clone, Copy)]
enum Remedy {
    Mesh,
    Shape,
    Offset,
}

/// Refuses lengths that no hand has; notes what is unlikely.
pub(crate) fn check(
    tree: &Tree<'_>,
    fingers: &Fingers,
    hand: &HandDescription,
    notes: &mut Vec<String>,
) -> Result<(), Fault> {
    let lengths = lengths(tree, fingers, hand);
    let typical = median(lengths.iter().map(|length| length.value).collect());
    for length in &lengths {
        judge(length, typical, notes)?;
    }
    reach(hand)?;
    notes.extend(rates(hand, |what| format!("`--{what} '*=…'` sets it (`joint` under `[hand]`)")));
    masses(tree, fingers, notes);
    Ok(())
}

/// How far each link's shapes go and each joint is from the one before, over the fingers.
fn lengths(tree: &Tree<'_>, fingers: &Fingers, hand: &HandDescription) -> Vec<Length> {
    let mut lengths = Vec::new();
    for (chain, finger) in fingers.chains.iter().zip(&hand.finger) {
        for &index in &chain.path {
            let joint = tree.joint(index);
            let value = joint.X_PJ.translation.vector.norm();
            let what = format!("the offset of joint `{}`", joint.name);
            lengths.push(Length { what, line: joint.line, value, remedy: Remedy::Offset });
        }
        for (&index, joint) in chain.moving.iter().zip(&finger.joint) {
            let link = tree.link_of(tree.child(index));
            let value = joint.link.iter().map(|placed| size(&placed.shape)).fold(0.0, f64::max);
            let (line, remedy) = first_solid(link);
            let what = format!("a shape of link `{}`", link.name);
            lengths.push(Length { what, line, value, remedy });
        }
    }
    lengths.retain(|length| length.value > 1e-9);
    lengths
}

/// The line of a link's first shape, and whether it is a mesh.
fn first_solid(link: &Link) -> (usize, Remedy) {
    let solids = [&link.collision, &link.visual].into_iter().filter_map(|solids| solids.as_ref().ok());
    let mut meshes = solids.flatten().filter(|solid| matches!(solid.geometry, Geometry::Mesh { .. }));
    meshes.next().map_or((link.line, Remedy::Shape), |mesh| (mesh.line, Remedy::Mesh))
}

/// The longest side of the box around a shape (m), along its own axes.
fn size(shape: &Shape) -> f64 {
    match shape.form() {
        Form::Primitive(primitive, _) => 2.0 * primitive.half_size().max(),
        Form::HalfSpace { .. } => 0.0,
        Form::Mesh(source) => {
            let points = || source.vertices.iter().map(|&v| Vec3::from(v));
            let low = points().reduce(|a, b| a.inf(&b)).unwrap_or_default();
            let high = points().reduce(|a, b| a.sup(&b)).unwrap_or_default();
            (high - low).max()
        }
    }
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(0.0)
}

fn judge(length: &Length, typical: f64, notes: &mut Vec<String>) -> Result<(), Fault> {
    let times = length.value / typical;
    let Length { what, value, line, .. } = length;
    if times > OUT_OF_PROPORTION {
        let message = format!(
            "{what} is {value:.3} m long, {times:.0} times as much as the hand's others ({:.0} mm): {}",
            1e3 * typical,
            mend(length.remedy, times)
        );
        if *value > LONG {
            return Err(Fault::at(*line, message));
        }
        notes.push(format!("{message} (line {line})"));
    } else if times < 1.0 / TINY && !matches!(length.remedy, Remedy::Offset) {
        notes.push(format!(
            "{what} is {:.3} mm long, {:.0} times less than the hand's others ({:.0} mm): was its scale \
             applied twice? (line {line})",
            1e3 * value,
            1.0 / times,
            1e3 * typical
        ));
    }
    Ok(())
}

/// Names of units, and how many of them are a metre.
const UNITS: [(&str, f64); 4] =
    [("millimetres", 1000.0), ("centimetres", 100.0), ("inches", 39.37), ("decimetres", 10.0)];

/// The unit whose name explains a length that is so many times too large.
fn unit(times: f64) -> (&'static str, f64) {
    let apart = |per_metre: f64| (times / per_metre).ln().abs();
    let best = UNITS.into_iter().min_by(|a, b| apart(a.1).total_cmp(&apart(b.1)));
    best.expect("there are units")
}

fn mend(remedy: Remedy, times: f64) -> String {
    let (name, per_metre) = unit(times);
    let factor = if name == "inches" { "0.0254".to_owned() } else { (1.0 / per_metre).to_string() };
    match remedy {
        Remedy::Mesh => format!(
            "is the mesh in {name}? then write scale=\"{factor} {factor} {factor}\" into its <mesh>, or \
             give `mesh_scale` = {factor} \
             (`--mesh-scale`) if all meshes are"
        ),
        Remedy::Shape | Remedy::Offset => format!(
            "is it in {name}? lengths are in metres: multiply it by {factor}, or give `scale` = {factor} \
             (`--scale`) if the whole file is in {name}"
        ),
    }
}

/// The whole hand's size, by its longest finger.
fn reach(hand: &HandDescription) -> Result<(), Fault> {
    let of_finger = |finger: &regrasp_api::FingerDescription| {
        let offsets = finger.joint.iter().map(|joint| Vec3::from(joint.origin.position).norm());
        offsets.sum::<f64>() + Vec3::from(finger.tip).norm()
    };
    let longest = hand.finger.iter().map(of_finger).fold(0.0, f64::max);
    if (REACH.0..=REACH.1).contains(&longest) {
        return Ok(());
    }
    let advice = if longest > REACH.1 {
        mend(Remedy::Shape, longest / 0.1)
    } else {
        "are its lengths in kilometres, or were they scaled twice? give `scale` = 1000 (`--scale`)".into()
    };
    let message = format!("`scale`: the longest finger is {longest:.4} m long, no finger is: {advice}");
    Err(Fault::of_key("scale", message))
}

/// What a hand file says of efforts and velocities that no finger of this size has, for people.
pub fn implausible_rates(hand: &HandDescription) -> Vec<String> {
    rates(hand, |what| format!("`{what}` of that joint in the hand file sets it"))
}

/// Efforts and velocities that no finger of this size has; `remedy` says what sets one of them.
fn rates(hand: &HandDescription, remedy: impl Fn(&str) -> String) -> Vec<String> {
    let (mut strong, mut fast, mut weak, mut slow) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    for finger in &hand.finger {
        let lengths: Vec<f64> =
            finger.joint.iter().map(|joint| Vec3::from(joint.origin.position).norm()).collect();
        let turning = |(_, joint): &(usize, &JointDescription)| joint.kind == JointKind::Revolute;
        for (i, joint) in finger.joint.iter().enumerate().filter(turning) {
            let arm = lengths[i + 1..].iter().sum::<f64>() + Vec3::from(finger.tip).norm();
            let force = joint.effort / arm.max(0.02);
            let entry = |value: f64| (joint.name.clone(), value);
            match () {
                () if force > STRONG => strong.push(entry(joint.effort)),
                () if force < WEAK => weak.push(entry(joint.effort)),
                () => {}
            }
            match () {
                () if joint.velocity > FAST => fast.push(entry(joint.velocity)),
                () if joint.velocity < SLOW => slow.push(entry(joint.velocity)),
                () => {}
            }
        }
    }
    let told = [
        tell(&strong, ("effort", "N·m", "no finger of this size is as strong"), &remedy),
        tell(&weak, ("effort", "N·m", "too weak to hold anything"), &remedy),
        tell(&fast, ("velocity", "rad/s", "no finger is as fast"), &remedy),
        tell(&slow, ("velocity", "rad/s", "too slow to be meant"), &remedy),
    ];
    told.into_iter().flatten().collect()
}

fn tell(
    joints: &[(String, f64)],
    (what, unit, why): (&str, &str, &str),
    remedy: impl Fn(&str) -> String,
) -> Option<String> {
    let (first, value) = joints.first()?;
    let others = match joints.len() {
        1 => String::new(),
        count => format!(" and {} more joints", count - 1),
    };
    // Large and small ones with an exponent: nobody counts zeros.
    let value = if (1e-3..1e5).contains(value) { value.to_string() } else { format!("{value:e}") };
    let remedy = remedy(what);
    Some(format!("joint `{first}`{others}: {what} {value} {unit}, {why}; it is taken as it is: {remedy}"))
}

fn masses(tree: &Tree<'_>, fingers: &Fingers, notes: &mut Vec<String>) {
    for &index in fingers.chains.iter().flat_map(|chain| &chain.path) {
        let link = tree.link_of(tree.child(index));
        match link.mass {
            Some(mass) if mass > HEAVY => notes.push(format!(
                "link `{}` has a mass of {mass} kg, no link of a finger is as heavy; is it in grams? (line \
                 {})",
                link.name, link.line
            )),
            Some(mass) if mass < 0.0 => {
                notes.push(format!("link `{}` has a mass of {mass} kg (line {})", link.name, link.line));
            }
            _ => {}
        }
    }
}
