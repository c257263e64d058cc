//! The pages of a hand and of an object: what they are told.

use crate::small;

use regrasp_api::{Mesh, Primitive, Twin, Vec3};
use regrasp_view::{BallPlace, HandView, ObjectView, hand_page, object_page};
use regrasp_world::primitive_mesh;
use serde_json::json;
use small::{data, plan};

#[test]
fn the_page_of_a_hand_has_joints_that_follow_and_tips_to_check() {
    let mut hand = plan().scenario.problem.hand;
    let mut driven = hand.finger[0].joint[2].clone();
    driven.name = "d".into();
    driven.mimic = Some(regrasp_api::Mimic { joint: "c".into(), multiplier: 0.5, offset: 0.1 });
    hand.finger[0].joint.push(driven);
    hand.finger[0].rest.push(0.5 * 0.2 + 0.1);
    let view = HandView {
        hand: &hand,
        ball_radius: 0.02,
        ball: Some(BallPlace { position: [0.0, 0.01, 0.09], quality: 0.4 }),
        facts: vec![("Radius".into(), "10 mm".into())],
        lists: vec![("notes".into(), vec!["<script>".into()])],
    };
    let page = hand_page(&view).unwrap();
    assert!(page.contains("handpage.js") && !page.contains("data-module=\"main.js\""));
    let data = data(&page);
    let joint = &data["hand"]["fingers"][0]["joints"][3];
    assert_eq!(joint["mimic"], json!({"joint": 2, "multiplier": 0.5, "offset": 0.1}));
    assert_eq!(data["hand"]["fingers"][0]["rest"], json!([0.0, 0.1, 0.2, 0.2]));
    assert_eq!(data["ball"], json!({"position": [0.0, 0.01, 0.09], "quality": 0.4}));
    assert_eq!(data["lists"], json!([["notes", ["<script>"]]]));
    // The last of the postures: all at their upper ends, but for the joint that is driven.
    let last = &data["checks"][2];
    assert_eq!(last["joints"], json!([1.0, 1.0, 1.0, 0.6]));
    // The first joint turns about x, the others about y, by as much as all before them together.
    let bends = [0.0_f64, 1.0, 2.0, 2.6];
    let along = bends.map(|angle| Vec3::new(angle.sin(), 0.0, angle.cos()) * 0.05);
    let along = along.into_iter().fold(Vec3::zeros(), |sum, part| sum + part);
    let turned = nalgebra::Rotation3::from_axis_angle(&Vec3::x_axis(), 1.0) * along;
    let tip = &last["tips"][0];
    let expected = [turned.x, turned.y, 0.05 + turned.z];
    assert!((0..3).all(|i| (tip[i].as_f64().unwrap() - expected[i]).abs() < 1e-8), "{tip} {expected:?}");
}

#[test]
fn the_page_of_an_object_tells_how_far_both_surfaces_are_apart() {
    let ball = |radius| primitive_mesh(&Primitive::Sphere { radius }, 1280).unwrap();
    let (mesh, twin) = (ball(0.03), Twin { mesh: ball(0.0302), bound: 2.1e-4, tolerance: 3e-4 });
    let view = |twin| ObjectView {
        name: "ball.stl",
        mesh: &mesh,
        twin,
        p_OCm: [0.0; 3],
        fingertip_radius: 0.01,
        facts: vec![("size".into(), "60 mm".into())],
    };
    let told = data(&object_page(&view(Some(&twin))).unwrap());
    let heights = told["twin"]["heights"].as_array().unwrap();
    assert_eq!(heights.len(), twin.mesh.vertices().len());
    // Vertices of the larger one are 0.2 mm above the smaller one's, whose facets run the same way.
    assert!(heights.iter().all(|h| (h.as_f64().unwrap() - 2e-4).abs() < 2e-5), "{heights:?}");
    let below = told["twin"]["of_mesh"].as_array().unwrap();
    assert!(below.len() == mesh.vertices().len() && below.iter().all(|h| h.as_f64().unwrap() < -1.5e-4));
    assert_eq!(told["twin"]["bound"], 2.1e-4);
    assert_eq!(told["facts"], json!([["size", "60 mm"]]));
    assert_eq!(data(&object_page(&view(None)).unwrap())["twin"], json!(null));
}

#[test]
fn large_objects_are_drawn_with_fewer_facets_and_their_own_distances() {
    let mesh = |radius| primitive_mesh(&Primitive::Sphere { radius }, 80_000).unwrap();
    let (fine, twin): (Mesh, Mesh) = (mesh(0.03), mesh(0.03005));
    let twin = Twin { mesh: twin, bound: 1e-4, tolerance: 1e-4 };
    let view = ObjectView {
        name: "fine",
        mesh: &fine,
        twin: Some(&twin),
        p_OCm: [0.0; 3],
        fingertip_radius: 0.01,
        facts: vec![],
    };
    let page = object_page(&view).unwrap();
    assert!(page.len() < 4_000_000, "{}", page.len());
    let data = data(&page);
    for (surface, heights) in [("object", "of_mesh"), ("twin", "heights")] {
        let drawn = data[surface]["vertices"].as_array().unwrap().len() / 3;
        assert!(drawn < 40_000);
        assert_eq!(data["twin"][heights].as_array().unwrap().len(), drawn, "one for each drawn vertex");
    }
}
