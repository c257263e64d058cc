//! Each kind of damage is caught by the check that is meant, at the place where it is.

use crate::common;

use common::*;
use regrasp_api::*;
use regrasp_plan::*;
use regrasp_verify::{Verdict, verify};
use regrasp_world::ChainHand;

/// The names of the checks that fail after a damage.
fn failures(damage: impl FnOnce(&mut Plan)) -> Vec<&'static str> {
    names(&judged(damage))
}

fn judged(damage: impl FnOnce(&mut Plan)) -> Verdict {
    let mut plan = plan(5);
    damage(&mut plan);
    verify(&plan)
}

/// A plan whose motion is made anew by `make`, from the original one.
fn with_motion(make: impl FnOnce(&ChainHand, &mut Motion)) -> Verdict {
    judged(|plan| {
        let hand = ChainHand::new(plan.scenario.problem.hand.clone()).unwrap();
        let mut motion = regrasp_plan::motion(plan).unwrap();
        make(&hand, &mut motion);
        assign_times(&mut motion, &hand, &TimingLimits::default()).unwrap();
        plan.segments = records(&motion, &hand).unwrap();
    })
}

#[test]
fn undamaged_plans_pass() {
    assert_eq!(failures(|_| {}), [""; 0]);
}

#[test]
fn form() {
    assert_eq!(failures(|p| p.segments[1].states[2].joints[0].truncate(2)), ["form"]);
    assert_eq!(failures(|p| p.segments[1].states[2].contacts.truncate(2)), ["form"]);
    assert_eq!(failures(|p| p.segments[1].states[2].joints[0][0] = f64::NAN), ["form"]);
    assert_eq!(failures(|p| p.segments[0].states[1].object.orientation = [0.0; 4]), ["form"]);
    assert_eq!(failures(|p| p.segments[0].states.truncate(1)), ["form"]);
    assert_eq!(failures(|p| p.segments[1].finger = None), ["form"]);
    assert_eq!(failures(|p| p.segments[1].finger = Some(4)), ["form"]);
    assert_eq!(failures(|p| p.scenario.problem.hand.finger.clear()), ["form"]);
    assert_eq!(failures(|p| p.scenario.problem.object.friction = -1.0), ["form"]);
    assert_eq!(failures(|p| p.scenario.problem.limits.tolerances.slip = f64::NAN), ["form"]);
    assert_eq!(failures(|p| p.scenario.problem.limits.tolerances.closure = 1.0), ["form"]);
    assert_eq!(failures(|p| p.object = None), ["form"], "as in version 1");
    let facets = |p: &mut Plan, change: fn(&mut Facets)| {
        change(p.object.as_mut().unwrap().surface.as_mut().unwrap());
    };
    assert_eq!(failures(|p| facets(p, |f| f.vertices[3][1] += 1e-6)), ["form"]);
    assert_eq!(failures(|p| facets(p, |f| f.facets.truncate(11))), ["form"]);
    assert_eq!(
        failures(|p| facets(p, |f| f.vertices.iter_mut().flatten().for_each(|x| *x *= 0.5))),
        ["form"]
    );
    let file = ObjectShape::Mesh(MeshSource { file: Some("cube.stl".into()), ..Default::default() });
    let verdict = judged(|p| p.scenario.problem.object.shape = file);
    assert_eq!(names(&verdict), ["form"]);
    assert!(verdict.checks[0].place.note.as_ref().unwrap().contains("stand alone"));
}

#[test]
fn quaternions() {
    let long = |p: &mut Plan| p.segments[2].states[3].object.orientation.iter_mut().for_each(|x| *x *= 1.001);
    let verdict = judged(long);
    assert_eq!(names(&verdict), ["quaternions"]);
    let place = &verdict.check("quaternions").unwrap().place;
    assert_eq!((place.segment, place.state), (Some(2), Some(3)));
}

