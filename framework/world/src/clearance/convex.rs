//! Convex solids in closed form: how far a rod is from them, bounded from both sides.

use super::rod::Rod;
use regrasp_api::{Primitive, Vec3};

/// What a bound says about "farther apart than the clearance".
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Verdict {
    /// Certainly farther.
    Free,
    /// Certainly not.
    Close,
    /// The bound is too wide: ask the exact distance.
    Unknown,
}

/// A convex solid K about the origin of its frame, and how much of it is certainly body: `inner`·K ⊂ body ⊂
/// K.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Convex {
    form: Primitive,
    inner: f64,
}

/// A plane that K does not cross (n·x ≤ height for all x in K), and a point of K near it.
struct Support {
    normal: Vec3,
    height: f64,
    point: Vec3,
}

/// Cuts of the search along a rod before it gives up; two or three decide nearly always.
const CUTS: usize = 12;

impl Convex {
    /// A box of these half edge lengths (m), all of it body.
    pub fn cuboid(half_size: Vec3) -> Self {
        Self { form: Primitive::Cuboid { half_size }, inner: 1.0 }
    }

    /// The primitive around a polytope given by its facets' planes n·x = d (m); `None` for a torus, which is
    /// not convex, and where the planes do not hold the origin.
    pub fn around(form: Primitive, planes: impl Iterator<Item = (Vec3, f64)>) -> Option<Self> {
        if matches!(form, Primitive::Torus { .. }) {
            return None;
        }
        let mut all = Self { form, inner: 1.0 };
        // s·K lies inside the plane iff s·h(n) ≤ d.
        all.inner = planes.map(|(n, d)| d / all.height(&n)).fold(1.0, f64::min) * (1.0 - 1e-12);
        (all.inner > 0.0).then_some(all)
    }

    /// How much of K is certainly body: from 0 to 1, of its lengths.
    pub fn inner(&self) -> f64 {
        self.inner
    }

    /// The support function: the largest n·x over K (m).
    #[inline]
    pub fn height(&self, n: &Vec3) -> f64 {
        match self.form {
            Primitive::Sphere { radius } => radius,
            Primitive::Ellipsoid { semi_axes } => semi_axes.component_mul(n).norm(),
            Primitive::Cuboid { half_size } => half_size.dot(&n.abs()),
            Primitive::Cylinder { radius, half_height } => radius * n.x.hypot(n.y) + half_height * n.z.abs(),
            Primitive::Capsule { radius, half_height } => radius + half_height * n.z.abs(),
            Primitive::Torus { ring_radius, tube_radius } => tube_radius + ring_radius * n.x.hypot(n.y),
        }
    }

    /// Whether the rod, given in K's frame, keeps the body at more than `clear` (m).
    ///
    /// The distance g(t) of the points along the axis from K is convex: each supporting plane gives a tangent
    /// below it, and the next point is where the lowest two tangents meet (J. E. Kelley, "The cutting-plane
    /// method for solving convex programs", SIAM J. 1960). Free as soon as the tangents stay above radius +
    /// clearance; close as soon as one point is that near the inner body.
    #[inline]
    pub fn verdict(&self, rod: &Rod, clear: f64) -> Verdict {
        let apart = rod.radius + clear;
        let along = rod.b - rod.a;
        let length_squared = along.norm_squared();
        let mut t =
            if length_squared > 0.0 { (-rod.a.dot(&along) / length_squared).clamp(0.0, 1.0) } else { 0.0 };
        let (mut low, mut high) = (None, None);
        for _ in 0..CUTS {
            let p = rod.a + along * t;
            let Some(support) = self.support(&p) else { return self.verdict_inside(&p, apart) };
            if (p - support.point * self.inner).norm_squared() <= apart * apart {
                return Verdict::Close;
            }
            let tangent = Tangent {
                t,
                value: support.normal.dot(&p) - support.height,
                slope: support.normal.dot(&along),
            };
            if tangent.lowest() > apart {
                return Verdict::Free;
            }
            let end = if tangent.slope > 0.0 { &mut high } else { &mut low };
            *end = Some(tangent);
            let Some((next, value)) = next_cut(&low, &high) else { return Verdict::Unknown };
            if value > apart {
                return Verdict::Free;
            }
            if (next - t).abs() < 1e-9 {
                return Verdict::Unknown;
            }
            t = next;
        }
        Verdict::Unknown
    }

