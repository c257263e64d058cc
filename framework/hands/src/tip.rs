//! The ball that stands for a fingertip: where its centre lies, and what of the link it replaces.

use crate::ball::{self, Ball, CAP};
use crate::fingers::Fingers;
use crate::hulls::around;
use crate::solids::Piece;
use crate::tree::Tree;
use regrasp_api::{Pose, Shape, Vec3, any_orthogonal};
use regrasp_formats::{Geometry, Link};
use std::f64::consts::{PI, TAU};

/// The clearance (m) that planning keeps by default: a link that is thinner than the ball by less touches
/// the object beside the ball.
pub(crate) const CLEARANCE: f64 = 5e-4;
/// A ball that can touch flat faces up to this angle (rad) from the finger's direction, however they are
/// turned, is free enough.
const FREE: f64 = 75.0 * PI / 180.0;
/// Steps (m) in which a last link is cut back.
const CUT: f64 = 5e-4;
/// Directions about the finger that are looked at.
const TURNS: usize = 24;

/// The ball's centre in the last link's frame L (m), the direction in which the finger ends, and how both
/// were found.
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

/// The radius (m) of the tip links' own balls, if they are all equal.
pub(crate) fn own_balls(tree: &Tree<'_>, fingers: &Fingers) -> Option<f64> {
    let radii: Vec<Option<f64>> =
        fingers.chains.iter().map(|chain| own_radius(tree.link_of(chain.tip))).collect();
    let first = radii[0].filter(|first| (1e-4..=0.2).contains(first))?;
    let same = radii.iter().all(|r| r.is_some_and(|r| (r - first).abs() < 1e-6));
    same.then_some(first)
}

/// The shapes at the end of a finger, in the last link's frame, and the direction in which it ends there.
pub(crate) struct End {
    pub name: String,
    pub pieces: Vec<Piece>,
    pub outward: Vec3,
}

impl End {
    /// The end, or its one shape that reaches farthest, where a ball fits that better: the pad of a
    /// fingertip is often a mesh of its own in front of a bulky link.
    pub fn or_its_last_piece(self) -> Self {
        let reach = |piece: &&Piece| piece.reach(&self.outward);
        let last = self.pieces.iter().max_by(|a, b| reach(a).total_cmp(&reach(b)));
        let Some(last) = last.filter(|_| self.pieces.len() > 1).cloned() else { return self };
        let alone = Self {
            name: self.name.clone(),
            outward: outward(&Vec3::zeros(), std::slice::from_ref(&last)),
            pieces: vec![last],
        };
        match (self.ball(), alone.ball()) {
            (Some(all), Some(one)) if all.is_fit() && one.error > 0.7 * all.error => self,
            (_, Some(one)) if one.is_fit() => alone,
            _ => self,
        }
    }

    fn ball(&self) -> Option<Ball> {
        ball::fit(&self.pieces, &self.outward, None)
    }
}

/// A radius (m, a multiple of 0.1 mm) that fits the ends of all fingers: the median of the balls that fit
/// each; or why there is none, with one that may do.
pub(crate) fn fitted_radius(ends: &[End]) -> Result<f64, (String, f64)> {
    let balls: Vec<Option<Ball>> = ends.iter().map(|end| end.ball().filter(Ball::is_fit)).collect();
    let mut radii: Vec<f64> = balls.iter().flatten().map(|ball| ball.radius).collect();
    radii.sort_by(f64::total_cmp);
    let tenths = |radius: f64| (radius * 1e4).round() / 1e4;
    if let (Some(&radius), true) = (radii.get(radii.len() / 2), 2 * radii.len() > ends.len()) {
        return Ok(tenths(radius));
    }
    let half = |end: &End| {
        let corners: Vec<Vec3> = end.pieces.iter().flat_map(Piece::spread).collect();
        let (low, high) = around(&corners);
        ((high - low) / 2.0).min()
    };
    let thin = ends.iter().filter(|end| !end.pieces.is_empty()).map(half).fold(f64::INFINITY, f64::min);
    let hint = if (1e-3..=0.2).contains(&thin) {
        format!("; their shapes suggest about {thin:.4}")
    } else {
        String::new()
    };
    let names: Vec<String> = ends.iter().map(|end| format!("`{}`", end.name)).collect();
    let why = format!(
        "the fingertips ({}) are not balls of one radius, and no ball fits the ends of most: give \
         `fingertip_radius`, the radius (m) of the balls \
         that are to stand for them{hint}",
        names.join(", ")
    );
    Err((why, if (1e-3..=0.2).contains(&thin) { thin } else { 0.01 }))
}

impl Tip {
    /// `own`: the tip link's shapes; `all`: those of everything that moves with it, both in L. `offset`: the
    /// centre as given, in the tip link's frame (m).
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

