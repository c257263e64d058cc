use super::*;
use regrasp_contact_models as _;
use regrasp_local_planners as _;
use std::fs;

fn registry() -> Registry {
    Registry::linked().expect("the ids of the contact models differ")
}

fn read_text(text: &str) -> Result<Scenario, ScenarioError> {
    from_text("mine.toml", text, Path::new(""), &registry())
}

/// The built-in scenario `sphere` with one replacement.
fn sphere_with(from: &str, to: &str) -> Result<Scenario, ScenarioError> {
    let text = find(SCENARIOS, "sphere").unwrap().text;
    assert!(text.contains(from), "`{from}` is no longer in the scenario");
    read_text(&text.replace(from, to))
}

fn refusal(from: &str, to: &str) -> String {
    sphere_with(from, to).err().expect("the change must be refused").to_string()
}

/// The place of the line of `sphere` that begins with `start`, which the change must not have moved.
fn at(start: &str) -> String {
    let text = find(SCENARIOS, "sphere").unwrap().text;
    let line = text.lines().position(|line| line.starts_with(start)).expect("the scenario has such a line");
    format!("mine.toml:{}", line + 1)
}

fn assert_says(message: &str, parts: &[&str]) {
    for part in parts {
        assert!(message.contains(part), "`{part}` is not in:\n{message}");
    }
}

#[test]
fn every_built_in_scenario_loads_under_its_own_name_with_its_source() {
    for built_in in SCENARIOS {
        let scenario = load(built_in.name, &registry()).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(scenario.name, built_in.name);
        assert!(!scenario.summary.is_empty() && !scenario.source.is_empty());
        assert_eq!(scenario.object.friction, 0.8);
    }
}

#[test]
fn the_suites_are_built_in_and_those_called_given_have_grasps_at_both_ends() {
    for built_in in STRICT.iter().chain(HARDER) {
        let scenario = load(built_in.name, &registry()).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(scenario.name, built_in.name);
        assert_eq!(scenario.problem.limits.budget.max_nodes, 20_000);
        assert_eq!(scenario.paper.is_some(), built_in.name.contains("-given-"));
        let given = scenario.problem.start.grasp.is_some() && scenario.problem.goal[0].grasp.is_some();
        assert_eq!(given, built_in.name.contains("-given-"));
    }
}

#[test]
fn every_built_in_hand_is_accepted() {
    for hand in HANDS {
        let changed = format!("builtin = \"{}\"", hand.name);
        sphere_with("builtin = \"four-finger\"", &changed).unwrap_or_else(|error| panic!("{error}"));
    }
}

#[test]
fn every_scenario_file_in_the_folder_is_built_in() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios");
    let suites = [STRICT, HARDER].concat();
    let places = [("", SCENARIOS), ("strict", &suites), ("hands", HANDS)];
    for (folder, files) in places.map(|(name, files)| (folder.join(name), files)) {
        let mut found: Vec<String> = fs::read_dir(folder)
            .unwrap()
            .filter_map(|entry| entry.unwrap().file_name().to_str()?.strip_suffix(".toml").map(str::to_owned))
            .collect();
        let mut known: Vec<&str> = files.iter().map(|file| file.name).collect();
        found.sort_unstable();
        known.sort_unstable();
        assert_eq!(found, known);
    }
}

#[test]
fn the_papers_figures_are_those_of_its_table() {
    let figures = |name| load(name, &registry()).unwrap().paper.unwrap();
    let table = [("sphere", 17.5, 196, 23), ("cubic", 27.0, 113, 27), ("ellip-obst", 128.0, 543, 65)];
    for (name, time_s, generated, graph) in table {
        let paper = figures(name);
        assert_eq!((paper.time_s, paper.generated_nodes, paper.graph_nodes), (time_s, generated, graph));
    }
}

#[test]
fn unknown_scenarios_and_hands_show_the_near_ones() {
    let message = load("spere", &registry()).err().unwrap().to_string();
    assert_says(&message, &["no built-in scenario `spere`", "did you mean `sphere`"]);
    let message = load("xyzzy", &registry()).err().unwrap().to_string();
    assert_says(&message, &["built in are `sphere`, `cubic`"]);
    assert_says(&refusal("four-finger", "for-finger"), &["no built-in hand `for-finger`", "`four-finger`"]);
    assert_says(
        &refusal("builtin = \"four-finger\"", ""),
        &["give one of `builtin`", "`file`", "key `hand`", &at("[hand]")],
    );
}

