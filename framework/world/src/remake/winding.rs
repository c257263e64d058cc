//! How often facets wind around a point, in a time that grows with the logarithm of their number.
//!
//! Far groups of facets count as one dipole (G. Barill, N. Dickson, R. Schmidt, D. Levin, A. Jacobson, "Fast
//! winding numbers for soups and clouds", SIGGRAPH 2018, of first order).

use regrasp_api::Vec3;
use std::f64::consts::PI;

/// Facets that are looked at one by one.
const FEW: usize = 8;
/// A group is far if it is farther off than this many of its radii.
const FAR: f64 = 2.3;

/// Facets in groups of groups.
pub(super) struct Winding {
    corners: Vec<[Vec3; 3]>,
    groups: Vec<Group>,
}

struct Group {
    center: Vec3,
    radius: f64,
    /// Sum of normals times areas.
    dipole: Vec3,
    /// Where its facets begin and end.
    range: (usize, usize),
    /// Its two halves; none where its facets are few.
    halves: Option<[usize; 2]>,
}

impl Winding {
    /// Of sound facets; `None` where there are none.
    pub fn new(vertices: &[Vec3], facets: &[[u32; 3]]) -> Option<Self> {
        let mut corners: Vec<[Vec3; 3]> =
            facets.iter().map(|facet| facet.map(|vertex| vertices[vertex as usize])).collect();
        let mut groups = Vec::new();
        let count = corners.len();
        (count > 0).then(|| group(&mut corners, 0, &mut groups))?;
        Some(Self { corners, groups })
    }

    /// The winding number at a point: about 1 inside, 0 outside.
    pub fn at(&self, p: &Vec3) -> f64 {
        let (mut open, mut sum) = (vec![0], 0.0);
        while let Some(index) = open.pop() {
            let group = &self.groups[index];
            let away = group.center - p;
            let distance = away.norm();
            if distance > FAR * group.radius {
                sum += group.dipole.dot(&away) / (distance * distance * distance);
            } else if let Some(halves) = group.halves {
                open.extend(halves);
            } else {
                sum += angle(&self.corners[group.range.0..group.range.1], p);
            }
        }
        sum / (4.0 * PI)
    }
}

/// Makes the group of some facets, which begin at `first` of all, and those in it; returns its place.
fn group(corners: &mut [[Vec3; 3]], first: usize, groups: &mut Vec<Group>) -> usize {
    let (mut area, mut center, mut dipole) = (0.0, Vec3::zeros(), Vec3::zeros());
    for [a, b, c] in corners.iter() {
        let n = (b - a).cross(&(c - a)) * 0.5;
        area += n.norm();
        center += (a + b + c) * (n.norm() / 3.0);
        dipole += n;
    }
    center /= area;
    let radius = corners.iter().flatten().map(|v| (v - center).norm()).fold(0.0, f64::max);
    let place = groups.len();
    let range = (first, first + corners.len());
    groups.push(Group { center, radius, dipole, range, halves: None });
    if corners.len() > FEW {
        let all = || corners.iter().map(|facet| facet.iter().sum::<Vec3>());
        let low = all().reduce(|a, b| a.inf(&b)).unwrap_or_default();
        let high = all().reduce(|a, b| a.sup(&b)).unwrap_or_default();
        let axis = (high - low).imax();
        let middle = corners.len() / 2;
        let key = |facet: &[Vec3; 3]| facet.iter().map(|v| v[axis]).sum::<f64>();
        corners.select_nth_unstable_by(middle, |a, b| key(a).total_cmp(&key(b)));
        let (some, others) = corners.split_at_mut(middle);
        groups[place].halves = Some([group(some, first, groups), group(others, first + middle, groups)]);
    }
    place
}

/// The solid angle of a few facets, positive where their backs are seen (van Oosterom and Strackee, "The
/// solid angle of a plane triangle", IEEE Trans. Biomed. Eng. 1983).
///
/// Half of each is the argument of a complex number; the argument of their product is the sum, but for whole
/// turns, which are counted.
fn angle(facets: &[[Vec3; 3]], p: &Vec3) -> f64 {
    let (mut re, mut im, mut turns) = (1.0, 0.0, 0.0);
    for facet in facets {
        let [a, b, c] = facet.map(|corner| corner - p);
        let (x, y, z) = (a.norm(), b.norm(), c.norm());
        let below = x * y * z + a.dot(&b) * z + b.dot(&c) * x + c.dot(&a) * y;
        let above = a.dot(&b.cross(&c));
        let before: f64 = im;
        (re, im) = (re * below - im * above, re * above + im * below);
        if before.signum() == above.signum() && before.signum() != im.signum() {
            turns += before.signum();
        }
    }
    2.0 * (im.atan2(re) + 2.0 * PI * turns)
}

#[cfg(test)]
mod tests {
    use super::*;
    use regrasp_api::Random;

    #[test]
    fn the_angle_of_facets_is_the_sum_of_each() {
        let mut random = Random::from_key(3, 0, 0, 0);
        let mut turned = 0;
        for _ in 0..2000 {
            // Facets all round the point, so that the sum goes beyond half a turn.
            let facet = |random: &mut Random| {
                let facet = [0; 3].map(|_| random.direction() * 0.02);
                let [a, b, c] = facet;
                if random.unit() < 0.8 && a.dot(&b.cross(&c)) < 0.0 { [a, c, b] } else { facet }
            };
            let facets: [_; FEW] = std::array::from_fn(|_| facet(&mut random));
            let p = random.direction() * 0.003;
            let sum: f64 = facets.iter().map(|facet| angle(std::slice::from_ref(facet), &p)).sum();
            assert!((angle(&facets, &p) - sum).abs() < 1e-9, "{sum}");
            turned += u32::from(sum.abs() > 2.0 * PI);
        }
        assert!(turned > 100, "{turned}");
    }
}
