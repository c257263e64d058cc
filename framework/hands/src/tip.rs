//! The ball that stands for a fingertip: where its centre lies, and what of the link it replaces.

use crate::fingers::{Chain, Fingers};
use crate::solids::{Piece, Shaper, around};
use crate::tree::Tree;
use regrasp_api::{Pose, Shape, Vec3, any_orthogonal};
use regrasp_formats::RobotFault as Fault;
use regrasp_formats::{Geometry, Link};
use std::f64::consts::{PI, TAU};

/// The clearance (m) that planning keeps by default: a link that is thinner than the ball by less touches the object beside the ball.
pub(crate) const CLEARANCE: f64 = 5e-4;
/// A ball that can touch flat faces up to this angle (rad) from the finger's direction, however they are turned, is free enough.
const FREE: f64 = 75.0 * PI / 180.0;
/// Directions about the finger that are looked at.
const TURNS: usize = 24;

/// The ball's centre in the last link's frame L (m), the direction in which the finger ends, and how both were found.
#[derive(Clone, Debug)]
pub(crate) struct Tip {
    pub center: Vec3,
    pub outward: Vec3,
    pub how: String,
    /// Whether the tip link's own shapes are nothing but the ball.
    pub is_ball: bool,
}

/// The radius (m) of the tip link's shape, if it is one ball.
fn own_radius(link: &Link) -> Option<f64> {
    let collision = link.collision.as_ref().ok()?;
    let solids = if collision.is_empty() { link.visual.as_ref().ok()? } else { collision };
    match solids[..] {
        [ref solid] => match solid.geometry {
            Geometry::Sphere { radius } => Some(radius),
            _ => None,
        },
        _ => None,
    }
}

/// The radius (m) of the tip links' own balls, all equal; else a fault that suggests one.
pub(crate) fn common_radius(tree: &Tree<'_>, fingers: &Fingers, shaper: &mut Shaper) -> Result<f64, Fault> {
    let tips = || fingers.chains.iter().map(|chain| tree.link_of(chain.tip));
    let radii: Vec<Option<f64>> = tips().map(own_radius).collect();
    let first = radii[0].filter(|first| (1e-4..=0.2).contains(first));
    let same = |first: f64| radii.iter().all(|r| r.is_some_and(|r| (r - first).abs() < 1e-6));
    if let Some(radius) = first.filter(|&first| same(first)) {
        return Ok(radius);
    }
    // A tip link without a shape is a name for the end of the link before.
    let shape = |chain: &Chain| {
        let links = [Some(chain.tip), chain.path.last().map(|&joint| tree.parent(joint))];
        links
            .into_iter()
            .flatten()
            .map(|link| shaper.glimpse(tree.link_of(link)))
            .find(|pieces| !pieces.is_empty())
    };
    let half = |pieces: Vec<Piece>| {
        let corners: Vec<Vec3> = pieces.iter().flat_map(Piece::spread).collect();
        let (low, high) = around(&corners);
        ((high - low) / 2.0).min()
    };
    let thin = fingers.chains.iter().filter_map(shape).map(half).fold(f64::INFINITY, f64::min);
    let hint = if (1e-3..=0.2).contains(&thin) {
        format!("; their shapes suggest about {:.4}", thin)
    } else {
        String::new()
    };
    let names: Vec<String> = tips().map(|tip| format!("`{}`", tip.name)).collect();
    Err(Fault::of_key(
        "fingertip_radius",
        format!(
            "the fingertips ({}) are not balls of one radius: give `fingertip_radius`, the radius (m) of the balls that are to stand for them{hint}",
            names.join(", ")
        ),
    ))
}

