use super::*;
use regrasp_api::{
    Clearance, Configuration, FingerGrasp, FingerSet, GoalDescription, Hand, HandDescription, MeshSource,
    ObjectDescription, ObjectShape, ObstacleDescription, PerFinger, PoseDescription, Shape, StartDescription,
    Workspace,
};

fn four_finger() -> HandDescription {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenarios/hands/four-finger.toml");
    toml::from_str(&std::fs::read_to_string(file).unwrap()).unwrap()
}

fn pose(position: [f64; 3]) -> PoseDescription {
    PoseDescription { position, ..Default::default() }
}

fn problem() -> Problem {
    let shape = ObjectShape::Sphere { radius: 0.03, facets: 1280 };
    Problem {
        hand: four_finger(),
        object: ObjectDescription {
            name: "ball".into(),
            shape,
            mass: 0.1,
            friction: 0.8,
            contact_surface: None,
            assembly: false,
        },
        obstacle: vec![obstacle(""), obstacle("bar")],
        gravity: [0.0, 0.0, -9.81],
        start: StartDescription { pose: pose([0.0, 0.0, 0.085]), grasp: None },
        goal: vec![GoalDescription { pose: pose([0.0, 0.01, 0.095]), grasp: None }],
        workspace: None,
        hold: None,
        limits: Default::default(),
    }
}

fn obstacle(name: &str) -> ObstacleDescription {
    let shape = Shape::Capsule { from: [0.045, 0.0, 0.075], to: [0.045, 0.0, 0.2], radius: 0.008 };
    ObstacleDescription { name: name.into(), shape, pose: pose([0.1, 0.0, 0.0]) }
}

#[test]
fn a_sound_problem_becomes_a_world() {
    let world = World::new(&problem()).unwrap();
    assert_eq!(world.obstacle_names, ["obstacle 1", "bar"]);
    assert_eq!((world.hand.finger_count(), world.object.mesh.facets().len()), (4, 1280));
    assert_eq!(world.start.translation.vector.z, 0.085);
    let (lower, upper) = world.workspace;
    assert!((lower - Vec3::new(-0.015, -0.015, 0.07)).norm() < 1e-12);
    assert!((upper - Vec3::new(0.015, 0.025, 0.11)).norm() < 1e-12);
    let q = Configuration {
        X_HO: world.start,
        joints: PerFinger::from_fn(4, |finger| world.hand.finger(finger).rest),
        contacts: PerFinger::filled(4, None),
    };
    assert_eq!(world.clearance.configuration_free(&q, FingerSet::first(4), true), Ok(()));
}

/// The message with which a changed problem is refused.
fn refusal(change: impl FnOnce(&mut Problem)) -> String {
    let mut changed = problem();
    change(&mut changed);
    World::new(&changed).err().expect("the problem is refused").to_string()
}

