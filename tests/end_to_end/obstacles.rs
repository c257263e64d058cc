//! Obstacles of every kind, from the scenario to the verdict.

use crate::desk::Desk;
use serde_json::Value;

#[test]
fn a_cylinder_in_the_way_is_planned_round_and_verified() {
    let desk = Desk::new();
    let scenario = desk.run("scenarios ellip-obst").out;
    let bar = "{ kind = \"capsule\", from = [0.045, 0.0, 0.075], to = [0.045, 0.0, 0.20], radius = 0.008 }";
    assert!(scenario.contains(bar), "{scenario}");
    let post =
        "{ kind = \"cylinder\", radius = 0.008, height = 0.12 }\npose = { position = [0.045, 0.0, 0.14] }";
    desk.write("post.toml", scenario.replace(bar, post));
    let said = desk.run("plan post.toml --seed 1 -o plan.json");
    assert_eq!(said.code, 0, "{}", said.err);
    assert_eq!(desk.run("verify plan.json").code, 0);
    let plan = desk.read("plan.json");
    let mut moved: Value = serde_json::from_str(&plan).expect("a plan is JSON");
    // A post through the middle of the hand meets the object.
    moved["scenario"]["problem"]["obstacle"][0]["pose"]["position"] = serde_json::json!([0.0, 0.0, 0.14]);
    desk.write("moved.json", moved.to_string());
    let said = desk.run("verify moved.json");
    assert_eq!(said.code, 4, "{}{}", said.out, said.err);
    assert!(said.out.contains("clearance"), "{}", said.out);
    for form in ["mjcf", "urdf", "gltf"] {
        assert_eq!(desk.run(&format!("export plan.json --to {form} -o {form}")).code, 0);
    }
    assert!(desk.read("mjcf/plan.mjcf.xml").contains("type=\"cylinder\""));
    assert!(desk.read("urdf/plan.hand.urdf").contains("<cylinder"));
    assert_eq!(desk.run("view plan.json -o plan.html").code, 0);
}
