use super::exact::{MeshSolid, Solid};
use super::rod::Rod;
use super::*;
use crate::object::primitive_mesh;
use regrasp_api::{
    HandDescription, MAX_FINGERS, Mesh, PerFinger, PlacedShape, PoseDescription, Primitive, Random, Rotation,
    Shape, Vec3,
};

const CLEARANCE: f64 = 5e-4;
/// What parry's iterative distances and ours may differ by (m).
const AGREEMENT: f64 = 1e-7;

fn four_finger() -> HandDescription {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenarios/hands/four-finger.toml");
    toml::from_str(&std::fs::read_to_string(file).unwrap()).unwrap()
}

fn placed(shape: Shape, position: [f64; 3]) -> PlacedShape {
    PlacedShape { shape, pose: at(position) }
}

fn at(position: [f64; 3]) -> PoseDescription {
    PoseDescription { position, axis: Some([1.0, 2.0, -1.0]), angle_deg: Some(35.0), ..Default::default() }
}

/// A ball with five deep dents around.
fn dented() -> Mesh {
    let ball = primitive_mesh(&Primitive::Sphere { radius: 0.03 }, 1280).unwrap();
    let dent = |v: &Vec3| v * (1.0 + 0.35 * (5.0 * v.y.atan2(v.x)).cos() * v.xy().norm() / v.norm());
    Mesh::new(ball.vertices().iter().map(dent).collect(), ball.facets().to_vec()).unwrap()
}

fn objects() -> Vec<(&'static str, ObjectModel)> {
    let model = |form| ObjectModel::new(primitive_mesh(&form, 320).unwrap(), Some(form), 0.1, 0.8);
    vec![
        ("sphere", model(Primitive::Sphere { radius: 0.03 })),
        ("ellipsoid", model(Primitive::Ellipsoid { semi_axes: Vec3::new(0.04, 0.025, 0.02) })),
        ("cuboid", model(Primitive::Cuboid { half_size: Vec3::new(0.02, 0.0225, 0.03) })),
        ("cylinder", model(Primitive::Cylinder { radius: 0.02, half_height: 0.03 })),
        ("capsule", model(Primitive::Capsule { radius: 0.02, half_height: 0.02 })),
        ("torus", model(Primitive::Torus { ring_radius: 0.03, tube_radius: 0.01 })),
        ("dented", ObjectModel::new(dented(), None, 0.1, 0.8)),
    ]
}

fn mesh_shape(mesh: &Mesh) -> Shape {
    Shape::Mesh(regrasp_api::MeshSource {
        vertices: mesh.vertices().iter().map(|&v| v.into()).collect(),
        facets: mesh.facets().to_vec(),
        ..Default::default()
    })
}

/// One obstacle of each kind, near the hand.
fn obstacles() -> Vec<ObstacleDescription> {
    let small = primitive_mesh(&Primitive::Torus { ring_radius: 0.02, tube_radius: 0.005 }, 200).unwrap();
    [
        (Shape::Sphere { radius: 0.01 }, [0.05, 0.05, 0.12]),
        (Shape::Box { size: [0.02, 0.03, 0.04] }, [-0.06, 0.05, 0.11]),
        (
            Shape::Capsule { from: [0.0, 0.0, -0.05], to: [0.0, 0.0, 0.05], radius: 0.008 },
            [0.07, -0.04, 0.12],
        ),
        // Turned, this is a slanted floor below the palm's edge.
        (Shape::HalfSpace { normal: [0.0, 0.0, 2.0], offset: 0.0 }, [0.0, 0.0, -0.08]),
        (mesh_shape(&small), [-0.05, -0.05, 0.12]),
    ]
    .into_iter()
    .map(|(shape, position)| ObstacleDescription { name: String::new(), shape, pose: at(position) })
    .collect()
}

/// The four-finger hand with a mesh and a box among its links.
fn mixed_hand() -> HandDescription {
    let mut hand = four_finger();
    let pill = primitive_mesh(&Primitive::Capsule { radius: 0.008, half_height: 0.02 }, 200).unwrap();
    hand.finger[0].joint[1].link = vec![placed(mesh_shape(&pill), [0.0, 0.0, 0.03])];
    hand.finger[1].joint[2].link = vec![
        placed(Shape::Box { size: [0.014, 0.012, 0.04] }, [0.0, 0.0, 0.02]),
        placed(Shape::Sphere { radius: 0.007 }, [0.0, 0.0, 0.04]),
    ];
    hand
}

