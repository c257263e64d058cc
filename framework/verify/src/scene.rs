//! All bodies of the scene and the pairs of them that may not touch.

use crate::hand::Chains;
use crate::shape::{Core, distance};
use crate::solid::Solid;
use crate::track::Frames;
use regrasp_api::{
    Body, FingerIndex, HandDescription, JointKind, MAX_FINGER_JOINTS, ObjectModel, PlacedShape, Pose,
    Problem, Vec3,
};
use std::sync::Arc;

/// The scene's bodies, one entry for each shape.
pub(crate) struct Scene {
    pub(crate) object: Arc<Solid>,
    /// What contacts live on: the object itself, or the twin that the plan holds.
    pub(crate) touched: Arc<Solid>,
    /// How far (m) a fingertip that touches the twin may be from touching the object, and how deep it may
    /// enter it.
    pub(crate) bound: f64,
    /// Largest distance of the object's surface from its frame's origin (m).
    pub(crate) object_reach: f64,
    pub(crate) bodies: Vec<Solidity>,
    /// Indices of two bodies that may not touch.
    pub(crate) pairs: Vec<(usize, usize)>,
}

/// One shape of a body.
pub(crate) struct Solidity {
    pub(crate) body: Body,
    pub(crate) core: Core,
    pub(crate) radius: f64,
    /// Centre and radius of a ball that holds core and radius, in the body's frame (m).
    pub(crate) ball: Option<(Vec3, f64)>,
    /// The link whose frame it moves in, counted through.
    link: Option<usize>,
    /// First joint of its finger, and how far its points can move for one unit of each joint (m).
    first: usize,
    pub(crate) levers: [f64; MAX_FINGER_JOINTS],
    /// Which of these joints turn it: 1 for each, else 0.
    turning: [f64; MAX_FINGER_JOINTS],
}

impl Solidity {
    /// How far (m) any point of the body moves at most, and how far its joints turn in sum (rad), where each
    /// joint of the hand moves by its step.
    pub(crate) fn motion(&self, steps: &[f64]) -> (f64, f64) {
        if self.link.is_none() {
            return (0.0, 0.0);
        }
        let joints = self.levers.iter().zip(&self.turning).zip(&steps[self.first..]);
        joints.fold((0.0, 0.0), |(motion, turned), ((lever, turning), step)| {
            (motion + lever_times(*lever, *step), turned + turning * step)
        })
    }
}

impl Scene {
    /// The bodies of a problem, for a motion whose joint positions stay within ± `travel` (one for each joint
    /// of the hand).
    pub(crate) fn new(
        problem: &Problem,
        object: &ObjectModel,
        hand: &Chains,
        travel: &[f64],
    ) -> Result<Self, String> {
        let solid = Arc::new(Solid::new(&object.mesh));
        let (touched, bound) = match &object.twin {
            Some(twin) => (Arc::new(Solid::new(&twin.mesh)), twin.bound),
            None => (solid.clone(), 0.0),
        };
        let mut scene = Self {
            object: solid.clone(),
            touched,
            bound,
            object_reach: object.mesh.radius(),
            bodies: Vec::new(),
            pairs: Vec::new(),
        };
        scene.add(Body::Object, Core::Mesh(solid), 0.0);
        for placed in &problem.hand.palm {
            scene.add_described(Body::Palm, placed).map_err(|e| format!("palm: {e}"))?;
        }
        for (i, obstacle) in problem.obstacle.iter().enumerate() {
            let placed = PlacedShape { shape: obstacle.shape.clone(), pose: obstacle.pose.clone() };
            let index = u16::try_from(i).map_err(|_| "too many obstacles")?;
            let named = |e| format!("obstacle `{}`: {e}", obstacle.name);
            scene.add_described(Body::Obstacle(index), &placed).map_err(named)?;
        }
        scene.add_fingers(problem, hand, travel)?;
        scene.pair_up(problem, hand)?;
        Ok(scene)
    }

    /// Whether contacts live on a surface of their own.
    pub(crate) fn has_twin(&self) -> bool {
        !Arc::ptr_eq(&self.object, &self.touched)
    }

    fn add_fingers(&mut self, problem: &Problem, hand: &Chains, travel: &[f64]) -> Result<(), String> {
        for (f, (finger, chain)) in problem.hand.finger.iter().zip(&hand.fingers).enumerate() {
            let index = FingerIndex(f as u8);
            for (link, joint) in finger.joint.iter().enumerate() {
                for placed in &joint.link {
                    let body = Body::Link(index, link as u8);
                    let named = |e| format!("a link of finger `{}`: {e}", finger.name);
                    self.add_described(body, placed).map_err(named)?;
                    self.attach(chain, link, travel);
                }
            }
            self.add(Body::Fingertip(index), Core::Point(chain.p_LTip), hand.tip_radius);
            self.attach(chain, chain.joints.len() - 1, travel);
        }
        Ok(())
    }

    fn add_described(&mut self, body: Body, placed: &PlacedShape) -> Result<(), String> {
        let (core, radius) = Core::of(placed)?;
        self.add(body, core, radius);
        Ok(())
    }

    fn add(&mut self, body: Body, core: Core, radius: f64) {
        let ball = core.ball().map(|(center, core)| (center, core + radius));
        self.bodies.push(Solidity {
            body,
            core,
            radius,
            ball,
            link: None,
            first: 0,
            levers: Default::default(),
            turning: Default::default(),
        });
    }

