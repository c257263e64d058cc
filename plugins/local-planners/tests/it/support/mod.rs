//! Hands, objects and tasks for the tests, and what they need to check motions by arithmetic of their own.
#![allow(dead_code, missing_docs)]

pub mod check;
pub mod geometry;

use regrasp_api::*;
use regrasp_contact_models::Pcwf;
use regrasp_stability_tests::{ForceClosure, ForceClosureSettings};
use regrasp_surfaces::geodesic::{Geodesic, GeodesicSettings};
use regrasp_world::{ChainHand, SceneClearance};
use std::{path::Path as FilePath, sync::Arc};

/// Every grasp holds: for tests of kinematics alone.
pub struct Glue;

impl StabilityTest for Glue {
    fn test(&self, _: &Grasp<'_>, _: &mut Hint, _: &mut Context<'_>) -> Result<Stability, CallError> {
        Ok(Stability::Stable)
    }
    fn assess(
        &self,
        _: &Grasp<'_>,
        _: Option<f64>,
        _: Option<Vec3>,
        _: &mut Context<'_>,
    ) -> Result<Assessment, CallError> {
        unreachable!("local planners do not assess")
    }
}

/// Everything may become a node.
pub struct Anything;

impl Admissible for Anything {
    fn admit_finger(
        &self,
        _: &Task<'_>,
        _: &Configuration,
        _: FingerIndex,
        _: FingerSet,
        _: &mut Context<'_>,
    ) -> Result<Option<Reason>, CallError> {
        Ok(None)
    }
    fn admit_grasp(
        &self,
        _: &Task<'_>,
        _: &Configuration,
        _: &mut Context<'_>,
    ) -> Result<Option<Reason>, CallError> {
        Ok(None)
    }
}

/// Everything that a task borrows.
pub struct Bench {
    pub hand: Arc<ChainHand>,
    pub object: ObjectModel,
    pub clearance: SceneClearance,
    pub surface: Box<dyn SurfaceParam>,
    pub stability: Box<dyn StabilityTest>,
    pub tolerances: Tolerances,
    pub resolution: Resolution,
}

impl Bench {
    pub fn new(hand: HandDescription, object: ObjectModel) -> Self {
        Self::among(hand, object, &[])
    }

    pub fn among(hand: HandDescription, object: ObjectModel, obstacles: &[ObstacleDescription]) -> Self {
        let hand = Arc::new(ChainHand::new(hand).unwrap());
        let resolution = Resolution::default();
        let clearance = SceneClearance::new(hand.clone(), &object, obstacles, resolution.clearance).unwrap();
        let surface =
            Geodesic::new(&GeodesicSettings::default(), &object.mesh, hand.fingertip_radius()).unwrap();
        Self {
            hand,
            object,
            clearance,
            surface: Box::new(surface),
            stability: Box::new(ForceClosure::new(ForceClosureSettings::default()).unwrap()),
            tolerances: Tolerances::default(),
            resolution,
        }
    }

    pub fn task(&self) -> Task<'_> {
        Task {
            hand: &*self.hand,
            clearance: &self.clearance,
            contact_model: &Pcwf,
            stability: &*self.stability,
            surface: &*self.surface,
            admissible: &Anything,
            object: &self.object,
            g_H: Vec3::zeros(),
            tolerances: &self.tolerances,
            resolution: &self.resolution,
            workspace: (Vec3::new(-0.02, -0.02, 0.06), Vec3::new(0.02, 0.02, 0.11)),
            landmarks: &[],
        }
    }

    pub fn radius(&self) -> f64 {
        self.hand.fingertip_radius()
    }
}

pub fn context(seed: u64) -> Context<'static> {
    Context::new(Random::from_key(seed, 0, 0, 0), &Uninterrupted)
}

/// The hand of the paper's problems.
pub fn four_finger() -> HandDescription {
    let file = FilePath::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/hands/four-finger.toml");
    toml::from_str(&std::fs::read_to_string(file).unwrap()).unwrap()
}

/// The same with one joint to spare in every finger: the last link bends once more.
pub fn redundant() -> HandDescription {
    let mut hand = four_finger();
    hand.name = "redundant".into();
    for finger in &mut hand.finger {
        let mut last = finger.joint[2].clone();
        last.name += "-tip";
        (last.lower, last.upper) = (-0.4, 0.8);
        last.origin.position = [0.0, 0.0, 0.03];
        last.link.clear();
        finger.joint.push(last);
        finger.tip = [0.0, 0.0, 0.02];
        finger.rest.push(0.1);
    }
    hand
}

