use super::*;
use regrasp_api::{Hand, PerFinger, Pose, Vec3};
use regrasp_contact_models as _;
use regrasp_host::Registry;
use regrasp_local_planners as _;
use regrasp_run::scenario::{Scenario, load};

fn scenario(name: &str) -> Scenario {
    load(name, &Registry::linked().unwrap()).unwrap()
}

/// The object at the start, the fingers at rest, none touching.
fn picture(scenario: &Scenario) -> Picture {
    let hand = scenario.hand.as_ref();
    let X_HO: Pose = scenario.problem.start.pose.pose().unwrap();
    let joints = PerFinger::from_fn(hand.finger_count(), |finger| hand.finger(finger).rest);
    let q = Configuration { X_HO, joints, contacts: PerFinger::filled(hand.finger_count(), None) };
    let obstacles = &scenario.problem.obstacle;
    Picture::of(&Scene { hand, mesh: &scenario.object.mesh, obstacles }, &q)
}

#[test]
fn everything_is_drawn_within_the_bounds() {
    let scenario = scenario("ellip-obst");
    let picture = picture(&scenario);
    let (text, fingers) = (picture.elements(), scenario.hand.finger_count());
    assert_eq!(text.matches("rg-free").count(), fingers);
    assert_eq!(text.matches("rg-link").count(), 3 * fingers);
    assert!(text.contains("rg-object") && text.contains("rg-paint") && text.contains("rg-obstacle"));
    let numbers = text.split(['"', ' ', ',', 'M', 'l', 'z']).filter_map(|word| word.parse::<f64>().ok());
    let bounds = picture.bounds();
    let largest = bounds.low.iter().chain(&bounds.high).fold(0.0_f64, |most, end| most.max(end.abs()));
    assert!(numbers.into_iter().all(|number| number.abs() <= largest + 0.1));
}

/// A picture with nothing in it yet.
fn empty() -> Picture {
    Picture { bounds: Bounds::NOTHING, strokes: Vec::new() }
}

#[test]
fn a_trace_is_dotted_where_the_object_hides_it() {
    let mut picture = empty();
    let towards = Vec3::new(0.0, -1.0, 0.0);
    let points =
        [0.0, 0.1, 0.2, 0.3].map(|x| (Vec3::new(x, 0.0, 0.0), if x < 0.15 { towards } else { -towards }));
    picture.trace("rg-trace", &points);
    let text = picture.elements();
    assert_eq!(text.matches("<polyline").count(), 2);
    assert_eq!(text.matches("rg-trace rg-behind").count(), 1);
    // The parts share the point where they meet.
    assert_eq!(text.matches("200.0,").count(), 2);
    assert_eq!(picture.bounds().size(), [300.0, 0.0]);
}

#[test]
fn a_sheet_has_every_picture_with_its_caption() {
    let scenario = scenario("sphere");
    let frames: Vec<_> = ["a < b", "c", "d"].map(|caption| (picture(&scenario), caption.to_owned())).into();
    let text = sheet(&frames, 2);
    assert!(text.contains(">a &lt; b</text>") && text.contains(">d</text>"));
    assert_eq!(
        text.matches("rg-link\"").count(),
        3 * picture(&scenario).elements().matches("rg-link\"").count()
    );
    let size = picture(&scenario).bounds().size();
    let width = 2.0 * (size[0] + 20.0);
    // Two rows, each with its captions in letters of 1.8 % of the width.
    let wanted = format!("viewBox=\"0 0 {width:.0} {:.0}\"", 2.0 * (size[1] + 17.0 + 0.018 * width));
    assert!(text.contains(&wanted), "{wanted}");
}
