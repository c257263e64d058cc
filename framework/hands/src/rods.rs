//! Capsules that were written as a cylinder with a ball at each end, as formats without capsules must.

use nalgebra::Point3;
use regrasp_api::Vec3;
use regrasp_formats::{Geometry, Solid};
use std::borrow::Cow;

/// How far (m) ball and cylinder may be off.
const CLOSE: f64 = 1e-6;

/// The shapes, each cylinder with its two balls as one capsule: quicker to keep clear of than a prism, and
/// rounder.
pub(crate) fn joined(solids: &[Solid]) -> Vec<Cow<'_, Solid>> {
    let mut taken = vec![false; solids.len()];
    let mut capsules = Vec::new();
    for (i, solid) in solids.iter().enumerate() {
        let Geometry::Cylinder { radius, length } = solid.geometry else { continue };
        let end = |sign: f64| (solid.X_LS * Point3::from(Vec3::z() * (sign * length / 2.0))).coords;
        let ball =
            |place: Vec3| (0..solids.len()).find(|&k| !taken[k] && is_ball(&solids[k], radius, &place));
        if let (Some(one), Some(other)) = (ball(end(-1.0)), ball(end(1.0)))
            && one != other
        {
            [i, one, other].into_iter().for_each(|k| taken[k] = true);
            capsules.push((i, Solid { geometry: Geometry::Capsule { radius, length }, ..solid.clone() }));
        }
    }
    let mut capsules = capsules.into_iter().peekable();
    let mut all = Vec::new();
    for (i, solid) in solids.iter().enumerate() {
        match capsules.next_if(|(at, _)| *at == i) {
            Some((_, capsule)) => all.push(Cow::Owned(capsule)),
            None if !taken[i] => all.push(Cow::Borrowed(solid)),
            None => {}
        }
    }
    all
}

fn is_ball(solid: &Solid, wanted: f64, place: &Vec3) -> bool {
    let same = |radius: f64| (radius - wanted).abs() < CLOSE;
    matches!(solid.geometry, Geometry::Sphere { radius } if same(radius))
        && (solid.X_LS.translation.vector - place).norm() < CLOSE
}
