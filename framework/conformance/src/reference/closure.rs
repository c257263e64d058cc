//! Force closure by linear programming over cones with many edges: slow, simple, and with a known error.
//!
//! A grasp is force closure where the origin lies strictly inside the hull of the wrenches at unit normal
//! force (Mishra, Schwartz, Sharir, "On the existence and synthesis of multifinger positive grips",
//! Algorithmica 1987). Inside a round cone lies one with m edges, around it another; where the inner one
//! closes the grasp does, and where the outer one does not the grasp does not.

use super::nonnegative::nonnegative_least_squares;
use nalgebra::Vector6;
use regrasp_api::{
    Assessment, CallError, Certificate, Cone, Context, Grasp, GraspContact, Hint, Slot, Stability,
    StabilityTest, Vec3, any_orthogonal,
};
use std::f64::consts::{PI, TAU};

/// Edges of the cones that stand for a round one, and points of the surface that stands for a soft finger's
/// ellipsoid.
const EDGES: usize = 32;
const POINTS: usize = 120;
/// By how much the outer surface of points is larger than the inner one, so that its hull holds the
/// ellipsoid.
const SWELL: f64 = 1.07;

/// What linear programming proves about a grasp.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Closure {
    /// Force closure.
    Closed,
    /// Not force closure.
    Open,
    /// Closer to the boundary than cones with edges can tell.
    Near,
}

/// Decides force closure, or says that it is too close.
pub fn closure(grasp: &Grasp<'_>) -> Closure {
    if positively_spans(&wrenches(grasp, false)).is_some() {
        return Closure::Closed;
    }
    if positively_spans(&wrenches(grasp, true)).is_none() { Closure::Open } else { Closure::Near }
}

/// Whether the contacts can give a force and a torque about the contacts' centroid, however large, inside
/// cones that are a little too wide: where not, nothing carries that load.
pub(crate) fn may_give(grasp: &Grasp<'_>, force: &Vec3, torque: &Vec3) -> bool {
    let (_, length) = center_and_length(grasp);
    let vectors: Vec<_> = wrenches(grasp, true).iter().map(|w| w.scaled).collect();
    let m = torque / length;
    let wish = Vector6::new(force.x, force.y, force.z, m.x, m.y, m.z);
    nonnegative_least_squares(&vectors, &wish).1.norm() <= 1e-7 * wish.norm()
}

/// One wrench that a contact can transmit at unit normal force: force, torque about the normal, force with
/// torque about the centroid.
struct Wrench {
    contact: usize,
    f_O: Vec3,
    torsion: f64,
    scaled: Vector6<f64>,
}

/// The centroid of the contacts, and the largest distance from it (m; 1 where that is zero).
pub(crate) fn center_and_length(grasp: &Grasp<'_>) -> (Vec3, f64) {
    let contacts = grasp.contacts();
    let center = contacts.iter().map(|c| c.p_OC).sum::<Vec3>() / contacts.len().max(1) as f64;
    let length = contacts.iter().map(|c| (c.p_OC - center).norm()).fold(0.0, f64::max);
    (center, if length > 0.0 { length } else { 1.0 })
}

fn wrenches(grasp: &Grasp<'_>, outer: bool) -> Vec<Wrench> {
    let (center, length) = center_and_length(grasp);
    let mut all = Vec::new();
    for (index, contact) in grasp.contacts().iter().enumerate() {
        let n = -contact.n_O;
        let (t1, t2) = tangents(&n);
        for [x, y, torsion] in slice(contact, outer) {
            let f_O = n + t1 * x + t2 * y;
            let m = ((contact.p_OC - center).cross(&f_O) + n * torsion) / length;
            let scaled = Vector6::new(f_O.x, f_O.y, f_O.z, m.x, m.y, m.z);
            all.push(Wrench { contact: index, f_O, torsion, scaled });
        }
    }
    all
}

/// The tangents of a contact's frame, from the inward normal.
pub(crate) fn tangents(n: &Vec3) -> (Vec3, Vec3) {
    let t1 = any_orthogonal(n);
    (t1, n.cross(&t1))
}

/// Points (tangential force, torsion) whose hull lies inside, or around, the slice of the cone at unit normal
/// force.
fn slice(contact: &GraspContact<'_>, outer: bool) -> Vec<[f64; 3]> {
    match &contact.cone {
        Cone::Polyhedral(edges) => {
            edges.iter().map(|e| [e.tangential[0], e.tangential[1], e.torsion]).collect()
        }
        Cone::Grained(grain) => {
            // The round slice of radius 1, stretched along and across.
            let (t1, t2) = tangents(&-contact.n_O);
            let round = Cone::Elliptic { mu: 1.0, gamma: grain.gamma };
            let [(a, along), (b, across)] = grain.at(&contact.n_O);
            let stretched = |[x, y, z]: [f64; 3]| {
                let f = a * (along * x) + b * (across * y);
                [f.dot(&t1), f.dot(&t2), z]
            };
            slice(&GraspContact { cone: round, ..contact.clone() }, outer)
                .into_iter()
                .map(stretched)
                .collect()
        }
        &Cone::Elliptic { mu: 0.0, gamma } => vec![[0.0, 0.0, gamma], [0.0, 0.0, -gamma]],
        &Cone::Elliptic { mu, gamma: 0.0 } => {
            let radius = if outer { mu / (PI / EDGES as f64).cos() } else { mu };
            let angles = (0..EDGES).map(|k| TAU * k as f64 / EDGES as f64);
            angles.map(|a| [radius * a.cos(), radius * a.sin(), 0.0]).collect()
        }
        &Cone::Elliptic { mu, gamma } => {
            let swell = if outer { SWELL } else { 1.0 };
            let scale = |u: Vec3| [swell * mu * u.x, swell * mu * u.y, swell * gamma * u.z];
            (0..POINTS).map(|k| scale(spiral(k))).collect()
        }
    }
}

