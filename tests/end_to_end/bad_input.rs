//! Every kind of bad input: exit code 2, one readable message, nothing written or overwritten.

use crate::desk::{Desk, built_in};

/// A plan file that must survive.
const KEPT: &str = "{ \"format\": \"regrasp-plan\", \"kept\": true }";

/// Plans `scenario` over an old plan; it must be refused with all of `parts`, and the old plan left alone.
fn refused(scenario: &str, parts: &[&str]) {
    refused_with(&Desk::new(), scenario, "", parts);
}

fn refused_with(desk: &Desk, scenario: &str, options: &str, parts: &[&str]) {
    desk.write("mine.toml", scenario);
    desk.write("plan.json", KEPT);
    let before = desk.files();
    let said = desk.run(&format!("plan mine.toml -o plan.json {options}"));
    said.assert_fails(2, parts);
    assert!(said.err.starts_with("error: ") && said.out.is_empty(), "{}\n{}", said.out, said.err);
    assert_eq!((desk.read("plan.json").as_str(), desk.files()), (KEPT, before));
}

fn sphere(from: &str, to: &str) -> String {
    built_in("sphere", &[(from, to)])
}

const MASS: &str = "mass = 0.1";
const BALL: &str = "shape = { kind = \"sphere\", radius = 0.030 }";
const START: &str = "[start]\npose = { position = [0.0, 0.0, 0.085] }";

#[test]
fn missing_and_unreadable_files() {
    let desk = Desk::new();
    desk.run("plan nowhere.toml").assert_fails(2, &["cannot read", "nowhere.toml", "No such file"]);
    desk.run("plan .").assert_fails(2, &["cannot read"]);
    desk.write("binary.toml", [0xff, 0x00, 0xfe]);
    desk.run("plan binary.toml").assert_fails(2, &["not UTF-8", "binary.toml"]);
    desk.run("verify nowhere.json").assert_fails(2, &["nowhere.json", "does not exist"]);
    assert_eq!(desk.files(), ["binary.toml"]);
}

#[test]
fn syntax_errors_and_unknown_keys() {
    refused(&sphere("[object]", "[object"), &["not valid TOML", "mine.toml:16", "[object"]);
    refused(&sphere("friction", "fricton"), &["unknown key; did you mean `friction`?", "`object.fricton`"]);
    refused(&sphere("\"sphere\", radius", "\"shpere\", radius"), &["did you mean `sphere`?"]);
}

#[test]
fn numbers_out_of_range_nan_and_infinite() {
    refused(&sphere("friction = 0.8", "friction = -1.0"), &["-1 is outside 0..=10", "key `object.friction`"]);
    refused(&sphere(MASS, "mass = nan"), &["nan is outside the finite numbers", "`object.mass`"]);
    refused(&sphere(MASS, "mass = inf"), &["inf is outside the finite numbers"]);
    refused(
        &sphere("radius = 0.030", "radius = 0.0"),
        &["0 is outside 0.000001..=1000 m", "key `object.shape.radius`"],
    );
    let limits = format!("[limits.tolerances]\nclosure = 5.0\n\n{START}");
    refused(&sphere(START, &limits), &["5 is outside 0.0000001..=0.01 m", "`limits.tolerances.closure`"]);
    let desk = Desk::new();
    for option in [
        "--time-limit nan",
        "--time-limit -1",
        "--time-limit inf",
        "--max-nodes 0",
        "--threads 0",
        "--seed -1",
        "--seed 18446744073709551616",
    ] {
        desk.run(&format!("plan sphere {option}")).assert_fails(2, &["error: "]);
    }
}

#[test]
fn unknown_plugins_scenarios_settings_and_slots() {
    let desk = Desk::new();
    desk.run("plan spere").assert_fails(2, &["no built-in scenario `spere`", "did you mean `sphere`"]);
    let plugins = format!("[plugins.sampler]\nuse = \"rgl\"\n\n{START}");
    refused(&sphere(START, &plugins), &["no plugin `rgl`", "did you mean `sampler/rlg`?", "mine.toml:23"]);
    let text = sphere(MASS, MASS);
    refused_with(
        &desk,
        &text,
        "--use stability-test=force-closur",
        &["did you mean `stability-test/force-closure`?"],
    );
    refused_with(&desk, &text, "--use samler=rlg", &["there is no slot `samler`", "did you mean `sampler`?"]);
    refused_with(&desk, &text, "--use local-planner.grasp=rolling", &["it fits `local-planner.transfer`"]);
    refused_with(&desk, &text, "--set sampler.tris=3", &["unknown key", "`sampler/rlg`"]);
    refused_with(&desk, &text, "--set sampler.tries", &["not of the form SLOT.KEY=VALUE"]);
    desk.run("plugins stability-test/force-closur")
        .assert_fails(2, &["did you mean `stability-test/force-closure`"]);
    desk.run("scenarios cubics").assert_fails(2, &["did you mean `cubic`?"]);
}

