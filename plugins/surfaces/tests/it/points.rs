//! Projection, sampling, walking and edge distances against brute force and closed forms.

use crate::common;

use common::{length, meshes, reference};
use proptest::prelude::*;
use regrasp_api::{Contact, Mesh, Random, SurfaceParam, Vec3};
use regrasp_surfaces::geodesic::{Geodesic, GeodesicSettings};
use std::f64::consts::{PI, TAU};

const RADIUS: f64 = 0.010;

fn surface(mesh: &Mesh) -> Geodesic {
    Geodesic::new(&GeodesicSettings::default(), mesh, RADIUS).unwrap()
}

fn all_kinds() -> Vec<Mesh> {
    vec![
        meshes::cuboid(Vec3::new(0.0225, 0.0225, 0.001)),
        meshes::sphere(0.03, 2),
        meshes::cylinder(0.025, 0.03, 24),
        meshes::random_hull(4, 14, 0.03),
        meshes::angle_block(0.04, 0.02),
        meshes::torus(0.03, 0.012, 20, 9),
        meshes::bumpy(0.03, 0.12, 2),
    ]
}

/// Whether a point is inside, by the winding number (van Oosterom & Strackee, IEEE TBME 1983).
fn is_inside(mesh: &Mesh, p: &Vec3) -> bool {
    let angle = |facet| {
        let [a, b, c] = mesh.corners(facet).map(|corner| corner - p);
        let (x, y, z) = (a.norm(), b.norm(), c.norm());
        2.0 * a.dot(&b.cross(&c)).atan2(x * y * z + a.dot(&b) * z + b.dot(&c) * x + c.dot(&a) * y)
    };
    (0..mesh.facets().len() as u32).map(angle).sum::<f64>() > TAU
}

#[test]
fn projection_is_the_closest_point_with_its_sign_whatever_the_hint() {
    for mesh in all_kinds() {
        let surface = surface(&mesh);
        let mut random = Random::from_key(11, 0, 0, 0);
        for _ in 0..300 {
            // Near the surface, inside and far away.
            let near = surface.sample(&mut random).p_OC;
            let p = near + random.direction() * [1e-4, 1e-2, 5e-2, 0.5][random.index(4)];
            let found = surface.project(&p, None);
            assert!((found.distance.abs() - reference::distance(&mesh, &p)).abs() < 1e-12, "{p:?}");
            assert_eq!(found.distance < 0.0, is_inside(&mesh, &p), "{p:?}");
            let contact = found.contact;
            assert!((contact.p_OC + contact.n_O * found.distance - p).norm() < 1e-12, "{p:?}");
            assert!((contact.n_O.norm() - 1.0).abs() < 1e-12);
            assert!(reference::facets_with(&mesh, &contact.p_OC).contains(&contact.facet));
            for _ in 0..5 {
                let hint = random.index(mesh.facets().len() + 1) as u32;
                assert_eq!(surface.project(&p, Some(hint)), found, "hint {hint}");
            }
            assert_eq!(surface.project(&p, Some(contact.facet)), found, "its own facet as hint");
        }
    }
}

#[test]
fn ties_on_edges_and_at_vertices_do_not_depend_on_the_hint() {
    for mesh in all_kinds() {
        let surface = surface(&mesh);
        let mut random = Random::from_key(12, 0, 0, 0);
        for _ in 0..300 {
            let facet = random.index(mesh.facets().len()) as u32;
            let k = random.index(3);
            let neighbor = mesh.neighbors(facet)[k];
            let corners = mesh.corners(facet);
            let along = [0.0, random.unit()][random.index(2)];
            let p = corners[k].lerp(&corners[(k + 1) % 3], along);
            let n = (mesh.normal(facet) + mesh.normal(neighbor.facet)).normalize();
            let tip = p + n * [0.0, 1e-9, RADIUS][random.index(3)];
            let found = surface.project(&tip, None);
            for hint in [facet, neighbor.facet, random.index(mesh.facets().len()) as u32] {
                assert_eq!(surface.project(&tip, Some(hint)), found);
            }
        }
    }
}

