//! A link that is a box, or held by one, against the object: bounds that decide nearly always, where the
//! exact distance of box and mesh costs some 50 µs.

use super::body::Placed;
use super::convex::Verdict;
use super::exact::Solid;
use super::object::ObjectBody;
use super::rod::Rod;
use crate::hand::LinkFrame;
use regrasp_api::{Pose, Vec3};

/// Whether a solid at `X_HS` is farther from the object at `X_HO` than `clear` (m).
///
/// Free where a plane lies between the two: square to the line from the object's middle to the nearest point
/// of the box, or parallel to a side of the box or of the object's frame. Close where the nearest point
/// itself is.
pub(super) fn verdict(
    placed: &Placed,
    X_HS: &Pose,
    object: &ObjectBody,
    X_HO: &LinkFrame,
    clear: f64,
) -> Verdict {
    let (center, half, is_box) = match &placed.solid {
        Solid::Cuboid { half_size } => (Vec3::zeros(), *half_size, true),
        Solid::Mesh(mesh) => (mesh.bounds.center(), mesh.bounds.half_size(), false),
        Solid::Rod(_) | Solid::HalfSpace { .. } => return Verdict::Unknown,
    };
    let X_HS = LinkFrame::from(X_HS);
    let R_OS = X_HO.R_HL.tr_mul(&X_HS.R_HL);
    // B is S with its origin in the middle of the box.
    let p_OB = X_HO.R_HL.tr_mul(&(X_HS.point(&center) - X_HO.p_HL));
    let p_BMiddle = R_OS.tr_mul(&(object.p_OMiddle - p_OB));
    let near = p_BMiddle.sup(&-half).inf(&half);
    let separates = |n_O: Vec3| {
        let lowest = n_O.dot(&p_OB) - half.dot(&R_OS.tr_mul(&n_O).abs());
        lowest - object.height(&n_O) > clear
    };
    let toward = (near - p_BMiddle).try_normalize(0.0);
    if toward.is_some_and(|n_B| separates(R_OS * n_B)) {
        return Verdict::Free;
    }
    let nearest = Rod::ball(p_OB + R_OS * near, 0.0);
    if is_box && !object.clear_of_rod(&nearest, clear) {
        return Verdict::Close;
    }
    let of_box = (0..3).map(|k| R_OS.column(k) * -p_BMiddle[k].signum());
    let of_object = (0..3).map(|k| Vec3::ith(k, (p_OB - object.p_OMiddle)[k].signum()));
    if of_box.chain(of_object).any(separates) { Verdict::Free } else { Verdict::Unknown }
}