#[test]
fn files_that_cannot_be_read_are_named() {
    assert_says(
        &load("nowhere/sphere.toml", &registry()).err().unwrap().to_string(),
        &["cannot read the file: No such file", "--> nowhere/sphere.toml"],
    );
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("binary.toml");
    fs::write(&path, [0xff, 0xfe, 0x00]).unwrap();
    let message = load(path.to_str().unwrap(), &registry()).err().unwrap().to_string();
    assert_says(&message, &["not UTF-8", "binary.toml"]);
    let message = load(folder.path().to_str().unwrap(), &registry()).err().unwrap().to_string();
    assert_says(&message, &["cannot read the file: it is a folder"]);
    let wrong = load("sphere.toml", &registry()).err().unwrap().to_string();
    assert_says(&wrong, &["the built-in scenario is called `sphere`"]);
    let path = folder.path().join("plan.json");
    fs::write(&path, "{\"format\": \"regrasp-plan\"}").unwrap();
    let message = load(path.to_str().unwrap(), &registry()).err().unwrap().to_string();
    assert_says(&message, &["it is a plan, not a scenario", "`verify`", "plan.json"]);
}

/// The built-in scenario `sphere` as JSON.
fn sphere_as_json() -> String {
    let table: toml::Table = toml::from_str(find(SCENARIOS, "sphere").unwrap().text).unwrap();
    serde_json::to_string_pretty(&table).unwrap()
}

#[test]
fn json_is_the_same_tree_as_toml() {
    let from_json = read_text(&sphere_as_json()).unwrap_or_else(|error| panic!("{error}"));
    let from_toml = sphere_with("[object]", "[object]").unwrap();
    assert_eq!(from_json.problem, from_toml.problem);
    assert_eq!(from_json.choices, from_toml.choices);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("sphere.json");
    fs::write(&path, sphere_as_json()).unwrap();
    assert_eq!(load(path.to_str().unwrap(), &registry()).unwrap().problem, from_toml.problem);
}

#[test]
fn json_has_the_errors_of_toml_with_their_lines() {
    let text = sphere_as_json();
    let refused = |from: &str, to: &str| {
        assert!(text.contains(from), "{from} is not in the text");
        read_text(&text.replace(from, to)).err().expect("the change must be refused").to_string()
    };
    let line = text.lines().position(|line| line.contains("\"friction\"")).unwrap() + 1;
    let at = format!("mine.toml:{line}");
    assert_says(&refused("\"friction\": 0.8", "\"friction\": -0.8"), &["-0.8 is outside 0..=10", &at]);
    assert_says(
        &refused("\"friction\"", "\"fricton\""),
        &["did you mean `friction`?", "`object.fricton`", &at],
    );
    assert_says(&refused("\"friction\": 0.8", "\"friction\": NaN"), &["not valid JSON", &at]);
    assert_says(&refused("\"friction\": 0.8", "\"friction\": 1e999"), &["not valid JSON", &at]);
}

#[test]
fn syntax_errors_have_their_line() {
    let message = refusal("[object]", "[object");
    assert_says(&message, &["not valid TOML", &at("[object]"), " | [object"]);
    assert_says(&refusal("mass = 0.1", "mass = 0.1\nmass = 0.2"), &["duplicate key", &at("friction")]);
}

#[test]
fn unknown_keys_have_their_line_and_the_nearest_known_one() {
    assert_says(
        &refusal("friction = 0.8", "fricton = 0.8"),
        &[
            "unknown key; did you mean `friction`?",
            &at("friction"),
            "key `object.fricton`",
            " | fricton = 0.8",
        ],
    );
    assert_says(&refusal("radius = 0.030", "radius = 0.030, facet = 5"), &["did you mean `facets`?"]);
    assert_says(&refusal("[[goal]]", "[[gaol]]"), &["did you mean `goal`?"]);
    assert_says(
        &refusal("\"sphere\", radius", "\"shpere\", radius"),
        &["did you mean `sphere`?", "key `object.shape.kind`"],
    );
    assert_says(&refusal("friction = 0.8", ""), &["the key `friction` is missing", "key `object`"]);
}

#[test]
fn numbers_outside_their_range_are_refused_with_it() {
    assert_says(&refusal("friction = 0.8", "friction = -0.8"), &["-0.8 is outside 0..=10", &at("friction")]);
    assert_says(
        &refusal("radius = 0.030", "radius = 0.0"),
        &["0 is outside 0.000001..=1000 m", "key `object.shape.radius`"],
    );
    let limits = |text: &str| refusal("[start]", &format!("[limits]\n{text}\n\n[start]"));
    assert_says(&limits("tolerances.slip = 1.0"), &["1 is outside 0.0000001..=0.01 m", " | tolerances.slip"]);
    assert_says(&limits("budget.max_nodes = 0"), &["0 is outside 1..=10000000"]);
    assert_says(&limits("budget.max_nodes = -4"), &["-4 is outside 1..=10000000"]);
    assert_says(&limits("resolution.friction_margin = 1.5"), &["1.5 is outside 0.01..=1"]);
}