#[test]
fn samples_are_uniform_over_the_area() {
    let mesh = meshes::cuboid(Vec3::new(0.04, 0.02, 0.01));
    let surface = surface(&mesh);
    let mut random = Random::from_key(1, 0, 0, 0);
    let (mut count, mut sum) = (vec![0.0; mesh.facets().len()], Vec3::zeros());
    let draws = 40_000;
    for _ in 0..draws {
        let contact = surface.sample(&mut random);
        count[contact.facet as usize] += 1.0 / f64::from(draws);
        sum += contact.p_OC / f64::from(draws);
        assert!(reference::facets_with(&mesh, &contact.p_OC).contains(&contact.facet));
    }
    let total: f64 = (0..mesh.facets().len() as u32).map(|f| mesh.area(f)).sum();
    for (facet, share) in count.iter().enumerate() {
        assert!((share - mesh.area(facet as u32) / total).abs() < 0.01);
    }
    assert!(sum.norm() < 1e-3);
}

#[test]
fn samples_of_hollow_solids_can_be_touched() {
    for mesh in
        [meshes::angle_block(0.04, 0.02), meshes::torus(0.02, 0.012, 20, 9), meshes::bumpy(0.03, 0.12, 2)]
    {
        let surface = surface(&mesh);
        let mut random = Random::from_key(2, 0, 0, 0);
        for _ in 0..200 {
            let tip = surface.sample(&mut random).tip_center(RADIUS);
            assert!(reference::distance(&mesh, &tip) > RADIUS - 2e-9 && !is_inside(&mesh, &tip));
        }
    }
}

#[test]
fn a_walk_around_a_cylinder_comes_back_and_over_a_cuboid_goes_straight() {
    let mesh = meshes::cylinder(0.025, 0.03, 48);
    let around = 48.0 * 2.0 * 0.025 * (PI / 48.0).sin();
    let start = Contact {
        facet: surface(&mesh).project(&Vec3::new(0.1, 0.003, 0.004), None).contact.facet,
        ..surface(&mesh).project(&Vec3::new(0.1, 0.003, 0.004), None).contact
    };
    let end = surface(&mesh).walk(&start, &Vec3::y(), around);
    assert!((end.p_OC - start.p_OC).norm() < 1e-9, "{end:?}");
    // On a cube of edge 2: from the top's middle 1 to the edge, then 0.5 down.
    let cube = meshes::cuboid(Vec3::repeat(1.0));
    let top = surface(&cube).project(&Vec3::new(0.0, 0.1, 2.0), None).contact;
    let end = surface(&cube).walk(&top, &Vec3::new(7.0, 0.0, 3.0), 1.5);
    assert!((end.p_OC - Vec3::new(1.0, 0.1, 0.5)).norm() < 1e-12, "{end:?}");
    assert!((end.n_O - Vec3::x()).norm() < 1e-12);
}

#[test]
fn a_walk_is_as_long_as_the_geodesic_to_its_end() {
    for mesh in
        [meshes::sphere(0.03, 2), meshes::random_hull(4, 14, 0.03), meshes::cuboid(Vec3::repeat(0.02))]
    {
        let surface = surface(&mesh);
        let mut random = Random::from_key(21, 0, 0, 0);
        let mut straight = 0;
        for _ in 0..200 {
            let from = surface.sample(&mut random);
            let distance = random.range(0.0, 0.02);
            let to = surface.walk(&from, &random.direction(), distance);
            assert!(reference::facets_with(&mesh, &to.p_OC).contains(&to.facet));
            assert!((surface.project(&to.p_OC, None).distance).abs() < 1e-12);
            // Straight lines are not always shortest, but never shorter, and over small distances mostly
            // shortest.
            let shortest = length(&surface, &from, &to);
            assert!(shortest <= distance * (1.0 + 3e-4) + 1e-9, "{shortest} > {distance}");
            straight += usize::from((shortest - distance).abs() < 3e-4 * distance + 1e-9);
        }
        assert!(straight > 130, "{straight}");
    }
}

