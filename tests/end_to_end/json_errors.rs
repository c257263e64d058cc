//! Errors as JSON: one object on standard output with what is wrong in fields, the message on standard error
//! as ever.

use crate::desk::{Desk, Said, built_in};
use serde_json::Value;

/// The error of a refused command, which says the same in words.
fn error(said: &Said) -> Value {
    let object: Value = serde_json::from_str(&said.out).unwrap_or_else(|_| panic!("no JSON: {}", said.out));
    let error = object["error"].clone();
    let known = ["code", "message", "file", "line", "key", "value", "range", "remedy"];
    let keys = error.as_object().expect("an object").keys();
    assert!(keys.into_iter().all(|key| known.contains(&key.as_str())), "{error}");
    let first = error["message"].as_str().expect("a message").lines().next().unwrap_or_default();
    assert!(!first.is_empty() && said.err.contains(first), "{error}\n{}", said.err);
    error
}

fn refused(desk: &Desk, command: &str, wanted: &[(&str, Value)]) {
    let said = desk.run(command);
    said.assert_fails(2, &[]);
    let error = error(&said);
    for (key, value) in wanted {
        assert_eq!(&error[*key], value, "{command}: `{key}` of {error}");
    }
}

#[test]
fn a_number_outside_its_range_comes_with_place_value_and_range() {
    let desk = Desk::new();
    desk.write("mine.toml", built_in("sphere", &[("radius = 0.030", "radius = 0.0")]));
    let wanted = [
        ("code", "out-of-range".into()),
        ("file", "mine.toml".into()),
        ("line", 20.into()),
        ("key", "object.shape.radius".into()),
        ("value", "0".into()),
        ("range", "0.000001..=1000 m".into()),
    ];
    refused(&desk, "plan mine.toml --json", &wanted);
    refused(&desk, "compare mine.toml -o study --json", &wanted);
}

#[test]
fn a_misspelt_key_and_a_misspelt_plugin_come_with_what_was_meant() {
    let desk = Desk::new();
    desk.write("mine.toml", built_in("sphere", &[("friction", "fricton")]));
    let meant = ("remedy", "did you mean `friction`?".into());
    let wanted = [("code", "unknown-key".into()), ("key", "object.fricton".into()), meant];
    refused(&desk, "plan mine.toml --json", &wanted);
    let wanted = [("code", "unknown-plugin".into()), ("key", "sampler".into()), ("value", "rgl".into())];
    refused(&desk, "plan sphere --use sampler=rgl --json", &wanted);
    let wanted = [("code", "out-of-range".into()), ("key", "poses".into()), ("value", "0".into())];
    refused(&desk, "plan sphere --set sampler.poses=0 --json", &wanted);
}

#[test]
fn a_given_grasp_that_does_not_hold_comes_with_its_key() {
    let desk = Desk::new();
    let start = "[start]\npose = { position = [0.0, 0.0, 0.085] }";
    let zero = "[start]\npose = { orientation = [0.0, 0.0, 0.0, 0.0] }";
    desk.write("mine.toml", built_in("sphere", &[(start, zero)]));
    let key = ("key", "start.pose.orientation".into());
    refused(&desk, "plan mine.toml --json", &[("code", "pose".into()), key]);
}

#[test]
fn plans_and_hands_that_cannot_be_read_name_their_file() {
    let desk = Desk::new();
    let file = ("file", "nowhere.json".into());
    refused(&desk, "verify nowhere.json --json", &[("code", "missing-file".into()), file]);
    desk.write("hand.urdf", "<robot name=\"r\">\n<link name=\"a\"/>\n<link name=\"a\"/>\n</robot>");
    let place = [("file", "hand.urdf".into()), ("line", 3.into())];
    refused(&desk, "hand hand.urdf --json", &[&[("code", "robot-file".into())], &place[..]].concat());
}

#[test]
fn a_command_that_answered_adds_no_second_object() {
    let desk = Desk::new();
    let said = desk.run("plan sphere --max-nodes 1 --json --seed 3");
    let one: Value = serde_json::from_str(&said.out).expect("one object");
    assert!(one.get("error").is_none());
}

#[test]
fn a_wrong_hand_comes_with_its_line_and_a_missing_key_with_an_example() {
    let desk = Desk::new();
    desk.write("mine.toml", built_in("sphere", &[("builtin = \"four-finger\"", "builtin = \"shadow\"")]));
    let wanted = [
        ("code", "unknown-name".into()),
        ("file", "mine.toml".into()),
        ("line", line_of(&desk, "shadow").into()),
        ("key", "hand.builtin".into()),
        ("value", "shadow".into()),
    ];
    refused(&desk, "plan mine.toml --json", &wanted);
    let text = built_in("sphere", &[]);
    desk.write("mine.toml", &text[..text.find("[[goal]]").expect("it has a goal")]);
    let remedy = "give `goal`, such as `[[goal]] pose = { position = [0.0, 0.0, 0.085], \
                  axis = [0.0, 0.0, 1.0], angle_deg = 90.0 }`";
    refused(&desk, "plan mine.toml --json", &[("code", "missing-key".into()), ("remedy", remedy.into())]);
    desk.run("plan mine.toml")
        .assert_fails(2, &["`goal` is missing; for example", "[[goal]]", "--> mine.toml"]);
}

/// The line of `mine.toml` that has this word, counted from 1.
fn line_of(desk: &Desk, word: &str) -> usize {
    desk.read("mine.toml").lines().position(|line| line.contains(word)).expect("it is there") + 1
}

#[test]
fn a_scenario_may_come_from_standard_input() {
    let desk = Desk::new();
    let said = desk.run_on("plan - --json", &built_in("cube-free", &[]));
    assert_eq!((said.code, said.json()["scenario"].as_str()), (0, Some("cube-free")), "{}", said.err);
    let table: toml::Table = toml::from_str(&built_in("cube-free", &[])).expect("it is TOML");
    let said = desk.run_on("plan - --json", &serde_json::to_string(&table).expect("it can be JSON"));
    assert_eq!((said.code, said.json()["scenario"].as_str()), (0, Some("cube-free")), "{}", said.err);
    let said = desk.run_on("plan - --json", &built_in("cube-free", &[("friction", "fricton")]));
    said.assert_fails(2, &["--> standard input:"]);
    assert_eq!(error(&said)["file"], "standard input");
}
