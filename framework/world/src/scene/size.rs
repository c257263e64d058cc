//! Objects whose size no grasp fits: told, with the scale that would fit, before anything is searched for.

use crate::error::WorldError;
use crate::hand::ChainHand;
use regrasp_api::{FingerIndex, FingerJoints, Hand, Mesh, ObjectModel, ObjectShape, Random, Vec3};
use std::f64::consts::{PI, TAU};

/// Directions in which a width is looked for.
const DIRECTIONS: usize = 400;
/// Random postures of each finger.
const POSTURES: usize = 500;
/// The widest opening may be so much wider than that of some postures.
const WIDER: f64 = 1.1;
/// The width that fits a hand, in parts of its fingers' reach.
const FITTING: f64 = 0.5;
/// Three balls of radius 1 touch a smaller one between them if its radius is at least this (2 / √3 - 1).
const BETWEEN_THREE: f64 = 0.154_7;

/// Refuses an object so small that three fingertips cannot touch it at once; otherwise what a user should
/// know of its size, if anything.
pub fn check_size(
    hand: &ChainHand,
    object: &ObjectModel,
    shape: &ObjectShape,
) -> Result<Option<String>, WorldError> {
    let (low, high) = sides(&object.mesh);
    let (radius, tip) = ((high - low).norm() / 2.0, hand.fingertip_radius());
    let reach = fingers(hand).map(|finger| hand.finger(finger).reach).fold(0.0, f64::max);
    let wished = (FITTING * reach * 200.0).round() / 200.0;
    // The width is at most the shortest side: small objects cost nothing.
    let side = (high - low).min();
    let fit = |width: f64| fit(shape, wished, width);
    if radius < BETWEEN_THREE * tip {
        let reason = format!(
            "the object lies within a ball of {:.2} mm, between fingertips of {:.1} mm: no three of them can \
             touch it at once; {}",
            1e3 * radius,
            1e3 * tip,
            fit(side)
        );
        return Err(WorldError::value("object.shape", reason));
    }
    if (high - low).max() < 2.0 * tip {
        return Ok(Some(format!(
            "the object is {:.1} mm long, less than a fingertip is wide ({:.1} mm): a grasp is unlikely; {}",
            1e3 * (high - low).max(),
            2e3 * tip,
            fit(side)
        )));
    }
    if side <= reach {
        return Ok(None);
    }
    let (width, open) = (width(&object.mesh), opening(hand));
    Ok((width > open).then(|| {
        format!(
            "the object is {:.0} mm wide at its narrowest, and two fingertips of this hand come at most some \
             {:.0} mm apart: they can hold it only where it has thinner parts; {}",
            1e3 * width,
            1e3 * open,
            fit(width)
        )
    }))
}

fn fingers(hand: &ChainHand) -> impl Iterator<Item = FingerIndex> {
    (0..hand.finger_count() as u8).map(FingerIndex)
}

/// What would fit, in the words of the scenario.
fn fit(shape: &ObjectShape, wished: f64, width: f64) -> String {
    let times = wished / width;
    let change = match shape {
        ObjectShape::Mesh(source) => format!("`scale = {:.3}`", times * source.scale.unwrap_or(1.0)),
        _ => format!("multiplying its lengths by {times:.3}"),
    };
    format!("{change} makes its width {:.0} mm", 1e3 * wished)
}

/// The box around a mesh.
fn sides(mesh: &Mesh) -> (Vec3, Vec3) {
    let low = mesh.vertices().iter().copied().reduce(|a, b| a.inf(&b)).unwrap_or_default();
    let high = mesh.vertices().iter().copied().reduce(|a, b| a.sup(&b)).unwrap_or_default();
    (low, high)
}

/// The least distance of two parallel planes around a mesh, of evenly spread ones (a Fibonacci lattice).
fn width(mesh: &Mesh) -> f64 {
    let turn = PI * (3.0 - 5.0f64.sqrt());
    let across = |i: usize| {
        let z = (i as f64 + 0.5) / DIRECTIONS as f64;
        let (sin, cos) = (turn * i as f64 % TAU).sin_cos();
        let r = (1.0 - z * z).sqrt();
        let n = Vec3::new(r * cos, r * sin, z);
        let range = mesh.vertices().iter().map(|v| v.dot(&n));
        let (low, high) =
            range.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), h| (low.min(h), high.max(h)));
        high - low
    };
    (0..DIRECTIONS).map(across).fold(f64::INFINITY, f64::min)
}

/// About how wide (m) two fingertips can be apart from each other.
fn opening(hand: &ChainHand) -> f64 {
    let tips: Vec<Vec<Vec3>> = fingers(hand).map(|finger| tips(hand, finger)).collect();
    let mut widest: f64 = 0.0;
    for (i, some) in tips.iter().enumerate() {
        for others in &tips[i + 1..] {
            let apart = some.iter().flat_map(|a| others.iter().map(move |b| (a - b).norm_squared()));
            widest = widest.max(apart.fold(0.0, f64::max));
        }
    }
    (WIDER * widest.sqrt() - 2.0 * hand.fingertip_radius()).max(0.0)
}

fn tips(hand: &ChainHand, finger: FingerIndex) -> Vec<Vec3> {
    let joints = &hand.finger(finger).joints;
    let mut random = Random::from_key(0, 5, 0, u64::from(finger.0));
    let mut tip = || {
        let mut q = FingerJoints::zeros(joints.len());
        q.iter_mut().zip(joints).for_each(|(q, joint)| *q = random.range(joint.lower, joint.upper));
        hand.tip_center(finger, &q)
    };
    (0..POSTURES).map(|_| tip()).collect()
}
