//! Smooth surfaces whose geodesics have no elementary form: the geodesic equation, solved between two points.
//!
//! Three stages. *Sides*: chains of points through one of several places in the middle between the ends
//! (every path has to pass there) are measured; on an ellipsoid and on a torus geodesics between two points
//! differ by the side on which they pass (Itoh & Kiyohara 2004). *Relaxation*: the chains that are shorter
//! than their neighbours are pulled tight by Newton's method (`chain`). *Shooting*: from a chain's first
//! direction and length the geodesic equation is integrated, and both are corrected by the miss at the end;
//! how the end moves with the direction is a Jacobi field, integrated along (`flow`). The shortest result is
//! taken.

mod chain;
mod ellipsoid;
mod flow;
mod torus;

pub(super) use ellipsoid::Ellipsoid;
pub(super) use torus::Torus;

use super::curve::{Curve, Form};
use chain::Chain;
use flow::{Heading, Spread};
use regrasp_api::Vec3;
use std::cmp::Ordering;
use std::fmt::Debug;

/// Places in the middle through which chains are led.
const SIDES: usize = 16;
/// Chains that are pulled tight.
const MOST_CHAINS: usize = 4;
/// Pulled chains that are longer than the shortest by more than this share are not shot, unless all others
/// miss.
const MARGIN: f64 = 0.02;
/// Shots at an end; three to five are common.
const SHOTS: usize = 40;
/// How often a correction is halved before it counts as useless.
const HALVINGS: usize = 6;
/// A miss (relative to the object's size) below which the end counts as hit: of first shots with long steps,
/// of those that are worth a correction, and of the last ones.
const NEAR: f64 = 1e-6;
const CLOSE: f64 = 1e-3;
const HIT: f64 = 1e-13;
/// How much longer the steps of first shots are.
const LONG: f64 = 4.0;
/// First shots that are longer than the shortest by more than this share are not repeated.
const SAME: f64 = 1e-3;
/// How many times longer than its chain a geodesic may be.
const STRETCH: f64 = 1.25;
/// First directions (rad) tried to either side where the chain's own leads nowhere: their distance, and how
/// many.
const ASIDE: f64 = 0.06;
const SWEEP: i32 = 8;
/// Lengths tried then, over the chain's own.
const LENGTHS: [f64; 4] = [1.0, 1.12, 1.25, 1.45];

/// A smooth closed surface, in O.
pub(super) trait Smooth: Send + Sync + Debug {
    /// The outward unit normal at a point.
    fn normal(&self, p: &Vec3) -> Vec3;

    /// How the normal turns on the way along a unit tangent (1/m): the shape operator, positive where the
    /// surface bends inwards.
    fn turning(&self, p: &Vec3, along: &Vec3) -> Vec3;

    /// Gaussian curvature (1/m²).
    fn curvature(&self, p: &Vec3) -> f64;

    /// How fast (1/m) the surface changes on the way along a unit tangent: normal, curvature and spread of
    /// geodesics.
    fn pace(&self, p: &Vec3, along: &Vec3) -> f64;

    /// The point of the surface for one near it.
    fn onto(&self, p: &Vec3) -> Vec3;

    /// Whether two neighbours of a chain are joined over the surface, not through the solid.
    fn joins(&self, p: &Vec3, q: &Vec3) -> bool;

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
    chains
}

/// Shoots from `a` at `b`.
struct Gun<'a, S> {
    surface: &'a S,
    a: &'a Vec3,
    b: &'a Vec3,
    /// How many times longer than for the last digit the steps are.
    stretch: f64,
    /// The miss (m) that is good enough.
    near: f64,
}

/// Where a shot ended: the miss (m), and how the next one has to turn (rad) and lengthen (m).
struct Target {
    miss: f64,
    turn: f64,
    longer: f64,
}