#[test]
fn numbers_that_are_not_finite_are_refused() {
    for number in ["nan", "inf", "-inf", "1e999"] {
        let message = refusal("mass = 0.1", &format!("mass = {number}"));
        assert_says(&message, &[number, "is outside the finite numbers", "key `object.mass`", &at("mass")]);
    }
    let message = refusal("position = [0.0, 0.0, 0.085] }\n\n", "position = [0.0, nan, 0.085] }\n\n");
    assert_says(&message, &["key `start.pose.position[1]`"]);
    let message = refusal("mass = 0.1", "mass = 99999999999999999999");
    assert_says(&message, &["is outside what 64 bits hold"]);
}

#[test]
fn plugins_are_chosen_configured_and_checked_with_their_line() {
    let plugins = |text: &str| sphere_with("[start]", &format!("[plugins.contact-model]\n{text}\n\n[start]"));
    let scenario = plugins("use = \"frictionless\"").unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(scenario.choices.choice(Slot::ContactModel).id, "contact-model/frictionless");
    let message = plugins("use = \"pwcf\"").err().unwrap().to_string();
    assert_says(&message, &["no plugin `pwcf`", "did you mean `contact-model/pcwf`?", " | use = \"pwcf\""]);
    let message = plugins("gama = 1").err().unwrap().to_string();
    assert_says(&message, &["`contact-model/pcwf`", "unknown key", "key `plugins.contact-model.gama`"]);
}

#[test]
fn goals_that_coincide_are_refused() {
    assert_says(
        &refusal("angle_deg = 180.0", "angle_deg = 0.0"),
        &["`goal[0]` coincides with the start", "four quarters", "key `goal[0].pose`"],
    );
    let again = "[[goal]]\npose = { position = [0.0, 0.0, 0.085], axis = [0.0, 0.0, -1.0], angle_deg = \
        180.0 }\n\n[[goal]]";
    assert_says(&refusal("[[goal]]", again), &["`goal[1]` coincides with `goal[0]`"]);
    assert_says(&refusal("angle_deg = 180.0", "angle_deg = 360.0"), &["coincides with the start"]);
    let text = find(SCENARIOS, "sphere").unwrap().text;
    let without = &text[..text.find("[[goal]]").unwrap()];
    let shown = "`goal` is missing; for example\n    [[goal]]\n    pose = ";
    assert_says(&read_text(without).err().unwrap().to_string(), &[shown]);
}

#[test]
fn the_examples_of_missing_keys_are_a_scenario() {
    let schema = schemars::schema_for!(ScenarioFile).to_value();
    let properties = schema["properties"].as_object().unwrap();
    let required = schema["required"].as_array().unwrap().iter().map(|key| key.as_str().unwrap());
    let lines = required.map(|key| regrasp_api::example(key, &properties[key]).expect(key));
    let text = lines.collect::<Vec<_>>().join("\n");
    let read = read_text(&text).unwrap();
    assert_eq!((read.problem.goal.len(), read.problem.object.friction), (1, 0.8));
}

#[test]
fn poses_that_make_no_sense_are_refused() {
    assert_says(&refusal("axis = [0.0, 0.0, 1.0], ", ""), &["both `axis` and `angle_deg`", "goal[0].pose"]);
    assert_says(&refusal("axis = [0.0, 0.0, 1.0]", "axis = [0.0, 0.0, 0.0]"), &["not zero"]);
    assert_says(&refusal("axis = [0.0, 0.0, 1.0]", "axis = [0.0, 1.0]"), &["a list of 2 values is not"]);
}

#[test]
fn an_object_in_the_wrong_unit_is_refused_with_the_likely_fix() {
    assert_says(
        &refusal("radius = 0.030", "radius = 30.0"),
        &["are the lengths in metres?", "multiplied by 0.001"],
    );
}

const TETRAHEDRON: &str = "v 0 0 0\nv 40 0 0\nv 0 40 0\nv 0 0 40\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

