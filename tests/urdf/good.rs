//! Hands of three to five fingers with three to five joints that nobody has seen before plan a motion that
//! verifies.

use crate::desk::Desk;
use crate::generator::{Pattern, WEDGE, hand};

/// A scenario for a generated hand: a ball a little above its start, turned by 40°.
fn scenario(fingers: usize) -> String {
    let soft = "[plugins.contact-model]\nuse = \"contact-model/soft-finger\"\ngamma = 0.004\n";
    let pose = "position = [0.0, 0.0, 0.085]";
    format!(
        "[hand]\nurdf = \"urdf/hand.urdf\"\nfingertip_radius = 0.01\n\
         [object]\nfriction = 0.8\nshape = {{ kind = \"sphere\", radius = 0.03 }}\n\
         [start]\npose = {{ {pose} }}\n[[goal]]\npose = {{ {pose}, axis = [0.0, 0.0, 1.0], angle_deg = 40.0 \
         }}\n{}",
        if fingers == 3 { soft } else { "" }
    )
}

fn desk(pattern: Pattern) -> Desk {
    let desk = Desk::new();
    std::fs::create_dir_all(desk.path("urdf")).unwrap();
    std::fs::create_dir_all(desk.path("meshes")).unwrap();
    desk.write("urdf/hand.urdf", hand(pattern));
    desk.write("meshes/wedge.obj", WEDGE);
    desk.write("a.toml", scenario(pattern.fingers));
    desk
}

/// Plans, and verifies the plan file by itself; what `plan` and `verify` say as JSON.
#[track_caller]
fn plans(pattern: Pattern) -> (serde_json::Value, serde_json::Value) {
    let desk = desk(pattern);
    let said = desk.run("plan a.toml --json -o plan.json");
    assert_eq!(said.code, 0, "{pattern:?}: {}", said.err);
    assert!(said.err.contains("fingertips guessed"), "{}", said.err);
    // The plan stands alone.
    std::fs::remove_dir_all(desk.path("urdf")).unwrap();
    std::fs::remove_dir_all(desk.path("meshes")).unwrap();
    let verified = desk.run("verify plan.json --json");
    assert_eq!(verified.code, 0, "{pattern:?}: {}", verified.err);
    (serde_json::from_str(&desk.read("plan.json")).unwrap(), verified.json())
}

#[test]
fn every_number_of_fingers_and_joints_plans() {
    for fingers in 3..=5 {
        for (joints, link) in [(3, "capsule"), (4, "box"), (5, "cylinder")] {
            plans(Pattern { fingers, joints, link, driven: false });
        }
    }
}

#[test]
fn driven_joints_follow_in_every_state_and_the_verifier_looks_at_it() {
    let (plan, verdict) = plans(Pattern { fingers: 4, joints: 4, link: "capsule", driven: true });
    for segment in plan["segments"].as_array().unwrap() {
        for state in segment["states"].as_array().unwrap() {
            for joints in state["joints"].as_array().unwrap() {
                let q = |i: usize| joints[i].as_f64().unwrap();
                assert!((q(3) - (0.8 * q(2) + 0.02)).abs() < 1e-9, "{joints}");
            }
        }
    }
    assert!(verdict.to_string().contains("driven-joints"), "{verdict}");
}

#[test]
fn a_plan_whose_driven_joint_stays_behind_does_not_verify() {
    let desk = desk(Pattern { fingers: 4, joints: 4, link: "capsule", driven: true });
    assert_eq!(desk.run("plan a.toml -o plan.json").code, 0);
    let mut plan: serde_json::Value = serde_json::from_str(&desk.read("plan.json")).unwrap();
    let q = &mut plan["segments"][0]["states"][1]["joints"][0][3];
    *q = (q.as_f64().unwrap() + 1e-6).into();
    desk.write("plan.json", plan.to_string());
    let said = desk.run("verify plan.json");
    assert_eq!(said.code, 4, "{}\n{}", said.out, said.err);
    assert!((said.out + &said.err).contains("driven-joints"));
}

#[test]
fn links_of_meshes_become_convex_hulls_found_beside_the_file() {
    let pattern = Pattern { fingers: 4, joints: 3, link: "mesh", driven: false };
    let said = desk(pattern).run("hand urdf/hand.urdf --fingertip-radius 0.01");
    assert_eq!(said.code, 0, "{}", said.err);
    assert!(said.out.contains("the convex hull of wedge.obj (7 facets)"), "{}", said.out);
    plans(pattern);
}

#[test]
fn three_fingers_are_refused_without_soft_contacts() {
    let desk = desk(Pattern { fingers: 3, joints: 3, link: "capsule", driven: false });
    let said = desk.run("plan a.toml --use contact-model=pcwf");
    said.assert_fails(2, &["3 fingers", "4 fingers are needed", "contact model"]);
}

