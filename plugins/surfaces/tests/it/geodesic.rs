//! Lengths of shortest paths against closed forms and brute force.

use crate::common;

use common::{length, meshes, path, reference};
use nalgebra::Point3;
use regrasp_api::{Contact, Mesh, Pose, Primitive, Random, SurfaceParam, Vec3};
use regrasp_surfaces::geodesic::{Geodesic, GeodesicSettings};
use regrasp_world::primitive_mesh;
use std::f64::consts::{PI, TAU};

/// A point follows every path, so that every pair has a length.
const RADIUS: f64 = 0.0;

fn surface(mesh: &Mesh) -> Geodesic {
    Geodesic::new(&GeodesicSettings::default(), mesh, RADIUS).unwrap()
}

/// A random point of the surface: inside a facet, on an edge or at a vertex.
fn anywhere(mesh: &Mesh, random: &mut Random) -> Contact {
    let facet = random.index(mesh.facets().len()) as u32;
    let [a, b, c] = mesh.corners(facet);
    let t = random.unit();
    let p_OC = match random.index(4) {
        0 => a,
        1 => a * (1.0 - t) + b * t,
        _ => {
            let s = random.unit() * (1.0 - t);
            a * (1.0 - s - t) + b * s + c * t
        }
    };
    Contact { facet, p_OC, n_O: mesh.normal(facet) }
}

fn agrees_with_brute_force(mesh: &Mesh, seed: u64, pairs: usize) {
    let surface = surface(mesh);
    let mut random = Random::from_key(seed, 0, 0, 0);
    for _ in 0..pairs {
        let (from, to) = (anywhere(mesh, &mut random), anywhere(mesh, &mut random));
        let (ours, exact) = (length(&surface, &from, &to), reference::shortest(mesh, &from, &to));
        assert!((ours - exact).abs() <= 3e-4 * exact + 1e-9, "{ours} instead of {exact}: {from:?} {to:?}");
    }
}

#[test]
fn cuboids_agree_with_every_unfolding() {
    agrees_with_brute_force(&meshes::cuboid(Vec3::new(0.0225, 0.0225, 0.0225)), 1, 400);
    agrees_with_brute_force(&meshes::cuboid(Vec3::new(0.040, 0.015, 0.006)), 2, 400);
}

#[test]
fn irregular_convex_solids_agree_with_brute_force() {
    for seed in 0..10 {
        agrees_with_brute_force(&meshes::random_hull(seed, 12, 0.03), seed, 40);
    }
}

#[test]
fn round_solids_agree_with_brute_force() {
    agrees_with_brute_force(&meshes::sphere(0.03, 2), 4, 30);
    agrees_with_brute_force(&meshes::ellipsoid(Vec3::new(0.04, 0.025, 0.012), 2), 5, 30);
    agrees_with_brute_force(&meshes::cylinder(0.025, 0.03, 40), 6, 30);
}

#[test]
fn solids_that_are_not_convex_agree_with_brute_force() {
    agrees_with_brute_force(&meshes::angle_block(0.04, 0.02), 1, 200);
    agrees_with_brute_force(&meshes::torus(0.03, 0.012, 5, 4), 3, 60);
    agrees_with_brute_force(&meshes::bumpy(0.03, 0.15, 1), 7, 30);
}

/// Paths past saddles run along edges there, where rounding decides on which side of a vertex a ray passes.
#[test]
fn tori_of_any_size_have_paths_between_all_points() {
    let mut random = Random::from_key(8, 0, 0, 0);
    for _ in 0..40 {
        let (ring, tube) = (0.022 + 0.008 * random.unit(), 0.007 + 0.004 * random.unit());
        let mesh = primitive_mesh(&Primitive::Torus { ring_radius: ring, tube_radius: tube }, 1280).unwrap();
        let surface = surface(&mesh);
        for _ in 0..150 {
            let (from, to) = (anywhere(&mesh, &mut random), anywhere(&mesh, &mut random));
            let (there, back) = (length(&surface, &from, &to), length(&surface, &to, &from));
            assert!((there - back).abs() <= 1e-3 * there + 1e-9, "{there} there, {back} back");
            assert!(there >= (from.p_OC - to.p_OC).norm() - 1e-9);
        }
    }
}