    /// The ball of this radius (m) that fits the end of the shapes, for fingers that nobody said more of; as
    /// it was where none fits.
    ///
    /// The tip's frame stays the centre where it lies about a radius before the end.
    pub fn fitted(self, end: &End, radius: f64, notes: &mut Vec<String>) -> Self {
        let n = end.outward;
        let most = end.pieces.iter().map(|piece| piece.reach(&n)).fold(f64::NEG_INFINITY, f64::max);
        let before = most - n.dot(&self.center);
        if self.is_ball || (before - radius).abs() < 0.5 * radius && self.how.starts_with("the origin") {
            return self;
        }
        match ball::fit(&end.pieces, &n, Some(radius)) {
            Some(ball) if !ball.is_fit() => {
                notes.push(format!(
                    "no ball of {:.1} mm fits the end of `{}`, its shape departs from it by {:.1} mm: look \
                     at it, and give \
                     `fingertip_radius` and `tip_offset` (`--fingertip-radius`, `--tip-offset`)",
                    1e3 * radius,
                    end.name,
                    1e3 * ball.error
                ));
                self
            }
            Some(ball) => Self {
                center: ball.center,
                outward: n,
                how: format!(
                    "fitted: the shape departs from a ball of {:.1} mm by up to {:.1} mm within {:.0}° of \
                     the finger's direction",
                    1e3 * radius,
                    1e3 * ball.error,
                    CAP.to_degrees()
                ),
                is_ball: false,
            },
            None => self,
        }
    }

    /// The shapes cut back behind the ball as far as it takes for the ball to touch first up to [`FREE`], by
    /// at most its radius; a thinner rod stands for what was cut. For balls that were fitted to the shape
    /// that they stand for.
    pub fn freed(&self, pieces: &[Piece], radius: f64, notes: &mut Vec<String>, name: &str) -> Vec<Piece> {
        let steps = (radius / CUT) as usize;
        let mut best = (self.free(pieces, radius), 0.0, pieces.to_vec());
        for back in (1..=steps).map(|step| CUT * step as f64) {
            if best.0 >= FREE {
                break;
            }
            let height = self.outward.dot(&self.center) - back;
            let cut = |piece: &Piece| below(piece.clone(), &self.outward, height);
            let mut kept: Vec<Piece> = pieces.iter().filter_map(cut).collect();
            let ends = [self.center, self.center - self.outward * back];
            kept.push(Piece::capsule(ends, (radius - CLEARANCE - 1e-4).max(1e-4)));
            let free = self.free(&kept, radius);
            if free > best.0 {
                best = (free, back, kept);
            }
        }
        if best.1 > 0.0 {
            notes.push(format!(
                "the last link of `{name}` is cut {:.1} mm behind the ball's centre, so that its ball \
                 touches first; a rod stands for the rest",
                1e3 * best.1
            ));
        }
        best.2
    }

    /// What remains of the last link's shapes beside the ball: what lies beyond the ball's centre, where the
    /// finger ends there, is cut off.
    pub fn cut(&self, pieces: Vec<Piece>, radius: f64, notes: &mut Vec<String>, name: &str) -> Vec<Piece> {
        let height = self.outward.dot(&self.center);
        let most = pieces.iter().map(|piece| piece.reach(&self.outward)).fold(f64::NEG_INFINITY, f64::max);
        if most > height + 1.5 * radius {
            notes.push(format!(
                "the last link of `{name}` goes on for {:.1} mm beyond the ball of its tip; is the tip's \
                 frame where the finger ends?",
                1e3 * (most - height - radius)
            ));
            return pieces;
        }
        let kept: Vec<Piece> =
            pieces.into_iter().filter_map(|piece| below(piece, &self.outward, height)).collect();
        let free = self.free(&kept, radius);
        if free < FREE {
            notes.push(format!(
                "the last link of `{name}` is wide beside the ball of its tip ({:.1} mm): on flat faces, \
                 unless they are within {:.0}° of the finger's \
                 direction, the link can come to touch first, so that boxes may be hard to turn; tips with \
                  a thicker cap, `fingertip_radius` = \
                 {:.4}, allow {:.0}°",
                1e3 * radius,
                free.to_degrees(),
                (1e4 * self.wide(&kept, FREE)).ceil() / 1e4,
                FREE.to_degrees()
            ));
        }
        kept
    }

    /// Up to which angle (rad, at most π/2) from the finger's direction the ball touches a flat face before
    /// the link does, however the face is turned about the finger.
    pub fn free(&self, pieces: &[Piece], radius: f64) -> f64 {
        let degrees = (1..=90).map(|degree| f64::from(degree).to_radians());
        degrees.take_while(|&angle| self.wide_at(pieces, angle) <= radius).last().unwrap_or(0.0)
    }

    /// The least radius (m) of a ball that is free up to an angle (rad).
    fn wide(&self, pieces: &[Piece], angle: f64) -> f64 {
        (0..=16).map(|i| self.wide_at(pieces, angle * f64::from(i) / 16.0)).fold(0.0, f64::max)
    }

    /// How far (m) the pieces with what planning keeps around them reach from the ball's centre, in the
    /// farthest direction at an angle (rad) from the finger's.
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
pub(crate) fn outward(center: &Vec3, all: &[Piece]) -> Vec3 {
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

/// The ball of the given radius that touches the far end of the shapes from within, in the middle of what is
/// there.
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
