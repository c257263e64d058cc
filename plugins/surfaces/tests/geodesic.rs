//! Lengths of shortest paths against closed forms and brute force.

mod common;

use common::{length, meshes, reference};
use regrasp_api::{Contact, Mesh, Random, Vec3};
use regrasp_surfaces::geodesic::{Geodesic, GeodesicSettings};

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
fn solids_that_are_not_convex_agree_with_brute_force() {
    agrees_with_brute_force(&meshes::angle_block(0.04, 0.02), 1, 200);
    agrees_with_brute_force(&meshes::torus(0.03, 0.012, 5, 4), 3, 60);
}
