//! No command destroys a file: neither one that it reads, however it is spelt, nor one that is somebody
//! else's.

use crate::desk::{Desk, built_in};
use std::fs;

/// A scenario with a hand file and a mesh, and their contents.
fn own_files(desk: &Desk) -> Vec<(&'static str, String)> {
    desk.write("my-hand.toml", built_in("four-finger", &[]));
    desk.write("ball.obj", ball());
    let changes = [
        ("builtin = \"four-finger\"", "file = \"my-hand.toml\""),
        ("{ kind = \"sphere\", radius = 0.030 }", "{ kind = \"mesh\", file = \"ball.obj\" }"),
    ];
    desk.write("mine.toml", built_in("sphere", &changes));
    ["mine.toml", "my-hand.toml", "ball.obj"].map(|name| (name, desk.read(name))).to_vec()
}

/// An octahedron of 30 mm.
fn ball() -> String {
    let corners = [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]];
    let corner = |c: &[i32; 3]| {
        format!("v {} {} {}\n", 0.03 * f64::from(c[0]), 0.03 * f64::from(c[1]), 0.03 * f64::from(c[2]))
    };
    let facets = ["1 3 5", "3 2 5", "2 4 5", "4 1 5", "3 1 6", "2 3 6", "4 2 6", "1 4 6"];
    corners.iter().map(corner).chain(facets.iter().map(|facet| format!("f {facet}\n"))).collect()
}

#[test]
#[cfg(unix)]
fn inputs_are_kept_by_any_name_even_with_force() {
    let desk = Desk::new();
    let before = own_files(&desk);
    fs::create_dir(desk.path("deep")).unwrap();
    std::os::unix::fs::symlink(desk.path("ball.obj"), desk.path("link.obj")).unwrap();
    let absolute = desk.path("my-hand.toml").display().to_string();
    let outputs = [
        "-o mine.toml",
        "-o ./mine.toml",
        "-o deep/../mine.toml",
        "-o my-hand.toml",
        "-o ball.obj",
        "-o link.obj",
        &format!("-o {absolute}"),
        "-o plan.json --grasps ./plan.json",
    ];
    for output in outputs {
        desk.run(&format!("plan mine.toml --force {output}")).assert_fails(2, &["is not written"]);
    }
    for (name, content) in &before {
        assert_eq!(desk.read(name), *content, "{name}");
    }
    assert!(!desk.path("plan.json").exists());
}

#[test]
fn plans_are_kept_by_all_who_read_them() {
    let desk = Desk::new();
    assert_eq!(desk.run("plan sphere-free -o plan.json").code, 0);
    let before = desk.read("plan.json");
    for command in
        ["replay plan.json -o plan.json", "view plan.json -o ./plan.json", "view plan.json -o plan.json"]
    {
        desk.run(command).assert_fails(2, &["it is an input"]);
    }
    assert_eq!(desk.read("plan.json"), before);
    // A plan may take the place of a plan, and of nothing else.
    assert_eq!(desk.run("plan sphere-free -o plan.json").code, 0);
    desk.write("thesis.json", "{ \"chapters\": 7 }");
    desk.run("plan sphere-free -o thesis.json").assert_fails(2, &["it exists", "--force"]);
    assert_eq!(desk.run("plan sphere-free -o thesis.json --force").code, 0);
    assert!(desk.read("thesis.json").contains("regrasp-plan"));
}

#[test]
fn exported_files_replace_their_own_kind_alone() {
    let desk = Desk::new();
    assert_eq!(desk.run("plan sphere-free -o plan.json").code, 0);
    for _ in 0..2 {
        assert_eq!(desk.run("export plan.json --to csv,npz,urdf,mjcf,gltf").code, 0);
    }
    desk.write("plan.csv", "name,mark\nAda,1\n");
    desk.run("export plan.json --to csv,npz").assert_fails(2, &["plan.csv", "it exists", "--force"]);
    assert!(desk.read("plan.csv").contains("Ada"));
    desk.run("export plan.json --to csv -o -").assert_fails(2, &["name a folder"]);
}

#[test]
fn a_hyphen_is_standard_output() {
    let desk = Desk::new();
    let said = desk.run("plan sphere-free -o -");
    assert_eq!(said.code, 0, "{}", said.err);
    assert_eq!(said.json()["format"], "regrasp-plan");
    assert!(said.err.contains("solved, verified"), "{}", said.err);
    desk.write("plan.json", said.out);
    assert!(desk.run("view plan.json -o -").out.starts_with("<!"));
    desk.run("plan sphere-free -o - --json").assert_fails(2, &["standard output"]);
    assert_eq!(desk.files(), ["plan.json"]);
}
