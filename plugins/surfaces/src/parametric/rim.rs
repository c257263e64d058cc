//! The polygon that stands for a cylinder's circle.

use regrasp_api::{Mesh, Vec3};

/// The section of a cylinder's mesh: the rim's corners by angle about z.
#[derive(Clone, Debug)]
pub(super) struct Rim {
    /// Angle (rad) and position over the radius of each corner.
    corners: Vec<(f64, [f64; 2])>,
}

impl Rim {
    /// Reads the polygon from the vertices of the upper rim; `None` where they are no polygon about the axis
    /// or other vertices at the side lie between them.
    pub fn new(radius: f64, half_height: f64, slack: f64, mesh: &Mesh) -> Option<Self> {
        let on_side = |v: &&Vec3| (v.xy().norm() - radius).abs() <= slack;
        let on_top = |v: &&Vec3| (v.z - half_height).abs() <= slack;
        let corner = |v: &Vec3| (v.y.atan2(v.x), [v.x / radius, v.y / radius]);
        let sides: Vec<&Vec3> = mesh.vertices().iter().filter(on_side).collect();
        let mut corners: Vec<_> = sides.iter().copied().filter(on_top).map(corner).collect();
        corners.sort_by(|a, b| a.0.total_cmp(&b.0));
        let rim = Self { corners };
        let fits =
            rim.corners.len() >= 3 && sides.iter().all(|v| (rim.share(v) - 1.0).abs() * radius <= slack);
        fits.then_some(rim)
    }

    /// The polygon's distance from the axis over the circle's, in the direction of a point.
    fn share(&self, p: &Vec3) -> f64 {
        let length = p.xy().norm();
        if length == 0.0 {
            return 1.0;
        }
        let d = [p.x / length, p.y / length];
        let next = self.corners.partition_point(|corner| corner.0 <= p.y.atan2(p.x)) % self.corners.len();
        let before = (next + self.corners.len() - 1) % self.corners.len();
        let (a, b) = (self.corners[before].1, self.corners[next].1);
        let side = [b[0] - a[0], b[1] - a[1]];
        (a[0] * side[1] - a[1] * side[0]) / (d[0] * side[1] - d[1] * side[0])
    }

    /// A point moved from or towards the axis by a factor made of the polygon's share.
    pub fn scaled(&self, p: &Vec3, factor: impl Fn(f64) -> f64) -> Vec3 {
        let factor = factor(self.share(p));
        Vec3::new(p.x * factor, p.y * factor, p.z)
    }
}
