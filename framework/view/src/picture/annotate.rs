//! What is drawn over a picture: traces, outlines, marks and words. They lie on top of hand and object; what
//! the object hides is dotted.

use super::Picture;
use super::view::{Point, faces_the_eye, hull, see};
use regrasp_api::Vec3;

/// Radius of a mark (mm on the paper).
const MARK: f64 = 1.3;

impl Picture {
    /// A line through points of the hand's frame (m), each with the outward normal of the surface that it
    /// lies on; where that normal looks away from the eye the line is dotted.
    pub fn trace(&mut self, class: &str, points: &[(Vec3, Vec3)]) {
        let seen: Vec<(Point, bool)> = points.iter().map(|(p, n)| (see(p), faces_the_eye(n))).collect();
        let mut from = 0;
        while from + 1 < seen.len() {
            let front = seen[from].1;
            let count = seen[from..].iter().take_while(|(_, faces)| *faces == front).count();
            // The first point beyond belongs to both parts, so that they meet.
            let end = (from + count).min(seen.len() - 1);
            let path: String =
                seen[from..=end].iter().map(|(at, _)| format!("{:.1},{:.1} ", at.x, at.y)).collect();
            let dotted = if front { "" } else { " rg-behind" };
            let element = format!("<polyline class=\"{class}{dotted}\" points=\"{}\"/>", path.trim_end());
            let part: Vec<Point> = seen[from..=end].iter().map(|(at, _)| *at).collect();
            self.add(f64::INFINITY, &part, 0.0, element);
            from = end;
        }
    }

    /// The outline of points of the hand's frame (m): the convex hull of what is seen of them.
    pub fn outline(&mut self, class: &str, points: &[Vec3]) {
        let around = hull(points.iter().map(see).collect());
        let path: String = around.iter().map(|corner| format!("{:.1},{:.1} ", corner.x, corner.y)).collect();
        let element = format!("<polygon class=\"{class}\" points=\"{}\"/>", path.trim_end());
        self.add(f64::INFINITY, &around, 0.0, element);
    }

    /// A small disc at a point of the hand's frame (m).
    pub fn mark(&mut self, class: &str, p_H: &Vec3) {
        let at = see(p_H);
        let element =
            format!("<circle class=\"{class}\" cx=\"{:.1}\" cy=\"{:.1}\" r=\"{MARK}\"/>", at.x, at.y);
        self.add(f64::INFINITY, &[at], MARK, element);
    }
}
