//! Three point contacts with friction in closed form.
//!
//! Three forces in equilibrium at three points lie in the points' plane, along the triangle's edges: f0 = a01 u01 + a02 u02,
//! f1 = -a01 u01 + a12 u12, f2 = -a02 u02 - a12 u12. The plane cuts each cone in an angle, so closure is a homogeneous system of six
//! strict inequalities in (a01, a02, a12). After Nguyen, "Constructing force-closure grasps", IJRR 1988, and Li, Liu, Cai, "On computing
//! three-finger force-closure grasps of 2-D and 3-D objects", T-RA 2003; the enumeration of rays is ours.

use crate::contacts::{ScaledContact, ScaledGrasp};
use regrasp_api::Vec3;

/// Conditions that hold by less than this are left to the general test, which finds a proof for its verdict.
const COMFORT: f64 = 1e-3;
/// Conditions that fail by less than this are left to it too.
const CLEAR: f64 = 1e-6;

/// Whether three point contacts with friction are force closure; `None` near the boundary and for other grasps.
pub(crate) fn three_points(grasp: &ScaledGrasp) -> Option<bool> {
    let [c0, c1, c2] = grasp.contacts() else { return None };
    if [c0, c1, c2].iter().any(|c| c.mu <= 0.0 || c.gamma > 0.0) {
        return None;
    }
    let (u01, u02, u12) = (c1.r - c0.r, c2.r - c0.r, c2.r - c1.r);
    let normal = u01.cross(&u02);
    let area = normal.norm();
    // Scaled to a largest distance of 1 from the centroid, a well-shaped triangle has an area of about 2.
    if area < 0.01 {
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
    // Half-angle φ of the section: cos φ = cos θ / |n_p|, so tan φ = sqrt(excess). The conditions' vectors are at φ + 90° to the axis.
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
/// The cone {w·a ≥ 0} is spanned by its extreme rays, each the cross product of two w; the sum of those is inside if anything is.
fn feasible(w: &[Vec3; 6]) -> Option<bool> {
    let mut inside = Vec3::zeros();
    let mut clear = true;
    for i in 0..6 {
        for j in i + 1..6 {
            let ray = w[i].cross(&w[j]);
            let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
            for (k, w_k) in w.iter().enumerate() {
                if k != i && k != j {
                    let d = ray.dot(w_k);
                    low = low.min(d);
                    high = high.max(d);
                }
            }
            if low >= 0.0 {
                inside += ray;
            } else if high <= 0.0 {
                inside -= ray;
            }
            clear &= low < -CLEAR && high > CLEAR;
        }
    }
    if clear {
        return Some(false);
    }
    let bound = COMFORT * inside.norm();
    (bound > 0.0 && w.iter().all(|w_k| w_k.dot(&inside) > bound)).then_some(true)
}

#[cfg(test)]
mod tests {
    use super::super::newton::{Outcome, Search};
    use super::*;
    use regrasp_api::{Cone, FingerIndex, Grasp, GraspContact, Random};

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