#[test]
fn the_hand_file_that_is_written_plans_as_the_urdf_does() {
    let desk = desk(Pattern { fingers: 4, joints: 4, link: "box", driven: true });
    let said = desk.run("hand urdf/hand.urdf --fingertip-radius 0.01 -o hand.toml --json");
    assert_eq!(said.code, 0, "{}", said.err);
    let report = said.json();
    assert_eq!(report["fingers"].as_array().unwrap().len(), 4);
    assert_eq!(report["fingers"][0]["tip_link"], "f0_tip");
    assert_eq!(report["hand"]["finger"][0]["joint"][3]["mimic"]["joint"], "f0_flexion1");
    assert!(report["object_place"]["quality"].as_f64().unwrap() > 0.0);
    let segments = |file: &str| {
        assert_eq!(desk.run(&format!("plan {file} -o {file}.json")).code, 0);
        serde_json::from_str::<serde_json::Value>(&desk.read(&format!("{file}.json"))).unwrap()["segments"]
            .clone()
    };
    desk.write(
        "b.toml",
        scenario(4).replace("urdf = \"urdf/hand.urdf\"\nfingertip_radius = 0.01", "file = \"hand.toml\""),
    );
    assert_eq!(segments("a.toml"), segments("b.toml"));
}

#[test]
fn bodies_that_always_touch_are_found_and_excluded() {
    // A block at the root of one finger, and a large ball about the root of the next, fixed to its first
    // link: no posture keeps them apart.
    let desk = desk(Pattern { fingers: 4, joints: 3, link: "capsule", driven: false });
    let text = desk.read("urdf/hand.urdf");
    let with = |text: String, finger: usize, shape: &str| {
        let knuckle = format!("<link name=\"f{finger}_knuckle\">");
        assert!(text.contains(&knuckle));
        text.replacen(&knuckle, &format!("{knuckle}<collision><geometry>{shape}</geometry></collision>"), 1)
    };
    let text = with(text, 0, "<box size=\"0.02 0.02 0.03\"/>");
    desk.write("urdf/hand.urdf", with(text, 1, "<sphere radius=\"0.09\"/>"));
    let said = desk.run("hand urdf/hand.urdf --fingertip-radius 0.01 --json");
    assert_eq!(said.code, 0, "{}", said.err);
    let report = said.json();
    let pairs = report["report"]["touching"].as_array().unwrap();
    assert!(pairs.contains(&serde_json::json!(["f0_abduction", "f1_abduction"])), "{pairs:?}");
    assert_eq!(report["hand"]["touching"], report["report"]["touching"]);
}

#[test]
fn what_is_fixed_to_a_link_halfway_is_no_finger() {
    let desk = desk(Pattern { fingers: 4, joints: 3, link: "capsule", driven: false });
    let sensor = "<link name=\"sensor_tip\"/><joint name=\"sensor_mount\" type=\"fixed\"><parent \
        link=\"f1_link0\"/>\
        <child link=\"sensor_tip\"/></joint></robot>";
    desk.write("urdf/hand.urdf", desk.read("urdf/hand.urdf").replacen("</robot>", sensor, 1));
    let said = desk.run("hand urdf/hand.urdf --fingertip-radius 0.01 --json");
    assert_eq!(said.code, 0, "{}", said.err);
    assert_eq!(said.json()["report"]["tips"], serde_json::json!(["f0_tip", "f1_tip", "f2_tip", "f3_tip"]));
}

#[test]
fn joints_of_no_finger_are_held_and_said() {
    let desk = desk(Pattern { fingers: 4, joints: 3, link: "capsule", driven: false });
    let said = desk.run("hand urdf/hand.urdf --fingertip-radius 0.01 --tips f1_tip,f2_tip,f3_tip");
    assert_eq!(said.code, 0, "{}", said.err);
    for part in ["3 fingers", "as given", "`f0_flexion1` belongs to no finger: it is held at 0.05"] {
        assert!(said.out.contains(part), "`{part}` is not in:\n{}", said.out);
    }
}

/// The generated hand with plain boxes to the middle of every fingertip, which is a ball of 8 mm; `seen` are
/// the visual shapes of a last link and of a tip.
fn boxed(seen: (&str, &str)) -> Desk {
    let desk = desk(Pattern { fingers: 4, joints: 3, link: "box", driven: false });
    let mut text = desk.read("urdf/hand.urdf");
    for finger in 0..4 {
        let last = format!("<link name=\"f{finger}_link1\">");
        text = text.replacen(&last, &format!("{last}<visual>{}</visual>", seen.0), 1);
        let ball = "<collision><geometry><sphere radius=\"0.008\"/></geometry></collision>";
        let tip = format!("<link name=\"f{finger}_tip\"/>");
        assert!(text.contains(&last) && text.contains(&tip));
        let filled = format!("<link name=\"f{finger}_tip\">{ball}<visual>{}</visual></link>", seen.1);
        text = text.replacen(&tip, &filled, 1);
    }
    desk.write("urdf/hand.urdf", text);
    desk
}

