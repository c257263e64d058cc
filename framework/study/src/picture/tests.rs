use super::*;
use crate::scenario::{Scenario, load};
use regrasp_api::{Hand, PerFinger, Pose};
use regrasp_host::Registry;

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
    let numbers = text.split(['"', ' ', ',', 'M', 'L', 'Z']).filter_map(|word| word.parse::<f64>().ok());
    let bounds = picture.bounds();
    let largest = bounds.low.iter().chain(&bounds.high).fold(0.0_f64, |most, end| most.max(end.abs()));
    assert!(numbers.into_iter().all(|number| number.abs() <= largest + 0.1));
}