const TETRAHEDRON: &str =
    "v -20 -20 -20\nv 20 20 -20\nv 20 -20 20\nv -20 20 20\nf 1 2 3\nf 1 4 2\nf 1 3 4\nf 2 4 3\n";

/// Refuses the object of this OBJ file.
fn mesh_refused(obj: &str, keys: &str, parts: &[&str]) {
    let desk = Desk::new();
    desk.write("part.obj", obj);
    let shape = format!("shape = {{ kind = \"mesh\", file = \"part.obj\"{keys} }}");
    refused_with(&desk, &sphere(BALL, &shape), "", parts);
}

#[test]
fn meshes_that_cannot_be_used() {
    let scale = ", scale = 0.001";
    mesh_refused(&TETRAHEDRON.replace("f 2 4 3\n", ""), scale, &["not closed", "fill the holes"]);
    mesh_refused(TETRAHEDRON, &format!("{scale}, flip = true"), &["inside out", "flip"]);
    mesh_refused("v 0 0 0\n", scale, &["no facets"]);
    mesh_refused(TETRAHEDRON, "", &["are the lengths in metres?", "scale = 0.001"]);
    mesh_refused("v 0 0 zero\n", scale, &["part.obj", "line 1"]);
    let desk = Desk::new();
    let missing = sphere(BALL, "shape = { kind = \"mesh\", file = \"none.stl\" }");
    refused_with(&desk, &missing, "", &["none.stl", "No such file", "`object.shape.file`"]);
}

#[test]
fn a_mesh_of_millions_of_facets() {
    // The header of a binary STL file says how many facets follow; it is believed only as far as the file
    // goes.
    let mut stl = vec![0_u8; 80];
    stl.extend(3_000_000_u32.to_le_bytes());
    stl.resize(84 + 50 * 3_000_000, 0);
    let desk = Desk::new();
    desk.write("huge.stl", stl);
    let text = sphere(BALL, "shape = { kind = \"mesh\", file = \"huge.stl\" }");
    refused_with(&desk, &text, "", &["3000000 facets are more than the largest allowed 2000000", "simplify"]);
}

#[test]
fn starts_that_cannot_be() {
    let start = |pose: &str| sphere(START, &format!("[start]\n{pose}"));
    let grasp = |points: [&str; 4]| {
        let fingers: Vec<String> = points.iter().map(|point| format!("{{ contact = [{point}] }}")).collect();
        start(&format!("pose = {{ position = [0.0, 0.0, 0.085] }}\ngrasp = [{}]", fingers.join(", ")))
    };
    let round = ["0.03, 0, 0", "0, 0.03, 0", "-0.03, 0, 0", "0, -0.03, 0"];
    // The problem names what overlaps, with a grasp or without.
    refused(
        &start("pose = { position = [0.0, 0.0, 0.0] }"),
        &["`start.pose`: the palm and the object overlap", "mine.toml:23"],
    );
    let post = "[[obstacle]]\nname = \"post\"\nshape = { kind = \"sphere\", radius = 0.01 }\npose = { \
        position = [0.02, 0.0, 0.085] }\n\n[start]";
    refused(&sphere("[start]", post), &["`start.pose`", "obstacle `post`", "overlap"]);
    let far = start(
        "pose = { position = [0.0, 0.0, 0.6] }\ngrasp = [{ contact = [0.03, 0, 0] }, { contact = [0, 0.03, \
            0] }, \
         { contact = [-0.03, 0, 0] }, { contact = [0, -0.03, 0] }]",
    );
    refused(&far, &["start.grasp[0]", "`east`", "reach"]);
    refused(&grasp(["0.05, 0, 0", round[1], round[2], round[3]]), &["start.grasp[0]", "surface"]);
    let together = ["0.03, 0, 0", "0, 0.03, 0", "0.0001, 0.03, 0", "0, -0.03, 0"];
    refused(&grasp(together), &["`start`", "the object and link 3 of finger `west` overlap"]);
    let beside = ["0.03, 0, 0", "0.029, 0.0076, 0", "-0.03, 0, 0", "0, -0.03, 0"];
    refused(&grasp(beside), &["`start`", "link 3 of finger `east`", "finger `north`", "overlap"]);
    let none = start("pose = { position = [0.0, 0.0, 0.085] }\ngrasp = [{}, {}, {}, {}]");
    refused(&none, &["`start.grasp`", "not stable", "no finger has a `contact`"]);
    let two = "grasp = [{ contact = [0.03, 0, 0] }, { contact = [0, 0.03, 0] }, {}, {}]";
    let two = start(&format!("pose = {{ position = [0.0, 0.0, 0.085] }}\n{two}"));
    refused(&two, &["`start.grasp`", "not stable", "2 contacts (`east`, `north`)"]);
    refused(&start("pose = { position = [0.0, 0.0, 0.085] }\ngrasp = [{}]"), &["start.grasp"]);
}

