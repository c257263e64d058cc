//! What happens between samples: thin obstacles are not jumped over, nor are concave edges.

use crate::common;

use regrasp_api::*;
use regrasp_plan::*;
use regrasp_verify::{Verdict, verify};

/// A fingertip of 0.1 mm that slides along three axes; a block 0.2 m below; one segment from `states`
/// (positions of the tip, m).
fn probe(kind: SegmentName, states: &[[f64; 3]], edit: impl FnOnce(&mut Problem)) -> Verdict {
    let mut plan = common::plan(1);
    let axis = |i: usize| JointDescription {
        name: format!("axis-{i}"),
        kind: JointKind::Prismatic,
        origin: PoseDescription::default(),
        axis: std::array::from_fn(|k| f64::from(u8::from(k == i))),
        lower: -0.1,
        upper: 0.1,
        velocity: 10.0,
        acceleration: 1000.0,
        effort: 1.0,
        mimic: None,
        link: vec![],
    };
    let finger = FingerDescription {
        name: "probe".into(),
        base: PoseDescription::default(),
        joint: (0..3).map(axis).collect(),
        tip: [0.0; 3],
        rest: vec![0.0; 3],
    };
    let problem = &mut plan.scenario.problem;
    problem.hand = HandDescription {
        name: "probe".into(),
        references: vec![],
        fingertip_radius: 1e-4,
        fingertip: Default::default(),
        palm: vec![],
        finger: vec![finger],
        touching: vec![],
    };
    problem.start.pose.position = [0.0, 0.0, -0.2];
    problem.obstacle.clear();
    edit(problem);
    common::record_object(&mut plan);
    let problem = &plan.scenario.problem;
    let object = PoseRecord { position: problem.start.pose.position, orientation: [1.0, 0.0, 0.0, 0.0] };
    let state = |(k, q): (usize, &[f64; 3])| StateRecord {
        time: k as f64,
        object,
        joints: vec![q.to_vec()],
        velocities: None,
        contacts: vec![None],
        cones: None,
        forces: None,
    };
    let finger = (kind == SegmentName::Regrasp).then_some(0);
    plan.segments =
        vec![SegmentRecord { kind, finger, states: states.iter().enumerate().map(state).collect() }];
    verify(&plan)
}

fn with_ball(x: f64, y: f64, radius: f64) -> impl FnOnce(&mut Problem) {
    move |problem| {
        problem.obstacle.push(ObstacleDescription {
            name: "pea".into(),
            shape: Shape::Sphere { radius },
            pose: PoseDescription { position: [x, y, 0.0], ..Default::default() },
        });
    }
}

#[test]
fn thin_obstacles_between_samples_are_found() {
    // Samples are 2 mm apart, tip and obstacle 0.1 mm small: only a bisection meets the obstacle at 3 mm.
    let path = [[-0.01, 0.0, 0.0], [0.01, 0.0, 0.0]];
    let check = |x: f64, y: f64| {
        let verdict = probe(SegmentName::Regrasp, &path, with_ball(x, y, 1e-4));
        verdict.check("clearance").unwrap().clone()
    };
    let hit = check(0.003, 0.0);
    assert!(!hit.ok, "{hit:?}");
    assert_eq!(hit.place.pair, Some((Body::Obstacle(0), Body::Fingertip(FingerIndex(0)))));
    assert!((hit.place.time.unwrap() - 0.65).abs() < 0.02, "{hit:?}");
    assert!(check(0.003, 3e-4).ok, "passing by is fine");
    // At a sample the distance is exact.
    let near = check(0.0, 1e-3);
    assert!((near.worst.unwrap() - 8e-4).abs() < 1e-12, "{near:?}");
}

#[test]
fn a_lifted_tip_does_not_pass_through_the_object_between_samples() {
    let plate = |problem: &mut Problem| {
        problem.object.shape = ObjectShape::Cuboid { size: [0.0002, 0.05, 0.05] };
        problem.start.pose.position = [0.003, 0.0, 0.0];
    };
    let path = [[-0.01, 0.0, 0.0], [0.01, 0.0, 0.0]];
    let verdict = probe(SegmentName::Regrasp, &path, plate);
    assert!(!verdict.check("clearance").unwrap().ok);
    let past = [[-0.01, 0.03, 0.0], [0.01, 0.03, 0.0]];
    assert!(probe(SegmentName::Regrasp, &past, plate).check("clearance").unwrap().ok);
    // In a transfer a free fingertip may not touch either.
    assert!(!probe(SegmentName::Transfer, &path, plate).check("clearance").unwrap().ok);
}