    /// Fixes the body added last to a link.
    fn attach(&mut self, chain: &crate::hand::Chain, link: usize, travel: &[f64]) {
        let body = self.bodies.last_mut().expect("a body was just added");
        let reach = body.ball.map_or(f64::INFINITY, |(center, radius)| center.norm() + radius);
        body.link = Some(chain.first + link);
        body.first = chain.first;
        body.levers = chain.levers(link, reach, &travel[chain.first..]);
        for (turning, joint) in body.turning.iter_mut().zip(&chain.joints[..=link]) {
            *turning = f64::from(u8::from(joint.kind == JointKind::Revolute));
        }
    }

    fn pair_up(&mut self, problem: &Problem, hand: &Chains) -> Result<(), String> {
        let mounted = self.mounted(problem, hand)?;
        let touching = touching(&problem.hand)?;
        for a in 0..self.bodies.len() {
            for b in a + 1..self.bodies.len() {
                let (first, second) = (self.bodies[a].body, self.bodies[b].body);
                let by_construction = first == Body::Palm && mounted.contains(&second);
                let by_construction = by_construction
                    || touching.contains(&(first, second))
                    || touching.contains(&(second, first));
                if may_not_touch(first, second, &problem.hand) && !by_construction {
                    self.pairs.push((a, b));
                }
            }
        }
        Ok(())
    }

    /// The links that are mounted on the palm: first links with a shape that are no farther from it, in the
    /// resting posture, than the planner keeps bodies apart.
    fn mounted(&self, problem: &Problem, hand: &Chains) -> Result<Vec<Body>, String> {
        let mut frames = Frames::new(hand);
        for (finger, chain) in problem.hand.finger.iter().zip(&hand.fingers) {
            if finger.rest.len() != chain.joints.len() || !finger.rest.iter().all(|q| q.is_finite()) {
                return Err(format!("finger `{}`: `rest` needs one number for each joint", finger.name));
            }
            chain.frames(&finger.rest, &mut frames.X_HL[chain.first..]);
        }
        let limits = &problem.limits;
        let close = limits.tolerances.clearance + limits.resolution.clearance;
        let distance = |a: usize, b: usize| {
            let (first, second) = (&self.bodies[a], &self.bodies[b]);
            let (X_HA, X_HB) = (self.pose(a, &frames), self.pose(b, &frames));
            distance(&first.core, X_HA, &second.core, X_HB, true) - first.radius - second.radius
        };
        let palm: Vec<usize> =
            (0..self.bodies.len()).filter(|&a| self.bodies[a].body == Body::Palm).collect();
        let is_first =
            |body: Body| matches!((body, rank(body, &problem.hand)), (Body::Link(..), Some((_, 0))));
        let links = (0..self.bodies.len()).filter(|&b| is_first(self.bodies[b].body));
        let mounted = links.filter(|&b| palm.iter().any(|&a| distance(a, b) <= close));
        Ok(mounted.map(|b| self.bodies[b].body).collect())
    }

    /// The pose of a body's frame in H.
    pub(crate) fn pose<'f>(&self, body: usize, frames: &'f Frames) -> &'f Pose {
        static IDENTITY: std::sync::LazyLock<Pose> = std::sync::LazyLock::new(Pose::identity);
        match (self.bodies[body].link, self.bodies[body].body) {
            (Some(link), _) => &frames.X_HL[link],
            (None, Body::Object) => &frames.X_HO,
            _ => &IDENTITY,
        }
    }
}

/// The pairs that the hand's description says touch by construction.
fn touching(hand: &HandDescription) -> Result<Vec<(Body, Body)>, String> {
    let body = |name: &String| {
        hand.body_named(name).ok_or_else(|| format!("`touching`: `{name}` is not the name of one body"))
    };
    hand.touching.iter().map(|[a, b]| Ok((body(a)?, body(b)?))).collect()
}

/// A joint at rest moves nothing, however far its link reaches.
fn lever_times(lever: f64, step: f64) -> f64 {
    if step == 0.0 { 0.0 } else { lever * step }
}

/// Which link of each finger is the first, the last and so on that has a shape: its rank among them; a
/// fingertip has the last link's rank.
fn rank(body: Body, hand: &HandDescription) -> Option<(usize, usize)> {
    let shaped = |finger: usize, below: usize| {
        hand.finger[finger].joint[..below].iter().filter(|joint| !joint.link.is_empty()).count()
    };
    match body {
        Body::Link(finger, link) => Some((finger.index(), shaped(finger.index(), link.into()))),
        Body::Fingertip(finger) => {
            let joints = hand.finger[finger.index()].joint.len();
            Some((finger.index(), shaped(finger.index(), joints)))
        }
        _ => None,
    }
}

/// Whether a pair is to be compared: not what is fixed to the same frame, nor consecutive links of a finger
/// (those between which no link has a shape), of which the fingertip is the last.
fn may_not_touch(a: Body, b: Body, hand: &HandDescription) -> bool {
    let fixed = |body: Body| matches!(body, Body::Palm | Body::Obstacle(_));
    match (rank(a, hand), rank(b, hand)) {
        (Some((f, i)), Some((g, j))) => f != g || i.abs_diff(j) > 1,
        (None, None) => !(fixed(a) && fixed(b)) && a != b,
        _ => true,
    }
}
