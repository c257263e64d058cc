//! Three point contacts with friction in closed form.
//!
//! Three forces in equilibrium at three points lie in the points' plane, along the triangle's edges: f0 = a01
//! u01 + a02 u02, f1 = -a01 u01 + a12 u12, f2 = -a02 u02 - a12 u12. The plane cuts each cone in an angle, so
//! closure is a homogeneous system of six strict inequalities in (a01, a02, a12). After Nguyen, "Constructing
//! force-closure grasps", IJRR 1988, and Li, Liu, Cai, "On computing three-finger force-closure grasps of 2-D
//! and 3-D objects", T-RA 2003; the enumeration of rays is ours.

use crate::contacts::ScaledContact;
use regrasp_api::Vec3;

/// Conditions that hold by less than this are left to the general test, which finds a proof for its verdict.
const COMFORT: f64 = 1e-3;
/// Conditions that fail by less than this are left to it too.
const CLEAR: f64 = 1e-6;

/// Triangles farther from the origin than this times their size are left to the general test, which centres
/// them.
const FAR: f64 = 1e6;
/// Least area (twice) of a triangle over the square of its longest side; a regular one has 0.87.
const SHAPELY: f64 = 0.005;

/// Whether three point contacts with friction are force closure; `None` near the boundary and for other
/// grasps.
///
/// The contacts may be given in any unit of length and about any point not far away.
pub(crate) fn three_points(contacts: &[ScaledContact; 3]) -> Option<bool> {
    let [c0, c1, c2] = contacts;
    if contacts.iter().any(|c| c.mu <= 0.0 || c.gamma > 0.0) {
        return None;
    }
    let (u01, u02, u12) = (c1.r - c0.r, c2.r - c0.r, c2.r - c1.r);
    let normal = u01.cross(&u02);
    let area = normal.norm();
    let longest = larger(larger(u01.norm_squared(), u02.norm_squared()), u12.norm_squared());
    if area <= SHAPELY * longest || c0.r.norm_squared() > FAR * FAR * longest {
        return None;
    }
    let m = normal / area;
    let mut conditions = [Vec3::zeros(); 6];
    for (i, (contact, from, to)) in
        [(c0, u01, u02), (c1, -u01, u12), (c2, -u02, -u12)].into_iter().enumerate()
    {
        match edges(contact, &m)? {
            Section::Empty => return Some(false),
            Section::Angle(e) => {
                for (k, e) in e.iter().enumerate() {
                    conditions[2 * i + k] = in_edges(i, e.dot(&from), e.dot(&to));
                }
            }
        }
    }
    feasible(&conditions)
}

/// The larger of two numbers that are not NaN, in one instruction.
#[inline(always)]
fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// The plane's section of a cone.
enum Section {
    /// The apex alone.
    Empty,
    /// All f in the plane with e·f ≥ 0 for both unit vectors.
    Angle([Vec3; 2]),
}

fn edges(contact: &ScaledContact, m: &Vec3) -> Option<Section> {
    let n_p = contact.n - m * contact.n.dot(m);
    let square = n_p.norm_squared();
    let excess = square * (1.0 + contact.mu * contact.mu) - 1.0;
    if excess < COMFORT {
        return (excess < -CLEAR).then_some(Section::Empty);
    }
    // Half-angle φ of the section: cos φ = cos θ / |n_p|, so tan φ = sqrt(excess). The conditions' vectors
    // are at φ + 90° to the axis.
    let sin = (excess / (1.0 + excess)).sqrt();
    let cos = (1.0 / (1.0 + excess)).sqrt();
    let axis = n_p / square.sqrt();
    let side = m.cross(&axis);
    Some(Section::Angle([axis * sin + side * cos, axis * sin - side * cos]))
}

/// A condition on the force at vertex i as a unit vector in the space of (a01, a02, a12).
fn in_edges(vertex: usize, first: f64, second: f64) -> Vec3 {
    let condition = match vertex {
        0 => Vec3::new(first, second, 0.0),
        1 => Vec3::new(first, 0.0, second),
        _ => Vec3::new(0.0, first, second),
    };
    condition / condition.norm().max(f64::MIN_POSITIVE)
}

/// Whether some a has w·a > 0 for all six w; `None` where it is too close to say.
///
/// The cone {w·a ≥ 0} is spanned by its extreme rays, each the cross product of two w; the sum of those is
/// inside if anything is.
fn feasible(w: &[Vec3; 6]) -> Option<bool> {
    let mut rays = Rays { inside: Vec3::zeros(), clear: true };
    // The pair at vertex k leaves out coordinate 2 - k, so every product has zeros that need no
    // multiplication.
    for vertex in 0..3 {
        let (i, j) = (2 * vertex, 2 * vertex + 1);
        let mut ray = Vec3::zeros();
        let (a, b) = COORDINATES[vertex];
        let size = w[i][a] * w[j][b] - w[i][b] * w[j][a];
        // The sign of e_a × e_b is that of the missing axis, but for vertex 1, where (x, z) turns the other
        // way round.
        ray[2 - vertex] = if vertex == 1 { -size } else { size };
        rays.take(w, ray, i, j);
    }
    for (i, j) in [(0, 2), (0, 3), (1, 2), (1, 3)] {
        let (p, q, u, v) = (w[i].x, w[i].y, w[j].x, w[j].z);
        rays.take(w, Vec3::new(q * v, -p * v, -q * u), i, j);
    }
    for (i, j) in [(0, 4), (0, 5), (1, 4), (1, 5)] {
        let (p, q, u, v) = (w[i].x, w[i].y, w[j].y, w[j].z);
        rays.take(w, Vec3::new(q * v, -p * v, p * u), i, j);
    }
    for (i, j) in [(2, 4), (2, 5), (3, 4), (3, 5)] {
        let (p, q, u, v) = (w[i].x, w[i].z, w[j].y, w[j].z);
        rays.take(w, Vec3::new(-q * u, -p * v, p * u), i, j);
    }
    if rays.clear {
        return Some(false);
    }
    let bound = COMFORT * rays.inside.norm();
    (bound > 0.0 && (0..6).all(|k| value(w, k, &rays.inside) > bound)).then_some(true)
}

