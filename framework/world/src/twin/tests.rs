use super::*;
use crate::primitive_mesh;
use regrasp_api::{Primitive, Random, Vec3};

const TIP: f64 = 0.01;

/// Three numbers of about unit spread.
fn noise(random: &mut Random) -> Vec3 {
    Vec3::from_fn(|_, _| (0..12).map(|_| random.unit()).sum::<f64>() - 6.0)
}

/// A mesh whose vertices are off by `spread` (m) as a scanner's are.
fn noisy(mesh: &Mesh, spread: f64, seed: u64) -> Mesh {
    let mut random = Random::from_key(seed, 0, 0, 0);
    let vertices = mesh.vertices().iter().map(|v| v + noise(&mut random) * spread).collect();
    Mesh::new(vertices, mesh.facets().to_vec()).unwrap()
}

fn ball(facets: usize) -> Mesh {
    primitive_mesh(&Primitive::Sphere { radius: 0.03 }, facets).unwrap()
}

#[test]
fn a_noisy_ball_gets_a_convex_twin_that_a_fingertip_cannot_tell_from_it() {
    let scan = noisy(&ball(5120), 8e-5, 3);
    assert!(roughness(&scan, TIP) > 0.9);
    let twin = automatic_twin(&scan, TIP).unwrap();
    assert!(twin.mesh.is_locally_convex() && twin.mesh.facets().len() < 3200);
    assert!(twin.bound <= twin.tolerance && twin.tolerance <= FARTHEST);
    assert!(roughness(&twin.mesh, TIP) == 0.0);
    // A fingertip anywhere on the twin is as near to the scan as is said.
    let touch = touch::Touch::new(&scan, TIP);
    let mut random = Random::from_key(5, 0, 0, 0);
    for _ in 0..2000 {
        let facet = (random.unit() * twin.mesh.facets().len() as f64) as u32;
        let [a, b, c] = twin.mesh.corners(facet);
        let (u, v) = (random.unit(), random.unit());
        let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
        let gap = touch.gap(&(a + (b - a) * u + (c - a) * v), &twin.mesh.normal(facet), &mut 0);
        assert!(gap.abs() <= twin.bound + 1e-5, "{gap} {}", twin.bound);
    }
}

#[test]
fn what_is_smooth_stays_as_it_is() {
    assert!(automatic_twin(&ball(1280), TIP).is_none());
    let ring = primitive_mesh(&Primitive::Torus { ring_radius: 0.03, tube_radius: 0.01 }, 1280).unwrap();
    assert!(roughness(&ring, TIP) <= ROUGH, "{}", roughness(&ring, TIP));
    assert!(automatic_twin(&ring, TIP).is_none());
}

#[test]
fn a_noisy_ring_keeps_its_hole() {
    let ring = primitive_mesh(&Primitive::Torus { ring_radius: 0.03, tube_radius: 0.009 }, 2600).unwrap();
    let scan = noisy(&ring, 5e-5, 7);
    let twin = automatic_twin(&scan, TIP).unwrap();
    let holes = |mesh: &Mesh| 1 - (mesh.vertices().len() as i64 - mesh.facets().len() as i64 / 2) / 2;
    assert_eq!(holes(&twin.mesh), 1);
    assert!(twin.bound <= FARTHEST);
    assert!(roughness(&twin.mesh, TIP) < 0.7 * roughness(&scan, TIP));
}

#[test]
fn a_twin_is_made_once_and_for_all() {
    let scan = noisy(&ball(1280), 1e-4, 11);
    assert_eq!(automatic_twin(&scan, TIP), automatic_twin(&scan, TIP));
}

#[test]
fn no_twin_is_farther_than_is_wished() {
    let scan = noisy(&ball(1280), 4e-4, 13);
    for tolerance in [1e-5, 1e-4, 1e-3] {
        if let Some(twin) = twin_within(&scan, TIP, tolerance) {
            assert!(twin.bound <= tolerance);
        }
    }
    assert!(twin_within(&scan, TIP, 1e-3).is_some_and(|twin| twin.mesh.is_locally_convex()));
    assert!(twin_within(&scan, 0.0, 1e-3).is_none(), "a point feels every facet");
}