fn scene(
    hand: HandDescription,
    object: &ObjectModel,
    obstacles: &[ObstacleDescription],
) -> (Arc<ChainHand>, SceneClearance) {
    let hand = Arc::new(ChainHand::new(hand).unwrap());
    let scene = SceneClearance::new(hand.clone(), object, obstacles, CLEARANCE).unwrap();
    (hand, scene)
}

fn random_configuration(hand: &ChainHand, random: &mut Random) -> Configuration {
    let count = hand.finger_count();
    let far = random.unit();
    let joints = PerFinger::from_fn(count, |finger| {
        let models = &hand.finger(finger).joints;
        let values: Vec<_> = models.iter().map(|joint| random.range(joint.lower, joint.upper)).collect();
        // Often near the resting posture, where whole configurations are free now and then.
        hand.finger(finger).rest.interpolate(&FingerJoints::from_slice(&values), far)
    });
    let p = Vec3::new(random.range(-0.03, 0.03), random.range(-0.03, 0.03), random.range(0.02, 0.16));
    let X_HO = Pose::from_parts(p.into(), random.rotation());
    Configuration { X_HO, joints, contacts: PerFinger::filled(count, None) }
}

/// Whether the answer agrees with the exact distances of the pairs that it is about; undecided where they are
/// within rounding.
fn check(answer: Result<(), BodyPair>, exact: &[PairDistance], about: impl Fn(&BodyPair) -> bool) -> bool {
    let least = |pair: &PairDistance| about(&pair.pair).then_some(pair.distance);
    let closest = exact.iter().filter_map(least).fold(f64::INFINITY, f64::min);
    match answer {
        Ok(()) => assert!(closest > CLEARANCE - AGREEMENT, "free, but {closest} apart"),
        Err(pair) => {
            assert!(about(&pair), "{pair:?} was not asked for");
            let distance =
                exact.iter().find(|other| other.pair == pair).map_or(f64::INFINITY, |other| other.distance);
            assert!(distance <= CLEARANCE + AGREEMENT, "{pair:?} refused, but {distance} apart");
        }
    }
    answer.is_ok()
}

fn has(pair: &BodyPair, finger: FingerIndex) -> bool {
    let of = |body| matches!(body, Body::Link(f, _) | Body::Fingertip(f) if f == finger);
    of(pair.0) || of(pair.1)
}

fn two_fingers(pair: &BodyPair) -> bool {
    let finger = |body| match body {
        Body::Link(f, _) | Body::Fingertip(f) => Some(f),
        _ => None,
    };
    finger(pair.0).is_some() && finger(pair.1).is_some() && finger(pair.0) != finger(pair.1)
}

fn with_object(pair: &BodyPair) -> bool {
    pair.0 == Body::Object || pair.1 == Body::Object
}

/// Compares every call with the exact distances; returns how many whole configurations were free.
fn agree(hand: &ChainHand, scene: &SceneClearance, seed: u64, count: usize) -> [usize; 4] {
    let mut random = Random::from_key(seed, 0, 0, 0);
    let mut free = [0; 4];
    for _ in 0..count {
        let q = random_configuration(hand, &mut random);
        let exact = scene.distances(&q, 0.01);
        let not_fingers = |pair: &BodyPair| !(0..MAX_FINGERS as u8).any(|f| has(pair, FingerIndex(f)));
        free[0] += usize::from(check(scene.object_free(&q.X_HO), &exact, not_fingers));
        for (finger, joints) in q.joints.iter() {
            let answer = scene.finger_free(finger, joints, &q.X_HO, TipRule::Clear(1.0));
            free[1] += usize::from(check(answer, &exact, |pair| has(pair, finger) && !two_fingers(pair)));
            let answer = scene.finger_free(finger, joints, &q.X_HO, TipRule::Touches);
            let tip = |pair: &BodyPair| with_object(pair) && matches!(pair.1, Body::Fingertip(_));
            check(answer, &exact, |pair| has(pair, finger) && !two_fingers(pair) && !tip(pair));
        }
        for (a, joints_a) in q.joints.iter() {
            for (b, joints_b) in q.joints.iter().filter(|(b, _)| *b > a) {
                let answer = scene.fingers_free((a, joints_a), (b, joints_b));
                free[2] += usize::from(check(answer, &exact, |pair| has(pair, a) && has(pair, b)));
            }
        }
        let all = FingerSet::first(hand.finger_count());
        free[3] += usize::from(check(scene.configuration_free(&q, all, true), &exact, |_| true));
        let one = FingerSet::only(FingerIndex(2));
        check(scene.configuration_free(&q, one, false), &exact, |pair| has(pair, FingerIndex(2)));
        let touched = |pair: &BodyPair| has(pair, FingerIndex(2)) || with_object(pair);
        check(scene.configuration_free(&q, one, true), &exact, touched);
    }
    free
}