/// Against a graph with 12 points on every edge, which is never too short.
///
/// Our paths are real paths of the surface (tested below), so they are never too short either: being shorter
/// than the graph's they are nearer to the truth than the graph.
#[test]
fn fine_meshes_agree_with_dense_graphs() {
    for mesh in [
        meshes::sphere(0.03, 2),
        meshes::ellipsoid(Vec3::new(0.04, 0.025, 0.012), 2),
        meshes::cylinder(0.025, 0.03, 40),
        meshes::torus(0.03, 0.012, 20, 10),
        meshes::bumpy(0.03, 0.15, 2),
        meshes::bumpy(0.03, 0.05, 3),
    ] {
        let surface = surface(&mesh);
        let graph = reference::EdgePoints::new(&mesh, 12);
        let mut random = Random::from_key(5, 0, 0, 0);
        for _ in 0..4 {
            let from = anywhere(&mesh, &mut random);
            let lengths = graph.from(&from.p_OC);
            for _ in 0..40 {
                let to = anywhere(&mesh, &mut random);
                let (ours, bound) = (length(&surface, &from, &to), graph.to(&lengths, &from.p_OC, &to.p_OC));
                assert!(ours <= bound * (1.0 + 2.1e-4), "{ours} longer than {bound}: {from:?} {to:?}");
            }
        }
    }
}

#[test]
fn a_path_is_as_long_as_its_pieces_and_stays_on_the_surface() {
    for mesh in [meshes::ellipsoid(Vec3::new(0.04, 0.025, 0.012), 2), meshes::torus(0.03, 0.012, 20, 10)] {
        let surface = surface(&mesh);
        let mut random = Random::from_key(6, 0, 0, 0);
        for _ in 0..60 {
            let (from, to) = (anywhere(&mesh, &mut random), anywhere(&mesh, &mut random));
            let path = path(&surface, &from, &to);
            let points: Vec<Vec3> = path.waypoints.iter().map(|waypoint| waypoint.contact.p_OC).collect();
            let sum: f64 = points.windows(2).map(|pair| (pair[0] - pair[1]).norm()).sum();
            assert!((sum - path.length).abs() < 1e-9, "{sum} {}", path.length);
            for pair in points.windows(2) {
                for t in [0.25, 0.5, 0.75] {
                    assert!(reference::distance(&mesh, &pair[0].lerp(&pair[1], t)) < 1e-9);
                }
            }
        }
    }
}