/// Four fingertips without links, each on three slides, reaching 0.15 m about the origin.
pub fn free_tips() -> HandDescription {
    let mut finger = String::new();
    for name in ["a", "b", "c", "d"] {
        finger += &format!("[[finger]]\nname = \"{name}\"\nrest = [0.0, 0.0, 0.0]\n");
        for (joint, axis) in [("x", "[1.0, 0.0, 0.0]"), ("y", "[0.0, 1.0, 0.0]"), ("z", "[0.0, 0.0, 1.0]")] {
            finger += &format!(
                "[[finger.joint]]\nname = \"{name}-{joint}\"\nkind = \"prismatic\"\naxis = {axis}\nlower = \
                    -0.15\nupper = 0.15\n"
            );
        }
    }
    toml::from_str(&format!("name = \"free\"\nfingertip_radius = 0.01\n{finger}")).unwrap()
}

pub fn object(shape: &str) -> ObjectModel {
    let description: ObjectDescription =
        toml::from_str(&format!("friction = 0.8\nshape = {shape}\n")).unwrap();
    regrasp_world::load_object(&description).unwrap()
}

/// Objects of each kind, with their names.
pub fn objects() -> [(&'static str, ObjectModel); 4] {
    [("sphere", sphere()), ("cube", cube()), ("ellipsoid", ellipsoid()), ("ring", ring())]
}

pub fn sphere() -> ObjectModel {
    object("{ kind = \"sphere\", radius = 0.03, facets = 320 }")
}

pub fn cube() -> ObjectModel {
    object("{ kind = \"cuboid\", size = [0.045, 0.045, 0.045] }")
}

pub fn ellipsoid() -> ObjectModel {
    object("{ kind = \"ellipsoid\", semi_axes = [0.04, 0.025, 0.025], facets = 320 }")
}

/// A ring that a fingertip fits through: concave along its inner side.
pub fn ring() -> ObjectModel {
    object("{ kind = \"torus\", ring_radius = 0.03, tube_radius = 0.012, facets = 512 }")
}

/// The same of few facets: bent by some 45° from one to the next.
pub fn sharp_ring() -> ObjectModel {
    object("{ kind = \"torus\", ring_radius = 0.03, tube_radius = 0.012, facets = 64 }")
}

/// A random configuration with all fingers in contact and a stable grasp, collision-free.
pub fn grasp(bench: &Bench, random: &mut Random) -> Configuration {
    let task = bench.task();
    for _ in 0..2000 {
        let X_HO = Pose::from_parts(Vec3::new(0.0, 0.0, 0.085).into(), random.rotation());
        if let Some(q) = grasp_at(&task, X_HO, random) {
            return q;
        }
    }
    panic!("no grasp found");
}

/// A few tries for a stable grasp at the pose.
pub fn grasp_at(task: &Task<'_>, X_HO: Pose, random: &mut Random) -> Option<Configuration> {
    let count = task.hand.finger_count();
    let rest = PerFinger::from_fn(count, |finger| task.hand.finger(finger).rest);
    let mut q = Configuration { X_HO, joints: rest, contacts: PerFinger::filled(count, None) };
    for finger in FingerSet::first(count).iter() {
        let near = task.hand.finger(finger).rest;
        let (contact, joints) = (0..60).find_map(|_| {
            let contact = task.surface.sample(random);
            if task.surface.edge_distance(&contact) < 3e-3 {
                return None;
            }
            let p_OF = contact.tip_center(task.hand.fingertip_radius());
            if (task.surface.project(&p_OF, None).distance - task.hand.fingertip_radius()).abs() > 1e-9 {
                return None;
            }
            let joints = task.hand.inverse(finger, &geometry::to_hand(&X_HO, &p_OF), &near)?;
            Some((contact, joints))
        })?;
        q.contacts[finger] = Some(contact);
        q.joints[finger] = joints;
    }
    let stable = task.stability.test(&task.grasp(&q, q.holding()), &mut Hint::default(), &mut context(0));
    let all = FingerSet::first(count);
    (stable.unwrap().is_stable() && task.clearance.configuration_free(&q, all, true).is_ok()).then_some(q)
}

/// A pose turned and moved from another by random amounts up to these.
pub fn nearby(X_HO: &Pose, random: &mut Random, distance: f64, angle: f64) -> Pose {
    let turn = Rotation::from_scaled_axis(random.direction() * random.range(0.2 * angle, angle));
    let p = X_HO.translation.vector + random.direction() * random.range(0.0, distance);
    Pose::from_parts(p.into(), turn * X_HO.rotation)
}

/// Fingers in turn touching the object along these directions from its centre.
pub fn touching_along(bench: &Bench, X_HO: &Pose, directions: &[Vec3]) -> Configuration {
    let count = bench.hand.finger_count();
    let joints = PerFinger::from_fn(count, |finger| bench.hand.finger(finger).rest);
    let mut q = Configuration { X_HO: *X_HO, joints, contacts: PerFinger::filled(count, None) };
    for (finger, direction) in FingerSet::first(count).iter().zip(directions) {
        let contact = bench.surface.project(&(direction * 0.1), None).contact;
        let p_HF = geometry::to_hand(X_HO, &contact.tip_center(bench.radius()));
        q.joints[finger] = bench.hand.inverse(finger, &p_HF, &q.joints[finger]).unwrap();
        q.contacts[finger] = Some(contact);
    }
    q
}
