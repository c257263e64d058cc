//! A plan made by hand: four fingers roll a cube a little, one finger takes a new contact, they roll on.

#![allow(dead_code, reason = "each test file uses its part")]

use nalgebra::Point3;
use regrasp_api::*;
use regrasp_plan::*;
use regrasp_verify::Verdict;
use regrasp_world::ChainHand;
use std::collections::BTreeMap;

const FOUR_FINGER: &str = include_str!("../../../../../scenarios/hands/four-finger.toml");
/// Half the cube's edge (m).
const HALF: f64 = 0.0225;
/// Fingertip radius (m).
const RADIUS: f64 = 0.010;

pub const NORTH: FingerIndex = FingerIndex(1);

/// The cube at a height where all fingers reach it, the goal a little further.
pub fn problem() -> Problem {
    let text = r#"{
        "hand": {"name": "-", "fingertip_radius": 0.01, "finger": []},
        "object": {"name": "cube", "shape": {"kind": "cuboid", "size": [0.045, 0.045, 0.045]}, "friction": 0.8},
        "obstacle": [{"name": "bar", "shape": {"kind": "capsule", "from": [0.1, 0.1, 0], "to": [0.1, 0.1, 0.2], "radius": 0.008}}],
        "start": {"pose": {"position": [0, 0, 0.085]}},
        "goal": []
    }"#;
    let mut problem: Problem = serde_json::from_str(text).unwrap();
    problem.hand = toml::from_str(FOUR_FINGER).unwrap();
    problem
}

/// Moves the object from `q` to `X_HO` in `steps` steps, every holding fingertip staying where it is on the
/// object.
pub fn pinned(hand: &ChainHand, q: &Configuration, X_HO: &Pose, steps: usize) -> Segment {
    let mut states = vec![q.clone()];
    for step in 1..=steps {
        let mut next = states[step - 1].clone();
        next.X_HO = interpolate(&q.X_HO, X_HO, step as f64 / steps as f64);
        for finger in q.holding().iter() {
            next.joints[finger] = reach(hand, &next, finger, &q.contacts[finger].unwrap(), 0.0);
        }
        states.push(next);
    }
    Segment::new(SegmentKind::Transfer, states)
}

/// Fingers on the faces +x, +y, -x, -y, a little off the middle.
pub fn start(hand: &ChainHand) -> Configuration {
    let X_HO = Pose::translation(0.0, 0.0, 0.085);
    let normals = [Vec3::x(), Vec3::y(), -Vec3::x(), -Vec3::y()];
    let contact = |finger: FingerIndex| {
        let n_O = normals[finger.index()];
        Contact { facet: 0, p_OC: n_O * HALF + Vec3::z() * 0.002 * f64::from(finger.0), n_O }
    };
    let mut q = Configuration {
        X_HO,
        joints: PerFinger::from_fn(4, |finger| hand.finger(finger).rest),
        contacts: PerFinger::from_fn(4, |finger| Some(contact(finger))),
    };
    for finger in q.joints.fingers() {
        q.joints[finger] = reach(hand, &q, finger, &q.contacts[finger].unwrap(), 0.0);
    }
    q
}

/// The joints that bring the fingertip to a height (m) above a contact.
pub fn reach(
    hand: &ChainHand,
    q: &Configuration,
    finger: FingerIndex,
    contact: &Contact,
    height: f64,
) -> FingerJoints {
    let p_HF = (q.X_HO * Point3::from(contact.tip_center(RADIUS + height))).coords;
    hand.inverse(finger, &p_HF, &q.joints[finger]).expect("the motion stays within reach")
}

/// Moves the object from `q` to `X_HO` in `steps` steps, every holding fingertip rolling on its flat face.
pub fn transfer(hand: &ChainHand, q: &Configuration, X_HO: &Pose, steps: usize) -> Segment {
    let mut states = vec![q.clone()];
    let mut last = q.clone();
    for step in 1..=steps {
        // Ten small steps for each that is stored, so that the sum is that of rolling to 1e-8 m.
        for part in 1..=10 {
            let s = ((step - 1) as f64 + part as f64 / 10.0) / steps as f64;
            last = rolled(hand, &last, &interpolate(&q.X_HO, X_HO, s));
        }
        states.push(last.clone());
    }
    Segment::new(SegmentKind::Transfer, states)
}

/// One small step: the contact moves so that the two material points at it move alike.
fn rolled(hand: &ChainHand, from: &Configuration, X_HO: &Pose) -> Configuration {
    let mut to = from.clone();
    to.X_HO = *X_HO;
    let R_OF = |q: &Configuration, finger| {
        q.X_HO.rotation.inverse() * hand.tip_kinematics(finger, &q.joints[finger]).R_HF
    };
    for finger in from.joints.fingers() {
        let Some(contact) = from.contacts[finger] else { continue };
        let mut moved = contact;
        for _ in 0..20 {
            to.joints[finger] = reach(hand, &to, finger, &moved, 0.0);
            let turn = (R_OF(&to, finger) * R_OF(from, finger).inverse()).scaled_axis();
            moved.p_OC = contact.p_OC + turn.cross(&contact.n_O) * RADIUS;
        }
        to.contacts[finger] = Some(moved);
        to.joints[finger] = reach(hand, &to, finger, &moved, 0.0);
    }
    to
}

