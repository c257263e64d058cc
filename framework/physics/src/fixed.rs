//! Palm and obstacles: bodies that do not move.

use crate::PhysicsError;
use crate::border::{pose_to_glam, to_glam};
use crate::finger::{FIXED, HULL, TIPS, groups};
use rapier3d_f64::math::Pose as GlamPose;
use rapier3d_f64::prelude::{ColliderBuilder, PhysicsWorld, SharedShape};
use regrasp_api::{Mesh, PlacedShape, Problem, Shape, Vec3};
use regrasp_world::{WorldError, shape_mesh};

/// A shape with its pose in H.
pub(crate) type Placed = (GlamPose, SharedShape);

/// The palm and the obstacles of a problem that the world has checked.
pub(crate) fn fixed_shapes(problem: &Problem) -> Result<Vec<Placed>, PhysicsError> {
    let obstacles = problem
        .obstacle
        .iter()
        .map(|obstacle| PlacedShape { shape: obstacle.shape.clone(), pose: obstacle.pose.clone() });
    problem.hand.palm.iter().cloned().chain(obstacles).map(|placed| fixed_shape(&placed)).collect()
}

fn fixed_shape(placed: &PlacedShape) -> Result<Placed, PhysicsError> {
    let pose = placed.pose.pose().map_err(|error| PhysicsError::Shape(error.to_string()))?;
    let refused = |error: WorldError| PhysicsError::Shape(error.to_string());
    let (at, shape) = match &placed.shape {
        Shape::Sphere { radius } => (Vec3::zeros(), SharedShape::ball(*radius)),
        Shape::Box { size: [x, y, z] } => (Vec3::zeros(), SharedShape::cuboid(x / 2.0, y / 2.0, z / 2.0)),
        Shape::Capsule { from, to, radius } => {
            let ends = [from, to].map(|end| to_glam(&Vec3::from(*end)));
            (Vec3::zeros(), SharedShape::capsule(ends[0], ends[1], *radius))
        }
        Shape::HalfSpace { normal, offset } => {
            let n = Vec3::from(*normal).normalize();
            (n * *offset, SharedShape::halfspace(to_glam(&n)))
        }
        other => {
            let mesh = shape_mesh(other, "shape").map_err(refused)?;
            let is_mesh = matches!(other, Shape::Mesh(_));
            (Vec3::zeros(), if is_mesh { triangles(&mesh)? } else { hull(&mesh)? })
        }
    };
    Ok((pose_to_glam(&pose) * GlamPose::from_translation(to_glam(&at)), shape))
}

fn triangles(mesh: &Mesh) -> Result<SharedShape, PhysicsError> {
    let vertices = mesh.vertices().iter().map(to_glam).collect();
    SharedShape::trimesh(vertices, mesh.facets().to_vec())
        .map_err(|error| PhysicsError::Shape(error.to_string()))
}

/// A convex hull: of a convex shape, or what of the object meets fixed bodies.
pub(crate) fn hull(mesh: &Mesh) -> Result<SharedShape, PhysicsError> {
    let vertices: Vec<_> = mesh.vertices().iter().map(to_glam).collect();
    SharedShape::convex_hull(&vertices)
        .ok_or_else(|| PhysicsError::Shape("its convex hull could not be computed".into()))
}

/// Puts fixed shapes into the world.
pub(crate) fn insert(world: &mut PhysicsWorld, shapes: &[Placed]) {
    for (X_HS, shape) in shapes {
        let collider =
            ColliderBuilder::new(shape.clone()).position(*X_HS).collision_groups(groups(FIXED, TIPS | HULL));
        world.colliders.insert(collider);
    }
}
