//! Seven points of the set that do not lie in one hyperplane.

use super::{Point, dot};

/// Points nearer to the others' hyperplane than this make no simplex.
const FLAT: f64 = 1e-7;

/// Support points in turn, each as far as the set goes from the plane through those before; `None` where the
/// set is flat.
pub(super) fn first_simplex(support: &impl Fn(&Point) -> Point) -> Option<[Point; 7]> {
    let mut corners = [[0.0; 6]; 7];
    corners[0] = support(&[1.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    let mut basis = [[0.0; 6]; 6];
    for k in 0..6 {
        let (corner, rise) = farthest_off(support, &corners[0], &basis[..k])?;
        corners[k + 1] = corner;
        basis[k] = rise;
    }
    Some(corners)
}

/// The support point farthest from the plane through `origin` along `basis`, looking both ways along what the
/// basis leaves of each axis.
fn farthest_off(
    support: &impl Fn(&Point) -> Point,
    origin: &Point,
    basis: &[Point],
) -> Option<(Point, Point)> {
    let mut best: Option<(f64, Point, Point)> = None;
    for axis in 0..6 {
        let mut w = [0.0; 6];
        w[axis] = 1.0;
        let w = rise(w, basis);
        for sign in [1.0, -1.0] {
            let point = support(&w.map(|x| sign * x));
            let off = rise(std::array::from_fn(|i| point[i] - origin[i]), basis);
            let distance = dot(&off, &off).sqrt();
            if best.is_none_or(|(most, ..)| distance > most) {
                best = Some((distance, point, off.map(|x| x / distance)));
            }
        }
    }
    best.filter(|(distance, ..)| *distance > FLAT).map(|(_, point, rise)| (point, rise))
}

/// What the basis leaves of `v`.
fn rise(mut v: Point, basis: &[Point]) -> Point {
    for q in basis.iter().chain(basis) {
        let c = dot(&v, q);
        v.iter_mut().zip(q).for_each(|(v, q)| *v -= c * q);
    }
    v
}
