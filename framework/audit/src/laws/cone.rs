//! Laws of cones.

use super::{Kept, ensure};
use regrasp_api::{Cone, Vec3, tangents};

/// How far a cone may stand out beyond another by rounding alone (no unit).
const ROUNDING: f64 = 1e-9;

/// The largest value over the cone's slice at unit normal force of the product with `w` = (t1, t2, torsion /
/// m), for a contact with the outward unit normal `n_O`.
pub fn support(cone: &Cone<'_>, n_O: &Vec3, w: &Vec3) -> f64 {
    match cone {
        Cone::Grained(grain) => {
            let ([t1, t2], (least, g)) = (tangents(&-n_O), grain.spread(n_O));
            let more = g.dot(&(t1 * w.x + t2 * w.y));
            let tangential = least * least * (w.x * w.x + w.y * w.y) + more * more;
            (tangential + (grain.gamma * w.z).powi(2)).sqrt()
        }
        Cone::Elliptic { mu, gamma } => (mu * mu * (w.x * w.x + w.y * w.y) + (gamma * w.z).powi(2)).sqrt(),
        Cone::Polyhedral(edges) => {
            let value = |t: [f64; 2], torsion: f64| t[0] * w.x + t[1] * w.y + torsion * w.z;
            edges.iter().map(|e| value(e.tangential, e.torsion)).fold(f64::NEG_INFINITY, f64::max)
        }
    }
}

/// Directions over a cone's slice: round the tangents, along the normal's torque, and between.
pub fn directions() -> impl Iterator<Item = Vec3> {
    let ring = (0..16).map(|k| (std::f64::consts::TAU * f64::from(k) / 16.0).sin_cos());
    let level = ring.clone().map(|(sin, cos)| Vec3::new(cos, sin, 0.0));
    // Torsion is a length: 100 per metre makes it weigh as much as friction for contacts of some millimetres.
    let tilted = ring.flat_map(|(sin, cos)| [100.0, -100.0].map(|z| Vec3::new(cos, sin, z)));
    level.chain(tilted).chain([Vec3::z(), -Vec3::z()])
}

/// Law `cone-valid`: finite, not empty, and holding the force along the normal.
pub fn cone_valid(cone: &Cone<'_>, n_O: &Vec3) -> Kept {
    let finite = match cone {
        Cone::Elliptic { mu, gamma } => mu.is_finite() && gamma.is_finite() && *mu >= 0.0 && *gamma >= 0.0,
        Cone::Grained(grain) => {
            let numbers = || [grain.mu[0], grain.mu[1], grain.gamma].into_iter();
            let axis = grain.axis_O.norm();
            numbers().all(|x| x.is_finite() && x >= 0.0) && axis.is_finite() && axis > 0.0
        }
        Cone::Polyhedral(edges) => {
            let finite = |x: &f64| x.is_finite();
            !edges.is_empty()
                && edges.iter().all(|e| e.tangential.iter().all(finite) && e.torsion.is_finite())
        }
    };
    ensure("cone-valid", finite, || format!("{cone:?} is not finite, negative, or has no edge"))?;
    let outside = directions().find(|w| support(cone, n_O, w) < -ROUNDING);
    ensure("cone-valid", outside.is_none(), || format!("{cone:?} does not hold the force along the normal"))
}

/// Law `cone-within-friction`: tangential forces at most `mu` times the normal one.
pub fn cone_within_friction(cone: &Cone<'_>, mu: f64) -> Kept {
    let reach = match cone {
        Cone::Elliptic { mu, .. } => *mu,
        Cone::Grained(grain) => grain.mu[0].max(grain.mu[1]),
        Cone::Polyhedral(edges) => {
            edges.iter().map(|e| e.tangential[0].hypot(e.tangential[1])).fold(0.0, f64::max)
        }
    };
    ensure("cone-within-friction", reach <= mu + ROUNDING, || {
        format!("tangential forces up to {reach:.4} of the normal one at μ = {mu:.4}")
    })
}

/// `law`: `inner` reaches no further than `outer` in any direction.
pub fn cone_inside(law: &'static str, n_O: &Vec3, inner: &Cone<'_>, outer: &Cone<'_>) -> Kept {
    let reach = |w: &Vec3| (support(inner, n_O, w), support(outer, n_O, w));
    let out = directions().find(|w| {
        let (inner, outer) = reach(w);
        inner > outer + ROUNDING
    });
    match out {
        None => Ok(()),
        Some(w) => {
            let (inner, outer) = reach(&w);
            let along = w.as_slice();
            super::broken(law, format!("along {along:.2?} it reaches {inner:.5}, and {outer:.5} is allowed"))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use regrasp_api::ConeEdge;

    #[test]
    fn cones_that_cannot_be_are_told() {
        let valid = |cone: Cone<'_>| cone_valid(&cone, &Vec3::z());
        let edge = |x, y| ConeEdge { tangential: [x, y], torsion: 0.0 };
        assert!(valid(Cone::Elliptic { mu: 0.5, gamma: 0.0 }).is_ok());
        assert!(valid(Cone::Elliptic { mu: f64::NAN, gamma: 0.0 }).is_err());
        assert!(valid(Cone::Polyhedral(Vec::new().into())).is_err());
        // All edges on one side of the normal.
        assert!(valid(Cone::Polyhedral(vec![edge(0.2, 0.1), edge(0.3, -0.1)].into())).is_err());
        assert!(valid(Cone::grained(&Vec3::x(), [0.8, 0.2], 0.002)).is_ok());
        assert!(valid(Cone::grained(&Vec3::zeros(), [0.8, 0.2], 0.002)).is_err());
        assert!(valid(Cone::grained(&Vec3::x(), [0.8, -0.2], 0.0)).is_err());
    }

    #[test]
    fn a_wider_cone_is_told_with_its_direction() {
        let round = Cone::Elliptic { mu: 0.5, gamma: 0.0 };
        let grained = Cone::grained(&Vec3::x(), [0.7, 0.2], 0.0);
        assert!(cone_within_friction(&grained, 0.7).is_ok());
        assert!(cone_within_friction(&grained, 0.6).is_err());
        assert!(cone_inside("cone-monotone", &Vec3::z(), &grained, &round).is_err());
        assert!(
            cone_inside("cone-monotone", &Vec3::z(), &round, &Cone::Elliptic { mu: 0.6, gamma: 0.0 }).is_ok()
        );
    }
}
