//! The slice of a polyhedral cone at unit normal force and no torsion: a convex polygon round the normal, and
//! what of a force it allows.

use super::force::{Contact, Force};
use regrasp_api::{Cone, Vec3, tangents};

/// Tangential forces below this, of the normal one, are rounding.
const ROUNDING: f64 = 1e-9;

/// A polygon as half-planes a·t ≤ b, with unit normals a and b ≥ 0, in the coordinates of [`tangents`] of the
/// inward normal.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Slice {
    sides: Vec<([f64; 2], f64)>,
}

impl Slice {
    /// `None` where the cone is not polyhedral, has no such forces, or does not hold the one along the
    /// normal.
    pub(super) fn of(cone: &Cone<'_>) -> Option<Self> {
        let Cone::Polyhedral(edges) = cone.without_torsion() else { return None };
        let corners = hull(edges.iter().map(|edge| edge.tangential).collect());
        let sides = match corners[..] {
            [] => return None,
            [p] => sides_of(&[[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]], &p),
            [p, q] => {
                let a = unit([q[0] - p[0], q[1] - p[1]]);
                let across = [-a[1], a[0]];
                let behind = sides_of(&[[-a[0], -a[1]]], &p);
                sides_of(&[a, across, [-across[0], -across[1]]], &q).into_iter().chain(behind).collect()
            }
            _ => {
                let next = corners.iter().cycle().skip(1);
                let each = corners.iter().zip(next);
                each.flat_map(|(p, q)| sides_of(&[unit([q[1] - p[1], p[0] - q[0]])], p)).collect()
            }
        };
        let sound = |(a, b): &([f64; 2], f64)| a.iter().all(|x| x.is_finite()) && *b >= -ROUNDING;
        let sides: Vec<_> = Some(sides).filter(|sides: &Vec<_>| sides.iter().all(sound))?;
        Some(Self { sides: sides.into_iter().map(|(a, b)| (a, b.max(0.0))).collect() })
    }

    /// The share of the friction that a force without torsion needs, its tangential part in N; infinite where
    /// none would do.
    pub(super) fn share(&self, contact: &Contact, force: &Force) -> f64 {
        if force.normal <= 0.0 {
            return f64::INFINITY;
        }
        let t = coordinates(contact, &(force.tangential / force.normal));
        let each = self.sides.iter().map(|(a, b)| {
            let along = dot(a, &t);
            if along <= ROUNDING { 0.0 } else { along / b }
        });
        each.fold(0.0, f64::max)
    }

    /// The room of a force to each side and to no pressing at all (N), above zero inside, and how it grows
    /// with each of three changes of the force.
    pub(super) fn rooms(&self, contact: &Contact, force: &Force, changes: [&Force; 3]) -> Vec<(f64, Vec3)> {
        let tangents = tangents(&contact.n);
        let of = move |force: &Force, (a, b): &([f64; 2], f64)| {
            b * force.normal - dot(a, &tangents.map(|tangent| tangent.dot(&force.tangential)))
        };
        let pressing = (force.normal, Vec3::from(changes.map(|change| change.normal)));
        let sides = self.sides.iter();
        let sides = sides.map(|side| (of(force, side), Vec3::from(changes.map(|change| of(change, side)))));
        sides.chain([pressing]).collect()
    }
}

fn coordinates(contact: &Contact, t: &Vec3) -> [f64; 2] {
    tangents(&contact.n).map(|tangent| tangent.dot(t))
}

fn dot(a: &[f64; 2], b: &[f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

fn unit(a: [f64; 2]) -> [f64; 2] {
    let length = a[0].hypot(a[1]);
    a.map(|x| x / length)
}

/// The half-planes with these normals through a point.
fn sides_of(normals: &[[f64; 2]], p: &[f64; 2]) -> Vec<([f64; 2], f64)> {
    normals.iter().map(|a| (*a, dot(a, p))).collect()
}

/// The corners of the convex hull, counterclockwise (A. M. Andrew, "Another efficient algorithm for convex
/// hulls in two dimensions", IPL 1979).
fn hull(mut points: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    points.sort_by(|p, q| p[0].total_cmp(&q[0]).then(p[1].total_cmp(&q[1])));
    points.dedup();
    if points.len() < 3 {
        return points;
    }
    let mut corners = chain(points.iter());
    corners.pop();
    corners.extend(chain(points.iter().rev()));
    corners.pop();
    corners
}

fn chain<'p>(points: impl Iterator<Item = &'p [f64; 2]>) -> Vec<[f64; 2]> {
    let mut corners: Vec<[f64; 2]> = Vec::new();
    for &p in points {
        while let [.., a, b] = corners[..]
            && (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]) <= 0.0
        {
            corners.pop();
        }
        corners.push(p);
    }
    corners
}