/// Points spread evenly over the unit sphere along a spiral of the golden angle.
fn spiral(k: usize) -> Vec3 {
    let z = 1.0 - (2 * k + 1) as f64 / POINTS as f64;
    let (sin, cos) = (PI * (3.0 - 5.0_f64.sqrt()) * k as f64).sin_cos();
    let radius = (1.0 - z * z).sqrt();
    Vec3::new(radius * cos, radius * sin, z)
}

/// Weights ≥ 1 under which the wrenches balance, if there are any and the wrenches span all of space.
///
/// Weights 1 + s balance where s ≥ 0 combines the wrenches to minus their sum.
fn positively_spans(wrenches: &[Wrench]) -> Option<Vec<f64>> {
    let vectors: Vec<_> = wrenches.iter().map(|w| w.scaled).collect();
    let square = vectors.iter().fold(nalgebra::Matrix6::zeros(), |sum, v| sum + v * v.transpose());
    let eigenvalues = square.symmetric_eigenvalues();
    if eigenvalues.min() <= 1e-12 * eigenvalues.max() {
        return None;
    }
    let b: Vector6<f64> = -vectors.iter().sum::<Vector6<f64>>();
    let (s, remainder) = nonnegative_least_squares(&vectors, &b);
    let total: f64 = s.iter().sum();
    // Weights so uneven that the smallest is rounding prove nothing.
    let even = total < 1e6 * vectors.len() as f64;
    (remainder.norm() <= 1e-9 * vectors.len() as f64 && even).then(|| s.iter().map(|s| 1.0 + s).collect())
}

/// The reference stability test: force closure with cones of many edges, a proof with each yes.
#[derive(Clone, Copy, Debug, Default)]
pub struct EdgeClosure;

impl StabilityTest for EdgeClosure {
    fn test(
        &self,
        grasp: &Grasp<'_>,
        _: &mut Hint,
        context: &mut Context<'_>,
    ) -> Result<Stability, CallError> {
        context.count_call(Slot::StabilityTest);
        let closed = positively_spans(&wrenches(grasp, false)).is_some();
        Ok(if closed { Stability::Stable } else { Stability::Unstable })
    }

    fn assess(
        &self,
        grasp: &Grasp<'_>,
        _length: Option<f64>,
        _center_O: Option<Vec3>,
        _context: &mut Context<'_>,
    ) -> Result<Assessment, CallError> {
        let wrenches = wrenches(grasp, false);
        let Some(weights) = positively_spans(&wrenches) else {
            let (stability, certificate) = (Stability::Unstable, Certificate::None);
            return Ok(Assessment { stability, margin_lower: 0.0, margin_upper: 0.0, certificate });
        };
        let mut forces_O = vec![Vec3::zeros(); grasp.contacts().len()];
        let mut torsions = vec![0.0; forces_O.len()];
        for (wrench, weight) in wrenches.iter().zip(&weights) {
            forces_O[wrench.contact] += wrench.f_O * *weight;
            torsions[wrench.contact] += wrench.torsion * weight;
        }
        Ok(Assessment {
            stability: Stability::Stable,
            margin_lower: 0.0,
            margin_upper: f64::INFINITY,
            certificate: Certificate::InternalForce { forces_O, torsions },
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixtures::grasps::{self, Touch};

    fn verdict(touches: &[Touch]) -> Closure {
        closure(&grasps::grasp_of(touches))
    }

    #[test]
    fn closed_forms_agree() {
        // Three contacts on a great circle at 120°: closed for every μ > 0 that leaves the plane, here 0.5.
        assert_eq!(verdict(&grasps::equator(3, 0.5)), Closure::Closed);
        // Without friction a sphere can always be turned.
        assert_eq!(verdict(&grasps::equator(8, 0.0)), Closure::Open);
        for touches in grasps::never_closed() {
            assert_eq!(verdict(&touches), Closure::Open, "{touches:?}");
        }
        // Two soft fingers on one axis hold; without torsion they do not.
        let mut pair = grasps::equator(2, 0.5);
        assert_eq!(verdict(&pair), Closure::Open);
        pair.iter_mut().for_each(|touch| touch.gamma = 0.003);
        assert_eq!(verdict(&pair), Closure::Closed);
    }

    /// Two contacts on parallel planes a distance `h` apart and offset by `d` along them close, with a third,
    /// just where d/h < μ.
    #[test]
    fn the_critical_friction_of_an_offset_pair_is_bracketed() {
        let pair = |d: f64, mu: f64| {
            let side = |z: f64, x: f64| Touch {
                p: Vec3::new(x, 0.0, z),
                n: Vec3::new(0.0, 0.0, z.signum()),
                mu,
                gamma: 0.003,
            };
            [side(0.02, 0.5 * d), side(-0.02, -0.5 * d)]
        };
        assert_eq!(verdict(&pair(0.018, 0.5)), Closure::Closed);
        assert_eq!(verdict(&pair(0.022, 0.5)), Closure::Open);
    }
}
