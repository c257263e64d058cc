//! `surface/steiner` against its bound, the default surface and closed forms.

use crate::common;

use common::{anywhere, length, meshes, path, reference};
use regrasp_api::{BuildError, Contact, Mesh, Random, Settings, SurfaceParam, Vec3};
use regrasp_surfaces::geodesic::{Geodesic, GeodesicSettings};
use regrasp_surfaces::steiner::{Steiner, SteinerSettings};

/// A point follows every path, so that every pair has a length.
const RADIUS: f64 = 0.0;

fn surface(mesh: &Mesh, straighten: bool, spacing: f64) -> Steiner {
    Steiner::new(&SteinerSettings { straighten, spacing, ..SteinerSettings::default() }, mesh, RADIUS)
        .unwrap()
}

fn exact(mesh: &Mesh) -> Geodesic {
    Geodesic::new(&GeodesicSettings { tolerance: 1e-6, ..GeodesicSettings::default() }, mesh, RADIUS).unwrap()
}

fn solids() -> Vec<Mesh> {
    vec![
        meshes::cuboid(Vec3::repeat(0.0225)),
        meshes::cuboid(Vec3::new(0.04, 0.015, 0.006)),
        meshes::sphere(0.03, 3),
        meshes::ellipsoid(Vec3::new(0.04, 0.025, 0.012), 2),
        meshes::cylinder(0.025, 0.03, 40),
        meshes::random_hull(3, 20, 0.03),
        meshes::angle_block(0.04, 0.02),
        meshes::torus(0.03, 0.012, 12, 8),
        meshes::bumpy(0.03, 0.15, 2),
    ]
}

#[test]
fn paths_keep_the_stated_bound() {
    for (index, mesh) in solids().iter().enumerate() {
        let exact = exact(mesh);
        for spacing in [0.002, 0.02] {
            let surfaces = [false, true].map(|straighten| surface(mesh, straighten, spacing));
            let mut random = Random::from_key(index as u64, 0, 0, 0);
            for _ in 0..40 {
                let [from, to] = [(); 2].map(|()| exact.sample(&mut random));
                let shortest = path(&exact, &from, &to);
                let lengths = surfaces.each_ref().map(|surface| length(surface, &from, &to));
                let most = shortest.length + surfaces[0].bound(&shortest) + 1e-9;
                let least = shortest.length * (1.0 - 1e-5) - 1e-12;
                assert!(lengths[0] <= most, "solid {index}: {} m, at most {most} m", lengths[0]);
                assert!(
                    lengths[1] <= lengths[0] + 1e-12,
                    "solid {index}: straightening lengthened {lengths:?}"
                );
                assert!(lengths[1] >= least, "solid {index}: {} m is too short: {least} m", lengths[1]);
            }
        }
    }
}

#[test]
fn straightened_paths_are_the_default_ones_nearly_always() {
    let (mut longer, mut count) = (0, 0);
    for (index, mesh) in solids().iter().enumerate() {
        let (ours, exact) = (surface(mesh, true, 0.002), exact(mesh));
        let mut random = Random::from_key(index as u64, 1, 0, 0);
        for _ in 0..100 {
            let (from, to) = (anywhere(mesh, &mut random), anywhere(mesh, &mut random));
            let (a, b) = (length(&ours, &from, &to), length(&exact, &from, &to));
            assert!(
                a >= b * (1.0 - 1e-5) - 1e-12 && a <= 1.01 * b + 1e-9,
                "solid {index}: {a} instead of {b}"
            );
            longer += usize::from(a > 1.0001 * b + 1e-9);
            count += 1;
        }
    }
    assert!(longer * 20 <= count, "{longer} of {count} paths are not the shortest");
}

#[test]
fn paths_over_a_cuboid_are_straight_in_an_unfolding() {
    let mesh = meshes::cuboid(Vec3::repeat(0.0225));
    let ours = surface(&mesh, true, 0.001);
    let mut random = Random::from_key(5, 0, 0, 0);
    for _ in 0..200 {
        let (from, to) = (anywhere(&mesh, &mut random), anywhere(&mesh, &mut random));
        let (length, best) = (length(&ours, &from, &to), reference::shortest(&mesh, &from, &to));
        assert!(length >= best - 1e-9 && length <= 1.005 * best + 1e-9, "{length} instead of {best}");
    }
}

#[test]
fn paths_over_a_fine_ball_are_great_circles() {
    let mesh = meshes::sphere(0.03, 4);
    let ours = surface(&mesh, true, 0.002);
    let mut random = Random::from_key(6, 0, 0, 0);
    for _ in 0..100 {
        let [a, b] = [(); 2].map(|()| ours.sample(&mut random));
        let arc = 0.03 * a.p_OC.angle(&b.p_OC);
        let length = length(&ours, &a, &b);
        assert!((length - arc).abs() <= 0.004 * arc + 1e-4, "{length} instead of {arc}");
    }
}

#[test]
fn parts_that_are_not_connected_have_no_path() {
    let (a, b) = (meshes::cuboid(Vec3::repeat(0.01)), meshes::cuboid(Vec3::repeat(0.01)));
    let moved = b.vertices().iter().map(|v| v + Vec3::x() * 0.05);
    let vertices: Vec<Vec3> = a.vertices().iter().copied().chain(moved).collect();
    let facets = a.facets().iter().copied().chain(b.facets().iter().map(|f| f.map(|v| v + 8)));
    let mesh = Mesh::new(vertices, facets.collect()).unwrap();
    let ours = surface(&mesh, true, 0.002);
    let on = |facet: u32| {
        let p_OC = mesh.corners(facet).iter().sum::<Vec3>() / 3.0;
        Contact { facet, p_OC, n_O: mesh.normal(facet) }
    };
    let mut context = regrasp_api::Context::new(Random::from_key(0, 0, 0, 0), &regrasp_api::Uninterrupted);
    let found = ours.geodesic(&on(0), &on(12), &mut Default::default(), &mut context);
    assert_eq!(found, Ok(false));
}

#[test]
fn settings_out_of_range_are_refused() {
    for (json, key) in [
        (r#"{"fewest": 0}"#, "fewest"),
        (r#"{"fewest": 65}"#, "fewest"),
        (r#"{"spacing": 0.0}"#, "spacing"),
        (r#"{"spacing": 2.0}"#, "spacing"),
        (r#"{"step": 0.1}"#, "step"),
        (r#"{"sharp_angle_deg": 0.0}"#, "sharp_angle_deg"),
    ] {
        let error = SteinerSettings::from_json(json).unwrap_err().to_string();
        assert!(error.contains(key), "{json}: {error}");
    }
}

#[test]
fn a_spacing_that_needs_too_many_points_is_refused() {
    let settings = SteinerSettings { spacing: 1e-5, ..SteinerSettings::default() };
    let error = Steiner::new(&settings, &meshes::sphere(1.0, 3), RADIUS).unwrap_err();
    assert!(matches!(&error, BuildError::Unsupported(text) if text.contains("spacing")), "{error}");
}