impl Tip {
    /// `own`: the tip link's shapes; `all`: those of everything that moves with it, both in L. `offset`: the centre as given, in the tip
    /// link's frame (m).
    pub fn new(
        X_LTip: &Pose,
        offset: Option<[f64; 3]>,
        (own, all): (&[Piece], &[Piece]),
        radius: f64,
        has_own_link: bool,
    ) -> Self {
        let origin = X_LTip.translation.vector;
        if let Some(offset) = offset {
            let center = (X_LTip * nalgebra::Point3::from(Vec3::from(offset))).coords;
            let (outward, how) = (outward(&center, all), format!("given: {offset:?} in the tip's frame"));
            return Self { center, outward, how, is_ball: has_own_link && inside(own, &center, radius) };
        }
        if let [piece] = own
            && matches!(piece.shape, Shape::Sphere { .. })
        {
            let center = piece.corners[0];
            let is_ball = has_own_link && piece.radius <= 1.25 * radius;
            return Self {
                center,
                outward: outward(&center, all),
                how: "the centre of the tip link's ball".into(),
                is_ball,
            };
        }
        if own.is_empty() {
            let outward = outward(&origin, all);
            return Self {
                center: origin,
                outward,
                how: "the origin of the tip link, which has no shape".into(),
                is_ball: false,
            };
        }
        let (center, outward) = fit(own, radius);
        Self {
            center,
            outward,
            how: "fitted to the end of the tip link's shape".into(),
            is_ball: has_own_link && inside(own, &center, radius),
        }
    }

    /// What remains of the last link's shapes beside the ball: what lies beyond the ball's centre, where the finger ends there, is cut off.
    pub fn cut(&self, pieces: Vec<Piece>, radius: f64, notes: &mut Vec<String>, name: &str) -> Vec<Piece> {
        let height = self.outward.dot(&self.center);
        let most = pieces.iter().map(|piece| piece.reach(&self.outward)).fold(f64::NEG_INFINITY, f64::max);
        if most > height + 1.5 * radius {
            notes.push(format!(
                "the last link of `{name}` goes on for {:.1} mm beyond the ball of its tip; is the tip's frame where the finger ends?",
                1e3 * (most - height - radius)
            ));
            return pieces;
        }
        let kept: Vec<Piece> =
            pieces.into_iter().filter_map(|piece| below(piece, &self.outward, height)).collect();
        let free = self.free(&kept, radius);
        if free < FREE {
            notes.push(format!(
                "the last link of `{name}` is wide beside the ball of its tip ({:.1} mm): on flat faces, unless they are within {:.0}° of the finger's \
                 direction, the link can come to touch first, so that boxes may be hard to turn; tips with a thicker cap, `fingertip_radius` = \
                 {:.4}, allow {:.0}°",
                1e3 * radius,
                free.to_degrees(),
                (1e4 * self.wide(&kept, FREE)).ceil() / 1e4,
                FREE.to_degrees()
            ));
        }
        kept
    }

    /// Up to which angle (rad, at most π/2) from the finger's direction the ball touches a flat face before the link does, however the face
    /// is turned about the finger.
    pub fn free(&self, pieces: &[Piece], radius: f64) -> f64 {
        let degrees = (1..=90).map(|degree| f64::from(degree).to_radians());
        degrees.take_while(|&angle| self.wide_at(pieces, angle) <= radius).last().unwrap_or(0.0)
    }

    /// The least radius (m) of a ball that is free up to an angle (rad).
    fn wide(&self, pieces: &[Piece], angle: f64) -> f64 {
        (0..=16).map(|i| self.wide_at(pieces, angle * f64::from(i) / 16.0)).fold(0.0, f64::max)
    }

    /// How far (m) the pieces with what planning keeps around them reach from the ball's centre, in the farthest direction at an angle
    /// (rad) from the finger's.
    fn wide_at(&self, pieces: &[Piece], angle: f64) -> f64 {
        let across = any_orthogonal(&self.outward);
        let other = self.outward.cross(&across);
        let reach = |i: usize| {
            let (sin, cos) = (i as f64 * TAU / TURNS as f64).sin_cos();
            let n = self.outward * angle.cos() + (across * cos + other * sin) * angle.sin();
            pieces.iter().map(|piece| piece.reach(&n)).fold(f64::NEG_INFINITY, f64::max) - n.dot(&self.center)
        };
        (0..TURNS).map(reach).fold(f64::NEG_INFINITY, f64::max) + CLEARANCE
    }
}

/// The direction from the last joint to the tip, or where both coincide to the middle of the shapes.
fn outward(center: &Vec3, all: &[Piece]) -> Vec3 {
    let direction = center.try_normalize(1e-4);
    direction.or_else(|| middle(all).try_normalize(1e-4)).unwrap_or_else(Vec3::z)
}

