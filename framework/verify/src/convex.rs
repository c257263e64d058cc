//! Convex solids of which parry knows the exact distance, beside cuboids.

use crate::border::{parry_pose, vector};
use nalgebra::Point3;
use parry3d_f64::shape::{Cylinder, Shape as ParryShape, SupportMap};
use regrasp_api::{Pose, Rotation, Vec3};
use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;

/// A convex solid about the origin of its own frame.
#[derive(Clone)]
pub(crate) struct Convex {
    /// Its frame in that of what it belongs to.
    pub(crate) X: Pose,
    shape: Arc<dyn Round>,
    /// The radius of a ball about the origin that holds it (m).
    reach: f64,
}

trait Round: ParryShape + SupportMap {}
impl<S: ParryShape + SupportMap> Round for S {}

impl std::fmt::Debug for Convex {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{:?} within {} m", self.shape.shape_type(), self.reach)
    }
}

impl Convex {
    /// A cylinder along z of the frame at `X`; parry's lie along y.
    pub(crate) fn cylinder(X: &Pose, radius: f64, height: f64) -> Self {
        let half = height / 2.0;
        let y_to_z = Rotation::from_axis_angle(&Vec3::x_axis(), FRAC_PI_2);
        let shape = Arc::new(Cylinder::new(half, radius));
        Self { X: X * y_to_z, shape, reach: radius.hypot(half) }
    }

    pub(crate) fn shape(&self) -> &dyn ParryShape {
        &*self.shape
    }

    /// A point in the solid's frame.
    pub(crate) fn local(&self, p: &Vec3) -> Vec3 {
        self.X.inverse_transform_point(&Point3::from(*p)).coords
    }

    /// Centre and radius of a ball that holds the solid.
    pub(crate) fn ball(&self) -> (Vec3, f64) {
        (self.X.translation.vector, self.reach)
    }

    /// The distance of a point (m); negative inside.
    pub(crate) fn distance(&self, p: &Vec3) -> f64 {
        self.shape.distance_to_local_point(vector(&self.local(p)), false)
    }

    /// Whether a point lies in the solid, whose frame is at `X`.
    pub(crate) fn holds(&self, X: &Pose, p: &Vec3) -> bool {
        let p = X.inverse_transform_point(&Point3::from(*p)).coords;
        self.shape.contains_local_point(vector(&p))
    }

    /// The least n · x over the solid, what it belongs to being at `X_AB`; n is given in A.
    pub(crate) fn lowest(&self, X_AB: &Pose, n: &Vec3) -> f64 {
        let X = X_AB * self.X;
        let down = parry_pose(&X).rotation.inverse() * vector(&-n);
        let p = self.shape.local_support_point(down);
        n.dot(&(X * Point3::new(p.x, p.y, p.z)).coords)
    }
}