#[test]
fn every_fault_is_refused_by_its_key() {
    let grasp = |count| Some(vec![FingerGrasp { contact: None, joints: Some(vec![0.0; 2]) }; count]);
    let messages = [
        (
            refusal(|p| p.obstacle[1].shape = Shape::Sphere { radius: -1.0 }),
            "`obstacle[1].shape.radius` = -1",
        ),
        (refusal(|p| p.obstacle[0].name = "bar".into()), "`obstacle[1].name`"),
        (refusal(|p| p.obstacle[0].pose.angle_deg = Some(3.0)), "`obstacle[0].pose`"),
        (
            refusal(|p| p.obstacle[0].shape = Shape::Box { size: [1.0, f64::NAN, 1.0] }),
            "`obstacle[0].shape.size[1]`: infinity or NaN",
        ),
        (refusal(|p| p.obstacle[0].shape = half_space([0.0; 3])), "`obstacle[0].shape.normal`"),
        (refusal(|p| p.obstacle[0].shape = mesh("none.stl")), "none.stl"),
        (refusal(|p| p.hand.palm[0].shape = mesh("none.stl")), "`hand.palm[0].shape`"),
        (refusal(|p| p.hand.finger[1].joint[2].link[0].shape = half_space([0.0, 0.0, 1.0])), "half-space"),
        (refusal(|p| p.hand.finger[0].joint[0].upper = f64::INFINITY), "in `hand`"),
        (refusal(|p| p.object.mass = 0.0), "`object.mass` = 0"),
        (refusal(|p| p.object.shape = ball(30.0)), "lengths multiplied by 0.001"),
        (refusal(|p| p.object.shape = ball(30e-6)), "lengths multiplied by 1000"),
        (refusal(|p| p.start.pose.position[2] = f64::NAN), "`start.pose`"),
        (refusal(|p| p.goal.clear()), "`goal`: there is no goal"),
        (refusal(|p| p.goal.push(p.goal[0].clone())), "`goal[1]` coincides with `goal[0]`"),
        (refusal(|p| p.goal[0].pose = p.start.pose.clone()), "`goal[0]` coincides with the start"),
        (refusal(|p| p.goal[0].grasp = grasp(3)), "`goal[0].grasp`: 3 entries"),
        (refusal(|p| p.start.grasp = grasp(4)), "`start.grasp[0].joints`"),
        (refusal(|p| p.gravity[1] = f64::NAN), "`gravity[1]`: infinity or NaN"),
        (
            refusal(|p| p.workspace = Some(Workspace { lower: [0.0; 3], upper: [1.0, -1.0, 1.0] })),
            "`workspace.upper[1]` = -1",
        ),
        (refusal(|p| p.limits.resolution.friction_margin = 0.0), "`limits.resolution.friction_margin` = 0"),
        (refusal(|p| p.limits.tolerances.slip = -1.0), "`limits.tolerances.slip` = -1"),
        (refusal(|p| p.limits.budget.max_nodes = 0), "`limits.budget.max_nodes` = 0"),
        (
            refusal(|p| p.limits.budget.time_limit = Some(f64::NAN)),
            "`limits.budget.time_limit`: it must be a finite number",
        ),
    ];
    for (message, part) in messages {
        assert!(message.contains(part), "{message} lacks {part}");
    }
}

#[test]
fn sizes_that_no_grasp_fits_are_told_with_the_scale_that_does() {
    let hand = ChainHand::new(four_finger()).unwrap();
    let told = |shape: ObjectShape| {
        let description = ObjectDescription { shape, ..problem().object };
        check_size(&hand, &load_object(&description).unwrap(), &description.shape)
    };
    assert_eq!(told(ball(0.03)), Ok(None));
    assert_eq!(told(ball(0.08)), Ok(None));
    // A sheet is wide, and thin enough to be held.
    assert_eq!(told(ObjectShape::Cuboid { size: [0.6, 0.6, 0.02] }), Ok(None));
    let large = told(ball(0.3)).unwrap().unwrap();
    assert!(large.contains("597 mm wide at its narrowest"), "{large}");
    assert!(large.contains("multiplying its lengths by 0.09"), "{large}");
    let small = told(ball(0.006)).unwrap().unwrap();
    assert!(small.contains("less than a fingertip is wide (20.0 mm)"), "{small}");
    let message = told(ball(0.0008)).unwrap_err().to_string();
    assert!(message.contains("no three of them can touch it at once"), "{message}");
    // Three balls of 10 mm leave room for one of 1.547 mm; its box is larger.
    assert!(told(ball(0.00155)).is_ok());
}

fn half_space(normal: [f64; 3]) -> Shape {
    Shape::HalfSpace { normal, offset: 0.0 }
}

fn ball(radius: f64) -> ObjectShape {
    ObjectShape::Sphere { radius, facets: 1280 }
}

fn mesh(file: &str) -> Shape {
    Shape::Mesh(MeshSource { file: Some(file.into()), ..Default::default() })
}