#[test]
fn times_and_rates() {
    let stretch = |p: &mut Plan, factor: f64| {
        for state in p.segments.iter_mut().flat_map(|segment| &mut segment.states) {
            state.time *= factor;
            state.velocities.iter_mut().flatten().flatten().for_each(|v| *v /= factor);
        }
    };
    assert_eq!(failures(|p| stretch(p, 0.9)), ["accelerations"]);
    assert_eq!(failures(|p| stretch(p, 0.1)), ["velocities", "accelerations"]);
    let back = failures(|p| p.segments[0].states[2].time = p.segments[0].states[1].time);
    assert!(back.contains(&"times") && back.contains(&"velocities"), "{back:?}");
    assert_eq!(failures(|p| stretch(p, 10.0)), [""; 0]);
}

#[test]
fn joint_limits() {
    let verdict = judged(|p| p.scenario.problem.hand.finger[2].joint[2].upper = 0.5);
    assert_eq!(names(&verdict), ["joint-limits"]);
    let place = &verdict.check("joint-limits").unwrap().place;
    assert_eq!((place.finger, place.joint), (Some(2), Some(2)));
}

#[test]
fn continuity() {
    let verdict = judged(|p| p.segments[2].states[0].time += 1e-12);
    assert_eq!(names(&verdict), ["continuity"]);
    assert_eq!(verdict.check("continuity").unwrap().place.segment, Some(2));
    let contact = failures(|p| p.segments[0].states[5].contacts[3].as_mut().unwrap().point_O[2] += 1e-9);
    assert_eq!(contact, ["continuity"]);
}

#[test]
fn rest() {
    assert_eq!(failures(|p| p.segments[1].states[4].object.position[1] += 1e-9), ["rest"]);
    let verdict = judged(|p| p.segments[1].states[4].joints[2][1] += 1e-9);
    assert_eq!(names(&verdict), ["rest"]);
    assert_eq!(verdict.check("rest").unwrap().place.finger, Some(2));
}

#[test]
fn contacts() {
    let lost = failures(|p| p.segments[0].states[2].contacts[0] = None);
    assert!(lost.contains(&"contacts"), "{lost:?}");
    let held = failures(|p| {
        let contact = p.segments[1].states[0].contacts[1];
        p.segments[1].states[3].contacts[1] = contact;
    });
    assert!(held.contains(&"contacts"), "{held:?}");
    let moved = failures(|p| p.segments[1].states[4].contacts[0].as_mut().unwrap().point_O[2] += 1e-9);
    assert_eq!(moved, ["contacts"]);
}

#[test]
fn closure() {
    let verdict = judged(|p| p.segments[0].states[2].object.position[0] += 30e-6);
    assert_eq!(names(&verdict), ["closure"]);
    assert!((verdict.check("closure").unwrap().worst.unwrap() - 30e-6).abs() < 1e-6);
    // The plan says where the contact is, on either body: both must be true.
    assert_eq!(
        failures(|p| p.segments[0].states[2].contacts[0].as_mut().unwrap().point_F[2] += 1e-4),
        ["closure"]
    );
    assert_eq!(
        failures(|p| p.segments[0].states[2].contacts[0].as_mut().unwrap().point_O[2] += 1e-4),
        ["closure"]
    );
    // The same distance, but from inside.
    let inside = failures(|p| {
        p.segments
            .iter_mut()
            .flat_map(|segment| &mut segment.states)
            .for_each(|s| s.object.position[0] -= 0.02);
    });
    assert!(inside.contains(&"closure") && inside.contains(&"clearance"), "{inside:?}");
}

#[test]
fn normals() {
    let tilt = |p: &mut Plan, angle: f64| {
        let n = &mut p.segments[0].states[2].contacts[0].as_mut().unwrap().normal_O;
        *n = [angle.cos(), angle.sin(), 0.0];
    };
    assert_eq!(failures(|p| tilt(p, 2e-3)), ["normals"]);
    assert_eq!(failures(|p| tilt(p, 0.5e-3)), [""; 0]);
    assert_eq!(failures(|p| tilt(p, std::f64::consts::PI)), ["normals"], "inward");
}

