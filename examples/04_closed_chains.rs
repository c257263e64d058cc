//! Samples closed chains: random configurations in which four fingertips of a hand touch a ball at once.
//!
//! `cargo run --example 04_closed_chains`
//!
//! Hand, fingers and object form loops. The random loop generator draws the object's pose and a contact for
//! each finger, and closes each chain by inverse kinematics. Every try that fails has its reason, and the
//! context counts them.

use regrasp::api::{Context, FingerSet, PoseRequest, Reason, Slot};
use std::error::Error;
use std::time::Instant;

/// How many configurations are asked for.
const SAMPLES: usize = 200;

fn main() -> Result<(), Box<dyn Error>> {
    let scenario = regrasp::load("sphere")?;
    let setup = regrasp::setup(&scenario)?; // builds the scenario's plugins once
    let task = setup.task(); // what plugins are handed: hand, collision, object, and each other
    let sampler = &setup.plugins().sampler;

    let mut context = Context::seeded(7); // its random stream is the only source of chance
    let all_four = FingerSet::first(4);
    let begin = Instant::now();
    let mut found = Vec::new();
    for _ in 0..SAMPLES {
        found.extend(sampler.sample(&task, PoseRequest::Anywhere, all_four, &mut context)?);
    }
    let rate = found.len() as f64 / begin.elapsed().as_secs_f64();

    println!(
        "{} of {SAMPLES} calls found a configuration, {rate:.0} a second; why tries failed:",
        found.len()
    );
    for reason in Reason::ALL {
        let count = context.tally.rejections(Slot::Sampler, reason);
        if count > 0 {
            println!("  {:<10} {count:>6}", reason.name());
        }
    }

    // Every chain is closed: each fingertip's centre is one radius above its contact.
    let radius = task.hand.fingertip_radius();
    let mut worst: f64 = 0.0;
    for q in &found {
        for finger in q.holding().iter() {
            let p_HF = task.hand.tip_center(finger, &q.joints[finger]);
            let wished = q.contact_tip_center(finger, radius).ok_or("a holding finger has a contact")?;
            worst = worst.max((p_HF - wished).norm());
        }
        assert_eq!(q.holding(), all_four);
        assert!(task.admissible.admit(&task, q, &mut context)?.is_none(), "free, stable, easy to leave");
    }
    println!("largest gap between a fingertip and its contact: {worst:.1e} m");
    assert!(found.len() > SAMPLES / 2 && worst < 1e-9);
    Ok(())
}
