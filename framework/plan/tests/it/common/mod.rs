//! A hand without links and a motion of it, for the tests of files and times.

#![allow(dead_code, reason = "each test file uses its part")]

use regrasp_api::*;
use regrasp_plan::Criterion;
use regrasp_plan::*;
use std::collections::BTreeMap;

/// Fingertips that three prismatic joints move, each about its own corner.
pub struct Fingertips {
    pub fingers: Vec<FingerModel>,
}

impl Fingertips {
    pub fn new(count: usize, velocity: f64, acceleration: f64) -> Self {
        let joint = |axis: usize| JointModel {
            name: format!("axis-{axis}"),
            kind: JointKind::Prismatic,
            lower: -1.0,
            upper: 1.0,
            velocity: velocity * (1.0 + 0.3 * axis as f64),
            acceleration,
            effort: 1.0,
        };
        let finger = |index: usize| FingerModel {
            name: format!("tip-{index}"),
            joints: (0..3).map(joint).collect(),
            spare: vec![],
            rest: FingerJoints::zeros(3),
            p_HReach: Vec3::zeros(),
            reach: 2.0,
        };
        Self { fingers: (0..count).map(finger).collect() }
    }
}

impl Hand for Fingertips {
    fn finger_count(&self) -> usize {
        self.fingers.len()
    }
    fn finger(&self, finger: FingerIndex) -> &FingerModel {
        &self.fingers[finger.index()]
    }
    fn fingertip_radius(&self) -> f64 {
        0.01
    }
    fn tip_center(&self, _: FingerIndex, joints: &FingerJoints) -> Vec3 {
        Vec3::new(joints[0], joints[1], joints[2])
    }
    fn tip_kinematics(&self, finger: FingerIndex, joints: &FingerJoints) -> TipKinematics {
        TipKinematics {
            p_HF: self.tip_center(finger, joints),
            R_HF: Rotation::identity(),
            J_v: TipJacobian::identity(),
            J_w: TipJacobian::zeros(),
        }
    }
    fn inverse(&self, _: FingerIndex, p_HF: &Vec3, _: &FingerJoints) -> Option<FingerJoints> {
        let mut joints = FingerJoints::zeros(3);
        joints.copy_from_slice(p_HF.as_slice());
        Some(joints)
    }
}

/// A state with joints and pose drawn at random.
pub fn state(random: &mut Random, fingers: usize) -> Configuration {
    let joints = |random: &mut Random| {
        let mut joints = FingerJoints::zeros(3);
        joints.iter_mut().for_each(|q| *q = random.range(-1.0, 1.0));
        joints
    };
    Configuration {
        X_HO: Pose::from_parts((random.direction() * 0.1).into(), random.rotation()),
        joints: PerFinger::from_fn(fingers, |_| joints(random)),
        contacts: PerFinger::from_fn(fingers, |finger| {
            (finger.0 > 0).then(|| Contact {
                facet: UNKNOWN_FACET,
                p_OC: random.direction() * 0.03,
                n_O: random.direction(),
            })
        }),
    }
}

/// A transfer, a regrasp and a transfer of `states` states each.
pub fn walk(seed: u64, fingers: usize, states: usize) -> Motion {
    let mut random = Random::from_key(seed, 0, 0, 0);
    let mut last = state(&mut random, fingers);
    let mut motion = Motion::default();
    for kind in [SegmentKind::Transfer, SegmentKind::Regrasp(FingerIndex(1)), SegmentKind::Transfer] {
        let mut segment = Segment::new(kind, vec![last.clone()]);
        let mut velocity = [0.0; 24];
        for _ in 1..states {
            let mut next = last.clone();
            for finger in last.joints.fingers() {
                for (j, q) in next.joints[finger].iter_mut().enumerate() {
                    let v = &mut velocity[finger.index() * 3 + j];
                    *v = 0.9 * *v + 0.002 * random.normal();
                    *q += *v;
                }
            }
            segment.states.push(next.clone());
            last = next;
        }
        motion.segments.push(segment);
    }
    motion
}

/// A plan about a ball, with the given motion.
pub fn plan(motion: &Motion, hand: &dyn Hand) -> Plan {
    let joint =
        serde_json::json!({"name": "j", "kind": "prismatic", "axis": [1, 0, 0], "lower": -1, "upper": 1});
    let finger = serde_json::json!({"name": "tip", "joint": [joint, joint, joint], "rest": [0, 0, 0]});
    let problem = serde_json::json!({
        "hand": {"name": "tips", "fingertip_radius": 0.01, "finger": vec![finger; hand.finger_count()]},
        "object": {"shape": {"kind": "sphere", "radius": 0.03, "facets": 320}, "friction": 0.8},
        "start": {"pose": {"position": [0.1, 0.2, 0.3]}},
        "goal": [{"pose": {"axis": [0, 0, 1], "angle_deg": 90.0}}],
    });
    let choice = PluginChoice { id: "sampler/rlg".into(), settings: serde_json::json!({"tries": 30}) };
    Plan {
        format: Format::RegraspPlan,
        version: VERSION,
        scenario: ResolvedScenario {
            name: "test".into(),
            problem: serde_json::from_value(problem).unwrap(),
            plugins: BTreeMap::from([(Slot::Sampler, choice)]),
        },
        seed: 7,
        object: None,
        notes: BTreeMap::new(),
        versions: BTreeMap::from([("regrasp".into(), "0.1.0".into())]),
        claims: Claims {
            contact: ContactClaim {
                model: "contact-model/pcwf".into(),
                cone: Some(ConeClaim::round(0.8, 0.0)),
                cones: vec![],
            },
            criterion: Criterion::Closure,
            transfer_law: TransferLaw::Rolling,
            margin: MarginFrame { center_O: [0.0; 3], length: 0.03 },
        },
        goals_reached: vec![3],
        stopped_by: None,
        statistics: Statistics::default(),
        certificate: None,
        segments: records(motion, hand).unwrap(),
    }
}