/// The two coordinates that a vertex's conditions speak of.
const COORDINATES: [(usize, usize); 3] = [(0, 1), (0, 2), (1, 2)];

/// w_k·a without the coordinate that w_k leaves out.
#[inline(always)]
fn value(w: &[Vec3; 6], k: usize, a: &Vec3) -> f64 {
    let (p, q) = COORDINATES[k / 2];
    w[k][p] * a[p] + w[k][q] * a[q]
}

/// What the pairs' rays say together.
struct Rays {
    /// The sum of the rays, or of their opposites, that keep all conditions.
    inside: Vec3,
    /// Whether every ray clearly breaks some condition, and so does its opposite.
    clear: bool,
}

impl Rays {
    /// Takes in the ray of conditions i and j.
    #[inline(always)]
    fn take(&mut self, w: &[Vec3; 6], ray: Vec3, i: usize, j: usize) {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for k in 0..6 {
            if k != i && k != j {
                let d = value(w, k, &ray);
                low = -larger(-low, -d);
                high = larger(high, d);
            }
        }
        // Without branches: which rays are inside is as good as random.
        let sign = f64::from(u8::from(low >= 0.0)) - f64::from(u8::from((low < 0.0) & (high <= 0.0)));
        self.inside += ray * sign;
        self.clear &= (low < -CLEAR) & (high > CLEAR);
    }
}

#[cfg(test)]
mod tests {
    use super::super::newton::{Outcome, Search};
    use super::*;
    use crate::contacts::ScaledGrasp;
    use regrasp_api::{Cone, FingerIndex, Grasp, GraspContact, Random};

    fn three_points(grasp: &ScaledGrasp) -> Option<bool> {
        super::three_points(grasp.contacts().first_chunk().unwrap())
    }

    fn random_grasp(random: &mut Random, mu: f64) -> ScaledGrasp {
        let mut grasp = Grasp::new(Vec3::zeros());
        for finger in 0..3 {
            let p_OC = random.direction() * random.range(0.5, 1.5);
            let n_O = (p_OC + random.direction() * random.range(0.0, 1.0)).normalize();
            let cone = Cone::Elliptic { mu, gamma: 0.0 };
            grasp.push(GraspContact { finger: FingerIndex(finger), p_OC, n_O, cone });
        }
        ScaledGrasp::gather(&grasp, None, "test").unwrap()
    }

    #[test]
    fn agrees_with_the_general_search_and_leaves_it_little() {
        let mut random = Random::from_key(3, 0, 0, 0);
        let (mut closed, mut left) = (0, 0);
        for _ in 0..20_000 {
            let mu = random.range(0.1, 1.5);
            let grasp = random_grasp(&mut random, mu);
            let general = matches!(Search::new(&grasp, 1e-6).run(), Outcome::Closed(_));
            closed += usize::from(general);
            match three_points(&grasp) {
                Some(verdict) => assert_eq!(verdict, general, "{grasp:?}"),
                None => left += 1,
            }
        }
        assert!((1000..15_000).contains(&closed), "{closed} of 20000 closed: no test of both verdicts");
        assert!(left < 1000, "{left} of 20000 left to the general search");
    }

    #[test]
    fn other_grasps_are_left_to_the_general_search() {
        let mut random = Random::from_key(4, 0, 0, 0);
        let grasp = random_grasp(&mut random, 0.5);
        assert_eq!(three_points(&grasp.with_friction(0.5, 0.1)), None);
        assert_eq!(three_points(&grasp.with_friction(0.0, 0.0)), None);
    }

    #[test]
    fn an_equilateral_grasp_closes_above_the_critical_friction_only() {
        // Each force aims at the centroid, turned by at most the cone: from any friction on.
        let grasp = |tilt: f64| {
            let mut grasp = Grasp::new(Vec3::zeros());
            for finger in 0..3 {
                let angle = f64::from(finger) * std::f64::consts::TAU / 3.0;
                let p_OC = Vec3::new(angle.cos(), angle.sin(), 0.0);
                let n_O = p_OC * tilt.cos() + Vec3::z() * tilt.sin();
                let cone = Cone::Elliptic { mu: 0.5, gamma: 0.0 };
                grasp.push(GraspContact { finger: FingerIndex(finger as u8), p_OC, n_O, cone });
            }
            ScaledGrasp::gather(&grasp, None, "test").unwrap()
        };
        // The plane leaves the cones where the tilt reaches atan μ.
        let critical = 0.5_f64.atan();
        assert_eq!(three_points(&grasp(0.0)), Some(true));
        assert_eq!(three_points(&grasp(critical - 0.01)), Some(true));
        assert_eq!(three_points(&grasp(critical + 0.01)), Some(false));
    }
}