#[test]
fn slip() {
    // The object moves on while one fingertip drags: in the end it is 0.3 mm from where it would have rolled
    // to.
    let drag = |hand: &ChainHand, motion: &mut Motion, distance: f64| {
        let states = &mut motion.segments[2].states;
        let last = states.len() - 1;
        for (k, q) in states.iter_mut().enumerate() {
            let mut contact = q.contacts[NORTH].unwrap();
            contact.p_OC.x += distance * k as f64 / last as f64;
            q.contacts[NORTH] = Some(contact);
            q.joints[NORTH] = reach(hand, q, NORTH, &contact, 0.0);
        }
    };
    let verdict = with_motion(|hand, motion| drag(hand, motion, 3e-4));
    assert_eq!(names(&verdict), ["slip"]);
    let check = verdict.check("slip").unwrap();
    assert_eq!((check.place.segment, check.place.finger), (Some(2), Some(1)));
    // The tip turns a little as it is dragged, so that it does not slip by all of it.
    assert!((1.5e-4..3.1e-4).contains(&check.worst.unwrap()), "{check:?}");
    assert!(with_motion(|hand, motion| drag(hand, motion, 5e-5)).valid);
}

#[test]
fn equal_lengths_are_not_rolling() {
    // The cube moves and the fingertips with it: no slip. Then only the contacts are turned back, so that
    // paths on both bodies are equally long.
    let verdict = with_motion(|hand, motion| {
        let states = &mut motion.segments[0].states;
        let start = states[0].clone();
        for q in &mut states[1..] {
            let (was, is) = (start.contacts[NORTH].unwrap(), q.contacts[NORTH].unwrap());
            let mirrored = Contact { p_OC: was.p_OC * 2.0 - is.p_OC, ..is };
            q.contacts[NORTH] = Some(mirrored);
            q.joints[NORTH] = reach(hand, q, NORTH, &mirrored, 0.0);
        }
        motion.segments.truncate(1);
    });
    assert!(names(&verdict).contains(&"slip"), "{:?}", names(&verdict));
}

#[test]
fn lift_and_touch() {
    // Up by 2 mm, down by 1 mm, up again.
    let swap = |_: &ChainHand, motion: &mut Motion| motion.segments[1].states.swap(1, 2);
    let verdict = with_motion(swap);
    assert_eq!(names(&verdict), ["lift"]);
    assert!(
        (verdict.check("lift").unwrap().worst.unwrap() - 1e-3).abs() < 1e-5,
        "a millimetre below the highest point yet"
    );
    // The tip slides on the surface before it lifts.
    let slide = |hand: &ChainHand, motion: &mut Motion| {
        let states = &mut motion.segments[1].states;
        let mut q = states[0].clone();
        let contact = q.contacts[NORTH].unwrap();
        q.contacts[NORTH] = None;
        let slid = |k: usize| Contact { p_OC: contact.p_OC + Vec3::x() * 2e-4 * k as f64, ..contact };
        let postures: Vec<_> = (1..=2).map(|k| reach(hand, &q, NORTH, &slid(k), 1e-6 * k as f64)).collect();
        for (k, joints) in postures.into_iter().enumerate() {
            q.joints[NORTH] = joints;
            states.insert(1 + k, q.clone());
        }
    };
    let failed = names(&with_motion(slide));
    assert!(failed.contains(&"touch-travel"), "{failed:?}");
    // It never lifts: it slides all the way, which is no clearance from the object.
    let drag = |hand: &ChainHand, motion: &mut Motion| {
        let states = &mut motion.segments[1].states;
        let (from, to) =
            (states[0].contacts[NORTH].unwrap(), states[states.len() - 1].contacts[NORTH].unwrap());
        let last = states.len() - 1;
        for (k, q) in states.iter_mut().enumerate().take(last).skip(1) {
            let contact = Contact { p_OC: from.p_OC.lerp(&to.p_OC, k as f64 / last as f64), ..from };
            q.joints[NORTH] = reach(hand, q, NORTH, &contact, 0.0);
        }
    };
    let failed = names(&with_motion(drag));
    assert!(failed.contains(&"clearance") || failed.contains(&"touch-travel"), "{failed:?}");
}