impl<S: Smooth> Gun<'_, S> {
    fn fire(&self, shot: &Shot) -> Target {
        let mut end = Heading::new(self.surface, self.a, &shot.along);
        let mut spread = Spread::default();
        flow::run(self.surface, &mut end, Some(&mut spread), shot.length, self.stretch);
        let miss = self.b - end.p;
        let across = self.surface.normal(&end.p).cross(&end.along);
        // Next to a conjugate point (no spread) the direction has no effect, nor has it on the length.
        let tiny = 1e-6 * self.surface.size();
        let turn = miss.dot(&across) * spread.width / (spread.width * spread.width + tiny * tiny);
        let most = 0.3 * shot.length;
        Target {
            miss: miss.norm(),
            turn: turn.clamp(-0.3, 0.3),
            longer: miss.dot(&end.along).clamp(-most, most),
        }
    }

    fn turned(&self, shot: &Shot, turn: f64, longer: f64) -> Shot {
        let (sin, cos) = turn.sin_cos();
        let along = shot.along * cos + self.surface.normal(self.a).cross(&shot.along) * sin;
        Shot { along: along.normalize(), length: shot.length + longer }
    }

    /// Corrects direction and length by the miss, less where that does not help; the miss (m) that is left
    /// comes along.
    fn correct(&self, start: Shot) -> (Shot, f64) {
        let (mut shot, mut target) = (start, self.fire(&start));
        for _ in 0..SHOTS {
            if target.miss < self.near {
                break;
            }
            let mut share = 1.0;
            let better = (0..HALVINGS).find_map(|_| {
                let next = self.turned(&shot, share * target.turn, share * target.longer);
                share /= 2.0;
                let there = self.fire(&next);
                (there.miss < target.miss).then_some((next, there))
            });
            let Some(better) = better else { break };
            (shot, target) = better;
        }
        (shot, target.miss)
    }

    /// Whether a shot is close enough to be corrected to the last digit.
    fn hits(&self, shot: &(Shot, f64)) -> bool {
        shot.1 < CLOSE * self.surface.size()
    }

    /// Hits before misses, then the shorter one, respectively the one that misses by less.
    fn order(&self, x: &(Shot, f64), y: &(Shot, f64)) -> Ordering {
        match (self.hits(x), self.hits(y)) {
            (true, true) => x.0.length.total_cmp(&y.0.length),
            (false, false) => x.1.total_cmp(&y.1),
            (hits, _) => {
                if hits {
                    Ordering::Less
                } else {
                    Ordering::Greater
                }
            }
        }
    }

    /// The same; where that leads nowhere, the best from directions to either side.
    fn shoot(&self, start: Shot) -> (Shot, f64) {
        let straight = self.correct(start);
        // A much longer one is another geodesic than the chain's.
        if self.hits(&straight) && straight.0.length < STRETCH * start.length {
            return straight;
        }
        // Chains cut the rims of flat solids, so that lengths are tried, too.
        let starts =
            LENGTHS.iter().flat_map(|share| (-SWEEP..=SWEEP).map(move |i| (share, ASIDE * f64::from(i))));
        let others =
            starts.map(|(share, turn)| self.correct(self.turned(&start, turn, (share - 1.0) * start.length)));
        others.fold(straight, |best, other| if self.order(&other, &best).is_lt() { other } else { best })
    }
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
        let size = self.0.size();
        let gun = |stretch: f64, near: f64| Gun { surface: &self.0, a, b, stretch, near: near * size };
        let chains = chains(&self.0, a, b);
        let begin = |chain: &Chain| Shot { along: chain.direction(&self.0), length: chain.length() };
        let most = chains[0].length() * (1.0 + MARGIN);
        let long = gun(LONG, NEAR);
        let mut first: Vec<(Shot, f64)> = Vec::with_capacity(chains.len());
        for chain in &chains {
            if chain.length() <= most || !first.iter().any(|shot| long.hits(shot)) {
                first.push(long.shoot(begin(chain)));
            }
        }
        first.sort_by(|x, y| long.order(x, y));
        let most = first[0].0.length * (1.0 + SAME);
        let near = first.iter().take_while(|shot| shot.0.length <= most);
        let last = near.map(|shot| gun(1.0, HIT).correct(shot.0));
        let Some((shot, _)) = last.min_by(|x, y| long.order(x, y)) else { return };
        flow::draw(&self.0, a, &shot.along, shot.length, spacing, curve);
        let last = curve.points.len() - 1;
        curve.points[last] = *b;
    }

    fn walk(&self, from: &Vec3, along: &Vec3, distance: f64, spacing: f64, curve: &mut Curve) {
        flow::draw(&self.0, from, along, distance, spacing, curve);
    }
}
