//! How the checks call a stability test, and the laws of single calls.

use crate::fixtures::Bench;
use crate::fixtures::grasps::{self, Touch, grasp_of};
use crate::law::{Subject, context, counted_once, pure, random};
use crate::reference::{Closure, center_and_length, closure, may_give};
use crate::report::{Finding, broken, ensure};
use regrasp_api::{
    Build, CallError, Cone, ConeEdge, Criterion, FingerIndex, FingerSet, Grasp, GraspContact, Hint, Load,
    Slot, Stability, StabilityTest, Vec3,
};

/// The plugin under test.
pub(super) fn build(subject: &Subject<'_>) -> Finding<Box<dyn StabilityTest>> {
    let Build::StabilityTest(build) = subject.entry.build else { return broken("it builds another role") };
    Ok(build(&subject.demands.settings, &Bench::free_sphere().parts())?)
}

/// The verdict without a hint; `None` where the test does not handle the cones.
pub(super) fn verdict(test: &dyn StabilityTest, grasp: &Grasp<'_>) -> Finding<Option<Stability>> {
    match test.test(grasp, &mut Hint::default(), &mut context(0)) {
        Ok(stability) => Ok(Some(stability)),
        Err(CallError::Unsupported { .. }) => Ok(None),
        Err(error) => Err(error.into()),
    }
}

/// Whether the contacts are called stable.
pub(super) fn stable(test: &dyn StabilityTest, touches: &[Touch]) -> Finding<bool> {
    Ok(verdict(test, &grasp_of(touches))?.is_some_and(Stability::is_stable))
}

/// The same with round cones replaced by pyramids of eight edges.
fn pyramids(touches: &[Touch]) -> Vec<Vec<ConeEdge>> {
    let edge = |touch: &Touch, k: usize| {
        let (sin, cos) = (std::f64::consts::TAU * k as f64 / 8.0).sin_cos();
        ConeEdge { tangential: [touch.mu * cos, touch.mu * sin], torsion: 0.0 }
    };
    touches.iter().map(|touch| (0..8).map(|k| edge(touch, k)).collect()).collect()
}

fn pyramid_grasp<'a>(touches: &[Touch], edges: &'a [Vec<ConeEdge>]) -> Grasp<'a> {
    let mut grasp = Grasp::new(Vec3::zeros());
    for (i, (touch, edges)) in touches.iter().zip(edges).enumerate() {
        let cone = Cone::Polyhedral(edges.as_slice().into());
        grasp.push(GraspContact { finger: FingerIndex(i as u8), p_OC: touch.p, n_O: touch.n, cone });
    }
    grasp
}

pub(super) fn no_false_stable(subject: &Subject<'_>) -> Finding {
    let test = build(subject)?;
    for touches in grasps::never_closed() {
        let found = stable(&*test, &touches)?;
        ensure(!found, || format!("calls a degenerate grasp stable: {touches:?}"))?;
    }
    let mut random = random(11);
    for i in 0..600 {
        let touches = grasps::random(&mut random, 1 + i % 5);
        let edges = pyramids(&touches);
        let grained = grasps::grained(&touches, &random.direction());
        for grasp in [grasp_of(&touches), pyramid_grasp(&touches, &edges), grained] {
            let wrong = verdict(&*test, &grasp)?.is_some_and(Stability::is_stable)
                && closure(&grasp) == Closure::Open;
            ensure(!wrong, || format!("calls a grasp stable that is not: {touches:?}"))?;
        }
    }
    match test.criterion() {
        Criterion::Equilibrium(load) => no_false_carrying(&*test, &load),
        _ => Ok(()),
    }
}

/// Where stable means that a load is carried: one that no forces inside the cones can carry is not, whatever
/// their size.
fn no_false_carrying(test: &dyn StabilityTest, load: &Load) -> Finding {
    let (mut random, bench) = (random(17), Bench::free_sphere());
    let object = &bench.world.object;
    for i in 0..400 {
        let touches = grasps::random(&mut random, 1 + i % 5);
        let mut grasp = grasp_of(&touches);
        grasp.g_O = random.direction() * 9.81;
        if !verdict(test, &grasp)?.is_some_and(Stability::is_stable) {
            continue;
        }
        let lever = object.p_OCm - center_and_length(&grasp).0;
        for direction in [Vec3::zeros(), random.direction(), random.direction(), random.direction()] {
            let weight = grasp.g_O * -object.mass;
            let push = weight + direction * load.disturbance_force;
            let twisted = lever.cross(&weight) + direction * load.disturbance_torque;
            let carried = may_give(&grasp, &push, &lever.cross(&push)) && may_give(&grasp, &weight, &twisted);
            ensure(carried, || format!("says that {touches:?} carry a load, g = {:?}", grasp.g_O))?;
        }
    }
    Ok(())
}

pub(super) fn accepts_good_grasps(subject: &Subject<'_>) -> Finding {
    let test = build(subject)?;
    for touches in grasps::good() {
        let found = stable(&*test, &touches)?;
        ensure(found, || format!("refuses a grasp with a wide margin: {touches:?}"))?;
    }
    Ok(())
}

