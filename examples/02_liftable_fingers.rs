//! Which fingers may be lifted? Three fingers and a thumb on a bar: any finger, but not the thumb.
//!
//! `cargo run --example 02_liftable_fingers`
//!
//! A finger may be lifted, and set down elsewhere, while the others hold the object by themselves. That is
//! why the planner searches with one finger more than are needed to hold.

use regrasp::api::{Cone, Context, FingerIndex, Grasp, GraspContact, StabilityTest, Vec3};
use regrasp::plugins::stability_tests::{ForceClosure, ForceClosureSettings};
use std::error::Error;

/// Who touches where (m), and the outward normal there: a bar 40 mm wide, the thumb opposite to the middle
/// finger.
const CONTACTS: [(&str, [f64; 3], [f64; 3]); 4] = [
    ("thumb", [-0.020, 0.0, 0.0], [-1.0, 0.0, 0.0]),
    ("index", [0.020, -0.025, 0.0], [1.0, 0.0, 0.0]),
    ("middle", [0.020, 0.0, 0.0], [1.0, 0.0, 0.0]),
    ("ring", [0.020, 0.025, 0.0], [1.0, 0.0, 0.0]),
];

fn grasp(mu: f64) -> Grasp<'static> {
    let mut grasp = Grasp::new(Vec3::zeros());
    for (k, (_, p_OC, n_O)) in CONTACTS.into_iter().enumerate() {
        let cone = Cone::Elliptic { mu, gamma: 0.0 };
        grasp.push(GraspContact { finger: FingerIndex(k as u8), p_OC: p_OC.into(), n_O: n_O.into(), cone });
    }
    grasp
}

fn main() -> Result<(), Box<dyn Error>> {
    let test = ForceClosure::new(ForceClosureSettings::default())?;
    let (grasp, mut context) = (grasp(0.8), Context::seeded(0));

    // All in one call. It may stop as soon as fewer than `enough` can still be found; here one is enough to
    // go on.
    let enough = 1;
    let liftable = test.liftable(&grasp, enough, &mut context)?;
    for (k, (name, ..)) in CONTACTS.iter().enumerate() {
        let finger = FingerIndex(k as u8);
        let rest = test.assess(&grasp.without(finger), None, None, &mut context)?;
        let may = if liftable.contains(finger) { "may be lifted" } else { "must stay" };
        println!("{name:<7} {may:<14} margin of the others: {:.4}", rest.margin_lower);
        assert_eq!(liftable.contains(finger), rest.stability.is_stable());
        assert_eq!(liftable.contains(finger), *name != "thumb", "without the thumb nothing presses back");
    }
    println!("{} of {} fingers may be lifted", liftable.len(), CONTACTS.len());
    Ok(())
}
