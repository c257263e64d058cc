//! The fingertip's path stays on the offset surface, starts and ends exactly, and moves without leaps.

use crate::common;

use common::{meshes, reference};
use regrasp_api::{
    Contact, Context, Mesh, Random, SurfaceParam, SurfacePath, Uninterrupted, Vec3, slerp_normals,
};
use regrasp_surfaces::geodesic::{Geodesic, GeodesicSettings};

const RADIUS: f64 = 0.010;

fn surface(mesh: &Mesh) -> Geodesic {
    Geodesic::new(&GeodesicSettings::default(), mesh, RADIUS).unwrap()
}

fn lifted(surface: &Geodesic, from: &Contact, to: &Contact) -> Option<SurfacePath> {
    let mut path = SurfacePath::default();
    let mut context = Context::new(Random::from_key(0, 0, 0, 0), &Uninterrupted);
    surface.geodesic(from, to, &mut path, &mut context).unwrap().then_some(path)
}

/// Largest deviation (m) from the offset surface of the motion that the waypoints mean.
fn deviation(mesh: &Mesh, path: &SurfacePath) -> f64 {
    let mut worst: f64 = 0.0;
    for pair in path.waypoints.windows(2) {
        let (a, b) = (pair[0].contact, pair[1].contact);
        let gap = (a.tip_center(RADIUS) - b.tip_center(RADIUS)).norm();
        assert!(gap <= pair[1].lift_length - pair[0].lift_length + 1e-9, "the fingertip leaps by {gap}");
        if gap < 1e-9 {
            continue; // the contact jumps, the fingertip rests
        }
        for k in 0..=8 {
            let t = f64::from(k) / 8.0;
            let p = a.p_OC.lerp(&b.p_OC, t);
            let center = p + slerp_normals(&a.n_O, &b.n_O, t) * RADIUS;
            worst = worst.max((reference::distance(mesh, &center) - RADIUS).abs());
            worst = worst.max(reference::distance(mesh, &p).abs());
        }
    }
    worst
}

fn check(mesh: &Mesh, seed: u64, pairs: usize, bound: f64) -> usize {
    let surface = surface(mesh);
    let mut random = Random::from_key(seed, 0, 0, 0);
    let mut followed = 0;
    for _ in 0..pairs {
        // Project places a little off the surface, so that normals between facets occur, as after rolling.
        let mut contact = || {
            let near = surface.sample(&mut random);
            let center = near.tip_center(RADIUS) + random.direction() * 1e-3;
            let contact = surface.project(&center, Some(near.facet)).contact;
            let touches = (reference::distance(mesh, &contact.tip_center(RADIUS)) - RADIUS).abs() < 1e-9;
            if touches { contact } else { near }
        };
        let (from, to) = (contact(), contact());
        let Some(path) = lifted(&surface, &from, &to) else { continue };
        followed += 1;
        assert_eq!(path.waypoints[0].contact, from);
        assert_eq!(path.waypoints.last().unwrap().contact, to);
        assert_eq!(path.waypoints[0].lift_length, 0.0);
        let worst = deviation(mesh, &path);
        assert!(worst < bound, "{worst} off the offset surface: {from:?} {to:?}");
    }
    followed
}

#[test]
fn convex_solids_are_followed_exactly() {
    for mesh in [
        meshes::cuboid(Vec3::repeat(0.0225)),
        meshes::sphere(0.03, 2),
        meshes::ellipsoid(Vec3::new(0.04, 0.025, 0.02), 2),
        meshes::cylinder(0.025, 0.03, 24),
        meshes::random_hull(4, 14, 0.03),
    ] {
        assert_eq!(check(&mesh, 7, 60, 1e-9), 60);
    }
}

