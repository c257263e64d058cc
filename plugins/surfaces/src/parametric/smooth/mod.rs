//! Smooth surfaces whose geodesics have no elementary form: the geodesic equation, solved between two points.
//!
//! Three stages. *Sides*: chains of points through one of several places in the middle between the ends (every path has to pass there)
//! are measured; on an ellipsoid and on a torus geodesics between two points differ by the side on which they pass (Itoh &
//! Kiyohara 2004). *Relaxation*: the chains that are shorter than their neighbours are pulled tight by Newton's method (`chain`).
//! *Shooting*: from a chain's first direction and length the geodesic equation is integrated, and both are corrected by the miss at
//! the end; how the end moves with the direction is a Jacobi field, integrated along (`flow`). The shortest result is taken.

mod chain;
mod ellipsoid;
mod flow;
mod torus;

pub(super) use ellipsoid::Ellipsoid;
pub(super) use torus::Torus;

use super::form::{Curve, Form};
use chain::Chain;
use flow::{Heading, Spread};
use regrasp_api::Vec3;
use std::fmt::Debug;

/// Places in the middle through which chains are led.
const SIDES: usize = 16;
/// Chains that are pulled tight.
const MOST_CHAINS: usize = 4;
/// Pulled chains that are longer than the shortest by more than this share are not shot.
const MARGIN: f64 = 0.01;
/// Newton steps of the shooting; three or four are common.
const SHOTS: usize = 24;
/// A miss (relative to the object's size) below which the end counts as hit.
const HIT: f64 = 1e-13;

/// A smooth closed surface, in O.
pub(super) trait Smooth: Send + Sync + Debug {
    /// The outward unit normal at a point.
    fn normal(&self, p: &Vec3) -> Vec3;

    /// How the normal turns on the way along a unit tangent (1/m): the shape operator, positive where the surface bends inwards.
    fn turning(&self, p: &Vec3, along: &Vec3) -> Vec3;

    /// Gaussian curvature (1/m²).
    fn curvature(&self, p: &Vec3) -> f64;

    /// The point of the surface for one near it.
    fn onto(&self, p: &Vec3) -> Vec3;

    /// Where the ray through a point begins that leads from facets to the surface.
    fn core(&self, p: &Vec3) -> Vec3;

    /// The largest extent (m): what is small is measured by it.
    fn size(&self) -> f64;

    /// The point a fraction `t` of the way from `a` to `b` that passes the middle on one of [`SIDES`] sides.
    fn via(&self, a: &Vec3, b: &Vec3, side: usize) -> impl Fn(f64) -> Vec3
    where
        Self: Sized;
}

/// A geodesic's beginning.
#[derive(Clone, Copy, Debug)]
struct Shot {
    along: Vec3,
    length: f64,
}

/// The chains that are shorter than those on the sides next to them, the shortest first, and pulled tight.
fn chains(surface: &impl Smooth, a: &Vec3, b: &Vec3) -> Vec<Chain> {
    let rough: [f64; SIDES] = std::array::from_fn(|side| Chain::rough(surface.via(a, b, side)));
    let is_low = |i: usize| rough[i] <= rough[(i + 1) % SIDES] && rough[i] < rough[(i + SIDES - 1) % SIDES];
    let best = (0..SIDES).min_by(|&i, &j| rough[i].total_cmp(&rough[j])).unwrap_or(0);
    let mut sides: Vec<usize> = (0..SIDES).filter(|&i| i != best && is_low(i)).collect();
    sides.sort_by(|&i, &j| rough[i].total_cmp(&rough[j]));
    sides.truncate(MOST_CHAINS - 1);
    sides.insert(0, best);
    let mut chains: Vec<Chain> =
        sides.into_iter().map(|side| Chain::pulled(surface, a, b, surface.via(a, b, side))).collect();
    chains.sort_by(|x, y| x.length().total_cmp(&y.length()));
    let most = chains[0].length() * (1.0 + MARGIN);
    chains.retain(|chain| chain.length() <= most);
    chains
}

/// Corrects direction and length until the geodesic ends at `b`; the miss (m) that is left comes along.
fn shoot(surface: &impl Smooth, a: &Vec3, b: &Vec3, start: Shot) -> (Shot, f64) {
    let (n, tiny) = (surface.normal(a), 1e-6 * surface.size());
    let (mut shot, mut best) = (start, (start, f64::INFINITY));
    for _ in 0..SHOTS {
        let mut end = Heading::new(surface, a, &shot.along);
        let mut spread = Spread::default();
        flow::run(surface, &mut end, Some(&mut spread), shot.length);
        let miss = b - end.p;
        if miss.norm() < best.1 {
            best = (shot, miss.norm());
        }
        if best.1 < HIT * surface.size() {
            break;
        }
        let across = surface.normal(&end.p).cross(&end.along);
        // Next to a conjugate point (no spread) the direction has no effect, nor has it on the length.
        let turn = miss.dot(&across) * spread.width / (spread.width * spread.width + tiny * tiny);
        let (sin, cos) = turn.clamp(-0.3, 0.3).sin_cos();
        let along = shot.along * cos + n.cross(&shot.along) * sin;
        let length = shot.length + miss.dot(&end.along).clamp(-0.3 * shot.length, 0.3 * shot.length);
        shot = Shot { along: along.normalize(), length };
    }
    best
}

/// A smooth surface as a closed form.
#[derive(Clone, Copy, Debug)]
pub(super) struct Geodesics<S>(pub S);

impl<S: Smooth> Form for Geodesics<S> {
    fn outward(&self, p: &Vec3) -> Vec3 {
        self.0.onto(p)
    }

    fn core(&self, p: &Vec3) -> Vec3 {
        self.0.core(p)
    }

    fn normal(&self, p: &Vec3) -> Vec3 {
        self.0.normal(p)
    }

    fn shortest(&self, a: &Vec3, b: &Vec3, spacing: f64, curve: &mut Curve) {
        curve.restart(a);
        if (b - a).norm() < HIT * self.0.size() {
            curve.points.push(*b);
            return;
        }
        let shots = chains(&self.0, a, b).into_iter().map(|chain| {
            let start = Shot { along: chain.direction(&self.0), length: chain.length() };
            shoot(&self.0, a, b, start)
        });
        // What misses by more than rounding is a last resort.
        let rank = |shot: &(Shot, f64)| (shot.1 / (1e-9 * self.0.size())).floor();
        let order = |x: &(Shot, f64), y: &(Shot, f64)| {
            rank(x).total_cmp(&rank(y)).then(x.0.length.total_cmp(&y.0.length))
        };
        let Some((shot, _)) = shots.min_by(order) else { return };
        flow::draw(&self.0, a, &shot.along, shot.length, spacing, curve);
        let last = curve.points.len() - 1;
        curve.points[last] = *b;
    }

    fn walk(&self, from: &Vec3, along: &Vec3, distance: f64, spacing: f64, curve: &mut Curve) {
        flow::draw(&self.0, from, along, distance, spacing, curve);
    }
}
