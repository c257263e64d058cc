//! `surface/heat` against the default surface and closed forms.

use crate::common;

use common::{length, meshes};
use regrasp_api::{Context, Mesh, Random, Settings, SurfaceParam, Uninterrupted, Vec3};
use regrasp_surfaces::geodesic::{Geodesic, GeodesicSettings};
use regrasp_surfaces::heat::{Heat, HeatSettings};

/// A point follows every path, so that every pair has a length.
const RADIUS: f64 = 0.0;
/// Pairs of points on each object.
const PAIRS: usize = 100;

fn surface(mesh: &Mesh) -> Heat {
    Heat::new(&HeatSettings::default(), mesh, RADIUS).unwrap()
}

fn agrees_within_two_per_cent(mesh: &Mesh, seed: u64) {
    let exact = GeodesicSettings { tolerance: 1e-6, ..GeodesicSettings::default() };
    let (ours, exact) = (surface(mesh), Geodesic::new(&exact, mesh, RADIUS).unwrap());
    let mut random = Random::from_key(seed, 0, 0, 0);
    for _ in 0..PAIRS {
        let [from, to] = [(); 2].map(|()| exact.sample(&mut random));
        let (a, b) = (length(&ours, &from, &to), length(&exact, &from, &to));
        assert!(a >= b * (1.0 - 1e-5) - 1e-12, "{a} m is too short: {b} m");
        assert!(a <= 1.02 * b + 1e-9, "{a} m instead of {b} m: {from:?} {to:?}");
    }
}

#[test]
fn paths_over_cuboids_are_shortest_within_two_per_cent() {
    agrees_within_two_per_cent(&meshes::cuboid(Vec3::repeat(0.0225)), 1);
    agrees_within_two_per_cent(&meshes::cuboid(Vec3::new(0.03, 0.02, 0.015)), 2);
}

#[test]
fn paths_over_round_solids_are_shortest_within_two_per_cent() {
    agrees_within_two_per_cent(&meshes::sphere(0.03, 3), 3);
    agrees_within_two_per_cent(&meshes::ellipsoid(Vec3::new(0.04, 0.025, 0.025), 3), 4);
}

#[test]
fn paths_over_solids_that_are_not_convex_are_shortest_within_two_per_cent() {
    agrees_within_two_per_cent(&meshes::angle_block(0.04, 0.02), 5);
    agrees_within_two_per_cent(&meshes::angle_block(0.06, 0.01), 8);
    agrees_within_two_per_cent(&meshes::bumpy(0.03, 0.15, 2), 9);
    agrees_within_two_per_cent(&meshes::torus(0.03, 0.012, 24, 16), 6);
}

#[test]
fn lengths_do_not_depend_on_the_direction() {
    let mesh = meshes::sphere(0.03, 3);
    let ours = surface(&mesh);
    let mut random = Random::from_key(7, 0, 0, 0);
    for _ in 0..30 {
        let [from, to] = [(); 2].map(|()| ours.sample(&mut random));
        let (there, back) = (length(&ours, &from, &to), length(&ours, &to, &from));
        assert!((there - back).abs() <= 1e-9, "{there} there, {back} back");
    }
}

#[test]
fn parts_that_are_not_connected_have_no_path() {
    let part = meshes::cuboid(Vec3::repeat(0.01));
    let moved = part.vertices().iter().map(|v| v + Vec3::x() * 0.05);
    let vertices: Vec<Vec3> = part.vertices().iter().copied().chain(moved).collect();
    let facets = part.facets().iter().copied().chain(part.facets().iter().map(|f| f.map(|v| v + 8)));
    let mesh = Mesh::new(vertices, facets.collect()).unwrap();
    let ours = surface(&mesh);
    let mut context = Context::new(Random::from_key(0, 0, 0, 0), &Uninterrupted);
    let on = |x: f64| ours.project(&Vec3::new(x, 0.0, 0.02), None).contact;
    let mut path = Default::default();
    assert_eq!(ours.geodesic(&on(0.0), &on(0.05), &mut path, &mut context), Ok(false));
    assert_eq!(ours.geodesic(&on(0.0), &on(0.005), &mut path, &mut context), Ok(true));
}

#[test]
fn settings_out_of_range_are_refused() {
    for (json, key) in [
        (r#"{"fewest_facets": 0}"#, "fewest_facets"),
        (r#"{"fewest_facets": 100001}"#, "fewest_facets"),
        (r#"{"smoothing": 0.0}"#, "smoothing"),
        (r#"{"step": 0.1}"#, "step"),
        (r#"{"sharp_angle_deg": 0.0}"#, "sharp_angle_deg"),
    ] {
        let error = HeatSettings::from_json(json).unwrap_err().to_string();
        assert!(error.contains(key), "{json}: {error}");
    }
}