#[test]
fn walks_start_on_edges_and_at_vertices_too_and_cross_vertices() {
    let mesh = meshes::sphere(0.03, 2);
    let surface = surface(&mesh);
    let mut random = Random::from_key(22, 0, 0, 0);
    for _ in 0..200 {
        let facet = random.index(mesh.facets().len()) as u32;
        let [a, b, _] = mesh.corners(facet);
        let p_OC = a.lerp(&b, [0.0, 0.3][random.index(2)]);
        let from = Contact { facet, p_OC, n_O: p_OC.normalize() };
        let direction = [random.direction(), b - a][random.index(2)];
        let to = surface.walk(&from, &direction, 0.012);
        assert!(reference::facets_with(&mesh, &to.p_OC).contains(&to.facet));
        let shortest = length(&surface, &from, &to);
        assert!(shortest <= 0.012 * (1.0 + 3e-4) && shortest > 0.0115, "{shortest}");
        // It went where it was told to go.
        let tangent = direction - from.n_O * from.n_O.dot(&direction);
        assert!((to.p_OC - from.p_OC).angle(&tangent) < 0.4, "{from:?} {tangent:?} {to:?}");
    }
    assert_eq!(
        surface
            .walk(&surface.sample(&mut random), &Vec3::zeros(), 1.0)
            .p_OC
            .iter()
            .filter(|x| x.is_nan())
            .count(),
        0
    );
}

#[test]
fn edge_distances_are_those_of_closed_forms() {
    let mesh = meshes::cuboid(Vec3::new(0.04, 0.03, 0.02));
    let cuboid = surface(&mesh);
    let mut random = Random::from_key(3, 0, 0, 0);
    for _ in 0..200 {
        let contact = cuboid.sample(&mut random);
        let inset = (Vec3::new(0.04, 0.03, 0.02) - contact.p_OC.abs()).iter().copied().collect::<Vec<_>>();
        let mut sorted = inset.clone();
        sorted.sort_by(f64::total_cmp);
        // The smallest inset is 0 (the face), the next is the distance to the nearest edge of the face.
        assert!((cuboid.edge_distance(&contact) - sorted[1]).abs() < 1e-12);
    }
    assert_eq!(
        surface(&meshes::sphere(0.03, 2)).edge_distance(&Contact {
            facet: 0,
            p_OC: Vec3::zeros(),
            n_O: Vec3::z()
        }),
        f64::INFINITY
    );
    let mesh = meshes::cylinder(0.025, 0.03, 64);
    let contact = Contact { facet: 0, p_OC: Vec3::new(0.0, 0.0, 0.03), n_O: Vec3::z() };
    let to_rim = surface(&mesh).edge_distance(&contact);
    assert!((to_rim - 0.025 * (PI / 64.0).cos()).abs() < 1e-12, "{to_rim}");
    let blunt = GeodesicSettings { sharp_angle_deg: 100.0, ..GeodesicSettings::default() };
    assert_eq!(Geodesic::new(&blunt, &mesh, RADIUS).unwrap().edge_distance(&contact), f64::INFINITY);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, ..ProptestConfig::default() })]

    /// The projection of a fingertip that touches is the contact itself.
    #[test]
    fn projecting_a_touching_fingertip_gives_the_contact_back(seed in 0..1000_u64) {
        for mesh in all_kinds() {
            let surface = surface(&mesh);
            let contact = surface.sample(&mut Random::from_key(seed, 0, 0, 0));
            let back = surface.project(&contact.tip_center(RADIUS), Some(contact.facet));
            prop_assert!((back.distance - RADIUS).abs() < 2e-9);
            if mesh.is_locally_convex() {
                prop_assert!((back.contact.p_OC - contact.p_OC).norm() < 1e-9);
                prop_assert!((back.contact.n_O - contact.n_O).norm() < 1e-9);
            }
        }
    }
}
