//! The motion of one joint as a screw in the hand's frame.
//!
//! R. Murray, Z. Li, S. Sastry, "A mathematical introduction to robotic manipulation", CRC Press 1994,
//! section 3.2: a revolute joint turns about a line, a prismatic one slides along it, and a chain's pose is
//! the product of these motions.

use regrasp_api::{JointKind, Vec3};

/// A joint's axis, given in some fixed frame, and the rigid motion that the joint makes about or along it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Screw {
    pub kind: JointKind,
    /// Unit direction.
    pub axis: Vec3,
    /// A point on the axis (m); of no meaning for a prismatic joint.
    pub point: Vec3,
}

impl Screw {
    pub fn new(kind: JointKind, axis: Vec3, point: Vec3) -> Self {
        Self { kind, axis, point }
    }

    /// Where the joint's motion by `q` (rad; m) takes the point `p` (m).
    #[inline]
    pub fn move_point(&self, p: &Vec3, q: f64) -> Vec3 {
        match self.kind {
            JointKind::Revolute => {
                let (sin, cos) = q.sin_cos();
                self.point + turn(&self.axis, &(p - self.point), sin, cos)
            }
            JointKind::Prismatic => p + self.axis * q,
        }
    }

    /// Where the joint's motion by `q` (rad; m) takes some points (m).
    pub fn move_points<const N: usize>(&self, points: [&Vec3; N], q: f64) -> [Vec3; N] {
        match self.kind {
            JointKind::Revolute => {
                let (sin, cos) = q.sin_cos();
                points.map(|p| self.point + turn(&self.axis, &(p - self.point), sin, cos))
            }
            JointKind::Prismatic => points.map(|p| p + self.axis * q),
        }
    }

    /// Where the joint's motion by `q` (rad; m) takes the free vector `v`.
    #[inline]
    pub fn move_vector(&self, v: &Vec3, q: f64) -> Vec3 {
        match self.kind {
            JointKind::Revolute => {
                let (sin, cos) = q.sin_cos();
                turn(&self.axis, v, sin, cos)
            }
            JointKind::Prismatic => *v,
        }
    }

    /// The point of the axis closest to `p` (m).
    pub fn foot(&self, p: &Vec3) -> Vec3 {
        self.point + self.axis * self.axis.dot(&(p - self.point))
    }

    /// The screw after the motion of another joint that lies before it in the chain.
    pub fn moved_by(&self, before: &Self, q: f64) -> Self {
        Self {
            kind: self.kind,
            axis: before.move_vector(&self.axis, q),
            point: before.move_point(&self.point, q),
        }
    }

    /// Velocity of the point `p` (m), which moves with the joint, per joint speed.
    #[inline]
    pub fn velocity(&self, p: &Vec3) -> Vec3 {
        match self.kind {
            JointKind::Revolute => self.axis.cross(&(p - self.point)),
            JointKind::Prismatic => self.axis,
        }
    }
}

/// The vector `v` turned about the unit vector `axis` by the angle with the given sine and cosine
/// (Rodrigues).
#[inline]
pub(super) fn turn(axis: &Vec3, v: &Vec3, sin: f64, cos: f64) -> Vec3 {
    v * cos + axis.cross(v) * sin + axis * (axis.dot(v) * (1.0 - cos))
}
