use super::*;
use regrasp_api::{Mat3, MeshError, ObjectShape, Vec3};
use std::f64::consts::PI;

const PRIMITIVES: [Primitive; 6] = [
    Primitive::Sphere { radius: 0.03 },
    Primitive::Ellipsoid { semi_axes: Vec3::new(0.04, 0.025, 0.02) },
    Primitive::Cuboid { half_size: Vec3::new(0.02, 0.03, 0.04) },
    Primitive::Cylinder { radius: 0.02, half_height: 0.04 },
    Primitive::Capsule { radius: 0.02, half_height: 0.03 },
    Primitive::Torus { ring_radius: 0.04, tube_radius: 0.015 },
];

/// Volume and diagonal of the inertia at density 1, in closed form.
fn closed_form(primitive: &Primitive) -> (f64, Vec3) {
    let boxed = |v: Vec3| Vec3::new(v.y * v.y + v.z * v.z, v.z * v.z + v.x * v.x, v.x * v.x + v.y * v.y);
    match *primitive {
        Primitive::Sphere { radius } => {
            closed_form(&Primitive::Ellipsoid { semi_axes: Vec3::repeat(radius) })
        }
        Primitive::Ellipsoid { semi_axes } => {
            let volume = 4.0 / 3.0 * PI * semi_axes.product();
            (volume, boxed(semi_axes) * (volume / 5.0))
        }
        Primitive::Cuboid { half_size } => {
            (8.0 * half_size.product(), boxed(half_size) * (8.0 * half_size.product() / 3.0))
        }
        Primitive::Cylinder { radius: r, half_height: h } => {
            let volume = 2.0 * PI * r * r * h;
            let across = volume * (r * r / 4.0 + h * h / 3.0);
            (volume, Vec3::new(across, across, volume * r * r / 2.0))
        }
        Primitive::Capsule { radius: r, half_height: h } => {
            let (side, ball) = (2.0 * PI * r * r * h, 4.0 / 3.0 * PI * r.powi(3));
            let across = side * (r * r / 4.0 + h * h / 3.0) + ball * (0.4 * r * r + h * h + 0.75 * h * r);
            (side + ball, Vec3::new(across, across, side * r * r / 2.0 + ball * 0.4 * r * r))
        }
        Primitive::Torus { ring_radius: a, tube_radius: b } => {
            let volume = 2.0 * PI * PI * a * b * b;
            let across = volume * (a * a / 2.0 + 5.0 / 8.0 * b * b);
            (volume, Vec3::new(across, across, volume * (a * a + 0.75 * b * b)))
        }
    }
}

/// Zero on the true surface, to first order the distance from it (m).
fn off_surface(primitive: &Primitive, p: Vec3) -> f64 {
    let beyond = |half: f64| (p.z.abs() - half).max(0.0);
    match *primitive {
        Primitive::Sphere { radius } => p.norm() - radius,
        Primitive::Ellipsoid { semi_axes } => (p.component_div(&semi_axes).norm() - 1.0) * semi_axes.min(),
        Primitive::Cuboid { half_size } => (p.abs() - half_size).max(),
        Primitive::Cylinder { radius, half_height } => (p.xy().norm() - radius).max(p.z.abs() - half_height),
        Primitive::Capsule { radius, half_height } => p.xy().norm().hypot(beyond(half_height)) - radius,
        Primitive::Torus { ring_radius, tube_radius } => {
            (p.xy().norm() - ring_radius).hypot(p.z) - tube_radius
        }
    }
}

#[test]
fn every_pattern_is_closed_near_its_wish_and_on_the_true_surface() {
    for primitive in &PRIMITIVES {
        for wished in [12, 20, 100, 1000, 1280, 5120, 40_000] {
            let mesh = primitive_mesh(primitive, wished).unwrap();
            let count = mesh.facets().len() as f64;
            assert!(mesh.vertices().iter().all(|&v| off_surface(primitive, v).abs() < 1e-15));
            match primitive {
                Primitive::Cuboid { .. } => assert_eq!(count, 12.0),
                // Four times more facets at each step.
                Primitive::Sphere { .. } | Primitive::Ellipsoid { .. } => {
                    assert!((0.4..=1.7).contains(&(count / wished as f64)), "{primitive:?} {wished} {count}");
                }
                _ if wished >= 1000 => {
                    assert!((0.9..=1.1).contains(&(count / wished as f64)), "{primitive:?} {wished} {count}");
                }
                _ => assert!(count <= 24.0_f64.max(1.5 * wished as f64), "{primitive:?} {wished} {count}"),
            }
            let euler = mesh.vertices().len() as i64 - mesh.facets().len() as i64 / 2;
            assert_eq!(euler, if matches!(primitive, Primitive::Torus { .. }) { 0 } else { 2 });
            assert_eq!(mesh.is_locally_convex(), !matches!(primitive, Primitive::Torus { .. }));
        }
    }
    assert_eq!(primitive_mesh(&PRIMITIVES[0], 1280).unwrap().facets().len(), 1280);
}