    fn verdict_inside(&self, p: &Vec3, apart: f64) -> Verdict {
        // p lies in K, inner·p in the inner body.
        if (1.0 - self.inner) * p.norm() <= apart { Verdict::Close } else { Verdict::Unknown }
    }

    /// A supporting plane facing `p`, as steep as the closest one can; `None` if `p` is inside K.
    #[inline]
    fn support(&self, p: &Vec3) -> Option<Support> {
        match self.form {
            Primitive::Sphere { radius } => towards(p, Vec3::zeros(), radius),
            Primitive::Cuboid { half_size } => {
                let point = p.sup(&-half_size).inf(&half_size);
                towards(p, point, 0.0)
            }
            Primitive::Capsule { radius, half_height } => {
                towards(p, Vec3::new(0.0, 0.0, p.z.clamp(-half_height, half_height)), radius)
            }
            Primitive::Cylinder { radius, half_height } => {
                let shrink = (radius / p.x.hypot(p.y)).min(1.0);
                towards(p, Vec3::new(p.x * shrink, p.y * shrink, p.z.clamp(-half_height, half_height)), 0.0)
            }
            Primitive::Ellipsoid { semi_axes } => ellipsoid_support(p, &semi_axes),
            Primitive::Torus { .. } => None,
        }
    }
}

/// The plane at the point that is closest to `p` of a ball of `radius` about `core`.
#[inline]
fn towards(p: &Vec3, core: Vec3, radius: f64) -> Option<Support> {
    let away = p - core;
    let distance = away.norm();
    if distance <= radius {
        return None;
    }
    let normal = away / distance;
    Some(Support { normal, height: normal.dot(&core) + radius, point: core + normal * radius })
}

/// A supporting plane of the ellipsoid whose normal is nearly that of the closest point.
///
/// The closest point solves Σ (aᵢ pᵢ / (aᵢ² + τ))² = 1 (D. Eberly, "Distance from a point to an ellipse, an
/// ellipsoid, or a hyperellipsoid", 2013); two Newton steps from a start that is exact on the axes are
/// plenty, since every normal gives a valid plane and the error is of second order in the normal's.
#[inline]
fn ellipsoid_support(p: &Vec3, semi_axes: &Vec3) -> Option<Support> {
    let squares = semi_axes.component_mul(semi_axes);
    let weights = p.component_div(semi_axes).map(|x| x * x);
    let scale_squared = weights.sum();
    if scale_squared <= 1.0 {
        return None;
    }
    let mut tau = (scale_squared.sqrt() - 1.0) * weights.dot(&squares) / scale_squared;
    let scaled = semi_axes.component_mul(p).map(|x| x * x);
    for _ in 0..2 {
        let inverse = squares.map(|square| 1.0 / (square + tau));
        let terms = scaled.component_mul(&inverse).component_mul(&inverse);
        let (sum, slope) = (terms.sum(), -2.0 * terms.dot(&inverse));
        // Newton on Σ^(-1/2), which is nearly linear in τ.
        tau = (tau + 2.0 * sum * (sum.sqrt() - 1.0) / -slope).max(0.0);
    }
    let normal = p.zip_map(&squares, |x, square| x / (square + tau)).normalize();
    let height = semi_axes.component_mul(&normal).norm();
    Some(Support { normal, height, point: squares.component_mul(&normal) / height })
}

/// A line below g(t).
#[derive(Clone, Copy)]
struct Tangent {
    t: f64,
    value: f64,
    slope: f64,
}

impl Tangent {
    /// Its least value over the whole rod.
    #[inline]
    fn lowest(&self) -> f64 {
        self.value + self.slope * if self.slope > 0.0 { -self.t } else { 1.0 - self.t }
    }

    #[inline]
    fn at(&self, t: f64) -> f64 {
        self.value + self.slope * (t - self.t)
    }
}

/// Where to cut next, and the tangents' value there, which is the least on the bracket; `None` at an end of
/// the rod, where g itself is least.
#[inline]
fn next_cut(low: &Option<Tangent>, high: &Option<Tangent>) -> Option<(f64, f64)> {
    match (low, high) {
        (Some(low), Some(high)) => {
            let meet = (high.at(0.0) - low.at(0.0)) / (low.slope - high.slope);
            // Rounding may carry the meeting point out of the bracket; its value is a bound nevertheless.
            Some((meet.clamp(low.t, high.t), low.at(meet)))
        }
        (Some(low), None) if low.t < 1.0 => Some((1.0, low.at(1.0))),
        (None, Some(high)) if high.t > 0.0 => Some((0.0, high.at(0.0))),
        _ => None,
    }
}