fn with_mesh(obj: &str, keys: &str) -> Result<Scenario, ScenarioError> {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("part.obj"), obj).unwrap();
    let shape = format!("shape = {{ kind = \"mesh\", file = \"part.obj\"{keys} }}");
    let text = find(SCENARIOS, "sphere").unwrap().text;
    let text = text.replace("shape = { kind = \"sphere\", radius = 0.030 }", &shape);
    let path = folder.path().join("mine.toml");
    fs::write(&path, text).unwrap();
    load(path.to_str().unwrap(), &registry())
}

#[test]
fn meshes_are_found_beside_the_scenario_and_embedded() {
    let scenario = with_mesh(TETRAHEDRON, ", scale = 0.001").unwrap_or_else(|error| panic!("{error}"));
    let regrasp_api::ObjectShape::Mesh(source) = &scenario.problem.object.shape else { panic!("a mesh") };
    assert_eq!((source.facets.len(), &source.file, source.scale), (4, &None, None));
    assert!(source.vertices.contains(&[0.04, 0.0, 0.0]));
}

#[test]
fn bad_meshes_are_refused_with_the_fix() {
    let refusal = |obj: &str, keys| with_mesh(obj, keys).err().expect("a bad mesh").to_string();
    assert_says(&refusal(TETRAHEDRON, ""), &["`scale = 0.001`", &at("shape"), "key `object.shape`"]);
    let hole = TETRAHEDRON.replace("f 2 3 4\n", "");
    assert_says(&refusal(&hole, ", scale = 0.001"), &["not closed", "fill the holes", &at("shape")]);
    let flipped = "v 0 0 0\nv 40 0 0\nv 0 40 0\nv 0 0 40\nf 1 2 3\nf 1 4 2\nf 1 3 4\nf 2 4 3\n";
    assert_says(&refusal(flipped, ", scale = 0.001"), &["inside out", "flip = true"]);
    assert_says(&refusal("v 0 0 0\n", ", scale = 0.001"), &["no facets"]);
    let flat = "v 0 0 0\nv 40 0 0\nv 0 40 0\nv 80 0 0\nf 1 2 3\nf 1 2 4\n";
    assert_says(&refusal(flat, ", scale = 0.001"), &["no area"]);
}

#[test]
fn hand_files_are_found_beside_the_scenario_and_checked() {
    let folder = tempfile::tempdir().unwrap();
    let hand = find(HANDS, "four-finger").unwrap().text;
    let text = find(SCENARIOS, "sphere").unwrap().text;
    let text = text.replace("builtin = \"four-finger\"", "file = \"hand.toml\"");
    let path = folder.path().join("mine.toml");
    fs::write(&path, text).unwrap();
    let load_with = |hand: &str| {
        fs::write(folder.path().join("hand.toml"), hand).unwrap();
        load(path.to_str().unwrap(), &registry())
    };
    assert!(load_with(hand).unwrap().remarks.is_empty());
    let fast = load_with(&hand.replacen("velocity = 4.0", "velocity = 1e5", 1)).unwrap();
    assert_says(&fast.remarks.join("\n"), &["east-abduction", "no finger is as fast"]);
    let wrong = hand.replacen("upper = 1.4", "upper = -1.4", 1);
    assert_says(&load_with(&wrong).err().unwrap().to_string(), &["must be less than", " | lower = -1.2"]);
    let wrong = hand.replacen("fingertip_radius", "finger_tip_radius", 1);
    assert_says(&load_with(&wrong).err().unwrap().to_string(), &["did you mean `fingertip_radius`"]);
    let east =
        hand.find("[[finger]]").unwrap()..hand.find("[[finger.joint]]\nname = \"east-distal\"").unwrap();
    let short =
        format!("{}{}", &hand[..east.end], &hand[hand.find("[[finger]]\nname = \"north\"").unwrap()..]);
    let short = short.replacen("rest = [0.0, -0.9, 0.6]", "rest = [0.0, -0.9]", 1);
    assert_says(
        &load_with(&short).err().unwrap().to_string(),
        &["\"east\"", "2 independent joints, at least three"],
    );
    fs::remove_file(folder.path().join("hand.toml")).unwrap();
    assert_says(
        &load(path.to_str().unwrap(), &registry()).err().unwrap().to_string(),
        &["cannot read the file", "hand.toml"],
    );
}

#[test]
fn the_schema_describes_every_section() {
    let schema: serde_json::Value = serde_json::from_str(&schema()).unwrap();
    let properties = schema["properties"].as_object().unwrap();
    for section in ["hand", "object", "obstacle", "start", "goal", "plugins", "limits"] {
        assert!(properties.contains_key(section), "{section}");
    }
}
