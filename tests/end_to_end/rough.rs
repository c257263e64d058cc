//! Rough objects, as scanners give them: planned on a contact surface, and every lie about that surface found
//! out.

use crate::desk::Desk;
use regrasp::api::{Mesh, Primitive, Random, Vec3};
use serde_json::{Value, json};
use std::fmt::Write;

/// A mesh whose vertices are off by `spread` (m), with the same error for the same seed.
fn scanned(primitive: Primitive, facets: usize, spread: f64, seed: u64) -> Mesh {
    let mesh = regrasp::world::primitive_mesh(&primitive, facets).expect("a sound primitive");
    let mut random = Random::from_key(seed, 0, 0, 0);
    // The sum of twelve numbers from 0 to 1 has a standard deviation of 1.
    let mut error = || Vec3::from_fn(|_, _| (0..12).map(|_| random.unit()).sum::<f64>() - 6.0) * spread;
    let vertices = mesh.vertices().iter().map(|v| v + error()).collect();
    Mesh::new(vertices, mesh.facets().to_vec()).expect("the error is far below the facets' size")
}

fn obj(mesh: &Mesh) -> String {
    let mut text = String::new();
    mesh.vertices().iter().for_each(|v| writeln!(text, "v {} {} {}", v.x, v.y, v.z).expect("a string"));
    mesh.facets().iter().for_each(|f| {
        writeln!(text, "f {} {} {}", f[0] + 1, f[1] + 1, f[2] + 1).expect("a string");
    });
    text
}

/// A scenario that turns the object of `scan.obj` about the vertical.
fn scenario(surface: &str, angle_deg: f64) -> String {
    format!(
        "summary = \"a scan\"\n[hand]\nbuiltin = \"four-finger\"\n[object]\nshape = {{ kind = \"mesh\", \
         file = \"scan.obj\" }}\n\
         friction = 0.8\n{surface}\n[start]\npose = {{ position = [0.0, 0.0, 0.085] }}\n[[goal]]\n\
         pose = {{ position = [0.0, 0.0, 0.085], axis = [0.0, 0.0, 1.0], angle_deg = {angle_deg} }}\n"
    )
}

fn desk(mesh: &Mesh, surface: &str) -> Desk {
    let desk = Desk::new();
    desk.write("scan.obj", obj(mesh));
    desk.write("scan.toml", scenario(surface, 180.0));
    desk
}

fn ball() -> Mesh {
    scanned(Primitive::Sphere { radius: 0.03 }, 5120, 8e-5, 17)
}

#[test]
fn noisy_balls_are_planned_on_a_surface_that_the_plan_states() {
    for spread in [8e-5, 2e-4] {
        let desk = desk(&scanned(Primitive::Sphere { radius: 0.03 }, 5120, spread, 17), "");
        for seed in 0..3 {
            let said = desk.run(&format!("plan scan.toml --seed {seed} --time-limit 20 -o {seed}.json"));
            assert_eq!(said.code, 0, "{}", said.err);
            assert!((said.out + &said.err).contains("of touching the mesh"), "the user is told");
            let plan: Value = serde_json::from_str(&desk.read(&format!("{seed}.json"))).expect("JSON");
            let surface = &plan["object"]["contact_surface"];
            assert!(surface["bound"].as_f64().expect("a number") <= 3e-4);
            assert!(surface["facets"].as_array().expect("a list").len() < 5120);
        }
    }
}

#[test]
fn every_lie_about_the_contact_surface_is_found_out() {
    let desk = desk(&ball(), "");
    assert_eq!(desk.run("plan scan.toml --seed 1 --time-limit 20 -o plan.json").code, 0);
    assert_eq!(desk.run("verify plan.json").code, 0);
    let honest: Value = serde_json::from_str(&desk.read("plan.json")).expect("JSON");
    let bound = honest["object"]["contact_surface"]["bound"].as_f64().expect("a number");
    let lie = |name: &str, change: &dyn Fn(&mut Value)| {
        let mut plan = honest.clone();
        change(&mut plan);
        desk.write(name, plan.to_string());
        let said = desk.run(&format!("verify {name}"));
        assert_eq!(said.code, 4, "{name} is believed: {}", said.out);
    };
    lie("nearer.json", &|plan| plan["object"]["contact_surface"]["bound"] = json!(0.3 * bound));
    lie("anything.json", &|plan| plan["object"]["contact_surface"]["bound"] = json!(0.009));
    lie("other.json", &|plan| plan["object"]["contact_surface"]["digest"] = json!("00"));
    lie("unsaid.json", &|plan| plan["object"] = Value::Null);
    lie("exact.json", &|plan| plan["scenario"]["problem"]["object"]["contact_surface"] = json!("exact"));
    lie("dent.json", &|plan| {
        let vertex = &mut plan["object"]["contact_surface"]["vertices"][5];
        for k in 0..3 {
            vertex[k] = json!(vertex[k].as_f64().expect("a number") * 1.03);
        }
    });
}

#[test]
fn what_is_kept_beside_the_mesh_gives_the_same_plan_and_another_mesh_another() {
    let desk = desk(&ball(), "");
    let plan = |file: &str| {
        assert_eq!(desk.run(&format!("plan scan.toml --seed 2 --time-limit 20 -o {file}")).code, 0);
        let plan: Value = serde_json::from_str(&desk.read(file)).expect("JSON");
        (plan["object"].clone(), plan["segments"].clone())
    };
    let first = plan("first.json");
    assert!(desk.files().contains(&"scan.obj.contact-surface.json".to_owned()), "{:?}", desk.files());
    assert!(first == plan("second.json"));
    desk.write("scan.obj", obj(&scanned(Primitive::Sphere { radius: 0.03 }, 5120, 8e-5, 18)));
    assert!(first.0 != plan("third.json").0, "what was kept of the first mesh does not serve the second");
}

#[test]
fn the_surface_is_as_the_scenario_wishes() {
    let wide = desk(&ball(), "contact_surface = { tolerance = 1e-3 }");
    assert_eq!(wide.run("plan scan.toml --seed 1 --time-limit 20 -o plan.json").code, 0);
    let exact = desk(&ball(), "contact_surface = \"exact\"");
    let said = exact.run("plan scan.toml --seed 1 --max-nodes 1 --time-limit 1 -o plan.json");
    assert!(!(said.out + &said.err).contains("of touching the mesh"));
    let wrong = desk(&ball(), "contact_surface = \"exakt\"");
    let said = wrong.run("plan scan.toml -o plan.json");
    assert!(said.code == 2 && said.err.contains("did you mean `exact`"), "{}", said.err);
}
