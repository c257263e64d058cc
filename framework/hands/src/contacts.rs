//! Which bodies of the hand always touch each other, and a posture in which the others do not: found by
//! sampling.

use regrasp_api::{
    BodyPair, Clearance, Configuration, FingerIndex, FingerJoints, Hand, HandDescription, ObjectModel,
    PerFinger, Pose, Primitive, Random,
};
use regrasp_formats::RobotFault as Fault;
use regrasp_world::{ChainHand, HandError, SceneClearance, WorldError, primitive_mesh};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Random postures that are looked at.
const POSTURES: usize = 200;
/// Random postures that are tried as the resting one.
const TRIES: usize = 500;
/// The distance (m) up to which bodies count as touching: what planning keeps between bodies by default.
const TOUCHING: f64 = 5e-4;
/// Pairs that touch in this share of the postures, though not in all, are worth a word.
const OFTEN: f64 = 0.8;

/// What was found.
#[derive(Debug, Default)]
pub(crate) struct Contacts {
    pub touching: Vec<[String; 2]>,
    /// Pairs that touch in most postures, with their share of them.
    pub often: Vec<([String; 2], f64)>,
    /// Pairs that touch in the resting posture, which was the best that was found.
    pub at_rest: Vec<[String; 2]>,
}

/// Completes a description whose resting posture is its zero posture: pairs that always touch are excluded,
/// and the fingers rest where nothing touches, if such a posture is found.
pub(crate) fn complete(hand: &mut HandDescription) -> Result<Contacts, WorldError> {
    let mut contacts = Contacts::default();
    let scene = Scene::new(hand)?;
    let mut random = Random::from_key(0, 2, 0, 0);
    let mut counts: BTreeMap<BodyPair, usize> = BTreeMap::new();
    for _ in 0..POSTURES {
        for pair in scene.touching(&scene.random_posture(&mut random)) {
            *counts.entry(pair).or_default() += 1;
        }
    }
    for (pair, count) in counts {
        let names = named(hand, pair);
        match count as f64 / POSTURES as f64 {
            1.0 => contacts.touching.push(names),
            share if share >= OFTEN => contacts.often.push((names, share)),
            _ => {}
        }
    }
    hand.touching.extend(contacts.touching.iter().cloned());
    let scene = Scene::new(hand)?;
    let (rest, touching) = scene.resting(hand);
    contacts.at_rest = touching.into_iter().map(|pair| named(hand, pair)).collect();
    for (finger, joints) in hand.finger.iter_mut().zip(rest.as_slice()) {
        finger.rest = joints.to_vec();
    }
    Ok(contacts)
}

fn named(hand: &HandDescription, pair: BodyPair) -> [String; 2] {
    [pair.0, pair.1].map(|body| hand.body_name(body).unwrap_or("?").to_owned())
}

/// The hand alone, its object far away.
struct Scene {
    hand: Arc<ChainHand>,
    clearance: SceneClearance,
}

impl Scene {
    fn new(description: &HandDescription) -> Result<Self, WorldError> {
        let hand = Arc::new(ChainHand::new(description.clone()).map_err(WorldError::from)?);
        let mesh = primitive_mesh(&Primitive::Cuboid { half_size: regrasp_api::Vec3::repeat(1e-3) }, 12)
            .expect("a cube is a mesh");
        let object = ObjectModel::new(mesh, None, 1.0, 1.0);
        let clearance = SceneClearance::new(hand.clone(), &object, &[], TOUCHING)?;
        Ok(Self { hand, clearance })
    }

    fn posture(&self, mut joint: impl FnMut(FingerIndex, usize) -> f64) -> PerFinger<FingerJoints> {
        PerFinger::from_fn(self.hand.finger_count(), |finger| {
            let mut joints = FingerJoints::zeros(self.hand.finger(finger).joints.len());
            joints.iter_mut().enumerate().for_each(|(j, q)| *q = joint(finger, j));
            self.hand.settle(finger, &mut joints);
            joints
        })
    }

    fn random_posture(&self, random: &mut Random) -> PerFinger<FingerJoints> {
        self.posture(|finger, j| {
            let joint = &self.hand.finger(finger).joints[j];
            random.range(joint.lower, joint.upper)
        })
    }

    /// The pairs that touch in a posture.
    fn touching(&self, joints: &PerFinger<FingerJoints>) -> Vec<BodyPair> {
        let contacts = PerFinger::filled(joints.len(), None);
        let q = Configuration { X_HO: Pose::translation(1e3, 1e3, 1e3), joints: *joints, contacts };
        self.clearance.distances(&q, TOUCHING).into_iter().map(|pair| pair.pair).collect()
    }

    /// A posture in which least touches, with what does: the zero posture, the middle of the ranges, or a
    /// random one.
    fn resting(&self, hand: &HandDescription) -> (PerFinger<FingerJoints>, Vec<BodyPair>) {
        let zero = self.posture(|finger, j| hand.finger[finger.index()].rest[j]);
        let middle = self.posture(|finger, j| {
            let joint = &self.hand.finger(finger).joints[j];
            0.5 * (joint.lower + joint.upper)
        });
        let mut random = Random::from_key(0, 3, 0, 0);
        let mut best = (zero, self.touching(&zero));
        for attempt in 0..TRIES {
            if best.1.is_empty() {
                break;
            }
            let posture = if attempt == 0 { middle } else { self.random_posture(&mut random) };
            let touching = self.touching(&posture);
            if touching.len() < best.1.len() {
                best = (posture, touching);
            }
        }
        best
    }
}

/// The refusal of the hand that a file describes.
pub(crate) fn refused(error: WorldError) -> Fault {
    match error {
        WorldError::Hand(error) => of_hand(&error),
        other => Fault::of_file(other.to_string()),
    }
}

fn of_hand(error: &HandError) -> Fault {
    Fault::of_file(format!("the hand that the file describes is refused: {error}"))
}
