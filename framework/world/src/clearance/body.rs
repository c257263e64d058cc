//! From descriptions to solids.

use super::convex::Convex;
use super::exact::{MeshSolid, Solid};
use super::rod::{Bounds, Rod};
use crate::error::WorldError;
use crate::object::primitive_mesh;
use crate::shape::check_shape;
use nalgebra::Point3;
use regrasp_api::{Form, Mesh, MeshSourceError, PlacedShape, Pose, PoseDescription, Primitive, Shape, Vec3};
use std::sync::Arc;

/// A solid placed in the frame of the body that it belongs to.
#[derive(Clone)]
pub(crate) struct Placed {
    pub solid: Solid,
    /// The solid's frame S in the body's frame B.
    pub X_BS: Pose,
    /// A rod in B that holds the solid; the solid itself if it is a rod. Meaningless for half-spaces.
    pub rod: Rod,
}

impl Placed {
    /// Reads a shape at a pose; `key` is the path of both in their description.
    pub fn read(shape: &Shape, pose: &PoseDescription, key: &str) -> Result<Self, WorldError> {
        let X_BS = pose.pose().map_err(|error| WorldError::Pose { key: format!("{key}.pose"), error })?;
        let solid = solid(shape, &format!("{key}.shape"))?;
        Ok(Self::new(solid, X_BS))
    }

    pub fn read_all(shapes: &[PlacedShape], key: &str) -> Result<Vec<Self>, WorldError> {
        let read = |(i, placed): (usize, &PlacedShape)| {
            Self::read(&placed.shape, &placed.pose, &format!("{key}[{i}]"))
        };
        shapes.iter().enumerate().map(read).collect()
    }

    /// A rod, given in the body's frame.
    pub fn rod(rod: Rod) -> Self {
        Self { solid: Solid::Rod(rod), X_BS: Pose::identity(), rod }
    }

    /// Rods and half-spaces are moved into the body's frame once and for all.
    fn new(solid: Solid, X_BS: Pose) -> Self {
        let at = |p: &Vec3| (X_BS * Point3::from(*p)).coords;
        match solid {
            Solid::Rod(rod) => Self::rod(Rod::new(at(&rod.a), at(&rod.b), rod.radius)),
            Solid::HalfSpace { normal, offset } => {
                let normal = X_BS.rotation * normal;
                let offset = offset + normal.dot(&X_BS.translation.vector);
                let rod = Rod::ball(Vec3::zeros(), f64::INFINITY);
                Self { solid: Solid::HalfSpace { normal, offset }, X_BS: Pose::identity(), rod }
            }
            Solid::Cuboid { half_size } => {
                let rod = around(&Bounds { lower: -half_size, upper: half_size });
                Self { solid, X_BS, rod: Rod::new(at(&rod.a), at(&rod.b), rod.radius) }
            }
            Solid::Mesh(ref mesh) => {
                let rod = around(&mesh.bounds);
                Self { X_BS, rod: Rod::new(at(&rod.a), at(&rod.b), rod.radius), solid }
            }
        }
    }

    /// Whether the rod is the solid itself.
    pub fn is_rod(&self) -> bool {
        matches!(self.solid, Solid::Rod(_))
    }

    /// Lowest and highest coordinates in the body's frame.
    pub fn bounds(&self) -> Bounds {
        let (X_BS, local) = match &self.solid {
            Solid::Rod(rod) => return rod.bounds(),
            Solid::HalfSpace { .. } => return Bounds::EVERYTHING,
            Solid::Cuboid { half_size } => (&self.X_BS, Bounds { lower: -half_size, upper: *half_size }),
            Solid::Mesh(mesh) => (&self.X_BS, mesh.bounds),
        };
        let half = X_BS.rotation.to_rotation_matrix().into_inner().abs() * local.half_size();
        let center = (X_BS * Point3::from(local.center())).coords;
        Bounds { lower: center - half, upper: center + half }
    }
}

/// A rod along the longest side that holds a box.
fn around(bounds: &Bounds) -> Rod {
    let (center, half) = (bounds.center(), bounds.half_size());
    let axis = half.imax();
    let mut across = half;
    across[axis] = 0.0;
    let mut along = Vec3::zeros();
    along[axis] = half[axis];
    Rod::new(center - along, center + along, across.norm())
}

/// Facets of what stands for a solid that is neither a rod nor a cuboid.
const FACETS: usize = 1280;

fn solid(shape: &Shape, key: &str) -> Result<Solid, WorldError> {
    check_shape(shape, key)?;
    if let Shape::Capsule { from, to, radius } = shape {
        return Ok(Solid::Rod(Rod::new((*from).into(), (*to).into(), *radius)));
    }
    Ok(match shape.form() {
        Form::Primitive(Primitive::Sphere { radius }, _) => Solid::Rod(Rod::ball(Vec3::zeros(), radius)),
        Form::Primitive(Primitive::Cuboid { half_size }, _) => Solid::Cuboid { half_size },
        Form::Primitive(primitive, _) => Solid::Mesh(Arc::new(MeshSolid::new(&hull(&primitive, key)?))),
        Form::HalfSpace { normal, offset } => Solid::HalfSpace { normal, offset },
        Form::Mesh(source) => {
            let mesh = source.mesh().map_err(|error| WorldError::mesh(key, error))?;
            Solid::Mesh(Arc::new(MeshSolid::new(&mesh)))
        }
    })
}

/// A polytope that holds a convex solid: facets whose corners lie on it, as much larger as they would
/// otherwise cut off.
fn hull(primitive: &Primitive, key: &str) -> Result<Mesh, WorldError> {
    let refused = |error| WorldError::mesh(key, MeshSourceError::Mesh(error));
    let mesh = primitive_mesh(primitive, FACETS).map_err(refused)?;
    let plane = |facet| {
        let n = mesh.normal(facet);
        (n, n.dot(&mesh.corners(facet)[0]))
    };
    let convex = Convex::around(*primitive, (0..mesh.facets().len() as u32).map(plane));
    let convex = convex.ok_or_else(|| WorldError::value(key, "it is not convex; give it as a mesh"))?;
    let vertices = mesh.vertices().iter().map(|v| v / convex.inner()).collect();
    Mesh::new(vertices, mesh.facets().to_vec()).map_err(refused)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_stands_for_a_cylinder_holds_it_and_is_hardly_larger() {
        let (radius, half_height) = (0.008, 0.1);
        let mesh = hull(&Primitive::Cylinder { radius, half_height }, "shape").unwrap();
        for facet in 0..mesh.facets().len() as u32 {
            let n = mesh.normal(facet);
            let own = radius * n.x.hypot(n.y) + half_height * n.z.abs();
            let height = n.dot(&mesh.corners(facet)[0]);
            assert!(height >= own && height < 1.02 * own, "{height} {own}");
        }
        let ring = Primitive::Torus { ring_radius: 0.04, tube_radius: 0.015 };
        assert!(hull(&ring, "shape").unwrap_err().to_string().contains("not convex"));
    }
}
