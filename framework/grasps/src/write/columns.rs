//! The columns of a set of grasps: name, type, shape of one grasp's part, and its numbers.

use crate::Layout;
use crate::grasp::BulkGrasp;
use regrasp_api::{FingerIndex, PerFinger, Vec3};

/// One array.
pub(super) struct Column {
    pub name: &'static str,
    /// NumPy's word for the type.
    pub kind: &'static str,
    /// The shape of one grasp's part.
    pub shape: Vec<usize>,
    /// Appends the bytes of one grasp's part.
    pub put: fn(&BulkGrasp, &mut Vec<u8>),
}

/// All columns of a set; F fingers, J joints.
pub(super) fn columns(layout: &Layout) -> Vec<Column> {
    let (f, j) = (layout.fingers(), layout.joints());
    let column = |name, kind, shape: &[usize], put| Column { name, kind, shape: shape.to_vec(), put };
    vec![
        column("pose", "<i8", &[], |g, out| out.extend((g.pose as i64).to_le_bytes())),
        column("object_position", "<f8", &[3], |g, out| floats(g.q.X_HO.translation.vector.iter(), out)),
        column("object_orientation", "<f8", &[4], |g, out| floats(&quaternion(g), out)),
        column("joints", "<f8", &[j], |g, out| g.q.joints.iter().for_each(|(_, q)| floats(q.iter(), out))),
        column("holding", "|b1", &[f], |g, out| bits(g, |f| g.q.contacts[f].is_some(), out)),
        column("liftable", "|b1", &[f], |g, out| bits(g, |f| g.liftable.contains(f), out)),
        column("facet", "<i8", &[f], |g, out| {
            let facet = |f| g.q.contacts[f].map_or(-1, |contact| i64::from(contact.facet));
            g.q.joints.fingers().for_each(|f| out.extend(facet(f).to_le_bytes()));
        }),
        column("contact_point_O", "<f8", &[f, 3], |g, out| vectors(g, |f| Some(g.q.contacts[f]?.p_OC), out)),
        column("contact_normal_O", "<f8", &[f, 3], |g, out| vectors(g, |f| Some(g.q.contacts[f]?.n_O), out)),
        column("force_O", "<f8", &[f, 3], |g, out| vectors(g, |f| g.held.as_ref()?.forces_O[f], out)),
        column("efforts", "<f8", &[j], |g, out| match &g.held {
            Some(held) => held.efforts.iter().for_each(|(_, efforts)| floats(efforts.iter(), out)),
            None => g.q.joints.iter().for_each(|(_, q)| floats(&vec![f64::NAN; q.len()], out)),
        }),
        column("margin", "<f8", &[], |g, out| floats([&g.margin], out)),
        column("clearance", "<f8", &[], |g, out| floats([&g.clearance], out)),
        column("friction", "<f8", &[], |g, out| floats([&held(g, |h| h.friction)], out)),
        column("effort_share", "<f8", &[], |g, out| floats([&held(g, |h| h.effort_share)], out)),
    ]
}

/// The object's orientation: w, x, y, z.
pub(super) fn quaternion(grasp: &BulkGrasp) -> [f64; 4] {
    let turn = grasp.q.X_HO.rotation.quaternion();
    [turn.w, turn.i, turn.j, turn.k]
}

fn held(grasp: &BulkGrasp, figure: fn(&crate::HeldBy) -> f64) -> f64 {
    grasp.held.as_ref().map_or(f64::NAN, figure)
}

fn floats<'x>(numbers: impl IntoIterator<Item = &'x f64>, out: &mut Vec<u8>) {
    numbers.into_iter().for_each(|x| out.extend(x.to_le_bytes()));
}

fn bits(grasp: &BulkGrasp, is: impl Fn(FingerIndex) -> bool, out: &mut Vec<u8>) {
    out.extend(grasp.q.joints.fingers().map(|finger| u8::from(is(finger))));
}

fn vectors(grasp: &BulkGrasp, pick: impl Fn(FingerIndex) -> Option<Vec3>, out: &mut Vec<u8>) {
    let all: PerFinger<Option<Vec3>> = PerFinger::from_fn(grasp.q.joints.len(), pick);
    let none = Vec3::repeat(f64::NAN);
    all.iter().for_each(|(_, vector)| floats(vector.unwrap_or(none).iter(), out));
}