/// Planning stops anywhere on a path and goes on from there.
#[test]
fn every_place_of_a_path_holds_its_facet_and_starts_a_path() {
    for mesh in
        [meshes::cuboid(Vec3::repeat(0.0225)), meshes::sphere(0.03, 1), meshes::torus(0.04, 0.015, 16, 8)]
    {
        let surface = surface(&mesh);
        let mut random = Random::from_key(14, 0, 0, 0);
        for _ in 0..40 {
            let (from, to) = (surface.sample(&mut random), surface.sample(&mut random));
            let path = lifted(&surface, &from, &to).unwrap();
            let s = random.unit();
            let via = path.at(s);
            if mesh.is_locally_convex() {
                assert!(reference::facets_with(&mesh, &via.p_OC).contains(&via.facet), "{via:?}");
            }
            let rest = lifted(&surface, &via, &to).unwrap();
            let begun = lifted(&surface, &from, &via).unwrap();
            assert!(path.length <= (rest.length + begun.length) * (1.0 + 2.1e-4));
            if mesh.is_locally_convex() {
                let sum = begun.length + rest.length;
                assert!((sum - path.length).abs() < 5e-4 * path.length, "{sum} {}", path.length);
                let lift = begun.lift_length() + rest.lift_length();
                assert!(lift < path.lift_length() * 1.001 + 1e-9, "{lift} {}", path.lift_length());
            }
            // A wrong facet does not lead astray.
            let lost = Contact { facet: random.index(mesh.facets().len()) as u32, ..from };
            assert!((lifted(&surface, &lost, &to).unwrap().length - path.length).abs() < 3e-4 * path.length);
        }
    }
}

#[test]
fn hollows_are_followed_without_penetration() {
    let mut share = Vec::new();
    for mesh in [
        meshes::angle_block(0.06, 0.03),
        meshes::torus(0.04, 0.015, 24, 12),
        meshes::bumpy(0.03, 0.05, 2),
        meshes::bumpy(0.03, 0.12, 2),
    ] {
        share.push(check(&mesh, 3, 40, 1e-6));
    }
    assert!(share.iter().all(|&followed| followed >= 36), "{share:?} of 40 followed");
}

/// Planning sets fingers down at places of a path: what the path says of the contact there must be true.
///
/// Places where the ball touches two facets at once, as it does all along an inner edge, have two true
/// answers.
#[test]
fn a_place_of_a_path_names_the_point_that_the_fingertip_touches() {
    for mesh in [
        meshes::angle_block(0.06, 0.03),
        meshes::torus(0.03, 0.012, 40, 16),
        meshes::bumpy(0.03, 0.12, 2),
        meshes::bumpy(0.03, 0.06, 3),
    ] {
        let surface = surface(&mesh);
        let mut random = Random::from_key(12, 0, 0, 0);
        for _ in 0..40 {
            let (from, to) = (surface.sample(&mut random), surface.sample(&mut random));
            let Some(path) = lifted(&surface, &from, &to) else { continue };
            for _ in 0..60 {
                let claimed = path.at(random.unit());
                let touched = surface.project(&claimed.tip_center(RADIUS), Some(claimed.facet));
                let (off, sunk) = ((touched.contact.p_OC - claimed.p_OC).norm(), RADIUS - touched.distance);
                assert!(
                    off < 2e-6 || sunk < 1e-9,
                    "{off} m beside, {sunk} m deep: {claimed:?} {from:?} {to:?}"
                );
            }
        }
    }
}

#[test]
fn a_fingertip_too_thick_for_the_hole_says_no() {
    // The hole's radius is 5 mm, the fingertip's 10 mm.
    let mesh = meshes::torus(0.020, 0.015, 24, 16);
    let surface = surface(&mesh);
    let inner = |z: f64| {
        let projection = surface.project(&Vec3::new(0.001, 0.0, z), None);
        projection.contact
    };
    let outer = surface.project(&Vec3::new(0.1, 0.0, 0.0), None).contact;
    assert!(lifted(&surface, &outer, &inner(0.0)).is_none());
    let mut random = Random::from_key(1, 0, 0, 0);
    for _ in 0..200 {
        let contact = surface.sample(&mut random);
        assert!(reference::distance(&mesh, &contact.tip_center(RADIUS)) > RADIUS - 2e-9);
    }
}
