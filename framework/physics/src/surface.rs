//! The object's surface as fingertips meet it.

use crate::PhysicsError;
use crate::border::to_glam;
use rapier3d_f64::geometry::{PointQuery, RayCast, TypedShape};
use rapier3d_f64::math::{Real, Vector};
use rapier3d_f64::parry::bounding_volume::BoundingSphere;
use rapier3d_f64::parry::query::{PointProjection, Ray, RayIntersection};
use rapier3d_f64::parry::shape::FeatureId;
use rapier3d_f64::prelude::{Aabb, MassProperties, Shape, ShapeType, SharedShape, TriMesh, TriMeshFlags};
use regrasp_api::Mesh;

/// The mesh as one surface that a ball touches at its closest point.
///
/// Rapier's own triangle meshes give a ball one contact per nearby triangle, its convex solids are limited to
/// convex meshes, and its exact primitives are up to a facet's height off the mesh that plans speak of. A
/// ball against this shape has one contact, at the closest point and with the normal from there to its
/// centre: the very contact of a plan, on convex and concave meshes alike. The normal is continuous on convex
/// edges, so a ball rolls over facets without a jolt.
///
/// Rapier knows contacts of custom shapes with balls only: what else the object may hit needs a shape of its
/// own.
#[derive(Clone)]
struct BallSurface(TriMesh);

/// The mesh as a shape for rapier.
pub(crate) fn ball_surface(mesh: &Mesh) -> Result<SharedShape, PhysicsError> {
    let vertices = mesh.vertices().iter().map(to_glam).collect();
    let mesh = TriMesh::with_flags(vertices, mesh.facets().to_vec(), TriMeshFlags::ORIENTED);
    mesh.map(|mesh| SharedShape::new(BallSurface(mesh)))
        .map_err(|error| PhysicsError::Shape(error.to_string()))
}

impl PointQuery for BallSurface {
    fn project_local_point(&self, p: Vector, solid: bool) -> PointProjection {
        self.0.project_local_point(p, solid)
    }

    fn project_local_point_and_get_feature(&self, p: Vector) -> (PointProjection, FeatureId) {
        (self.0.project_local_point(p, false), FeatureId::Unknown)
    }
}

impl RayCast for BallSurface {
    fn cast_local_ray_and_get_normal(&self, ray: &Ray, most: Real, solid: bool) -> Option<RayIntersection> {
        self.0.cast_local_ray_and_get_normal(ray, most, solid)
    }
}

impl Shape for BallSurface {
    fn compute_local_aabb(&self) -> Aabb {
        self.0.compute_local_aabb()
    }
    fn compute_local_bounding_sphere(&self) -> BoundingSphere {
        self.0.compute_local_bounding_sphere()
    }
    fn clone_dyn(&self) -> Box<dyn Shape> {
        Box::new(self.clone())
    }
    fn scale_dyn(&self, _: Vector, _: u32) -> Option<Box<dyn Shape>> {
        None
    }
    fn mass_properties(&self, density: Real) -> MassProperties {
        self.0.mass_properties(density)
    }
    fn shape_type(&self) -> ShapeType {
        ShapeType::Custom
    }
    fn as_typed_shape(&self) -> TypedShape<'_> {
        TypedShape::Custom(self)
    }
    fn ccd_thickness(&self) -> Real {
        self.0.ccd_thickness()
    }
    fn ccd_angular_thickness(&self) -> Real {
        self.0.ccd_angular_thickness()
    }
}
