//! Time of geodesics, of the paths of `surface/steiner`, projections and edge distances; each figure is the
//! mean over 256 fixed inputs.

#[path = "../tests/it/common/mod.rs"]
#[allow(unused)]
mod common;

use common::meshes;
use criterion::{Criterion, criterion_group, criterion_main};
use regrasp_api::{Contact, Context, Mesh, Random, SurfaceParam, SurfacePath, Uninterrupted, Vec3};
use regrasp_surfaces::geodesic::{Geodesic, GeodesicSettings};
use regrasp_surfaces::steiner::{Steiner, SteinerSettings};
use std::hint::black_box;

const RADIUS: f64 = 0.010;
const COUNT: usize = 256;

fn objects() -> Vec<(&'static str, Mesh)> {
    vec![
        ("cuboid-12", meshes::cuboid(Vec3::repeat(0.0225))),
        ("sphere-1280", meshes::sphere(0.030, 3)),
        ("sphere-20480", meshes::sphere(0.030, 5)),
        ("ellipsoid-1280", meshes::ellipsoid(Vec3::new(0.040, 0.025, 0.025), 3)),
        ("ellipsoid-20480", meshes::ellipsoid(Vec3::new(0.040, 0.025, 0.025), 5)),
        ("cylinder-256", meshes::cylinder(0.025, 0.035, 64)),
        ("torus-1280", meshes::torus(0.035, 0.012, 40, 16)),
        ("torus-20480", meshes::torus(0.035, 0.012, 160, 64)),
        ("bumpy-1280", meshes::bumpy(0.030, 0.06, 3)),
        ("bumpy-20480", meshes::bumpy(0.030, 0.06, 5)),
    ]
}

fn surface(mesh: &Mesh) -> Geodesic {
    Geodesic::new(&GeodesicSettings::default(), mesh, RADIUS).expect("the mesh is sound")
}

/// Pairs of contacts whose straight distance lies between two bounds (m).
fn pairs(surface: &Geodesic, low: f64, high: f64) -> Vec<(Contact, Contact)> {
    let mut random = Random::from_key(1, 0, 0, 0);
    let mut pairs = Vec::new();
    while pairs.len() < COUNT {
        let pair = (surface.sample(&mut random), surface.sample(&mut random));
        if (low..=high).contains(&(pair.0.p_OC - pair.1.p_OC).norm()) {
            pairs.push(pair);
        }
    }
    pairs
}

fn geodesics(criterion: &mut Criterion) {
    for (name, mesh) in objects() {
        let surface = surface(&mesh);
        for (kind, low, high) in [("planning", 0.02, 0.04), ("random", 0.0, 1.0)] {
            let pairs = pairs(&surface, low, high);
            time_paths(criterion, &format!("geodesic/{kind}/{name}"), &surface, &pairs);
        }
    }
}

fn time_paths(
    criterion: &mut Criterion,
    name: &str,
    surface: &dyn SurfaceParam,
    pairs: &[(Contact, Contact)],
) {
    let (mut path, mut index) = (SurfacePath::default(), 0);
    let mut context = Context::new(Random::from_key(0, 0, 0, 0), &Uninterrupted);
    criterion.bench_function(name, |bencher| {
        bencher.iter(|| {
            index = (index + 1) % COUNT;
            let (from, to) = &pairs[index];
            black_box(surface.geodesic(from, to, &mut path, &mut context)).expect("not interrupted")
        });
    });
}

/// The pairs of `geodesic/planning`, on the default surface's competitor that the paper cites.
fn steiner(criterion: &mut Criterion) {
    for (name, mesh) in objects() {
        let pairs = pairs(&surface(&mesh), 0.02, 0.04);
        for straighten in [false, true] {
            let settings = SteinerSettings { straighten, ..SteinerSettings::default() };
            let surface = Steiner::new(&settings, &mesh, RADIUS).expect("the mesh is sound");
            let kind = if straighten { "straightened" } else { "as-cited" };
            time_paths(criterion, &format!("steiner/{kind}/{name}"), &surface, &pairs);
        }
    }
}

fn projections(criterion: &mut Criterion) {
    for (name, mesh) in objects() {
        let surface = surface(&mesh);
        let mut random = Random::from_key(2, 0, 0, 0);
        // A fingertip centre a millimetre away from where the hint was current, as in a path's steps.
        let steps: Vec<_> = (0..COUNT)
            .map(|_| {
                let contact = surface.sample(&mut random);
                (contact.tip_center(RADIUS) + random.direction() * 1e-3, contact.facet)
            })
            .collect();
        for (kind, hinted) in [("hint", true), ("no-hint", false)] {
            let mut index = 0;
            criterion.bench_function(&format!("project/{kind}/{name}"), |bencher| {
                bencher.iter(|| {
                    index = (index + 1) % COUNT;
                    let (p_OF, facet) = &steps[index];
                    black_box(surface.project(p_OF, hinted.then_some(*facet)))
                });
            });
        }
    }
}

fn edge_distances(criterion: &mut Criterion) {
    for (name, mesh) in [
        ("cuboid-12", meshes::cuboid(Vec3::repeat(0.0225))),
        ("cylinder-256", meshes::cylinder(0.025, 0.035, 64)),
        ("sphere-1280", meshes::sphere(0.030, 3)),
    ] {
        let surface = surface(&mesh);
        let mut random = Random::from_key(3, 0, 0, 0);
        let contacts: Vec<_> = (0..COUNT).map(|_| surface.sample(&mut random)).collect();
        let mut index = 0;
        criterion.bench_function(&format!("edge-distance/{name}"), |bencher| {
            bencher.iter(|| {
                index = (index + 1) % COUNT;
                black_box(surface.edge_distance(&contacts[index]))
            });
        });
    }
}

fn preparation(criterion: &mut Criterion) {
    for (name, mesh) in
        [("sphere-1280", meshes::sphere(0.030, 3)), ("sphere-20480", meshes::sphere(0.030, 5))]
    {
        criterion.bench_function(&format!("prepare/{name}"), |bencher| bencher.iter(|| surface(&mesh)));
    }
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(20).without_plots().warm_up_time(std::time::Duration::from_millis(200)).measurement_time(std::time::Duration::from_millis(600));
    targets = geodesics, steiner, projections, edge_distances, preparation
}
criterion_main!(benches);
