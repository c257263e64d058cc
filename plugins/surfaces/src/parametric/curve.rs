//! What a closed form answers, and the curves that it answers with.

use regrasp_api::Vec3;

/// A curve on a closed form, as points in order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Curve {
    /// Length (m) on the closed form.
    pub length: f64,
    /// Points of the curve (m, in O), both ends included, neighbours no farther apart than was asked for;
    /// creases are among them.
    pub points: Vec<Vec3>,
}

impl Curve {
    /// Begins afresh at a point.
    pub(super) fn restart(&mut self, from: &Vec3) {
        self.length = 0.0;
        self.points.clear();
        self.points.push(*from);
    }

    /// Appends `count` equal parts of an arc of the given length (m); `at` gives the points for fractions in
    /// 0..1.
    pub(super) fn arc(&mut self, length: f64, spacing: f64, to: &Vec3, at: impl Fn(f64) -> Vec3) {
        let count = (length / spacing).ceil().max(1.0);
        self.points.extend((1..count as usize).map(|i| at(i as f64 / count)));
        self.points.push(*to);
        self.length += length;
    }

    /// Appends a straight line.
    pub(super) fn line(&mut self, spacing: f64, to: &Vec3) {
        let from = self.points[self.points.len() - 1];
        self.arc((to - from).norm(), spacing, to, |t| from.lerp(to, t));
    }
}

/// A surface in closed form; its points are given and returned in O (m).
pub(super) trait Form: Send + Sync + std::fmt::Debug {
    /// The point of the surface that stands for one near it.
    fn outward(&self, p: &Vec3) -> Vec3;

    /// Where the ray through a point of the surface begins that leads from facets to the surface and back.
    fn core(&self, p: &Vec3) -> Vec3;

    /// The outward unit normal at a point of the surface; on an edge that of one of its faces.
    fn normal(&self, p: &Vec3) -> Vec3;

    /// The shortest path between two points of the surface.
    fn shortest(&self, a: &Vec3, b: &Vec3, spacing: f64, curve: &mut Curve);

    /// The straightest path from a point of the surface along a tangent direction (not zero), of the given
    /// length (m).
    fn walk(&self, from: &Vec3, along: &Vec3, distance: f64, spacing: f64, curve: &mut Curve);
}
