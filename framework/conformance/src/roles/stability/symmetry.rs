//! Laws that relate the verdicts of two grasps.

use super::call::{build, stable};
use crate::fixtures::Bench;
use crate::fixtures::grasps::{self, Touch};
use crate::law::{Subject, random};
use crate::report::{Fault, Finding, broken, ensure};
use regrasp_api::{Build, Criterion, ObjectModel, Parts, Rotation, StabilityTest, Vec3};

/// Breaks the law where `change` turns a verdict that is far from the boundary.
fn invariant(
    test: &dyn StabilityTest,
    cases: &[Vec<Touch>],
    mut change: impl FnMut(&[Touch]) -> Vec<Touch>,
) -> Finding {
    for touches in cases {
        let changed = change(touches);
        let verdicts = (stable(test, touches)?, stable(test, &changed)?);
        ensure(verdicts.0 == verdicts.1, || {
            format!("stable: {} for {touches:?}, {} for {changed:?}", verdicts.0, verdicts.1)
        })?;
    }
    Ok(())
}

/// Clear random grasps, and symmetric ones.
fn cases(key: u64) -> Vec<Vec<Touch>> {
    let random = grasps::clear_cases(key, 120).into_iter().map(|(touches, _)| touches);
    random.chain((3..=5).map(|count| grasps::equator(count, 0.8))).collect()
}

pub(super) fn rigid_motion(subject: &Subject<'_>) -> Finding {
    let test = build(subject)?;
    let mut random = random(21);
    for distance in [0.05, 5.0] {
        for touches in cases(21) {
            let (R, t) = (random.rotation(), random.direction() * distance);
            let elsewhere = build_moved(subject, &R, &t)?;
            let changed = grasps::moved(&touches, &R, &t);
            let verdicts = (stable(&*test, &touches)?, stable(&*elsewhere, &changed)?);
            ensure(verdicts.0 == verdicts.1, || {
                format!("stable: {} for {touches:?}, {} for {changed:?}", verdicts.0, verdicts.1)
            })?;
        }
    }
    Ok(())
}

/// The test for the same object in another frame: a test that knows the centre of mass finds it where the
/// contacts went.
fn build_moved(subject: &Subject<'_>, R: &Rotation, t: &Vec3) -> Finding<Box<dyn StabilityTest>> {
    let Build::StabilityTest(build) = subject.entry.build else { return broken("it builds another role") };
    let parts = Bench::free_sphere().parts();
    let object = ObjectModel { p_OCm: R * parts.object.p_OCm + t, ..parts.object.clone() };
    Ok(build(&subject.demands.settings, &Parts { object: &object, ..parts })?)
}

pub(super) fn permutation(subject: &Subject<'_>) -> Finding {
    // The finger that a contact belongs to goes with it: `Grasp` is filled in another order.
    let test = build(subject)?;
    for touches in cases(22) {
        let plain = stable(&*test, &touches)?;
        let grasp = grasps::grasp_of(&touches);
        for turn in 1..touches.len() {
            let mut other = regrasp_api::Grasp::new(Vec3::zeros());
            let (front, back) = grasp.contacts().split_at(turn);
            back.iter().chain(front).for_each(|contact| other.push(contact.clone()));
            let found = super::call::verdict(&*test, &other)?.is_some_and(|s| s.is_stable());
            ensure(found == plain, || {
                format!("stable: {plain}, but {found} with contact {turn} first: {touches:?}")
            })?;
        }
    }
    Ok(())
}

pub(super) fn scale(subject: &Subject<'_>) -> Finding {
    let test = build(subject)?;
    if test.criterion() != Criterion::Closure {
        return Err(Fault::Skip("a load in newtons and newton metres gives a grasp a size".into()));
    }
    for factor in [0.02, 50.0] {
        let scaled = |touch: &Touch| Touch { p: touch.p * factor, gamma: touch.gamma * factor, ..*touch };
        invariant(&*test, &cases(23), |touches| touches.iter().map(scaled).collect())?;
    }
    Ok(())
}

pub(super) fn monotone_in_friction(subject: &Subject<'_>) -> Finding {
    let test = build(subject)?;
    let mut stream = random(24);
    for i in 0..250 {
        let touches = grasps::random(&mut stream, 2 + i % 4);
        let mut held = false;
        for factor in [0.3, 0.6, 1.0, 1.4, 3.0] {
            let now = stable(&*test, &grasps::with_friction(&touches, factor))?;
            ensure(now || !held, || format!("stable with less friction, not with {factor} × {touches:?}"))?;
            held = now;
        }
    }
    Ok(())
}

pub(super) fn monotone_in_contacts(subject: &Subject<'_>) -> Finding {
    let test = build(subject)?;
    let mut stream = random(25);
    for i in 0..120 {
        let mut touches =
            grasps::moved(&grasps::random(&mut stream, 3 + i % 2), &Rotation::identity(), &Vec3::zeros());
        let mut held = stable(&*test, &touches)?;
        while touches.len() < 7 {
            let u = stream.direction();
            touches.push(Touch { p: u * 0.03, n: u, mu: touches[0].mu, gamma: touches[0].gamma });
            let now = stable(&*test, &touches)?;
            ensure(now || !held, || format!("stable without the last contact, not with it: {touches:?}"))?;
            held = now;
        }
    }
    Ok(())
}