/// Lifts `finger` by 8 mm, moves it along its face by `shift` (m, in O), sets it down.
pub fn regrasp(hand: &ChainHand, q: &Configuration, finger: FingerIndex, shift: Vec3) -> Segment {
    let contact = q.contacts[finger].unwrap();
    let mut states = vec![q.clone()];
    let mut moving = q.clone();
    moving.contacts[finger] = None;
    let mut put = |moving: &mut Configuration, along: f64, height: f64| {
        let contact = Contact { p_OC: contact.p_OC + shift * along, ..contact };
        moving.joints[finger] = reach(hand, moving, finger, &contact, height);
        states.push(moving.clone());
    };
    (1..=8).for_each(|k| put(&mut moving, 0.0, 0.001 * f64::from(k)));
    (1..=6).for_each(|k| put(&mut moving, f64::from(k) / 6.0, 0.008));
    (1..=8).for_each(|k| put(&mut moving, 1.0, 0.001 * f64::from(8 - k)));
    let end = states.last_mut().unwrap();
    end.contacts[finger] = Some(Contact { p_OC: contact.p_OC + shift, ..contact });
    Segment::new(SegmentKind::Regrasp(finger), states)
}

/// The whole motion, timed.
pub fn by_hand(hand: &ChainHand, steps: usize) -> Motion {
    let start = start(hand);
    let turned = |x: f64, angle: f64| {
        Pose::translation(x, 0.001, 0.086) * Rotation::from_scaled_axis(Vec3::new(0.3, 0.2, 1.0) * angle)
    };
    let first = transfer(hand, &start, &turned(0.002, 0.08), steps);
    let second = regrasp(hand, first.states.last().unwrap(), NORTH, Vec3::new(0.004, 0.0, -0.003));
    let third = transfer(hand, second.states.last().unwrap(), &turned(-0.001, 0.14), steps);
    let mut motion = Motion { segments: vec![first, second, third] };
    assign_times(&mut motion, hand, &TimingLimits::default()).unwrap();
    motion
}

/// Records the facets of the plan's object, after a change of it.
pub fn record_object(plan: &mut Plan) {
    let object = regrasp_world::load_object(&plan.scenario.problem.object).unwrap();
    plan.object = Some(ObjectRecord { surface: Some(Facets::from(&object.mesh)), contact_surface: None });
}

/// A plan that holds everything it must.
pub fn plan(steps: usize) -> Plan {
    let problem = problem();
    let hand = ChainHand::new(problem.hand.clone()).unwrap();
    let motion = by_hand(&hand, steps);
    plan_of(problem, &hand, &motion)
}

/// The plan of a motion of three segments, the first and the last of which reach a goal.
pub fn plan_of(mut problem: Problem, hand: &ChainHand, motion: &Motion) -> Plan {
    let goal = |segment: usize| motion.segments[segment].states.last().unwrap().X_HO;
    problem.goal = [0, 2]
        .map(|segment| GoalDescription { pose: PoseDescription::from(&goal(segment)), grasp: None })
        .to_vec();
    let object = regrasp_world::load_object(&problem.object).unwrap();
    let transfer_law = TransferLaw::of_fingertips(problem.hand.fingertip);
    let choice = PluginChoice { id: "contact-model/pcwf".into(), settings: serde_json::json!({}) };
    Plan {
        format: Format::RegraspPlan,
        version: VERSION,
        scenario: ResolvedScenario {
            name: "by hand".into(),
            problem,
            plugins: BTreeMap::from([(Slot::ContactModel, choice)]),
        },
        seed: 0,
        object: Some(ObjectRecord { surface: Some(Facets::from(&object.mesh)), contact_surface: None }),
        notes: BTreeMap::new(),
        versions: BTreeMap::new(),
        claims: Claims {
            contact: ContactClaim {
                model: "contact-model/pcwf".into(),
                cone: Some(ConeClaim::round(0.8, 0.0)),
                cones: vec![],
            },
            criterion: Criterion::Closure,
            transfer_law,
            margin: MarginFrame::of_object(&object),
        },
        goals_reached: vec![1, 3],
        stopped_by: None,
        statistics: Statistics::default(),
        certificate: None,
        segments: records(motion, hand).unwrap(),
    }
}

/// The names of the checks that fail.
pub fn names(verdict: &Verdict) -> Vec<&'static str> {
    let failed: Vec<_> = verdict.failures().map(|check| check.name).collect();
    assert_eq!(verdict.valid, failed.is_empty());
    failed
}