#[test]
fn goals_that_coincide() {
    refused(
        &sphere("angle_deg = 180.0", "angle_deg = 360.0"),
        &["`goal[0]` coincides with the start", "quarters"],
    );
    let twice = "[[goal]]\npose = { position = [0.0, 0.0, 0.085], axis = [0.0, 0.0, 1.0], angle_deg = \
        -180.0 }\n\n[[goal]]";
    refused(&sphere("[[goal]]", twice), &["`goal[1]` coincides with `goal[0]`"]);
}

#[test]
fn hands_that_cannot_do_it() {
    refused(
        &sphere("four-finger", "three-finger"),
        &["the hand has 3 fingers", "`contact-model/pcwf`", "4 fingers are needed"],
    );
    let desk = Desk::new();
    let hand = built_in("four-finger", &[]);
    let joint = hand.find("[[finger.joint]]\nname = \"east-distal\"").expect("a joint of this name");
    let next = hand.find("[[finger]]\nname = \"north\"").expect("a finger of this name");
    let hand = format!("{}{}", &hand[..joint], &hand[next..]).replacen("[0.0, -0.9, 0.6]", "[0.0, -0.9]", 1);
    desk.write("hand.toml", hand);
    let text = sphere("builtin = \"four-finger\"", "file = \"hand.toml\"");
    refused_with(
        &desk,
        &text,
        "",
        &["\"east\"", "2 independent joints, at least three are needed", "hand.toml"],
    );
}

#[test]
fn places_where_no_plan_can_be_written() {
    let desk = Desk::new();
    desk.run("plan sphere -o nowhere/plan.json")
        .assert_fails(2, &["nowhere/plan.json", "folder does not exist"]);
    desk.run("plan sphere -o .").assert_fails(2, &["it is a folder"]);
    assert!(desk.files().is_empty());
    desk.write("kept.json", KEPT);
    let path = desk.folder().join("kept.json");
    let mut rights = std::fs::metadata(&path).expect("it was just written").permissions();
    rights.set_readonly(true);
    std::fs::set_permissions(&path, rights).expect("the file is ours");
    desk.run("plan sphere -o kept.json").assert_fails(2, &["kept.json", "permission denied"]);
    assert_eq!(desk.read("kept.json"), KEPT);
}

#[test]
fn plan_files_that_are_none() {
    let desk = Desk::new();
    assert_eq!(desk.run("plan sphere -o plan.json").code, 0);
    let plan = desk.read("plan.json");
    desk.write("short.json", &plan[..plan.len() / 2]);
    desk.run("verify short.json").assert_fails(2, &["short.json", "truncated"]);
    desk.write("later.json", plan.replacen("\"version\": 2", "\"version\": 99", 1));
    desk.run("verify later.json").assert_fails(2, &["version 99", "reads version"]);
    desk.write("full.json", plan.replacen("\"mu\": 0.8", "\"mu\": 0.9", 1));
    desk.run("verify full.json").assert_fails(4, &["does not verify: claims"]);
    desk.write("other.json", "{\"format\": \"something-else\"}");
    desk.run("verify other.json").assert_fails(2, &["not a plan file"]);
    desk.write("text.json", "hello");
    desk.run("verify text.json").assert_fails(2, &["not JSON"]);
}
