//! Whether two solids are farther apart than a given distance, which is cheaper than to know the distance.

use super::border::{to_glam, to_parry};
use super::exact::{self, MeshSolid, Solid};
use super::hull::Hull;
use parry3d_f64::math::{Pose as ParryPose, Vector};
use parry3d_f64::query::gjk::{self, CsoPoint, GJKResult, VoronoiSimplex};
use parry3d_f64::shape::{Cuboid, Segment, SupportMap};
use regrasp_api::{Pose, Vec3};

/// Whether two solids at their poses in H are more than `clear` (m) apart; exact.
pub(crate) fn farther(a: &Solid, X_HA: &Pose, b: &Solid, X_HB: &Pose, clear: f64) -> bool {
    let (Some(one), Some(other)) = (Core::of(a), Core::of(b)) else {
        return exact::farther(a, X_HA, b, X_HB, clear);
    };
    let X_AB = X_HA.inv_mul(X_HB);
    let apart = one.separated(&other, &X_AB, clear + one.radius + other.radius);
    apart.unwrap_or_else(|| exact::distance(a, X_HA, b, X_HB) > clear)
}

/// A convex solid without its thickness.
struct Core<'a> {
    shape: CoreShape<'a>,
    middle: Vec3,
    radius: f64,
}

enum CoreShape<'a> {
    Segment(Segment),
    Cuboid(Cuboid),
    Hull(&'a Hull),
}

impl<'a> Core<'a> {
    /// `None` for what is not convex, and for half-spaces.
    fn of(solid: &'a Solid) -> Option<Self> {
        Some(match solid {
            Solid::Rod(rod) => Self {
                shape: CoreShape::Segment(Segment::new(to_glam(&rod.a), to_glam(&rod.b))),
                middle: rod.middle(),
                radius: rod.radius,
            },
            Solid::Cuboid { half_size } => Self {
                shape: CoreShape::Cuboid(Cuboid::new(to_glam(half_size))),
                middle: Vec3::zeros(),
                radius: 0.0,
            },
            Solid::Mesh(mesh) => {
                let mesh: &MeshSolid = mesh;
                let shape = CoreShape::Hull(mesh.hull.as_ref()?);
                Self { shape, middle: mesh.bounds.center(), radius: 0.0 }
            }
            Solid::HalfSpace { .. } => return None,
        })
    }

    fn shape(&self) -> &dyn SupportMap {
        match &self.shape {
            CoreShape::Segment(shape) => shape,
            CoreShape::Cuboid(shape) => shape,
            CoreShape::Hull(shape) => *shape,
        }
    }

    /// Whether the other core, its frame B seen from this one's, is more than `apart` (m) away; `None` where
    /// the search does not converge.
    ///
    /// E. G. Gilbert, D. W. Johnson, S. S. Keerthi, "A fast procedure for computing the distance between
    /// complex objects in three-dimensional space", IEEE J. Robotics and Automation 1988, by parry; it ends
    /// as soon as a plane lies between the two.
    fn separated(&self, other: &Self, X_AB: &Pose, apart: f64) -> Option<bool> {
        let X = to_parry(X_AB);
        let (a, b) = (self.shape(), other.shape());
        let toward = (X_AB * nalgebra::Point3::from(other.middle)).coords - self.middle;
        let toward = to_glam(&toward.try_normalize(1e-12).unwrap_or_else(Vec3::x));
        let first = CsoPoint::from_shapes(&X, a, b, toward);
        if gap(&first, &toward) > apart {
            return Some(true);
        }
        let mut simplex = VoronoiSimplex::new();
        simplex.reset(first);
        match gjk::closest_points(&X, a, b, apart, true, &mut simplex) {
            GJKResult::ClosestPoints(p, q, _) => Some((p - q).length() > apart),
            GJKResult::Intersection => Some(false),
            // What a search without an end says, too, so it is looked at again.
            GJKResult::NoIntersection(direction) => is_between(&X, (a, b), &direction, apart).then_some(true),
            GJKResult::Proximity(_) => None,
        }
    }
}

fn is_between(
    X: &ParryPose,
    (a, b): (&dyn SupportMap, &dyn SupportMap),
    direction: &Vector,
    apart: f64,
) -> bool {
    gap(&CsoPoint::from_shapes(X, a, b, *direction), direction) > apart
}

/// How far the two shapes are apart along a direction, by the point of their difference farthest along it.
fn gap(point: &CsoPoint, direction: &Vector) -> f64 {
    -direction.dot(point.point)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::clearance::rod::Rod;
    use crate::object::primitive_mesh;
    use regrasp_api::{Primitive, Random};
    use std::sync::Arc;

    fn mesh(form: Primitive) -> Solid {
        Solid::Mesh(Arc::new(MeshSolid::new(&primitive_mesh(&form, 320).unwrap())))
    }

    /// Both answers come from parry, but on different ways: hulls by their corners here, facets there.
    #[test]
    fn farther_agrees_with_the_exact_distance() {
        let half_size = Vec3::new(0.02, 0.01, 0.03);
        let solids = [
            Solid::Rod(Rod::ball(Vec3::new(0.01, 0.0, 0.0), 0.012)),
            Solid::Rod(Rod::new(Vec3::zeros(), Vec3::new(0.0, 0.02, 0.03), 0.008)),
            Solid::Cuboid { half_size },
            mesh(Primitive::Cuboid { half_size }),
            mesh(Primitive::Ellipsoid { semi_axes: Vec3::new(0.03, 0.02, 0.01) }),
            mesh(Primitive::Torus { ring_radius: 0.025, tube_radius: 0.008 }),
            Solid::HalfSpace { normal: Vec3::z(), offset: -0.02 },
        ];
        let mut random = Random::from_key(17, 0, 0, 0);
        let mut counts = [0; 2];
        let mut pose = || Pose::from_parts((random.direction() * 0.05).into(), random.rotation());
        for round in 0..40 {
            for (a, b) in (0..solids.len() - 1).flat_map(|a| (0..solids.len()).map(move |b| (a, b))) {
                let (X_HA, X_HB) = (pose(), pose());
                let (a, b) = ((&solids[a], &X_HA), (&solids[b], &X_HB));
                let apart = exact::distance(a.0, a.1, b.0, b.1);
                let said = |clear: f64| farther(a.0, a.1, b.0, b.1, clear);
                counts[usize::from(apart > 0.0)] += 1;
                // Parry's precision: 1.5e-7 of the distance.
                let slack = 1e-6 * apart + 1e-10;
                assert!(!said(apart + slack), "round {round}: closer than {apart}");
                assert!(apart == 0.0 || said(apart - slack), "round {round}: farther than {apart}");
            }
        }
        assert!(counts.iter().all(|count| *count > 200), "{counts:?}");
    }
}