#[test]
fn clearance() {
    let bar = |p: &mut Plan, x: f64| {
        let shape = Shape::Capsule { from: [x, 0.0, 0.0], to: [x, 0.0, 0.2], radius: 0.008 };
        p.scenario.problem.obstacle[0].shape = shape;
    };
    let verdict = judged(|p| bar(p, 0.05));
    assert_eq!(names(&verdict), ["clearance"]);
    let pair = verdict.check("clearance").unwrap().place.pair.unwrap();
    assert_eq!(pair.0, Body::Obstacle(0));
    assert!(matches!(pair.1, Body::Link(FingerIndex(0), _)), "{pair:?}");
    assert_eq!(failures(|p| p.scenario.problem.limits.tolerances.clearance = 0.0025), ["clearance"]);
    assert_eq!(failures(|p| p.scenario.problem.limits.tolerances.clearance = 0.0015), [""; 0]);
    // An obstacle within the object.
    let inner = PoseDescription { position: [0.0, 0.0, 0.085], ..Default::default() };
    let verdict = judged(|p| {
        p.scenario.problem.obstacle[0].shape = Shape::Box { size: [0.001; 3] };
        p.scenario.problem.obstacle[0].pose = inner;
    });
    assert_eq!(names(&verdict), ["clearance"]);
}

#[test]
fn stability() {
    let verdict = judged(|p| p.claims.contact.cone.as_mut().unwrap().mu = 0.1);
    assert_eq!(names(&verdict), ["stability"]);
    assert!(verdict.check("stability").unwrap().worst.unwrap() <= 0.0);
    // A finger that the plan says is free holds nothing: of the three others two do not hold alone.
    let failed = failures(|p| {
        for state in p.segments.iter_mut().flat_map(|segment| &mut segment.states) {
            (state.contacts[0], state.contacts[2]) = (None, None);
        }
    });
    assert!(failed.contains(&"stability"), "{failed:?}");
}

#[test]
fn soft_fingers_have_no_torsion_in_transfers() {
    // Two soft fingers hold while the object rests; while it moves they may spin and do not.
    let soft = |p: &mut Plan| {
        p.claims.contact = ContactClaim {
            model: "contact-model/soft-finger".into(),
            cone: Some(ConeClaim::round(0.8, 0.002)),
            cones: vec![],
        };
        let settings = serde_json::json!({"gamma": 0.002});
        let choice = PluginChoice { id: "contact-model/soft-finger".into(), settings };
        p.scenario.plugins.insert(Slot::ContactModel, choice);
    };
    assert_eq!(failures(soft), [""; 0]);
    let hand = ChainHand::new(problem().hand).unwrap();
    let verdict = judged(|p| {
        soft(p);
        for state in p.segments.iter_mut().flat_map(|segment| &mut segment.states) {
            state.contacts[3] = None;
            let mut south = hand.finger(FingerIndex(3)).rest.to_vec();
            south[1] = -0.9;
            state.joints[3] = south;
        }
        p.segments.remove(2);
        p.segments.remove(0);
        p.scenario.problem.start.pose = pose_of(&p.segments[0].states[0]);
        p.scenario.problem.goal.clear();
        p.goals_reached.clear();
        // Times and joints that change their velocity from state to state.
        p.segments[0].states.iter_mut().enumerate().for_each(|(k, state)| {
            state.time = 0.2 * k as f64;
            state.velocities = None;
        });
    });
    assert_eq!(names(&verdict), [""; 0], "two soft fingers while the third regrasps");
    let verdict = judged(|p| {
        soft(p);
        p.claims.contact.cone.as_mut().unwrap().gamma = 0.01;
    });
    assert_eq!(names(&verdict), ["claims"]);
}

