//! Certificates and margins, checked by arithmetic.

use super::call::{build, verdict};
use crate::fixtures::Bench;
use crate::fixtures::grasps::{self, Touch, grasp_of};
use crate::law::{Subject, context, random};
use crate::reference::center_and_length;
use crate::report::{Fault, Finding, broken, ensure};
use regrasp_api::{Assessment, Certificate, Grasp, Stability, Vec3};
use regrasp_audit::laws;

/// The assessments of clear and symmetric grasps.
fn assessments(subject: &Subject<'_>) -> Finding<Vec<(Vec<Touch>, Assessment)>> {
    let test = build(subject)?;
    let random = grasps::clear_cases(31, 100).into_iter().map(|(touches, _)| touches);
    let mut all = Vec::new();
    for touches in random.chain(grasps::good()).chain(grasps::never_closed()) {
        let grasp = grasp_of(&touches);
        if verdict(&*test, &grasp)?.is_some() {
            let assessment = test.assess(&grasp, None, None, &mut context(0))?;
            all.push((touches, assessment));
        }
    }
    Ok(all)
}

pub(super) fn margins(subject: &Subject<'_>) -> Finding {
    for (touches, found) in assessments(subject)? {
        let (lower, upper) = (found.margin_lower, found.margin_upper);
        let text = || format!("{:?} with a margin of {lower} to {upper}: {touches:?}", found.stability);
        ensure(!lower.is_nan() && lower <= upper + 1e-9 * upper.abs() + 1e-12, text)?;
        ensure(found.stability.is_stable() || lower <= 0.0, text)?;
    }
    Ok(())
}

pub(super) fn certificate(subject: &Subject<'_>) -> Finding {
    for (touches, found) in assessments(subject)? {
        let grasp = grasp_of(&touches);
        let fault = match (&found.certificate, found.stability) {
            (Certificate::None, _) => None,
            (Certificate::InternalForce { forces_O, torsions }, Stability::Stable) => {
                force_fault(&grasp, &touches, forces_O, torsions)
            }
            (Certificate::SeparatingTwist { v_O, w_O }, Stability::Unstable) => {
                twist_fault(&grasp, &touches, v_O, w_O)
            }
            _ => Some("it proves another verdict".into()),
        };
        if let Some(fault) = fault {
            return broken(format!("{fault}: {found:?} for {touches:?}"));
        }
    }
    grained_certificate(subject)
}

/// The same where contacts have a grain, by the arithmetic of an audit.
fn grained_certificate(subject: &Subject<'_>) -> Finding {
    let (test, mut random) = (build(subject)?, random(33));
    for i in 0..100 {
        let grasp = grasps::grained(&grasps::random(&mut random, 3 + i % 3), &random.direction());
        if verdict(&*test, &grasp)?.is_none() {
            continue;
        }
        let found = test.assess(&grasp, None, None, &mut context(0))?;
        let object = &Bench::free_sphere().world.object;
        let kept = laws::certificate_kept(&grasp, object, test.criterion(), &found);
        kept.map_err(|fault| Fault::Broken(format!("with a grain: {}", fault.what)))?;
    }
    Ok(())
}

/// Forces that hold: one for each contact, strictly inside the cone, balanced to far less than the room that
/// is left there.
fn force_fault(grasp: &Grasp<'_>, touches: &[Touch], forces: &[Vec3], torsions: &[f64]) -> Option<String> {
    if forces.len() != touches.len() || torsions.len() != touches.len() {
        return Some("not one force for each contact".into());
    }
    let (center, length) = center_and_length(grasp);
    let (mut force, mut torque, mut room) = (Vec3::zeros(), Vec3::zeros(), f64::INFINITY);
    for (touch, (f, &m)) in touches.iter().zip(forces.iter().zip(torsions)) {
        let inward = -touch.n;
        let f_n = f.dot(&inward);
        let spin = if touch.gamma > 0.0 { m / touch.gamma } else { m / 1e-12 };
        let tangential = (f - inward * f_n).norm() / touch.mu.max(1e-12);
        room = room.min(f_n - tangential.hypot(spin));
        force += f;
        torque += ((touch.p - center).cross(f) + inward * m) / length;
    }
    let residual = force.norm().hypot(torque.norm());
    if room > 0.0 && residual < 1e-3 * room {
        None
    } else {
        Some(format!("room {room:e} inside the cones, residual {residual:e}"))
    }
}

/// A twist that no contact resists: no wrench of any cone has power against it.
fn twist_fault(grasp: &Grasp<'_>, touches: &[Touch], v_O: &Vec3, w_O: &Vec3) -> Option<String> {
    let (center, length) = center_and_length(grasp);
    let size = v_O.norm().hypot(w_O.norm() * length);
    let resists = |touch: &Touch| {
        let v = v_O + w_O.cross(&(touch.p - center));
        let n = -touch.n;
        let tangential = touch.mu * (v - n * n.dot(&v)).norm();
        // The largest power of a wrench of the cone against the twist.
        -n.dot(&v) + tangential.hypot(touch.gamma * w_O.dot(&n))
    };
    let worst = touches.iter().map(resists).fold(f64::NEG_INFINITY, f64::max);
    (size.is_nan() || size <= 0.0 || worst > 1e-9 * size)
        .then(|| format!("a contact resists the twist by {worst:e} of {size:e}"))
}
