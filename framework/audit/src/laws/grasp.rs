//! Laws of verdicts on grasps.

use super::cone::support;
use super::{Kept, broken, ensure};
use regrasp_api::{
    Assessment, Certificate, Criterion, Grasp, GraspContact, ObjectModel, Stability, Vec3, tangents,
};

/// Law `margins`: a lower bound at most the upper one, and not positive where the grasp is not stable.
pub fn assessment_kept(found: &Assessment) -> Kept {
    let (lower, upper) = (found.margin_lower, found.margin_upper);
    let text = || format!("{:?} with a margin of {lower:.3e} to {upper:.3e}", found.stability);
    ensure("margins", !lower.is_nan() && lower <= upper + 1e-9 * upper.abs() + 1e-12, text)?;
    ensure("margins", found.stability.is_stable() || lower <= 0.0, text)
}

/// Law `certificate`: the proof proves its verdict, by arithmetic.
pub fn certificate_kept(
    grasp: &Grasp<'_>,
    object: &ObjectModel,
    criterion: Criterion,
    found: &Assessment,
) -> Kept {
    match (&found.certificate, found.stability) {
        (Certificate::None, _) => Ok(()),
        (Certificate::InternalForce { forces_O, torsions }, Stability::Stable) => {
            // With a load the forces carry the weight; without they balance each other.
            let weight = match criterion {
                Criterion::Closure => None,
                _ => Some((object.p_OCm, grasp.g_O * object.mass)),
            };
            forces_balance(grasp, forces_O, torsions, weight)
        }
        (Certificate::SeparatingTwist { v_O, w_O }, Stability::Unstable) => twist_separates(grasp, v_O, w_O),
        _ => broken("certificate", format!("{:?} does not go with its certificate", found.stability)),
    }
}

fn center_and_length(grasp: &Grasp<'_>) -> (Vec3, f64) {
    let contacts = grasp.contacts();
    let center = contacts.iter().map(|contact| contact.p_OC).sum::<Vec3>() / contacts.len().max(1) as f64;
    let length = contacts.iter().map(|contact| (contact.p_OC - center).norm()).fold(0.0, f64::max);
    (center, if length > 0.0 { length } else { 1.0 })
}

fn forces_balance(
    grasp: &Grasp<'_>,
    forces: &[Vec3],
    torsions: &[f64],
    weight: Option<(Vec3, Vec3)>,
) -> Kept {
    const LAW: &str = "certificate";
    let contacts = grasp.contacts();
    ensure(LAW, forces.len() == contacts.len() && torsions.len() == contacts.len(), || {
        format!("{} forces for {} contacts", forces.len(), contacts.len())
    })?;
    let (center, length) = center_and_length(grasp);
    let (place, load) = weight.unwrap_or((center, Vec3::zeros()));
    let (mut force, mut torque, mut scale) = (load, (place - center).cross(&load) / length, load.norm());
    for ((contact, f), &m) in contacts.iter().zip(forces).zip(torsions) {
        let normal = -contact.n_O.dot(f);
        ensure(LAW, normal > 0.0 && inside(contact, f, m), || {
            format!("the force of `finger[{}]` lies outside its cone", contact.finger.0)
        })?;
        force += f;
        torque += ((contact.p_OC - center).cross(f) - contact.n_O * m) / length;
        scale += f.norm();
    }
    let residual = force.norm().hypot(torque.norm());
    ensure(LAW, residual <= 1e-6 * scale, || format!("the forces leave {residual:.2e} N of {scale:.2e} N"))
}

/// Whether a force on the object, with a torque about the inward normal, lies in the contact's cone.
fn inside(contact: &GraspContact<'_>, f: &Vec3, m: f64) -> bool {
    let inward = -contact.n_O;
    let normal = f.dot(&inward);
    let [t1, t2] = tangents(&inward);
    let at = Vec3::new(f.dot(&t1), f.dot(&t2), m) / normal;
    // A convex set holds a point where no direction tells them apart; the directions are those of the point
    // and of the kit.
    super::cone::directions()
        .chain([at])
        .all(|w| at.dot(&w) <= support(&contact.cone, &contact.n_O, &w) + 1e-7 * w.norm())
}

/// No wrench of any cone has power against the twist.
fn twist_separates(grasp: &Grasp<'_>, v_O: &Vec3, w_O: &Vec3) -> Kept {
    let (center, length) = center_and_length(grasp);
    let size = v_O.norm().hypot(w_O.norm() * length);
    let resists = |contact: &GraspContact<'_>| {
        let v = v_O + w_O.cross(&(contact.p_OC - center));
        let inward = -contact.n_O;
        let [t1, t2] = tangents(&inward);
        // The largest power of a wrench of the cone against the twist.
        -inward.dot(&v)
            + support(&contact.cone, &contact.n_O, &-Vec3::new(v.dot(&t1), v.dot(&t2), w_O.dot(&inward)))
    };
    let worst = grasp.contacts().iter().map(resists).fold(f64::NEG_INFINITY, f64::max);
    ensure("certificate", size > 0.0 && worst <= 1e-9 * size, || {
        format!("a contact resists the separating twist by {worst:.2e} of {size:.2e}")
    })
}