fn pose_of(state: &StateRecord) -> PoseDescription {
    PoseDescription {
        position: state.object.position,
        orientation: Some(state.object.orientation),
        ..Default::default()
    }
}

#[test]
fn claims() {
    assert_eq!(failures(|p| p.claims.contact.cone.as_mut().unwrap().mu = 0.81), ["claims"]);
    assert_eq!(failures(|p| p.claims.contact.cone.as_mut().unwrap().gamma = 1e-3), ["claims"]);
    assert_eq!(failures(|p| p.claims.contact.cone = None), ["claims"]);
    assert_eq!(failures(|p| p.claims.contact.model = "contact-model/glue".into()), ["claims"]);
    assert_eq!(failures(|p| p.claims.margin.length *= 0.5), ["claims"]);
    let nan = failures(|p| p.claims.contact.cone.as_mut().unwrap().mu = f64::NAN);
    assert_eq!(nan, ["stability", "claims"]);
    // A model of somebody else's is said to be unknown, and its cones unchecked if they are not elliptic.
    let verdict = judged(|p| {
        p.claims.contact = ContactClaim { model: "contact-model/gecko".into(), cone: None, cones: vec![] };
        p.scenario.plugins.get_mut(&Slot::ContactModel).unwrap().id = "contact-model/gecko".into();
    });
    assert!(verdict.valid);
    for name in ["stability", "claims"] {
        let check = verdict.check(name).unwrap();
        assert!(check.place.note.as_ref().unwrap().starts_with("not independently checked"), "{check:?}");
    }
}

#[test]
fn start_and_goals() {
    assert_eq!(failures(|p| p.scenario.problem.start.pose.position[2] += 2e-6), ["start"]);
    let turned = PoseDescription {
        position: [0.0, 0.0, 0.085],
        axis: Some([0.0, 0.0, 1.0]),
        angle_deg: Some(1e-3),
        ..Default::default()
    };
    assert_eq!(failures(|p| p.scenario.problem.start.pose = turned), ["start"]);
    let verdict = judged(|p| p.scenario.problem.goal[1].pose.position[0] += 2e-6);
    assert_eq!(names(&verdict), ["goals"]);
    assert_eq!(verdict.check("goals").unwrap().place.goal, Some(1));
    assert_eq!(failures(|p| p.goals_reached = vec![3, 1]), ["goals"]);
    assert_eq!(failures(|p| p.goals_reached = vec![1, 7]), ["goals"]);
    let verdict = judged(|p| p.goals_reached = vec![1]);
    assert_eq!(names(&verdict), ["complete"]);
    assert!(verdict.is_sound() && !verdict.valid);
}

#[test]
fn given_grasps() {
    let given = |p: &Plan, segment: usize, state: usize| -> Vec<FingerGrasp> {
        let state = &p.segments[segment].states[state];
        let finger = |(contact, joints): (&Option<ContactRecord>, &Vec<f64>)| FingerGrasp {
            contact: contact.map(|contact| contact.point_O),
            joints: Some(joints.clone()),
        };
        state.contacts.iter().zip(&state.joints).map(finger).collect()
    };
    let with = |change: fn(&mut Vec<FingerGrasp>)| {
        failures(|p| {
            let mut grasp = given(p, 0, 0);
            change(&mut grasp);
            p.scenario.problem.start.grasp = Some(grasp);
            p.scenario.problem.goal[1].grasp = Some(given(p, 2, 5));
        })
    };
    assert_eq!(with(|_| {}), [""; 0]);
    assert_eq!(with(|grasp| grasp[2].contact.as_mut().unwrap()[2] += 2e-3), ["start"]);
    assert_eq!(with(|grasp| grasp[2].contact = None), ["start"]);
    assert_eq!(with(|grasp| grasp[2].joints.as_mut().unwrap()[2] += 0.1), ["start"]);
    assert_eq!(with(|grasp| grasp.truncate(3)), ["start"]);
}
