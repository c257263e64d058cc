use super::answers::{GoalChoice, HandGiven, ObjectChoice};
use super::text::scenario;
use crate::args::LibraryArgs;
use std::path::Path;

#[test]
fn every_shape_and_goal_makes_a_scenario() {
    let registry = crate::plugins::registry(&LibraryArgs { load: Vec::new() }).unwrap();
    let shapes = [
        "sphere 0.03",
        "ellipsoid 0.03 0.025 0.02",
        "cuboid 0.05 0.04 0.05",
        "cylinder 0.025 0.05",
        "capsule 0.02 0.03",
        "torus 0.03 0.008",
    ];
    let hand = HandGiven::read("four-finger").unwrap();
    for shape in shapes {
        for goal in ["turn x -30", "move 0 0 0.01"] {
            let object = ObjectChoice::read(shape).unwrap();
            let goal = GoalChoice::read(goal).unwrap();
            let text = scenario(&hand, &object, &goal, [0.0, 0.0, 0.085], 4);
            let read = regrasp::run::scenario::from_text("mine.toml", &text, Path::new(""), &registry);
            assert_eq!(read.unwrap().problem.goal.len(), 1, "{text}");
        }
    }
}

#[test]
fn names_of_files_are_quoted() {
    let hand = HandGiven::read("a \"b\"\\c.URDF").unwrap();
    assert_eq!(hand.line(), r#"urdf = 'a "b"\c.URDF'"#);
}

#[test]
fn answers_that_mean_nothing_say_what_would() {
    let said = |failure: crate::Failure| failure.json().to_string();
    assert!(said(HandGiven::read("four-fingr").unwrap_err()).contains("four-finger"));
    assert!(said(ObjectChoice::read("spere 0.03").unwrap_err()).contains("sphere"));
    assert!(said(ObjectChoice::read("sphere").unwrap_err()).contains("radius"));
    assert!(said(ObjectChoice::read("cuboid 1 nan 2").unwrap_err()).contains("size (3 numbers)"));
    assert!(said(GoalChoice::read("turn w 30").unwrap_err()).contains("`x`, `y` or `z`"));
    assert!(said(GoalChoice::read("turn z").unwrap_err()).contains("degrees"));
    assert!(said(GoalChoice::read("30").unwrap_err()).contains("turn z 45"));
}
