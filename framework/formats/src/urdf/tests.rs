use super::*;
use crate::robot::Geometry;

/// A robot with these elements inside.
fn robot(inside: &str) -> String {
    format!("<robot name=\"r\" xmlns:xacro=\"http://www.ros.org/wiki/xacro\">\n{inside}\n</robot>")
}

fn refusal(inside: &str) -> Fault {
    parse_urdf(&robot(inside)).unwrap_err()
}

#[test]
fn what_a_macro_left_is_refused_at_any_depth_with_its_line() {
    let deep = [
        "<link name=\"a\">\n<xacro:shape/></link>",
        "<link name=\"a\"><collision>\n<xacro:insert_block name=\"origin\"/><geometry><sphere \
         radius=\"1\"/></geometry></collision></link>",
        "<joint name=\"j\" type=\"fixed\">\n<xacro:frame/><parent link=\"a\"/><child link=\"b\"/></joint>",
        "<link name=\"a\"><visual><geometry>\n<xacro:box/></geometry></visual></link>",
        "<gazebo>\n<plugin><xacro:sensor/></plugin></gazebo>",
        "<link name=\"a\"><collision>\n<insert_block name=\"shape\"/></collision></link>",
    ];
    for inside in deep {
        let fault = refusal(inside);
        assert!(fault.message.contains("xacro hand.urdf.xacro > hand.urdf"), "{}", fault.message);
        assert_eq!(fault.line, Some(3), "{inside}");
    }
    let value = "<link name=\"a\"><collision><origin xyz=\"${x} 0 0\"/><geometry><sphere \
     radius=\"1\"/></geometry></collision></link>";
    assert!(refusal(value).message.contains("${x}"));
}

#[test]
fn what_has_no_say_is_listed_with_its_lines() {
    let text = robot(
        "<link name=\"a\"><inertial><mass value=\"2\"/><inertia ixx=\"1\"/></inertial></link>\n\
         <link name=\"b\">\n<collison/></link>\n\
         <joint name=\"j\" type=\"revolute\"><parent link=\"a\"/><child link=\"b\"/>\n<orgin xyz=\"0 0 \
          1\"/>\n<limit lower=\"0\" uper=\"1\"/>\n\
         <dynamics damping=\"1\"/></joint>\n<transmission name=\"t\"/>",
    );
    let robot = parse_urdf(&text).unwrap();
    let has =
        |list: &[String], part: &str| assert!(list.iter().any(|x| x.contains(part)), "{part}: {list:?}");
    has(&robot.remarks, "<collison> in <link>: not known, not used; is `collision` meant? (line 4)");
    has(&robot.remarks, "<orgin> in <joint>: not known, not used; is `origin` meant? (line 6)");
    has(&robot.remarks, "`uper` of <limit>: not known, not used; is `upper` meant? (line 7)");
    has(&robot.ignored, "<dynamics> in <joint> (line 8)");
    has(&robot.ignored, "<transmission> in <robot> (line 9)");
    has(&robot.ignored, "<inertia> in <inertial> (line 2)");
    assert_eq!(robot.links[0].mass, Some(2.0));
}

#[test]
fn a_doctype_is_no_macro_and_soft_limits_are_read() {
    let text = format!(
        "<!DOCTYPE robot>\n{}",
        robot(
            "<joint name=\"j\" type=\"revolute\"><parent link=\"a\"/><child link=\"b\"/>\
             <safety_controller soft_lower_limit=\"-0.1\" soft_upper_limit=\"0.2\" k_velocity=\"1\"/></joint>"
        )
    );
    let soft = parse_urdf(&text).unwrap().joints[0].soft.unwrap();
    assert_eq!((soft.lower, soft.upper), (Some(-0.1), Some(0.2)));
}

#[test]
fn what_stands_twice_is_refused() {
    let collision =
        |inside: &str| refusal(&format!("<joint name=\"j\" type=\"fixed\">{inside}</joint>")).message;
    assert!(
        collision("<origin/><origin/><parent link=\"a\"/><child link=\"b\"/>").contains("second <origin>")
    );
    assert!(
        collision("<parent link=\"a\"/><parent link=\"c\"/><child link=\"b\"/>").contains("second <parent>")
    );
    // As it is published for some hands; what counts is told.
    let masses = robot(
        "<link name=\"a\"><inertial><mass value=\"2\"/></inertial>\n<inertial><mass \
         value=\"3\"/></inertial></link>",
    );
    let masses = parse_urdf(&masses).unwrap();
    assert_eq!(masses.links[0].mass, Some(2.0));
    assert_eq!(masses.remarks, ["a second <inertial> in one <link>: the first counts (line 3)"]);
    let two = robot(
        "<link name=\"a\"><collision><geometry><sphere radius=\"0.01\"/>\n<box size=\"1 1 \
         1\"/></geometry></collision></link>",
    );
    let link = &parse_urdf(&two).unwrap().links[0];
    let fault = link.collision.as_ref().unwrap_err();
    assert!(fault.message.contains("second shape, <box>") && fault.line == Some(3), "{fault:?}");
}

#[test]
fn shapes_keep_their_places_and_sizes() {
    let text = robot(
        "<link name=\"a\"><collision><origin xyz=\"0 0 1\" rpy=\"0 0 1.5707963267948966\"/><geometry><box \
         size=\"1 2 3\"/></geometry></collision></link>",
    );
    let robot = parse_urdf(&text).unwrap();
    let solid = &robot.links[0].collision.as_ref().unwrap()[0];
    assert!(matches!(solid.geometry, Geometry::Box { size: [1.0, 2.0, 3.0] }));
    let moved = solid.X_LS * nalgebra::Point3::new(1.0, 0.0, 0.0);
    assert!((moved - nalgebra::Point3::new(0.0, 1.0, 1.0)).norm() < 1e-12);
}

#[test]
fn what_a_macro_should_have_filled_in_is_refused_at_any_depth() {
    for text in [
        "<link name=\"a\"><inertial><origin xyz=\"${x} 0 0\"/></inertial></link>",
        "<link name=\"a\"><inertial><inertia ixx=\"$(arg i)\"/></inertial></link>",
        "<link name=\"a\"><visual><material name=\"${m}\"/></visual></link>",
        "<transmission><joint name=\"${j}\"/></transmission>",
        "<link name=\"a\"><foo><bar baz=\"${q}\"/></foo></link>",
    ] {
        assert!(refusal(text).message.contains("should have filled in"), "{text}");
    }
}

#[test]
fn numbers_that_no_robot_has_are_refused_with_their_range() {
    let joint = |inside: &str| {
        format!("<joint name=\"j\" type=\"revolute\"><parent link=\"a\"/><child link=\"b\"/>{inside}</joint>")
    };
    for (inside, range) in [
        ("<limit lower=\"1e160\"/>", "<limit lower>: 1e160 is outside -1e9..=1e9"),
        ("<axis xyz=\"0 -1e160 0\"/>", "<axis xyz>: -1e160 is outside"),
        ("<origin rpy=\"0 1e5 0\"/>", "angles are in radians"),
        (
            "<mimic joint=\"k\" multiplier=\"1e8\"/>",
            "<mimic multiplier>: 100000000 is outside -10000..=10000",
        ),
        ("<mimic joint=\"k\" offset=\"-1e8\"/>", "<mimic offset>: -100000000 is outside -1000..=1000"),
    ] {
        let message = refusal(&joint(inside)).message;
        assert!(message.contains(range), "{inside}: {message}");
    }
}
