//! `surface/parametric`: its contacts and paths against the facets, and what it refuses.

use crate::common;

use common::{length, meshes, path};
use regrasp_api::{BuildError, Mesh, ObjectModel, Primitive, Random, Settings, SurfaceParam, Vec3};
use regrasp_surfaces::geodesic::{Geodesic, GeodesicSettings};
use regrasp_surfaces::parametric::{Parametric, ParametricSettings};

fn object(primitive: Primitive, mesh: Mesh) -> ObjectModel {
    ObjectModel::new(mesh, Some(primitive), 0.1, 0.8)
}

fn surface(primitive: Primitive, mesh: &Mesh, radius: f64) -> Parametric {
    Parametric::new(&ParametricSettings::default(), &object(primitive, mesh.clone()), radius).unwrap()
}

#[test]
fn settings_out_of_range_are_refused() {
    for (json, key) in [
        (r#"{"spacing": 0.0}"#, "spacing"),
        (r#"{"spacing": 1.0}"#, "spacing"),
        (r#"{"step": 0.1}"#, "step"),
        (r#"{"sharp_angle_deg": 0.0}"#, "sharp_angle_deg"),
    ] {
        let error = ParametricSettings::from_json(json).unwrap_err().to_string();
        assert!(error.contains(key), "{json}: {error}");
    }
}

#[test]
fn objects_without_closed_form_are_refused_with_what_to_use() {
    let mesh = meshes::bumpy(0.03, 0.1, 2);
    let refused = |object: &ObjectModel| {
        let error = Parametric::new(&ParametricSettings::default(), object, 0.01).unwrap_err();
        assert!(
            matches!(&error, BuildError::Unsupported(text) if text.contains("surface/geodesic")),
            "{error}"
        );
    };
    refused(&ObjectModel::new(mesh.clone(), None, 0.1, 0.8));
    refused(&object(Primitive::Sphere { radius: 0.03 }, mesh));
    let semi_axes = Vec3::new(0.04, 0.03, 0.003);
    refused(&object(Primitive::Ellipsoid { semi_axes }, meshes::ellipsoid(semi_axes, 3)));
}

#[test]
fn over_a_box_paths_are_those_of_the_default_surface() {
    let half = Vec3::new(0.03, 0.02, 0.015);
    let mesh = meshes::cuboid(half);
    let ours = surface(Primitive::Cuboid { half_size: half }, &mesh, 0.01);
    let exact = GeodesicSettings { tolerance: 1e-9, ..GeodesicSettings::default() };
    let exact = Geodesic::new(&exact, &mesh, 0.01).unwrap();
    let mut random = Random::from_key(3, 0, 0, 0);
    for _ in 0..200 {
        let [from, to] = [(); 2].map(|()| ours.sample(&mut random));
        let (a, b) = (path(&ours, &from, &to), path(&exact, &from, &to));
        assert!((a.length - b.length).abs() < 1e-9, "{} instead of {}", a.length, b.length);
        assert!((a.lift_length() - b.lift_length()).abs() < 1e-6);
    }
}

#[test]
fn over_facets_paths_become_those_of_the_ball() {
    let primitive = Primitive::Sphere { radius: 0.03 };
    let mut random = Random::from_key(4, 0, 0, 0);
    let ends: Vec<_> = (0..40).map(|_| (random.direction(), random.direction())).collect();
    let worst = |levels: usize| {
        let mesh = meshes::sphere(0.03, levels);
        let ours = surface(primitive, &mesh, 0.01);
        let touch = |u: &Vec3| ours.project(&(u * 0.05), None).contact;
        let off = |(u, v): &(Vec3, Vec3)| {
            let (a, b) = (touch(u), touch(v));
            (length(&ours, &a, &b) / (0.03 * a.p_OC.angle(&b.p_OC)) - 1.0).abs()
        };
        ends.iter().map(off).fold(0.0, f64::max)
    };
    let errors = [worst(2), worst(3), worst(4)];
    // The facets' depth falls to a quarter with each level.
    assert!(errors[2] < 2e-3 && errors[1] < errors[0] / 2.5 && errors[2] < errors[1] / 2.5, "{errors:?}");
}
