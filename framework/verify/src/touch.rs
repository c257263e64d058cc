//! A fingertip against a surface.

use crate::scene::Scene;
use crate::solid::Solid;
use regrasp_api::Vec3;

/// A fingertip against the object's surface.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Touch {
    /// The surface's point closest to the fingertip's centre, in O (m).
    pub(crate) p_OC: Vec3,
    /// The unit vector from there to the fingertip's centre, outward, in O.
    pub(crate) n_O: Vec3,
    /// The distance of ball and surface (m), negative where they overlap.
    pub(crate) gap: f64,
    /// The facet of the closest point: where to look first next time.
    pub(crate) facet: u32,
}

impl Touch {
    /// Where the ball of `radius` about `p_OTip` comes closest to what contacts live on.
    pub(crate) fn find(scene: &Scene, p_OTip: &Vec3, radius: f64, near: u32) -> Self {
        Self::on(&scene.touched, p_OTip, radius, near)
    }

    /// Where it comes closest to the object's own surface.
    pub(crate) fn of_object(scene: &Scene, p_OTip: &Vec3, radius: f64, near: u32) -> Self {
        Self::on(&scene.object, p_OTip, radius, near)
    }

    /// Where it comes closest to a solid.
    pub(crate) fn on(solid: &Solid, p_OTip: &Vec3, radius: f64, near: u32) -> Self {
        let closest = solid.closest(p_OTip, near);
        let away = p_OTip - closest.point;
        let (side, distance) = (if closest.inside { -1.0 } else { 1.0 }, away.norm());
        // At no distance there is no direction; the gap is then minus the whole radius, which no tolerance
        // allows.
        let n_O = away.try_normalize(1e-12).map_or(Vec3::z(), |n| n * side);
        Self { p_OC: closest.point, n_O, gap: side * distance - radius, facet: closest.facet }
    }
}