fn middle(pieces: &[Piece]) -> Vec3 {
    let corners: Vec<Vec3> = pieces.iter().flat_map(|piece| piece.corners.iter().copied()).collect();
    if corners.is_empty() {
        return Vec3::zeros();
    }
    let (low, high) = around(&corners);
    (low + high) / 2.0
}

/// The ball of the given radius that touches the far end of the shapes from within, in the middle of what is there.
fn fit(own: &[Piece], radius: f64) -> (Vec3, Vec3) {
    let outward = middle(own).try_normalize(1e-4).unwrap_or_else(Vec3::z);
    let end = own.iter().map(|piece| piece.reach(&outward)).fold(f64::NEG_INFINITY, f64::max);
    let is_near = |p: &&Vec3| outward.dot(p) >= end - radius;
    let mut near: Vec<Vec3> =
        own.iter().flat_map(|piece| piece.corners.iter().filter(is_near).copied()).collect();
    if near.is_empty() {
        near.push(middle(own));
    }
    let (low, high) = around(&near);
    let aside = (low + high) / 2.0;
    (aside + outward * (end - radius - outward.dot(&aside)), outward)
}

/// Whether the shapes are no more than the ball, to a quarter of its radius.
fn inside(own: &[Piece], center: &Vec3, radius: f64) -> bool {
    let far =
        |piece: &Piece| piece.corners.iter().map(|p| (p - center).norm() + piece.radius).fold(0.0, f64::max);
    own.iter().all(|piece| far(piece) <= 1.25 * radius)
}

/// The part of a piece with n · x ≤ height; `None` where nothing is left.
pub(crate) fn below(piece: Piece, n: &Vec3, height: f64) -> Option<Piece> {
    if piece.reach(n) <= height + 1e-9 {
        return Some(piece);
    }
    match piece.shape {
        // A thinner rod may end in the ball.
        Shape::Capsule { .. } | Shape::Sphere { .. } => rod_below(piece, n, height),
        Shape::Box { size } if is_square(&piece, n) => Some(box_below(&piece, size, n, height)),
        _ => {
            let lines = piece.corners.iter().enumerate();
            let pairs = lines.flat_map(|(i, a)| piece.corners[i + 1..].iter().map(move |b| (a, b)));
            let mut points: Vec<Vec3> =
                piece.corners.iter().copied().filter(|p| n.dot(p) <= height).collect();
            // Every edge is among the lines between corners; the others cross the plane inside the cut.
            points.extend(pairs.filter_map(|(a, b)| crossing(a, b, n, height)));
            regrasp_world::convex_hull(&points).map(|mesh| Piece::of_mesh(&mesh))
        }
    }
}

/// Whether a side of the box faces in the direction `n`.
fn is_square(piece: &Piece, n: &Vec3) -> bool {
    let n_S = piece.X_BS.rotation.inverse() * n;
    n_S.abs().max() > 1.0 - 1e-9
}

fn box_below(piece: &Piece, size: [f64; 3], n: &Vec3, height: f64) -> Piece {
    let n_S = piece.X_BS.rotation.inverse() * n;
    let axis = n_S.abs().imax();
    let cut = (piece.reach(n) - height).min(size[axis] - 1e-6);
    let mut half = Vec3::from(size) / 2.0;
    half[axis] -= cut / 2.0;
    let mut X_BS = piece.X_BS;
    X_BS.translation.vector -= n * (cut / 2.0);
    Piece::cuboid(half, X_BS)
}

fn rod_below(piece: Piece, n: &Vec3, height: f64) -> Option<Piece> {
    let ends = (piece.corners[0], *piece.corners.last()?);
    let (from, to) = if n.dot(&ends.0) <= n.dot(&ends.1) { ends } else { (ends.1, ends.0) };
    if n.dot(&from) > height {
        return None;
    }
    let to = crossing(&from, &to, n, height).unwrap_or(to);
    Some(Piece::capsule([from, to], piece.radius))
}

/// Where a line between two points crosses the plane n · x = height, if it does.
fn crossing(a: &Vec3, b: &Vec3, n: &Vec3, height: f64) -> Option<Vec3> {
    let (low, high) = (n.dot(a) - height, n.dot(b) - height);
    (low * high < 0.0).then(|| a + (b - a) * (low / (low - high)))
}
