//! Object, hand and obstacles as strokes.

use super::outline::outline;
use super::view::{Point, area, hull, see};
use super::{Picture, Scene};
use regrasp_api::{Configuration, Mesh, Pose, Shape, Vec3};
use regrasp_world::{ChainHand, LinkFrame, shape_mesh};

/// How many degrees of brightness a surface has.
const SHADES: usize = 4;

/// Of more facets than this, those of one slice in depth are taken not to hide each other ...
const MANY: usize = 200;
/// ... which is so thick, in radii of the object (three corners' depths are added).
const SLICE: f64 = 0.8;

/// From where the light falls.
const LIGHT: Vec3 = Vec3::new(-0.35, -0.55, 0.76);

fn moved(X: &Pose, p: &Vec3) -> Vec3 {
    X.rotation * p + X.translation.vector
}

impl Picture {
    /// The facets that face the eye, shaded; those about two of the object's own planes are painted as a
    /// cross.
    pub(super) fn draw_object(&mut self, mesh: &Mesh, X_HO: &Pose) {
        let seen: Vec<Point> = mesh.vertices().iter().map(|p| see(&moved(X_HO, p))).collect();
        let depth = see(&X_HO.translation.vector).depth;
        let mut facets: Vec<(String, f64, [u32; 3])> = Vec::new();
        for (k, corners) in mesh.facets().iter().enumerate() {
            let points = corners.map(|corner| seen[corner as usize]);
            if area(&points[0], &points[1], &points[2]) > 0.0 {
                let middle = points.iter().map(|point| point.depth).sum::<f64>();
                facets.push((class(mesh, k as u32, X_HO), middle, *corners));
            }
        }
        // Facets of a convex object do not hide each other, so that those of one colour can share an element;
        // others are drawn by depth.
        match mesh.is_locally_convex() {
            true => facets.sort_by(|a, b| a.0.cmp(&b.0)),
            false => {
                let slice = if facets.len() > MANY { SLICE * 1e3 * mesh.radius() } else { 0.0 };
                let depth = |depth: f64| if slice > 0.0 { (depth / slice).floor() } else { depth };
                facets.sort_by(|a, b| depth(a.1).total_cmp(&depth(b.1)).then_with(|| a.0.cmp(&b.0)));
            }
        }
        for (k, group) in facets.chunk_by(|a, b| a.0 == b.0).enumerate() {
            let path = outline(group.iter().map(|facet| facet.2), &seen);
            let corners = group.iter().flat_map(|facet| facet.2);
            let points: Vec<Point> = corners.map(|corner| seen[corner as usize]).collect();
            let element = format!("<path class=\"{}\" d=\"{path}\"/>", group[0].0);
            // Groups keep their order at what is one depth for everything else.
            self.add(depth + 1e-6 * k as f64, &points, 0.0, element);
        }
    }

    /// Links as lines from joint to joint, tips as discs.
    pub(super) fn draw_fingers(&mut self, hand: &ChainHand, q: &Configuration) {
        use regrasp_api::Hand;
        let radius = 1e3 * hand.fingertip_radius();
        for (finger, joints) in q.joints.iter() {
            let mut room = LinkFrame::room();
            let frames = hand.link_frames(finger, joints, &mut room);
            let tip = hand.tip_center(finger, joints);
            let joints: Vec<Point> =
                frames.iter().map(|frame| frame.p_HL).chain([tip]).map(|p| see(&p)).collect();
            for ends in joints.windows(2) {
                self.draw_line("rg-link", ends, 0.8 * radius);
            }
            let class = if q.contacts[finger].is_some() { "rg-tip" } else { "rg-free" };
            // A tip is seen in front of its own link, which ends in it.
            let link = self.strokes.last().map_or(f64::NEG_INFINITY, |link| link.0);
            self.draw_disc(class, &see(&tip), radius, link + 1e-3);
        }
    }

    /// Palm and obstacles.
    pub(super) fn draw_obstacles(&mut self, scene: &Scene<'_>) {
        for part in scene.hand.palm_shapes() {
            self.draw_shape("rg-palm", &part.shape, part.pose.pose().unwrap_or_default());
        }
        for obstacle in scene.obstacles {
            self.draw_shape("rg-obstacle", &obstacle.shape, obstacle.pose.pose().unwrap_or_default());
        }
    }

    fn draw_shape(&mut self, class: &str, shape: &Shape, X: Pose) {
        let at = |p: &[f64; 3]| see(&moved(&X, &Vec3::from(*p)));
        match shape {
            Shape::Sphere { radius } => {
                self.draw_disc(class, &at(&[0.0; 3]), 1e3 * radius, f64::NEG_INFINITY);
            }
            Shape::Capsule { from, to, radius } => {
                self.draw_line(&format!("{class} rg-line"), &[at(from), at(to)], 1e3 * radius);
            }
            Shape::HalfSpace { .. } => {}
            // What has no facets is not drawn: pictures judge nothing.
            other => {
                let corners = shape_mesh(other, "shape").map(|mesh| mesh.vertices().to_vec());
                let seen = corners.unwrap_or_default().into_iter().map(|p| at(&p.into())).collect();
                self.draw_outline(class, seen);
            }
        }
    }

    fn draw_line(&mut self, class: &str, ends: &[Point], radius: f64) {
        let depth = ends.iter().map(|end| end.depth).sum::<f64>() / ends.len() as f64;
        let path: String = ends.iter().map(|end| format!("{:.1},{:.1} ", end.x, end.y)).collect();
        let width = 2.0 * radius;
        let element = format!(
            "<polyline class=\"{class}\" points=\"{}\" stroke-width=\"{width:.1}\"/>",
            path.trim_end()
        );
        self.add(depth, ends, radius, element);
    }

    /// A disc at its own depth or nearer.
    fn draw_disc(&mut self, class: &str, center: &Point, radius: f64, nearest: f64) {
        let Point { x, y, depth } = center;
        let element = format!("<circle class=\"{class}\" cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{radius:.1}\"/>");
        self.add(depth.max(nearest), &[*center], radius, element);
    }

    fn draw_outline(&mut self, class: &str, corners: Vec<Point>) {
        let depth = corners.iter().map(|corner| corner.depth).sum::<f64>() / corners.len().max(1) as f64;
        let around = hull(corners);
        let path: String = around.iter().map(|corner| format!("{:.1},{:.1} ", corner.x, corner.y)).collect();
        let element = format!("<polygon class=\"{class}\" points=\"{}\"/>", path.trim_end());
        self.add(depth, &around, 0.0, element);
    }
}

/// The class of a facet: painted or not, and how brightly it is lit.
fn class(mesh: &Mesh, facet: u32, X_HO: &Pose) -> String {
    let lit = (X_HO * mesh.normal(facet)).dot(&LIGHT.normalize()).clamp(0.0, 1.0);
    let shade = ((lit * SHADES as f64) as usize).min(SHADES - 1);
    let middle = mesh.corners(facet).iter().sum::<Vec3>() / 3.0;
    let band = 0.1 * mesh.radius();
    let painted = middle.x.abs() < band || middle.y.abs() < band && middle.x > 0.0;
    format!("rg-{}{shade}", if painted { "paint" } else { "object" })
}