/// A corner that opens towards +x and +z: an L along y, 40 mm long, its inner edge at the origin.
fn corner() -> ObjectShape {
    let outline = [[-0.02, -0.02], [0.04, -0.02], [0.04, 0.0], [0.0, 0.0], [0.0, 0.04], [-0.02, 0.04]];
    let vertices = [-0.02, 0.02].iter().flat_map(|&y| outline.map(|[x, z]| [x, y, z])).collect();
    let mut facets = Vec::new();
    for i in 0..6_u32 {
        let j = (i + 1) % 6;
        facets.extend([[i, j, j + 6], [i, j + 6, i + 6]]);
    }
    // Both ends, as two rectangles that share the inner edge's vertex.
    let fan = [[0, 1, 3], [1, 2, 3], [0, 3, 5], [3, 4, 5]];
    facets.extend(fan.map(|[a, b, c]: [u32; 3]| [a, c, b]));
    facets.extend(fan.map(|f| f.map(|v| v + 6)));
    let flipped = facets.iter().map(|&[a, b, c]| [a, c, b]).collect();
    let mesh = |facets| MeshSource { vertices: Vec::clone(&vertices), facets, ..Default::default() };
    let outward = mesh(facets.clone()).mesh().is_ok();
    ObjectShape::Mesh(mesh(if outward { facets } else { flipped }))
}

#[test]
fn contacts_do_not_jump_over_concave_edges() {
    let judge = |path: &[[f64; 2]]| {
        let mut plan = common::plan(1);
        let place = |problem: &mut Problem| {
            problem.hand.fingertip_radius = 0.01;
            problem.object.shape = corner();
            problem.start.pose.position = [0.0; 3];
        };
        // The tip touches all the time: the file says so.
        let hand = probe_hand(place, &mut plan);
        plan.segments = vec![SegmentRecord {
            kind: SegmentName::Transfer,
            finger: None,
            states: path.iter().enumerate().map(|(k, p)| touching(k as f64, *p, hand)).collect(),
        }];
        verify(&plan)
    };
    // Down the wall at x = 0 into the corner, and out along the floor at z = 0: the contact jumps by 14 mm.
    let verdict = judge(&[[0.01, 0.03], [0.01, 0.01], [0.03, 0.01]]);
    let jump = verdict.check("contact-jumps").unwrap();
    assert!(!jump.ok && jump.worst.unwrap() > 0.01, "{jump:?}");
    assert!(verdict.check("closure").unwrap().ok, "{verdict:?}");
    let wall = judge(&[[0.01, 0.03], [0.01, 0.02]]);
    assert!(wall.check("contact-jumps").unwrap().ok);
    assert!(!wall.check("slip").unwrap().ok, "a tip that cannot turn slips");
}

fn probe_hand(place: impl FnOnce(&mut Problem), plan: &mut Plan) -> f64 {
    let mut edited = None;
    probe(SegmentName::Transfer, &[[0.05; 3], [0.05; 3]], |problem| {
        place(problem);
        edited = Some(problem.clone());
    });
    plan.scenario.problem = edited.expect("the edit was made");
    plan.scenario.problem.hand.fingertip_radius
}

/// A tip at x, z that touches the nearer of the walls x = 0 and z = 0.
fn touching(time: f64, [x, z]: [f64; 2], radius: f64) -> StateRecord {
    let on_wall = x <= z;
    let normal_O = if on_wall { [1.0, 0.0, 0.0] } else { [0.0, 0.0, 1.0] };
    let contact = ContactRecord {
        point_O: if on_wall { [0.0, 0.0, z] } else { [x, 0.0, 0.0] },
        normal_O,
        point_F: normal_O.map(|n| -n * radius),
    };
    StateRecord {
        time,
        object: PoseRecord { position: [0.0; 3], orientation: [1.0, 0.0, 0.0, 0.0] },
        joints: vec![vec![x, 0.0, z]],
        velocities: None,
        contacts: vec![Some(contact)],
        cones: None,
        forces: None,
    }
}