#[test]
fn flat_faces_balls_and_cylinders_have_their_closed_forms() {
    // On one face of a subdivided box: the straight distance.
    let mut vertices = meshes::cuboid(Vec3::repeat(0.02)).vertices().to_vec();
    let facets = meshes::subdivide(&mut vertices, meshes::cuboid(Vec3::repeat(0.02)).facets());
    let facets = meshes::subdivide(&mut vertices, &facets);
    let surface_of_box = surface(&Mesh::new(vertices, facets).unwrap());
    let on_top = |x: f64, y: f64| surface_of_box.project(&Vec3::new(x, y, 0.03), None).contact;
    for (a, b) in [((-0.02, -0.02), (0.02, 0.02)), ((0.0, 0.0), (0.01, 0.005)), ((-0.02, 0.01), (0.02, 0.01))]
    {
        let straight = f64::hypot(a.0 - b.0, a.1 - b.1);
        let ours = length(&surface_of_box, &on_top(a.0, a.1), &on_top(b.0, b.1));
        assert!((ours - straight).abs() < 1e-9, "{ours} {straight}");
    }
    // A ball of 1,280 facets lies up to 0.4 % below its circumscribed sphere; great circles shrink by as much
    // at most.
    let mesh = meshes::sphere(0.03, 3);
    let surface_of_ball = surface(&mesh);
    let mut random = Random::from_key(8, 0, 0, 0);
    for _ in 0..100 {
        let (a, b) = (anywhere(&mesh, &mut random), anywhere(&mesh, &mut random));
        let arc = 0.03 * a.p_OC.angle(&b.p_OC);
        let ours = length(&surface_of_ball, &a, &b);
        assert!(ours <= arc * (1.0 + 1e-3) + 2e-4 && ours >= arc * (1.0 - 5e-3), "{ours} {arc}");
    }
    // The side of a prism unrolls.
    let around = 32;
    let mesh = meshes::cylinder(0.02, 0.2, around);
    let prism = surface(&mesh);
    let side = 2.0 * 0.02 * (PI / f64::from(around)).sin();
    let at = |faces: f64, z: f64| {
        let middle = TAU * (faces.floor() + 0.5) / f64::from(around);
        let chord = Vec3::new(middle.cos(), middle.sin(), 0.0) * 0.02 * (PI / f64::from(around)).cos();
        let along = Vec3::new(-middle.sin(), middle.cos(), 0.0) * (faces.fract() - 0.5) * side;
        let p = chord + along + Vec3::z() * z;
        prism.project(&p, None).contact
    };
    for (faces, z) in [(3.7, 0.05), (11.2, -0.03), (15.9, 0.02), (0.6, 0.1)] {
        let unrolled = f64::hypot((faces - 0.25) * side, z + 0.01);
        let ours = length(&prism, &at(0.25, -0.01), &at(faces, z));
        assert!((ours - unrolled).abs() < 2.1e-4 * unrolled, "{ours} {unrolled}");
    }
}

#[test]
fn lengths_are_a_metric() {
    for mesh in [
        meshes::sphere(0.03, 2),
        meshes::torus(0.03, 0.012, 20, 10),
        meshes::cuboid(Vec3::new(0.03, 0.02, 0.01)),
    ] {
        let surface = surface(&mesh);
        let mut random = Random::from_key(9, 0, 0, 0);
        for _ in 0..60 {
            let [a, b, c] = [(); 3].map(|()| anywhere(&mesh, &mut random));
            let (ab, ba) = (length(&surface, &a, &b), length(&surface, &b, &a));
            assert!((ab - ba).abs() <= 2.1e-4 * ab, "{ab} {ba}");
            assert!(ab >= (a.p_OC - b.p_OC).norm() - 1e-15);
            let detour = length(&surface, &a, &c) + length(&surface, &c, &b);
            assert!(ab <= detour * (1.0 + 2.1e-4), "{ab} {detour}");
            assert_eq!(length(&surface, &a, &a), 0.0);
        }
    }
}

#[test]
fn lengths_do_not_change_with_a_rigid_motion_and_grow_with_scale() {
    let mesh = meshes::bumpy(0.03, 0.1, 2);
    let mut random = Random::from_key(10, 0, 0, 0);
    let X_WO = Pose::from_parts(Vec3::new(0.1, -0.2, 0.05).into(), random.rotation());
    let place = |p: &Vec3| (X_WO * Point3::from(*p)).coords * 2.0;
    let moved = Mesh::new(mesh.vertices().iter().map(place).collect(), mesh.facets().to_vec()).unwrap();
    let (here, there) = (surface(&mesh), surface(&moved));
    for _ in 0..60 {
        let (a, b) = (anywhere(&mesh, &mut random), anywhere(&mesh, &mut random));
        let carry =
            |c: &Contact| Contact { facet: c.facet, p_OC: place(&c.p_OC), n_O: X_WO.rotation * c.n_O };
        let (before, after) = (length(&here, &a, &b), length(&there, &carry(&a), &carry(&b)));
        assert!((2.0 * before - after).abs() <= 2.1e-4 * after + 1e-12, "{before} {after}");
    }
}
