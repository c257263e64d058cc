//! From descriptions to solids.

use super::exact::{MeshSolid, Solid};
use super::rod::{Bounds, Rod};
use crate::error::{WorldError, check_range};
use nalgebra::Point3;
use regrasp_api::{PlacedShape, Pose, PoseDescription, Shape, Vec3};
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

/// Lengths of shapes (m): beyond these, somebody has mistaken the unit by far.
const LENGTHS: (f64, f64) = (1e-6, 1e3);

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

fn solid(shape: &Shape, key: &str) -> Result<Solid, WorldError> {
    let length = |name: &str, value: f64| {
        check_range(&format!("{key}.{name}"), value, LENGTHS.0, LENGTHS.1, " m").map(|()| value)
    };
    let finite = |name: &str, value: [f64; 3]| {
        let far = !value.iter().all(|x| x.abs() <= LENGTHS.1);
        let range = format!("three numbers of at most {} m", LENGTHS.1);
        if far {
            Err(WorldError::range(format!("{key}.{name}"), format!("{value:?}"), range))
        } else {
            Ok(value.into())
        }
    };
    match shape {
        Shape::Sphere { radius } => Ok(Solid::Rod(Rod::ball(Vec3::zeros(), length("radius", *radius)?))),
        Shape::Box { size } => {
            for (axis, &edge) in size.iter().enumerate() {
                length(&format!("size[{axis}]"), edge)?;
            }
            Ok(Solid::Cuboid { half_size: Vec3::from(*size) / 2.0 })
        }
        Shape::Capsule { from, to, radius } => {
            Ok(Solid::Rod(Rod::new(finite("from", *from)?, finite("to", *to)?, length("radius", *radius)?)))
        }
        Shape::HalfSpace { normal, offset } => {
            let direction: Vec3 = finite("normal", *normal)?;
            if direction.norm() <= 1e-9 {
                return Err(WorldError::value(format!("{key}.normal"), "it must not be zero"));
            }
            check_range(&format!("{key}.offset"), *offset, -LENGTHS.1, LENGTHS.1, " m")?;
            Ok(Solid::HalfSpace { normal: direction.normalize(), offset: *offset })
        }
        Shape::Mesh(source) => {
            let mesh = source.mesh().map_err(|error| WorldError::mesh(key, error))?;
            Ok(Solid::Mesh(Arc::new(MeshSolid::new(&mesh))))
        }
    }
}
