//! One JSON object a line.

use super::Set;
use super::columns::quaternion;
use crate::grasp::BulkGrasp;
use regrasp_api::{FingerIndex, Vec3};
use serde_json::{Value, json};
use std::io::{self, Write};

/// Writes one line for each grasp: `grasp` (its number), `pose`, `object` (`position`, `orientation` w, x, y,
/// z), `joints` and `efforts` (a list for each finger), `contacts` (for each finger null or `point_O`,
/// `normal_O`, `facet`, `force_O`, `liftable`), `margin`, `clearance`, `friction`, `effort_share`; SI units,
/// null for what does not exist.
pub fn lines(set: &Set<'_>, out: &mut dyn Write) -> io::Result<()> {
    let mut number = 0_u64;
    set.rows.each(&mut |grasp| {
        writeln!(out, "{{\"grasp\":{number},{}", &line(grasp).to_string()[1..])?;
        number += 1;
        Ok(())
    })
}

fn line(grasp: &BulkGrasp) -> Value {
    let vector = |v: Vec3| <[f64; 3]>::from(v);
    let held = grasp.held.as_ref();
    let contact = |finger: FingerIndex| {
        grasp.q.contacts[finger].map(|contact| {
            json!({
                "point_O": vector(contact.p_OC),
                "normal_O": vector(contact.n_O),
                "facet": contact.facet,
                "force_O": held.and_then(|held| held.forces_O[finger]).map(vector),
                "liftable": grasp.liftable.contains(finger),
            })
        })
    };
    json!({
        "pose": grasp.pose,
        "object": {
            "position": vector(grasp.q.X_HO.translation.vector),
            "orientation": quaternion(grasp),
        },
        "joints": grasp.q.joints.iter().map(|(_, joints)| joints.to_vec()).collect::<Vec<_>>(),
        "efforts": held.map(|h| h.efforts.iter().map(|(_, e)| e.to_vec()).collect::<Vec<_>>()),
        "contacts": grasp.q.joints.fingers().map(contact).collect::<Vec<_>>(),
        "margin": finite(grasp.margin),
        "clearance": finite(grasp.clearance),
        "friction": held.and_then(|held| finite(held.friction)),
        "effort_share": held.map(|held| held.effort_share),
    })
}

fn finite(number: f64) -> Option<f64> {
    Some(number).filter(|number| number.is_finite())
}