#[cfg(test)]
mod tests {
    use super::*;
    use regrasp_api::ConeEdge;

    fn slice(edges: &[[f64; 3]]) -> Option<Slice> {
        let edge = |[x, y, torsion]: &[f64; 3]| ConeEdge { tangential: [*x, *y], torsion: *torsion };
        Slice::of(&Cone::Polyhedral(edges.iter().map(edge).collect()))
    }

    /// A contact on top of an object, and the force on it with these tangential coordinates.
    fn force(normal: f64, [x, y]: [f64; 2]) -> (Contact, Force) {
        let n = -Vec3::z();
        let contact = Contact::new(Vec3::z(), n, &Cone::Elliptic { mu: 1.0, gamma: 0.0 }, 1.0);
        let [t1, t2] = tangents(&n);
        (contact.expect("it is elliptic"), Force { normal, tangential: t1 * x + t2 * y, spin: 0.0 })
    }

    fn share(slice: &Slice, normal: f64, t: [f64; 2]) -> f64 {
        let (contact, force) = force(normal, t);
        slice.share(&contact, &force)
    }

    #[test]
    fn a_diamond_allows_what_lies_within_it() {
        // The inner points are corners of nothing.
        let diamond = [[0.5, 0.0, 0.0], [0.0, 0.5, 0.0], [-0.5, 0.0, 0.0], [0.0, -0.5, 0.0], [0.1, 0.1, 0.0]];
        let slice = slice(&diamond).unwrap();
        for (t, needed) in [([1.0, 0.0], 1.0), ([0.5, 0.5], 1.0), ([0.5, 0.0], 0.5), ([-0.5, 1.0], 1.5)] {
            let found = share(&slice, 2.0, t);
            assert!((found - needed).abs() < 1e-12, "{t:?}: {found}");
        }
        assert_eq!(share(&slice, 2.0, [0.0, 0.0]), 0.0);
        assert_eq!(share(&slice, -1.0, [0.0, 0.0]), f64::INFINITY);
        let ((contact, now), (_, more)) = (force(2.0, [0.2, 0.0]), force(0.0, [0.2, 0.2]));
        let less = Force { normal: -1.0, ..Force::default() };
        let rooms: Vec<_> = slice.rooms(&contact, &now, [&more, &less, &Force::default()]);
        let least = |k: usize| {
            let each = rooms.iter().filter(|(_, rates)| rates[k] < 0.0).map(|(room, rates)| -room / rates[k]);
            each.fold(f64::INFINITY, f64::min)
        };
        // As far as the side x + y = 0.5, and with less pressing until 0.2 is all that friction gives.
        assert!((least(0) - 2.0).abs() < 1e-12 && (least(1) - 1.6).abs() < 1e-12, "{rooms:?}");
        assert_eq!(least(2), f64::INFINITY);
        let outside = force(1.0, [0.6, 0.0]).1;
        assert!(slice.rooms(&contact, &outside, [&more; 3]).iter().any(|(room, _)| *room < 0.0));
    }

    #[test]
    fn flat_cones_and_cones_with_torsion_are_exact() {
        let line = slice(&[[0.4, 0.0, 0.0], [-0.2, 0.0, 0.0]]).unwrap();
        assert!((share(&line, 1.0, [0.4, 0.0]) - 1.0).abs() < 1e-12);
        assert!((share(&line, 1.0, [-0.4, 0.0]) - 2.0).abs() < 1e-12);
        assert_eq!(share(&line, 1.0, [0.0, 0.1]), f64::INFINITY);
        let point = slice(&[[0.0, 0.0, 0.0]]).unwrap();
        assert_eq!((share(&point, 1.0, [0.0, 0.0]), share(&point, 1.0, [0.1, 0.0])), (0.0, f64::INFINITY));
        // No torque is left of edges that turn opposite ways: half of each.
        let twisted = [[0.6, 0.0, 0.01], [0.0, 0.0, -0.01], [-0.3, 0.3, 0.0], [-0.3, -0.3, 0.0]];
        assert!((share(&slice(&twisted).unwrap(), 1.0, [0.3, 0.0]) - 1.0).abs() < 1e-12);
        // Not round the normal; no force without torsion; no number.
        assert!(slice(&[[0.2, 0.1, 0.0], [0.3, -0.1, 0.0], [0.4, 0.0, 0.0]]).is_none());
        assert!(slice(&[[0.2, 0.0, 0.01], [-0.2, 0.0, 0.01]]).is_none());
        assert!(slice(&[[f64::NAN, 0.0, 0.0], [0.2, 0.1, 0.0], [-0.3, 0.0, 0.0]]).is_none());
    }
}