/// A visual box of a last link up to this height (m), and a visual cylinder of a tip from `below` under its
/// ball's centre to its end.
fn seen(height: f64, below: f64, radius: f64) -> (String, String) {
    let link = format!(
        "<origin xyz=\"0 0 {}\"/><geometry><box size=\"0.014 0.014 {height}\"/></geometry>",
        height / 2.0
    );
    let tip = format!(
        "<origin xyz=\"0 0 {}\"/><geometry><cylinder radius=\"{radius}\" length=\"{}\"/></geometry>",
        (0.007 - below) / 2.0,
        below + 0.007
    );
    (link, tip)
}

#[test]
fn the_box_of_a_last_link_ends_where_the_link_is_seen_to_end() {
    let (link, tip) = seen(0.040, 0.010, 0.0075);
    let said = boxed((&link, &tip)).run("hand urdf/hand.urdf --json");
    assert_eq!(said.code, 0, "{}", said.err);
    let report = said.json();
    let notes = report["report"]["notes"].to_string();
    assert!(
        notes.contains("`f0_tip` is cut 10.0 mm behind the ball's centre") && notes.contains("7.4 mm radius"),
        "{notes}"
    );
    let shapes = report["hand"]["finger"][0]["joint"][2]["link"].as_array().unwrap().clone();
    assert_eq!(shapes.len(), 2, "{shapes:?}");
    let height = shapes[0]["shape"]["size"][2].as_f64().unwrap();
    assert!((height - 0.040).abs() < 1e-9, "{height}");
    assert_eq!(shapes[1]["shape"]["kind"], "capsule");
}

#[test]
fn what_is_seen_of_a_tip_must_fit_its_ball_and_its_link() {
    // The tip is wider than its ball; it ends before it meets the link; the link is seen up to the ball.
    for (height, below, radius) in [(0.040, 0.010, 0.010), (0.040, 0.005, 0.0075), (0.050, 0.010, 0.0075)] {
        let (link, tip) = seen(height, below, radius);
        let said = boxed((&link, &tip)).run("hand urdf/hand.urdf --json");
        assert_eq!(said.code, 0, "{}", said.err);
        let report = said.json();
        let notes = report["report"]["notes"].to_string();
        assert!(!notes.contains("is cut") && notes.contains("is wide beside the ball"), "{notes}");
        assert_eq!(report["hand"]["finger"][0]["joint"][2]["link"].as_array().unwrap().len(), 1);
    }
}

#[test]
fn ends_that_can_be_no_finger_are_left_out_of_a_guess() {
    let desk = desk(Pattern { fingers: 4, joints: 3, link: "capsule", driven: false });
    let flap = "<link name=\"flap\"/><joint name=\"hinge\" type=\"revolute\"><parent link=\"palm\"/><child \
        link=\"flap\"/>\
        <axis xyz=\"0 0 1\"/><limit lower=\"0\" upper=\"1\" velocity=\"1\" effort=\"1\"/></joint></robot>";
    desk.write("urdf/hand.urdf", desk.read("urdf/hand.urdf").replacen("</robot>", flap, 1));
    let said = desk.run("hand urdf/hand.urdf --fingertip-radius 0.01");
    assert_eq!(said.code, 0, "{}", said.err);
    for part in [
        "4 fingers, 12 joints",
        "`flap` is no finger: 1 of the joints",
        "joint `hinge` belongs to no finger: it is held at 0",
    ] {
        assert!(said.out.contains(part), "`{part}` is not in:\n{}", said.out);
    }
}

/// A robot with the generated hand at the end of each of its arms; an arm is one joint.
fn two_hands() -> String {
    let hand = hand(Pattern { fingers: 4, joints: 3, link: "capsule", driven: false });
    let from = hand.find("<link").unwrap();
    let body = hand[from..].trim_end().trim_end_matches("</robot>");
    let named = |side: &str| {
        let mut text = body.to_owned();
        for name in ["name=\"", "link=\""] {
            text = text.replace(name, &format!("{name}{side}_"));
        }
        let arm = format!(
            "<joint name=\"{side}_arm\" type=\"revolute\"><parent link=\"body\"/><child \
                link=\"{side}_palm\"/><axis xyz=\"0 0 1\"/>\
             <limit lower=\"-1\" upper=\"1\" velocity=\"1\" effort=\"1\"/></joint>"
        );
        text + &arm
    };
    format!("<robot name=\"two\"><link name=\"body\"/>{}{}</robot>", named("left"), named("right"))
}