#[test]
fn mass_properties_approach_the_closed_forms_from_inside() {
    for primitive in &PRIMITIVES {
        let mass = primitive_mesh(primitive, 20_480).unwrap().mass_properties();
        let (volume, inertia) = closed_form(primitive);
        assert!(mass.volume <= volume * (1.0 + 1e-12) && mass.volume > 0.997 * volume, "{primitive:?}");
        assert!(mass.p_OCm.norm() < 1e-12);
        let error = mass.inertia_OCm - Mat3::from_diagonal(&inertia);
        assert!(error.norm() < 0.005 * inertia.norm(), "{primitive:?}: {error}");
    }
}

#[test]
fn an_object_has_the_mass_it_was_given() {
    let description = describe(ObjectShape::Cuboid { size: [0.02, 0.04, 0.06] });
    let object = load_object(&description).unwrap();
    assert_eq!((object.mass, object.friction), (0.3, 0.8));
    let expected = 0.3 / 12.0 * Vec3::new(0.0052, 0.0040, 0.0020);
    assert!((object.inertia_OCm - Mat3::from_diagonal(&expected)).norm() < 1e-15);
    assert_eq!(object.primitive, Some(Primitive::Cuboid { half_size: Vec3::new(0.01, 0.02, 0.03) }));
}

fn describe(shape: ObjectShape) -> ObjectDescription {
    ObjectDescription {
        name: "thing".into(),
        shape,
        mass: 0.3,
        friction: 0.8,
        contact_surface: None,
        assembly: false,
    }
}

#[test]
fn bad_numbers_are_refused_with_key_value_and_range() {
    let sphere = |radius, facets| describe(ObjectShape::Sphere { radius, facets });
    let mut heavy = sphere(0.03, 1280);
    heavy.mass = f64::INFINITY;
    let mut slippery = sphere(0.03, 1280);
    slippery.friction = -0.1;
    let ring = |tube_radius| describe(ObjectShape::Torus { ring_radius: 0.02, tube_radius, facets: 1280 });
    let needle = describe(ObjectShape::Cylinder { radius: 1e-5, height: 900.0, facets: 1280 });
    let flat = describe(ObjectShape::Cuboid { size: [0.01, 0.0, 0.01] });
    for (description, parts) in [
        (sphere(-0.03, 1280), ["object.shape.radius", "-0.03"]),
        (sphere(f64::NAN, 1280), ["object.shape.radius", "NaN"]),
        (sphere(0.03, 2), ["object.shape.facets", "12..=2000000"]),
        (sphere(0.03, 3_000_000), ["object.shape.facets", "3000000"]),
        (heavy, ["object.mass", "inf"]),
        (slippery, ["object.friction", "-0.1"]),
        (ring(0.03), ["object.shape.tube_radius", "0.03"]),
        (flat, ["object.shape.size[1]", "0"]),
        (needle, ["object.shape", "10000"]),
    ] {
        let message = load_object(&description).unwrap_err().to_string();
        assert!(parts.iter().all(|part| message.contains(part)), "{message}");
    }
}

#[test]
fn a_mesh_in_place_is_an_object_too_and_its_faults_are_named() {
    let mesh = primitive_mesh(&PRIMITIVES[5], 200).unwrap();
    let source = regrasp_api::MeshSource {
        vertices: mesh.vertices().iter().map(|&v| v.into()).collect(),
        facets: mesh.facets().to_vec(),
        ..Default::default()
    };
    let object = load_object(&describe(ObjectShape::Mesh(source.clone()))).unwrap();
    assert_eq!((object.mesh, object.primitive), (mesh, None));
    let mut open = source.clone();
    open.facets.pop();
    let error = load_object(&describe(ObjectShape::Mesh(open))).unwrap_err();
    assert!(matches!(error, WorldError::Mesh { source: MeshError::Open { count: 3, .. }, .. }), "{error}");
    let mut both = source;
    both.file = Some("x.stl".into());
    let error = load_object(&describe(ObjectShape::Mesh(both))).unwrap_err();
    assert!(error.to_string().contains("either `file`"));
}
