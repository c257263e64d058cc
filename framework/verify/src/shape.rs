//! Solids as a core and a radius around it, and their exact distances by parry.

use crate::border::{parry_pose, segment, vector};
use crate::object::mesh_of;
use crate::solid::{ANYWHERE, Solid};
use nalgebra::Point3;
use parry3d_f64::math::Pose as ParryPose;
use parry3d_f64::query::details::distance_segment_segment;
use parry3d_f64::query::{self, PointQuery};
use parry3d_f64::shape::{Cuboid, Shape as ParryShape};
use regrasp_api::{Mesh, MeshSource, PlacedShape, Pose, Shape, Vec3};
use std::sync::Arc;

/// What is left of a solid when a layer of constant thickness is taken off; in the frame of what it belongs
/// to.
#[derive(Clone, Debug)]
pub(crate) enum Core {
    Point(Vec3),
    Segment(Vec3, Vec3),
    Cuboid { X: Pose, half: Vec3 },
    Mesh(Arc<Solid>),
    HalfSpace { n: Vec3, offset: f64 },
}

impl Core {
    /// The core and radius of a described shape, in the frame of what it belongs to; `Err` says what makes no
    /// sense in it.
    pub(crate) fn of(placed: &PlacedShape) -> Result<(Self, f64), String> {
        let X = placed.pose.pose().map_err(|error| error.to_string())?;
        let point = |p: [f64; 3]| X * Point3::from(p);
        let positive = |x: f64, what: &str| {
            if x > 0.0 && x < 1e6 {
                Ok(x)
            } else {
                Err(format!("`{what}` = {x} must be positive and finite"))
            }
        };
        Ok(match &placed.shape {
            Shape::Sphere { radius } => (Self::Point(X.translation.vector), positive(*radius, "radius")?),
            Shape::Capsule { from, to, radius } => {
                let ends = (point(*from).coords, point(*to).coords);
                if !ends.0.iter().chain(ends.1.iter()).all(|x| x.is_finite()) {
                    return Err("a capsule's ends must be finite".into());
                }
                (Self::Segment(ends.0, ends.1), positive(*radius, "radius")?)
            }
            Shape::Box { size } => {
                for &edge in size {
                    positive(edge, "size")?;
                }
                (Self::Cuboid { X, half: Vec3::from(*size) / 2.0 }, 0.0)
            }
            Shape::HalfSpace { normal, offset } => (half_space(normal, *offset, &X)?, 0.0),
            Shape::Mesh(source) => (mesh(source, &X)?, 0.0),
        })
    }

    /// Centre and radius of a ball that holds the core; `None` for what is unbounded.
    pub(crate) fn ball(&self) -> Option<(Vec3, f64)> {
        match self {
            Self::Point(p) => Some((*p, 0.0)),
            Self::Segment(a, b) => Some(((a + b) / 2.0, (b - a).norm() / 2.0)),
            Self::Cuboid { X, half } => Some((X.translation.vector, half.norm())),
            Self::Mesh(solid) => {
                let infinity = Vec3::repeat(f64::INFINITY);
                let low = solid.vertices.iter().fold(infinity, |low, v| low.inf(v));
                let high = solid.vertices.iter().fold(-infinity, |high, v| high.sup(v));
                let center = (low + high) / 2.0;
                Some((center, solid.vertices.iter().map(|v| (v - center).norm()).fold(0.0, f64::max)))
            }
            Self::HalfSpace { .. } => None,
        }
    }

    /// How far a point in H is from a box whose body is at `X_HB` (m), 0 inside; minus infinity for what is
    /// no box.
    pub(crate) fn box_to(&self, X_HB: &Pose, p_H: &Vec3) -> f64 {
        let Self::Cuboid { X, half } = self else { return f64::NEG_INFINITY };
        let p_B = X_HB.inverse_transform_point(&Point3::from(*p_H));
        let local = X.inverse_transform_point(&p_B).coords;
        (local.abs() - half).sup(&Vec3::zeros()).norm()
    }