#[test]
fn one_of_two_hands_is_chosen_by_its_palm() {
    let desk = Desk::new();
    desk.write("two.urdf", two_hands());
    let said = desk.run("hand two.urdf --fingertip-radius 0.01");
    said.assert_fails(2, &["more than one hand", "`left_palm` (to `left_f0_tip`, ", "`right_palm` (to"]);
    let said = desk.run("hand two.urdf --fingertip-radius 0.01 --palm right_palm");
    assert_eq!(said.code, 0, "{}", said.err);
    for part in
        ["4 fingers, 12 joints", "right_f3_tip", "everything above joint `right_arm`, which moves the palm"]
    {
        assert!(said.out.contains(part), "`{part}` is not in:\n{}", said.out);
    }
}

#[test]
fn faulty_shapes_that_are_not_used_do_no_harm() {
    let desk = desk(Pattern { fingers: 4, joints: 3, link: "capsule", driven: false });
    let visual =
        "<visual><origin xyz=\"a b c\"/><geometry><sphere radius=\"0\"/></geometry></visual><collision>";
    let text = desk.read("urdf/hand.urdf");
    desk.write("urdf/hand.urdf", text.replace("<collision>", visual));
    let said = desk.run("hand urdf/hand.urdf --fingertip-radius 0.01");
    assert_eq!(said.code, 0, "{}", said.err);
    let said = desk.run("hand urdf/hand.urdf --fingertip-radius 0.01 --json");
    desk.write("urdf/hand.urdf", text);
    assert_eq!(
        said.json()["hand"],
        desk.run("hand urdf/hand.urdf --fingertip-radius 0.01 --json").json()["hand"]
    );
}

#[test]
fn velocities_and_efforts_that_a_file_lacks_can_be_given() {
    let desk = desk(Pattern { fingers: 4, joints: 3, link: "capsule", driven: false });
    let text = desk.read("urdf/hand.urdf");
    let text = text.replacen("velocity=\"4\" effort=\"1\"", "velocity=\"0\" effort=\"0\"", 2);
    desk.write("urdf/hand.urdf", text.replacen(" velocity=\"4\" effort=\"1\"", "", 1));
    let said = desk.run("hand urdf/hand.urdf --fingertip-radius 0.01 --velocity 3 --effort 0.5 --json");
    assert_eq!(said.code, 0, "{}", said.err);
    let report = said.json();
    for (finger, joint, limits) in [(0, 0, (3.0, 0.5)), (0, 2, (3.0, 0.5)), (1, 0, (4.0, 1.0))] {
        let joint = &report["hand"]["finger"][finger]["joint"][joint];
        assert_eq!(
            (joint["velocity"].as_f64().unwrap(), joint["effort"].as_f64().unwrap()),
            limits,
            "{joint}"
        );
    }
    assert!(
        report["report"]["notes"]
            .to_string()
            .contains("`f0_abduction`: the file says no velocity; 3 is taken")
    );
    // The scenario has keys of the same names.
    desk.write(
        "a.toml",
        scenario(4)
            .replace("fingertip_radius = 0.01", "fingertip_radius = 0.01\nvelocity = 3.0\neffort = 0.5"),
    );
    assert_eq!(desk.run("plan a.toml").code, 0);
}

#[test]
fn a_cylinder_with_a_ball_at_each_end_is_a_capsule() {
    let desk = desk(Pattern { fingers: 4, joints: 3, link: "capsule", driven: false });
    let json =
        |desk: &Desk| desk.run("hand urdf/hand.urdf --fingertip-radius 0.01 --json").json()["hand"].clone();
    let (text, capsules) = (desk.read("urdf/hand.urdf"), json(&desk));
    let mut rods = text;
    for length in [0.065, 0.05] {
        let capsule = format!("<capsule radius=\"0.007\" length=\"{length}\"/></geometry></collision>");
        assert!(rods.contains(&capsule));
        let ball = |z: f64| {
            format!(
                "<collision><origin xyz=\"0 0 {z}\"/><geometry><sphere \
                    radius=\"0.007\"/></geometry></collision>"
            )
        };
        let cylinder = capsule.replace("<capsule", "<cylinder") + &ball(length) + &ball(0.0);
        rods = rods.replace(&capsule, &cylinder);
    }
    desk.write("urdf/hand.urdf", rods);
    assert_eq!(json(&desk), capsules);
}