#[test]
fn every_answer_agrees_with_the_exact_distances() {
    for (i, (name, object)) in objects().iter().enumerate() {
        let (hand, scene) = scene(four_finger(), object, &obstacles());
        let free = agree(&hand, &scene, i as u64, 300);
        // Free and close must both come up, or nothing was tested.
        let asked = [300, 1200, 1800, 300];
        assert!(
            free.iter().zip(asked).all(|(&free, asked)| free > 0 && free < asked),
            "{name}: {free:?} of {asked:?}"
        );
    }
}

#[test]
fn links_of_any_shape_agree_too() {
    for (i, (_, object)) in objects().iter().enumerate().skip(1).step_by(2) {
        let (hand, scene) = scene(mixed_hand(), object, &obstacles());
        let free = agree(&hand, &scene, 100 + i as u64, 60);
        assert!(free[1] > 0 && free[1] < 240, "{free:?}");
    }
}

#[test]
fn a_link_wholly_inside_a_hollow_of_the_mesh_is_close_only_to_its_wall() {
    // A link inside the ring's hole touches nothing; inside the solid it does.
    let big = Primitive::Torus { ring_radius: 0.2, tube_radius: 0.03 };
    let object = ObjectModel::new(primitive_mesh(&big, 2000).unwrap(), Some(big), 0.1, 0.8);
    let (hand, scene) = scene(four_finger(), &object, &[]);
    let q = random_configuration(&hand, &mut Random::from_key(1, 2, 3, 4));
    let rest = PerFinger::from_fn(4, |finger| hand.finger(finger).rest);
    let around = Configuration { X_HO: Pose::translation(0.0, 0.0, 0.05), joints: rest, ..q.clone() };
    assert!(scene.configuration_free(&around, FingerSet::EMPTY, true).is_ok());
    let ball = Primitive::Sphere { radius: 0.4 };
    let mesh = primitive_mesh(&ball, 1280).unwrap();
    for primitive in [Some(ball), None] {
        let object = ObjectModel::new(mesh.clone(), primitive, 0.1, 0.8);
        let (_, scene) = self::scene(four_finger(), &object, &[]);
        assert!(scene.configuration_free(&around, FingerSet::first(4), false).is_err());
        let inside = scene.distances(&around, 0.01);
        assert!(inside.iter().filter(|pair| with_object(&pair.pair)).all(|pair| pair.distance == 0.0));
        // Four fingers with two links and a tip, and the palm.
        assert_eq!(inside.iter().filter(|pair| with_object(&pair.pair)).count(), 13);
    }
}

#[test]
fn a_turn_of_everything_that_is_not_the_hand_changes_nothing_for_the_object() {
    let (_, object) = objects().swap_remove(1);
    let mut random = Random::from_key(5, 0, 0, 0);
    for _ in 0..20 {
        let turn: Rotation = random.rotation();
        let bar = |turn: &Rotation| {
            let ends = [[0.05, 0.0, -0.1], [0.05, 0.01, 0.1]].map(|end| (turn * Vec3::from(end)).into());
            let shape = Shape::Capsule { from: ends[0], to: ends[1], radius: 0.02 };
            ObstacleDescription { name: String::new(), shape, pose: PoseDescription::default() }
        };
        let mut hand = four_finger();
        hand.palm.clear();
        let (_, straight) = scene(hand.clone(), &object, &[bar(&Rotation::identity())]);
        let (_, turned) = scene(hand, &object, &[bar(&turn)]);
        for _ in 0..20 {
            let X_HO = Pose::from_parts((random.direction() * 0.02).into(), random.rotation());
            assert_eq!(straight.object_free(&X_HO), turned.object_free(&(turn * X_HO)));
        }
    }
}

/// A mesh of a box with its edges along the axes.
fn box_mesh(half_size: Vec3) -> Solid {
    Solid::Mesh(Arc::new(MeshSolid::new(&primitive_mesh(&Primitive::Cuboid { half_size }, 12).unwrap())))
}

