//! Laws of closing chains for given contacts.

use super::{CLOSED, benches, build, somewhere, usual};
use crate::fixtures::Bench;
use crate::law::{Subject, context, random};
use crate::report::{Finding, broken, ensure};
use regrasp_api::{Hand, Pose, SurfaceParam};

pub(super) fn close_exact(subject: &Subject<'_>) -> Finding {
    closes_what_holds_nothing(subject)?;
    closes_nearby(subject)?;
    for bench in benches() {
        let (sampler, near) = (build(subject, bench)?, somewhere(bench, 2));
        let mut moved = near.X_HO;
        moved.translation.vector.x += 5e-4;
        for X_HO in [near.X_HO, moved] {
            let found = sampler.close(&bench.task(), &X_HO, &near.contacts, &near, &mut context(0))?;
            let Some(q) = found else {
                // The moved pose may be out of reach; the pose at which they are closed is not.
                ensure(X_HO != near.X_HO, || "does not close what is closed".into())?;
                continue;
            };
            ensure(q.X_HO == X_HO && q.contacts == near.contacts, || "changes pose or contacts".into())?;
            for (finger, joints) in q.joints.iter() {
                let tip = bench.world.hand.tip_center(finger, joints);
                let gap = (q.contact_tip_center(finger, bench.radius()).unwrap_or(tip) - tip).norm();
                ensure(gap <= CLOSED, || format!("finger {} is {gap:e} m off its contact", finger.0))?;
                let jump = joints.max_difference(&near.joints[finger]);
                ensure(jump <= 0.2, || {
                    format!("finger {} jumps by {jump} for a motion of 0.5 mm", finger.0)
                })?;
                ensure(bench.world.hand.within_limits(finger, joints), || {
                    format!("the joints of finger {} are beyond their limits: {joints:?}", finger.0)
                })?;
            }
        }
    }
    closes_what_is_given(subject)
}

/// The contacts are those that are given, not those of the configuration nearby.
fn closes_what_is_given(subject: &Subject<'_>) -> Finding {
    let bench = Bench::free_sphere();
    let (sampler, near, mut random) = (build(subject, bench)?, somewhere(bench, 4), random(72));
    let mut contacts = near.contacts;
    for finger in bench.fingers().iter() {
        contacts[finger] = contacts[finger].map(|c| bench.surface.walk(&c, &random.direction(), 1e-3));
    }
    let found = sampler.close(&bench.task(), &near.X_HO, &contacts, &near, &mut context(0))?;
    let Some(q) = found else { return broken("does not close contacts a millimetre beside closed ones") };
    ensure(q.contacts == contacts, || "closes other contacts than those that are given".into())?;
    for finger in bench.fingers().iter() {
        let tip = bench.world.hand.tip_center(finger, &q.joints[finger]);
        let gap = (q.contact_tip_center(finger, bench.radius()).unwrap_or(tip) - tip).norm();
        ensure(gap <= CLOSED, || format!("finger {} is {gap:e} m off its contact", finger.0))?;
    }
    Ok(())
}

/// Where there is a choice of postures, the one near the given one is taken.
fn closes_nearby(subject: &Subject<'_>) -> Finding {
    let bench = Bench::two_ways_sphere();
    let hand = &bench.world.hand;
    let mut near = somewhere(bench, 2);
    for finger in bench.fingers().iter() {
        let mut bent = near.joints[finger];
        (bent[1], bent[2]) = (bent[1] + bent[2], -bent[2]);
        let tip = hand.tip_center(finger, &near.joints[finger]);
        near.joints[finger] = hand.inverse(finger, &tip, &bent).unwrap_or(near.joints[finger]);
    }
    let sampler = build(subject, bench)?;
    let found = sampler.close(&bench.task(), &near.X_HO, &near.contacts, &near, &mut context(0))?;
    let Some(q) = found else { return broken("does not close what is closed, bent the other way") };
    for (finger, joints) in q.joints.iter() {
        let jump = joints.max_difference(&near.joints[finger]);
        ensure(jump <= 0.2, || {
            format!("finger {} goes over to its other posture, by {jump:.2} rad, where none moves", finger.0)
        })?;
    }
    Ok(())
}

/// Whether a grasp holds is nothing that closing asks.
fn closes_what_holds_nothing(subject: &Subject<'_>) -> Finding {
    let bench = Bench::free_sphere();
    let mut near = somewhere(bench, 2);
    for finger in bench.fingers().iter().skip(1) {
        near.contacts[finger] = None;
    }
    let found =
        build(subject, bench)?.close(&bench.task(), &near.X_HO, &near.contacts, &near, &mut context(0))?;
    ensure(found.is_some(), || {
        "does not close a chain that is closed, because one finger holds nothing".into()
    })
}

pub(super) fn close_refuses(subject: &Subject<'_>) -> Finding {
    for bench in usual() {
        let (sampler, near) = (build(subject, bench)?, somewhere(bench, 3));
        let far = Pose::translation(0.0, 0.0, 1.0);
        let found = sampler.close(&bench.task(), &far, &near.contacts, &near, &mut context(0))?;
        ensure(found.is_none(), || format!("closes chains a metre away: {found:?}"))?;
    }
    Ok(())
}
