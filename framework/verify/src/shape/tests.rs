use super::*;
use crate::solid::Gap;
use regrasp_api::{PoseDescription, Primitive, Random};

fn torus() -> Core {
    let mesh = regrasp_world::primitive_mesh(&Primitive::Torus { ring_radius: 0.05, tube_radius: 0.02 }, 600);
    Core::Mesh(Arc::new(Solid::new(&mesh.unwrap())))
}

fn cube() -> Core {
    Core::Cuboid { X: Pose::translation(0.01, 0.0, 0.0), half: Vec3::new(0.02, 0.03, 0.01) }
}

fn pose(random: &mut Random) -> Pose {
    Pose::from_parts((random.direction() * random.range(0.0, 0.2)).into(), random.rotation())
}

/// The least distance of many points of a segment, each of which is exact.
fn along(a: &Vec3, b: &Vec3, other: &Core, X: &Pose) -> f64 {
    let at = |k: usize| Core::Point(a.lerp(b, k as f64 / 2000.0));
    (0..=2000).map(|k| distance(&at(k), X, other, &Pose::identity(), true)).fold(f64::INFINITY, f64::min)
}

#[test]
fn segments_keep_the_least_distance_of_their_points() {
    let mut random = Random::from_key(5, 0, 0, 0);
    let other = Core::Segment(Vec3::zeros(), Vec3::new(0.0, 0.05, 0.02));
    for core in [torus(), cube(), other, Core::HalfSpace { n: Vec3::z(), offset: 0.01 }] {
        let mut apart = 0;
        for _ in 0..40 {
            let (X, a, b) = (pose(&mut random), random.direction() * 0.05, random.direction() * 0.05);
            let exact = distance(&Core::Segment(a, b), &X, &core, &Pose::identity(), true);
            let sampled = along(&a, &b, &core, &X);
            if sampled <= 0.0 {
                assert!(exact <= 0.0, "{exact} {sampled}");
            } else {
                apart += 1;
                let step = (b - a).norm() / 2000.0;
                assert!(exact <= sampled + 1e-9 && exact > sampled - step, "{exact} {sampled}");
            }
            let swapped = distance(&core, &Pose::identity(), &Core::Segment(a, b), &X, true);
            assert!((swapped - exact).abs() < 1e-9);
        }
        assert!(apart > 10);
    }
}

#[test]
fn boxes_and_meshes_agree_where_the_mesh_is_the_box() {
    let half = Vec3::new(0.02, 0.03, 0.01);
    let mesh = regrasp_world::primitive_mesh(&Primitive::Cuboid { half_size: half }, 12).unwrap();
    let mesh = Core::Mesh(Arc::new(Solid::new(&mesh)));
    let cuboid = Core::Cuboid { X: Pose::identity(), half };
    let mut random = Random::from_key(6, 0, 0, 0);
    for other in [torus(), cube(), Core::HalfSpace { n: Vec3::z(), offset: -0.05 }] {
        for _ in 0..30 {
            let X = pose(&mut random);
            let identity = Pose::identity();
            let first = distance(&mesh, &X, &other, &identity, true);
            let second = distance(&cuboid, &X, &other, &identity, true);
            assert!((first.max(0.0) - second.max(0.0)).abs() < 1e-7, "{first} {second}");
        }
    }
}

#[test]
fn what_lies_inside_a_mesh_is_no_distance_away() {
    let X = Pose::translation(0.05, 0.0, 0.0);
    let small = Vec3::new(0.001, 0.0, 0.0);
    let identity = Pose::identity();
    for core in [
        Core::Point(small),
        Core::Segment(small, -small),
        Core::Cuboid { X: identity, half: Vec3::repeat(0.001) },
    ] {
        assert!(distance(&core, &X, &torus(), &identity, true) <= 0.0);
        assert!(
            distance(&core, &identity, &torus(), &identity, true) > 0.02,
            "the hole of the ring is outside"
        );
    }
}

#[test]
fn closest_points_do_not_depend_on_where_the_search_begins() {
    let Core::Mesh(solid) = torus() else { panic!() };
    let mut random = Random::from_key(7, 0, 0, 0);
    for _ in 0..300 {
        let p = random.direction() * random.range(0.0, 0.1);
        let answers = [0, 77, 400, u32::MAX].map(|near| solid.closest(&p, near));
        for answer in answers {
            assert!(((answer.point - p).norm() - (answers[0].point - p).norm()).abs() < 1e-15);
            assert_eq!(answer.inside, answers[0].inside);
        }
        let ring = Vec3::new(p.x, p.y, 0.0).normalize() * 0.05;
        let depth = (p - ring).norm() - 0.02;
        assert!(depth.abs() < 0.002 || answers[0].inside == (depth < 0.0));
    }
}

#[test]
fn supports_give_separating_planes() {
    let Core::Mesh(solid) = torus() else { panic!() };
    let (a, b) = (Vec3::new(0.1, 0.02, 0.0), Vec3::new(0.1, -0.03, 0.01));
    let Gap { distance, direction: n, .. } = solid.gap_to_segment(&a, &b, 3);
    let plane = n.dot(&a).min(n.dot(&b)) - solid.support(&n);
    assert!(distance > 0.02 && plane <= distance + 1e-12 && plane > distance - 1e-3, "{plane} {distance}");
    let fine = Primitive::Ellipsoid { semi_axes: Vec3::new(0.1, 0.2, 0.3) };
    let fine = Solid::new(&regrasp_world::primitive_mesh(&fine, 5120).unwrap());
    let mut random = Random::from_key(8, 0, 0, 0);
    for _ in 0..50 {
        let n = random.direction();
        let brute = fine.vertices.iter().map(|v| v.dot(&n)).fold(0.0, f64::max);
        assert!((fine.support(&n) - brute).abs() < 1e-15, "the tree finds the outermost vertex too");
    }
}

#[test]
fn shapes_without_sense_are_refused() {
    let refuse = |shape: Shape| {
        let placed = PlacedShape { shape, pose: PoseDescription::default() };
        assert!(Core::of(&placed).is_err(), "{placed:?}");
    };
    refuse(Shape::Sphere { radius: f64::NAN });
    refuse(Shape::Capsule { from: [0.0; 3], to: [f64::INFINITY, 0.0, 0.0], radius: 0.1 });
    refuse(Shape::Box { size: [0.1, -0.1, 0.1] });
    refuse(Shape::HalfSpace { normal: [0.0; 3], offset: 0.0 });
    refuse(Shape::Mesh(regrasp_api::MeshSource { file: Some("a.stl".into()), ..Default::default() }));
}

#[test]
fn rods_are_as_far_from_a_point_as_its_exact_distance() {
    let mut random = Random::from_key(6, 0, 0, 0);
    for _ in 0..200 {
        let (X, p) = (pose(&mut random), random.direction() * random.range(0.0, 0.3));
        let rod = Core::Segment(random.direction() * 0.05, random.direction() * 0.05);
        let exact = distance(&rod, &X, &Core::Point(p), &Pose::identity(), false);
        assert!((rod.rod_to(&X, &p) - exact).abs() < 1e-9);
    }
    assert_eq!(cube().rod_to(&Pose::identity(), &Vec3::zeros()), f64::NEG_INFINITY);
    let point = Core::Segment(Vec3::x(), Vec3::x());
    assert!((point.rod_to(&Pose::identity(), &Vec3::zeros()) - 1.0).abs() < 1e-12);
}