#[test]
fn exact_distances_of_all_shapes_are_the_closed_forms() {
    let half_size = Vec3::new(0.1, 0.2, 0.3);
    let ball = Solid::Rod(Rod::ball(Vec3::new(0.0, 0.0, 0.05), 0.02));
    let rod = Solid::Rod(Rod::new(Vec3::new(0.0, 0.0, -0.1), Vec3::new(0.0, 0.0, 0.1), 0.03));
    let cuboid = Solid::Cuboid { half_size };
    let floor = Solid::HalfSpace { normal: Vec3::z(), offset: -1.0 };
    let mesh = box_mesh(half_size);
    let shapes = [&ball, &rod, &cuboid, &mesh];
    // The reach of each along ±x and the gap below it.
    let (across, low) = ([0.02, 0.03, 0.1, 0.1], [0.03, -0.13, -0.3, -0.3]);
    for (a, &shape_a) in shapes.iter().enumerate() {
        for (b, &shape_b) in shapes.iter().enumerate() {
            for apart in [0.4, 0.7] {
                let (X_HA, X_HB) =
                    (Pose::translation(3.0, 1.0, 1.0), Pose::translation(3.0 - apart, 1.0, 1.0));
                let distance = exact::distance(shape_a, &X_HA, shape_b, &X_HB);
                assert!((distance - (apart - across[a] - across[b])).abs() < 1e-9, "{a} {b}: {distance}");
            }
            assert_eq!(
                exact::distance(shape_a, &Pose::identity(), shape_b, &Pose::translation(0.0, 0.0, 0.01)),
                0.0
            );
        }
        let high = Pose::translation(0.3, 0.2, 0.5);
        for (one, other) in
            [((&floor, Pose::identity()), (shape_a, high)), ((shape_a, high), (&floor, Pose::identity()))]
        {
            let distance = exact::distance(one.0, &one.1, other.0, &other.1);
            assert!((distance - (1.5 + low[a])).abs() < 1e-12, "{a}: {distance}");
        }
        assert_eq!(
            exact::distance(&floor, &Pose::identity(), shape_a, &Pose::translation(0.0, 0.0, -2.0)),
            0.0
        );
    }
}

#[test]
fn bodies_wholly_inside_a_mesh_have_distance_zero() {
    let large = box_mesh(Vec3::repeat(1.0));
    let inside = Pose::translation(0.3, -0.2, 0.1);
    let small = Vec3::repeat(0.05);
    let solids =
        [Solid::Rod(Rod::ball(Vec3::zeros(), 0.01)), Solid::Cuboid { half_size: small }, box_mesh(small)];
    for solid in &solids {
        assert_eq!(exact::distance(&large, &Pose::identity(), solid, &inside), 0.0);
        assert_eq!(exact::distance(solid, &inside, &large, &Pose::identity()), 0.0);
    }
    let Solid::Mesh(mesh) = &large else { unreachable!() };
    assert!(!mesh.clear_of_rod(&Rod::new(inside.translation.vector, Vec3::zeros(), 0.01), 1e-3));
    assert!((mesh.signed_distance_within(&Vec3::new(0.9, 0.2, 0.3), 1.0) + 0.1).abs() < 1e-12);
}

#[test]
fn bounds_decide_nearly_always() {
    for (form, allowed) in [
        (Primitive::Sphere { radius: 0.03 }, 20),
        (Primitive::Ellipsoid { semi_axes: Vec3::new(0.04, 0.025, 0.02) }, 20),
        (Primitive::Cuboid { half_size: Vec3::new(0.02, 0.0225, 0.03) }, 0),
        (Primitive::Cylinder { radius: 0.02, half_height: 0.03 }, 20),
        (Primitive::Capsule { radius: 0.02, half_height: 0.02 }, 20),
    ] {
        let mesh = primitive_mesh(&form, 1280).unwrap();
        let planes = (0..mesh.facets().len() as u32)
            .map(|f| (mesh.normal(f), mesh.normal(f).dot(&mesh.corners(f)[0])));
        let convex = convex::Convex::around(form, planes).unwrap();
        let mut random = Random::from_key(11, 0, 0, 0);
        let mut counts = [0; 3];
        for _ in 0..1000 {
            let start = random.direction() * random.range(0.0, 0.06);
            let rod = Rod::new(start, start + random.direction() * 0.05, 0.008);
            counts[convex.verdict(&rod, CLEARANCE) as usize] += 1;
        }
        let [free, close, unknown] = counts;
        assert!(free > 100 && close > 100 && unknown <= allowed, "{form:?}: {counts:?}");
    }
}