    /// How far a point in H is from a segment whose body is at `X_HB` (m); minus infinity for what is none.
    pub(crate) fn rod_to(&self, X_HB: &Pose, p_H: &Vec3) -> f64 {
        let Self::Segment(from, to) = self else { return f64::NEG_INFINITY };
        let p_B = X_HB.inverse_transform_point(&Point3::from(*p_H)).coords;
        let (along, away) = (to - from, p_B - from);
        let part = (along.dot(&away) / along.norm_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        (away - along * part).norm()
    }

    /// A lower bound of how far a box whose body is at `X_HB` is from some points in H, any of which may be
    /// off by `play` (m): the box around them, along the axes of this one. Minus infinity for what is no box.
    pub(crate) fn box_to_points(&self, X_HB: &Pose, points_H: &[Vec3], play: f64) -> f64 {
        let Self::Cuboid { X, half } = self else { return f64::NEG_INFINITY };
        let infinity = Vec3::repeat(f64::INFINITY);
        let (mut low, mut high) = (infinity, -infinity);
        for p in points_H {
            let p_B = X_HB.inverse_transform_point(&Point3::from(*p));
            let local = X.inverse_transform_point(&p_B).coords;
            (low, high) = (low.inf(&local), high.sup(&local));
        }
        let apart = (low - half).sup(&(-half - high)) - Vec3::repeat(play);
        apart.sup(&Vec3::zeros()).norm()
    }

    /// The ends of a point or segment.
    pub(crate) fn ends(&self) -> Option<[Vec3; 2]> {
        match self {
            Self::Point(p) => Some([*p, *p]),
            Self::Segment(p, q) => Some([*p, *q]),
            _ => None,
        }
    }

    fn rank(&self) -> u8 {
        match self {
            Self::Point(_) => 0,
            Self::Segment(..) => 1,
            Self::Cuboid { .. } => 2,
            Self::Mesh(_) => 3,
            Self::HalfSpace { .. } => 4,
        }
    }

    /// Points whose convex hull is the core's; none for what is unbounded.
    fn corners(&self) -> Vec<Vec3> {
        match self {
            Self::Point(p) => vec![*p],
            Self::Segment(a, b) => vec![*a, *b],
            Self::Cuboid { X, half } => {
                let sign = |bit: usize| if bit == 0 { -1.0 } else { 1.0 };
                let corner = |i: usize| Vec3::new(sign(i & 1), sign(i & 2), sign(i & 4)).component_mul(half);
                (0..8).map(|i| (X * Point3::from(corner(i))).coords).collect()
            }
            Self::Mesh(solid) => solid.vertices.clone(),
            Self::HalfSpace { .. } => vec![],
        }
    }
}

fn half_space(normal: &[f64; 3], offset: f64, X: &Pose) -> Result<Core, String> {
    let n = Vec3::from(*normal);
    if !(n.norm().is_finite() && n.norm() > 1e-9 && offset.is_finite()) {
        return Err("a half-space's normal must be finite and not zero, its offset finite".into());
    }
    let n = X.rotation * n.normalize();
    Ok(Core::HalfSpace { n, offset: offset + n.dot(&X.translation.vector) })
}

fn mesh(source: &MeshSource, X: &Pose) -> Result<Core, String> {
    let mesh = mesh_of(source)?;
    let vertices = mesh.vertices().iter().map(|v| (X * Point3::from(*v)).coords).collect();
    let moved = Mesh::new(vertices, mesh.facets().to_vec()).map_err(|error| error.to_string())?;
    Ok(Core::Mesh(Arc::new(Solid::new(&moved))))
}

/// The distance of two cores given in frames A and B (m); not positive where they overlap.
///
/// Exact for surfaces; where `contained` is set, also that neither lies wholly inside the other is looked at
/// (a mesh is only its surface to parry), which a motion that starts apart need not ask again.
pub(crate) fn distance(a: &Core, X_HA: &Pose, b: &Core, X_HB: &Pose, contained: bool) -> f64 {
    if a.rank() > b.rank() {
        return distance(b, X_HB, a, X_HA, contained);
    }
    let X_BA = X_HB.inv_mul(X_HA);
    let moved = |p: &Vec3| (X_BA * Point3::from(*p)).coords;
    match (a, b) {
        (Core::HalfSpace { .. }, _) => 0.0, // Two half-spaces: they always meet.
        (_, Core::HalfSpace { n, offset }) => {
            a.corners().iter().map(|p| n.dot(&moved(p)) - offset).fold(f64::INFINITY, f64::min)
        }
        (Core::Point(p), _) => from_point(&moved(p), b),
        (Core::Segment(p, q), Core::Segment(u, v)) => {
            let (first, second) = (segment(&moved(p), &moved(q)), segment(u, v));
            distance_segment_segment(&ParryPose::IDENTITY, &first, &second)
        }
        (Core::Segment(p, q), Core::Cuboid { X, half }) => {
            let local = |p: &Vec3| X.inverse_transform_point(&Point3::from(moved(p))).coords;
            apart(&segment(&local(p), &local(q)), &ParryPose::IDENTITY, &cuboid(half))
        }
        (Core::Segment(p, q), Core::Mesh(solid)) => {
            let (p, q) = (moved(p), moved(q));
            if contained && solid.contains(&p) {
                0.0
            } else {
                solid.gap_to_segment(&p, &q, ANYWHERE).distance
            }
        }
        (Core::Cuboid { X, half }, Core::Cuboid { X: X_other, half: other }) => {
            let X = (X_BA * X).inv_mul(X_other);
            apart(&cuboid(half), &parry_pose(&X), &cuboid(other))
        }
        (Core::Cuboid { X, half }, Core::Mesh(solid)) => of_box_and_mesh(&(X_BA * X), half, solid, contained),
        (Core::Mesh(first), Core::Mesh(second)) => of_meshes(&X_BA, first, second, contained),
        _ => unreachable!("the cores are in the order of their ranks"),
    }
}

/// A box at X in the mesh's frame.
fn of_box_and_mesh(X: &Pose, half: &Vec3, solid: &Solid, contained: bool) -> f64 {
    let inside = |v: &Vec3| {
        let p = X.inverse_transform_point(&Point3::from(*v)).coords;
        p.iter().zip(half.iter()).all(|(x, h)| x.abs() <= *h)
    };
    if contained && (inside(&solid.vertices[0]) || solid.contains(&X.translation.vector)) {
        return 0.0;
    }
    apart(&cuboid(half), &parry_pose(&X.inverse()), solid.surface())
}

/// The first mesh at X in the second one's frame.
fn of_meshes(X: &Pose, first: &Solid, second: &Solid, contained: bool) -> f64 {
    let there = (X * Point3::from(first.vertices[0])).coords;
    let back = X.inverse_transform_point(&Point3::from(second.vertices[0])).coords;
    if contained && (second.contains(&there) || first.contains(&back)) {
        return 0.0;
    }
    apart(first.surface(), &parry_pose(&X.inverse()), second.surface())
}

/// The distance of a point from a core in its own frame; negative inside.
fn from_point(p: &Vec3, core: &Core) -> f64 {
    match core {
        Core::Point(other) => (p - other).norm(),
        Core::Segment(u, v) => segment(u, v).distance_to_local_point(vector(p), true),
        Core::Cuboid { X, half } => {
            let local = X.inverse_transform_point(&Point3::from(*p)).coords;
            cuboid(half).distance_to_local_point(vector(&local), false)
        }
        Core::Mesh(solid) => {
            let closest = solid.closest(p, ANYWHERE);
            (p - closest.point).norm() * if closest.inside { -1.0 } else { 1.0 }
        }
        Core::HalfSpace { n, offset } => n.dot(p) - offset,
    }
}

/// The distance of two parry shapes; `X` is the second one's pose in the first one's frame.
fn apart(first: &dyn ParryShape, X: &ParryPose, second: &dyn ParryShape) -> f64 {
    // Unsupported pairs do not occur among these shapes; were one to, it would count as touching.
    query::distance(&ParryPose::IDENTITY, first, X, second).map_or(0.0, |answer| answer.distance)
}

fn cuboid(half: &Vec3) -> Cuboid {
    Cuboid::new(vector(half))
}

#[cfg(test)]
mod tests;
