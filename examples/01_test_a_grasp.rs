//! Is a grasp stable, and by how much? Three fingers on a ball, higher and higher above its equator.
//!
//! `cargo run --example 01_test_a_grasp`
//!
//! At latitude φ the three forces balance only if each is tilted by φ from its contact's normal. So the grasp
//! is force closure, which means that the contacts resist every small push and turn, exactly where tan φ is
//! below the coefficient of friction.

use regrasp::api::{
    CallError, Certificate, Cone, Context, FingerIndex, Grasp, GraspContact, Hint, StabilityTest, Vec3,
};
use regrasp::plugins::stability_tests::{ForceClosure, ForceClosureSettings};
use std::error::Error;
use std::f64::consts::TAU;

/// Radius of the ball (m).
const RADIUS: f64 = 0.03;
/// Coefficient of friction, no unit.
const FRICTION: f64 = 0.5;

/// Three contacts, evenly round the ball, at this latitude (rad).
fn grasp(latitude: f64) -> Grasp<'static> {
    let mut grasp = Grasp::new(Vec3::zeros()); // force closure asks for no load
    for k in 0..3 {
        let (sin, cos) = (TAU * f64::from(k) / 3.0).sin_cos();
        let n_O = Vec3::new(cos * latitude.cos(), sin * latitude.cos(), latitude.sin()); // normals point outward
        let cone = Cone::Elliptic { mu: FRICTION, gamma: 0.0 }; // a point contact with friction
        grasp.push(GraspContact { finger: FingerIndex(k as u8), p_OC: n_O * RADIUS, n_O, cone });
    }
    grasp
}

/// The verdict, and the margin: the largest wrench in every direction, for contact forces that add up to one.
fn judge(test: &ForceClosure, latitude: f64) -> Result<(bool, f64), CallError> {
    let (grasp, mut context) = (grasp(latitude), Context::seeded(0));
    let verdict = test.test(&grasp, &mut Hint::default(), &mut context)?;
    let assessed = test.assess(&grasp, None, None, &mut context)?;
    assert_eq!(verdict, assessed.stability, "both calls give one verdict");
    Ok((verdict.is_stable(), assessed.margin_lower))
}

fn main() -> Result<(), Box<dyn Error>> {
    let test = ForceClosure::new(ForceClosureSettings::default())?;
    println!(
        "three fingers on a ball, friction {FRICTION}: tan φ reaches it at {:.2}°",
        FRICTION.atan().to_degrees()
    );
    println!("latitude  force closure  margin");
    for latitude_deg in [0.0, 10.0, 20.0, 26.0, 26.5, 26.6, 27.0, 30.0, 40.0_f64] {
        let latitude = latitude_deg.to_radians();
        let (stable, margin) = judge(&test, latitude)?;
        println!("{latitude_deg:>7.1}°  {:>13}  {margin:.4}", if stable { "yes" } else { "no" });
        assert_eq!(stable, latitude.tan() < FRICTION, "the verdict is exact");
    }

    // A verdict comes with a proof: forces that balance each other, every one inside its friction cone.
    let proof = test.assess(&grasp(0.2), None, None, &mut Context::seeded(0))?.certificate;
    let Certificate::InternalForce { forces_O, .. } = proof else {
        return Err("a stable grasp has a proof".into());
    };
    for (contact, force) in grasp(0.2).contacts().iter().zip(&forces_O) {
        let normal = -force.dot(&contact.n_O);
        let tangential = (force + contact.n_O * normal).norm();
        println!(
            "finger {}: presses with {normal:.3}, pulls sideways with {tangential:.3}",
            contact.finger.0
        );
        assert!(tangential < FRICTION * normal);
    }
    assert!(forces_O.iter().sum::<Vec3>().norm() < 1e-9);
    Ok(())
}
