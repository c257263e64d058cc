//! Where the fingertips reach, and where they can reach an object together.

use crate::clearance::Palm;
use crate::hand::ChainHand;
use regrasp_api::{FingerIndex, FingerJoints, Hand, Random, Vec3};
use std::collections::BTreeSet;

/// Random postures of each finger.
const POSTURES: usize = 20_000;
/// Edge of the cubes (m) by which a volume is counted.
const CUBE: f64 = 4e-3;
/// Places of an object that are looked at along each axis of the box that all fingers share.
const PLACES: usize = 16;
/// How far (m) a fingertip's centre may be from the offset surface of the ball and still count as touching
/// it.
const SHELL: f64 = 3e-3;
/// How far (m) an object is kept from the palm.
const BESIDE: f64 = 2e-3;

/// Where one fingertip reaches.
#[derive(Clone, Debug, PartialEq)]
pub struct FingerWorkspace {
    /// Lowest coordinates of the fingertip's centre in H (m).
    pub lower: Vec3,
    /// Highest coordinates of the fingertip's centre in H (m).
    pub upper: Vec3,
    /// Volume of the places that the fingertip's centre reaches (m³), to some 10 %; collisions are not looked
    /// at.
    pub volume: f64,
}

/// A place for an object.
#[derive(Clone, Debug, PartialEq)]
pub struct ObjectPlace {
    /// Centre of the object in H (m).
    pub p_HO: Vec3,
    /// How well the fingers surround a ball there, in [0, 1]: 0 where some finger does not reach it, or all
    /// push in one direction.
    pub quality: f64,
}

/// The box and volume that a finger's tip reaches, by fixed random postures.
pub fn finger_workspace(hand: &ChainHand, finger: FingerIndex) -> FingerWorkspace {
    let tips = tips(hand, finger);
    let lower = tips.iter().copied().reduce(|a, b| a.inf(&b)).unwrap_or_default();
    let upper = tips.iter().copied().reduce(|a, b| a.sup(&b)).unwrap_or_default();
    let cube = |p: &Vec3| -> [i64; 3] { (p / CUBE).map(|x| x.floor() as i64).into() };
    let cubes: BTreeSet<_> = tips.iter().map(cube).collect();
    FingerWorkspace { lower, upper, volume: cubes.len() as f64 * CUBE.powi(3) }
}

/// Where the fingertips can surround a ball of this radius (m) beside the palm, the best place first; none
/// where they cannot.
///
/// Over a grid: the mean of the directions from which each finger's tip reaches the ball. The quality falls
/// with the share of postures in which the worst finger touches it, and with the length of the sum of all
/// fingers' directions, which is zero where they push against each other. Links are not looked at: a hint, no
/// proof, as `plan` tells.
pub fn object_places(hand: &ChainHand, radius: f64) -> Vec<ObjectPlace> {
    let fingers: Vec<Vec<Vec3>> =
        (0..hand.finger_count() as u8).map(|finger| tips(hand, FingerIndex(finger))).collect();
    let all = || fingers.iter().flatten();
    let lower = all().copied().reduce(|a, b| a.inf(&b)).unwrap_or_default();
    let upper = all().copied().reduce(|a, b| a.sup(&b)).unwrap_or_default();
    let reach = radius + hand.fingertip_radius();
    let step = (upper - lower) / (PLACES - 1) as f64;
    let places = (0..PLACES.pow(3)).map(|i| {
        let index =
            Vec3::new((i % PLACES) as f64, (i / PLACES % PLACES) as f64, (i / PLACES / PLACES) as f64);
        lower + step.component_mul(&index)
    });
    let judged = places.map(|p_HO| ObjectPlace { p_HO, quality: quality(&fingers, &p_HO, reach) });
    let palm = Palm::new(hand, radius + BESIDE).ok();
    let is_free = |p: &Vec3| palm.as_ref().is_none_or(|palm| palm.is_clear_of(*p, radius, BESIDE));
    let mut places: Vec<_> = judged.filter(|place| place.quality > 0.0 && is_free(&place.p_HO)).collect();
    places.sort_by(|a, b| b.quality.total_cmp(&a.quality));
    places
}

fn quality(fingers: &[Vec<Vec3>], p_HO: &Vec3, reach: f64) -> f64 {
    let (mut sum, mut least) = (Vec3::zeros(), f64::INFINITY);
    for tips in fingers {
        let mut count = 0;
        let mut direction = Vec3::zeros();
        for tip in tips {
            let away = tip - p_HO;
            let distance = away.norm();
            if (distance - reach).abs() < SHELL {
                count += 1;
                direction += away / distance;
            }
        }
        if count == 0 {
            return 0.0;
        }
        sum += direction.try_normalize(1e-9).unwrap_or_else(Vec3::zeros);
        least = least.min(count as f64 / tips.len() as f64);
    }
    let balance = 1.0 - sum.norm() / fingers.len() as f64;
    balance * least.sqrt().min(1.0)
}

/// Fingertip centres in H (m) at fixed random postures.
fn tips(hand: &ChainHand, finger: FingerIndex) -> Vec<Vec3> {
    let joints = &hand.finger(finger).joints;
    let mut random = Random::from_key(0, 4, 0, u64::from(finger.0));
    let mut tip = || {
        let mut q = FingerJoints::zeros(joints.len());
        q.iter_mut().zip(joints).for_each(|(q, joint)| *q = random.range(joint.lower, joint.upper));
        hand.tip_center(finger, &q)
    };
    (0..POSTURES).map(|_| tip()).collect()
}
