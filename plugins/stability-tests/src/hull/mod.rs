//! How deep the origin lies in the convex hull of a set in R⁶ that is known by its support function: an
//! expanding polytope.
//!
//! After van den Bergen, "Proximity queries and penetration depth computation on 3D game objects", GDC 2001,
//! in six dimensions: the facet of an inner polytope that is nearest to the origin is pushed out to the set's
//! support along its normal, by the beneath-beyond step of Barber, Dobkin, Huhdanpaa, "The Quickhull
//! algorithm for convex hulls", TOMS 1996. At every moment the nearest facet bounds the depth from below and
//! the supports seen so far bound it from above.

mod polytope;
mod simplex;

use polytope::Polytope;
use simplex::first_simplex;

/// A point of R⁶.
pub(crate) type Point = [f64; 6];

/// Points after which a search ends with the bracket that it has.
const MAX_POINTS: usize = 1500;
/// Facets after which it ends.
const MAX_FACETS: usize = 400_000;
/// Each point is moved by about this much, so that no seven lie in one hyperplane; the bracket allows for it.
const JOGGLE: f64 = 1e-8;

/// Bounds of the depth of the origin: the distance to the hull's boundary, 0 or less outside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Depth {
    pub lower: f64,
    pub upper: f64,
}

/// When a search may end.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Until {
    /// Lower and upper bound differ by at most this share.
    Gap(f64),
    /// The depth is known to be above this one or at most this one.
    Decided(f64),
}

impl Until {
    fn reached(self, depth: &Depth) -> bool {
        match self {
            Self::Gap(share) => depth.upper - depth.lower <= share * depth.upper,
            Self::Decided(bound) => depth.lower > bound || depth.upper <= bound,
        }
    }
}

/// Brackets the depth of the origin in the hull of the set whose farthest point in direction `w` is
/// `support(w)`.
///
/// Not closed (the origin outside or on the boundary) gives `upper ≤ 0` up to rounding.
pub(crate) fn depth(support: impl Fn(&Point) -> Point, until: Until) -> Depth {
    let Some(simplex) = first_simplex(&support) else { return Depth { lower: 0.0, upper: 0.0 } };
    let mut polytope = Polytope::new(simplex.map(|point| joggled(point, 0)));
    let mut upper = f64::INFINITY;
    while let Some((facet, normal, offset)) = polytope.nearest() {
        let point = support(&normal);
        let reach = dot(&point, &normal);
        upper = upper.min(reach);
        let depth = Depth { lower: (offset - 4.0 * JOGGLE).min(upper), upper };
        let exhausted = polytope.point_count() >= MAX_POINTS || polytope.facet_count() >= MAX_FACETS;
        // What is within rounding of the facet is the facet.
        let settled = reach - offset <= 4.0 * JOGGLE;
        if upper <= 4.0 * JOGGLE || until.reached(&depth) || settled || exhausted {
            return depth;
        }
        if !polytope.push_out(facet, joggled(point, polytope.point_count())) {
            return depth;
        }
    }
    Depth { lower: 0.0, upper }
}

/// The point moved a little, by a pattern that depends on `index` and the coordinate alone.
fn joggled(point: Point, index: usize) -> Point {
    std::array::from_fn(|k| {
        let phase = (index * 6 + k) as f64 * 0.618_033_988_749_894_9 + point[k] * 1e3;
        point[k] + JOGGLE * (2.0 * (phase - phase.floor()) - 1.0) * 0.4
    })
}

/// The Euclidean product.
#[inline]
pub(crate) fn dot(a: &Point, b: &Point) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use regrasp_api::Random;

    fn farthest(points: &[Point], w: &Point) -> Point {
        *points.iter().max_by(|a, b| dot(a, w).total_cmp(&dot(b, w))).unwrap()
    }

    fn axes(shift: &Point) -> Vec<Point> {
        let corner =
            |k: usize, sign: f64| std::array::from_fn(|i| shift[i] + if i == k { sign } else { 0.0 });
        (0..6).flat_map(|k| [corner(k, 1.0), corner(k, -1.0)]).collect()
    }

    #[test]
    fn a_cross_polytope_is_as_deep_as_its_facets() {
        let points = axes(&[0.0; 6]);
        let found = depth(|w| farthest(&points, w), Until::Gap(1e-4));
        let exact = 1.0 / 6.0_f64.sqrt();
        assert!(found.lower <= exact && exact <= found.upper * (1.0 + 1e-6), "{found:?}");
        assert!(found.upper - found.lower < 1e-4);
        let off = axes(&[0.1, 0.1, 0.1, 0.1, 0.1, -0.1]);
        let found = depth(|w| farthest(&off, w), Until::Gap(1e-4));
        assert!((found.upper - (1.0 - 0.6) / 6.0_f64.sqrt()).abs() < 1e-6, "{found:?}");
    }

    #[test]
    fn a_cube_is_as_deep_as_its_half_edge() {
        let found = depth(|w| w.map(|x| if x < 0.0 { -0.7 } else { 0.7 }), Until::Gap(1e-3));
        assert!((found.upper - 0.7).abs() < 1e-6 && found.lower > 0.699, "{found:?}");
    }

    #[test]
    fn an_origin_outside_or_a_flat_set_has_no_depth() {
        let outside = axes(&[0.9, 0.9, 0.0, 0.0, 0.0, 0.0]);
        assert!(depth(|w| farthest(&outside, w), Until::Gap(0.01)).upper <= 0.0);
        let mut flat = axes(&[0.0; 6]);
        flat.iter_mut().for_each(|p| p[5] = 0.0);
        assert_eq!(depth(|w| farthest(&flat, w), Until::Gap(0.01)), Depth { lower: 0.0, upper: 0.0 });
    }

    #[test]
    fn random_hulls_are_bracketed_and_decided() {
        let mut random = Random::from_key(8, 0, 0, 0);
        for _ in 0..20 {
            let points: Vec<Point> = (0..30).map(|_| std::array::from_fn(|_| random.normal())).collect();
            let exact = depth(|w| farthest(&points, w), Until::Gap(1e-6));
            let loose = depth(|w| farthest(&points, w), Until::Gap(0.2));
            assert!(loose.lower <= exact.upper + 1e-6 && exact.lower <= loose.upper + 1e-6);
            if exact.lower > 0.0 {
                for factor in [0.8, 1.2] {
                    let bound = factor * exact.lower;
                    let decided = depth(|w| farthest(&points, w), Until::Decided(bound));
                    assert_eq!(decided.lower > bound, factor < 1.0);
                }
                // No direction reaches less far than the depth.
                for _ in 0..2000 {
                    let w: Point = std::array::from_fn(|_| random.normal());
                    let size = dot(&w, &w).sqrt();
                    assert!(dot(&farthest(&points, &w), &w) >= exact.lower * size);
                }
            }
        }
    }
}