pub(super) fn hint_never_decides(subject: &Subject<'_>) -> Finding {
    let test = build(subject)?;
    let mut random = random(12);
    let mut carried = Hint::default();
    let odd = [0.0, -1.0, 1e300, f64::NAN, f64::INFINITY];
    for (touches, _) in grasps::clear_cases(12, 120) {
        let grasp = grasp_of(&touches);
        let plain = verdict(&*test, &grasp)?;
        let mut noise = Hint { tag: random.index(4) as u64, values: [0.0; Hint::VALUES] };
        noise.values.iter_mut().for_each(|x| *x = random.normal());
        let mut strange =
            Hint { tag: random.index(4) as u64, values: [odd[random.index(odd.len())]; Hint::VALUES] };
        for hint in [&mut carried, &mut noise, &mut strange] {
            let before = *hint;
            let hinted = match test.test(&grasp, hint, &mut context(0)) {
                Ok(stability) => Some(stability),
                Err(CallError::Unsupported { .. }) => None,
                Err(error) => return Err(error.into()),
            };
            ensure(hinted == plain, || {
                format!("{plain:?} without hint, {hinted:?} with {before:?}: {touches:?}")
            })?;
        }
    }
    Ok(())
}

pub(super) fn test_equals_assess(subject: &Subject<'_>) -> Finding {
    let test = build(subject)?;
    for (touches, _) in grasps::clear_cases(13, 60) {
        let grasp = grasp_of(&touches);
        let Some(tested) = verdict(&*test, &grasp)? else { continue };
        for length in [None, Some(0.05)] {
            let assessed = test.assess(&grasp, length, None, &mut context(0))?.stability;
            ensure(tested.is_stable() == assessed.is_stable(), || {
                format!("test says {tested:?}, assess {assessed:?}: {touches:?}")
            })?;
        }
    }
    Ok(())
}

pub(super) fn liftable(subject: &Subject<'_>) -> Finding {
    let test = build(subject)?;
    for (touches, _) in grasps::clear_cases(14, 80).into_iter().filter(|(touches, _)| touches.len() > 2) {
        let grasp = grasp_of(&touches);
        let mut truth = FingerSet::EMPTY;
        for finger in grasp.contacts().iter().map(|contact| contact.finger) {
            let holds = verdict(&*test, &grasp.without(finger))?.is_some_and(Stability::is_stable);
            let says = test.stable_without(&grasp, finger, &mut context(0))?;
            ensure(holds == says, || {
                format!("stable_without({finger:?}) says {says}, test {holds}: {touches:?}")
            })?;
            truth = if holds { truth.with(finger) } else { truth };
        }
        for enough in 0..=touches.len() {
            let found = test.liftable(&grasp, enough, &mut context(0))?;
            let all = truth.len() < enough || found == truth;
            ensure(all && found.union(truth) == truth, || {
                format!("liftable says {found:?}, single tests {truth:?} (enough = {enough}): {touches:?}")
            })?;
        }
    }
    Ok(())
}

pub(super) fn unsupported_cones(subject: &Subject<'_>) -> Finding {
    let test = build(subject)?;
    let mut random = random(15);
    for count in 1..=regrasp_api::MAX_FINGERS {
        let mut touches = grasps::random(&mut random, count);
        for (mu, gamma) in [(0.0, 0.0), (0.6, 0.0), (0.6, 0.004), (0.0, 0.004)] {
            touches.iter_mut().for_each(|touch| (touch.mu, touch.gamma) = (mu, gamma));
            answers(&*test, &grasp_of(&touches))?;
        }
        let edges = pyramids(&touches);
        answers(&*test, &pyramid_grasp(&touches, &edges))?;
    }
    Ok(())
}

/// Every call answers, or says that it does not support the cones, all in the same way.
fn answers(test: &dyn StabilityTest, grasp: &Grasp<'_>) -> Finding {
    let supported = verdict(test, grasp)?.is_some();
    let assessed = match test.assess(grasp, None, None, &mut context(0)) {
        Ok(_) => true,
        Err(CallError::Unsupported { .. }) => false,
        Err(error) => return Err(error.into()),
    };
    ensure(supported == assessed, || {
        format!("test and assess disagree on whether they support {:?}", grasp.contacts()[0].cone)
    })?;
    match test.liftable(grasp, 0, &mut context(0)) {
        Ok(_) | Err(CallError::Unsupported { .. }) => Ok(()),
        Err(error) => Err(error.into()),
    }
}

pub(super) fn counted(subject: &Subject<'_>) -> Finding {
    let test = build(subject)?;
    for touches in grasps::good().iter().chain(&grasps::never_closed()) {
        let mut context = context(0);
        if test.test(&grasp_of(touches), &mut Hint::default(), &mut context).is_ok() {
            counted_once(&context, Slot::StabilityTest)?;
        }
    }
    Ok(())
}

pub(super) fn stability_pure(subject: &Subject<'_>) -> Finding {
    let test = build(subject)?;
    let cases = grasps::clear_cases(16, 40);
    pure(cases.len(), |i| {
        let grasp = grasp_of(&cases[i].0);
        let assessed = test.assess(&grasp, None, None, &mut context(0));
        let lifted = test.liftable(&grasp, 0, &mut context(0));
        Ok((verdict(&*test, &grasp)?, assessed, lifted))
    })
}
