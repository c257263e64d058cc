//! Shapes as other formats know them: primitives about their own frame, or triangles.

use crate::ExportError;
use nalgebra::Unit;
use regrasp_api::{
    FingerDescription, Mesh, MeshError, ObstacleDescription, PlacedShape, Pose, PoseDescription, Primitive,
    Problem, Rotation, Shape, Vec3,
};
use regrasp_world::WorldError;

/// A solid with the pose of its frame in that of the body it belongs to.
pub(crate) struct Piece {
    pub X_BS: Pose,
    pub solid: Solid,
    /// The surface as triangles, in the solid's frame; a half-space's is a slab below it.
    pub mesh: Mesh,
}

/// All solids of hand and obstacles.
pub(crate) struct Solids {
    /// The palm's, in H.
    pub palm: Vec<Piece>,
    /// For each finger and joint the solids of the link behind it, in the link's frame.
    pub links: Vec<Vec<Vec<Piece>>>,
    /// The fingertip's ball, about its centre.
    pub tip: Piece,
    /// The obstacles, in H.
    pub obstacles: Vec<Piece>,
}

/// A solid about the origin of its own frame (m).
pub(crate) enum Solid {
    Sphere {
        radius: f64,
    },
    Box {
        half_size: Vec3,
    },
    /// Along z.
    Capsule {
        radius: f64,
        half_height: f64,
    },
    /// Everything below z = 0.
    HalfSpace,
    /// The piece's mesh.
    Mesh,
}

/// Edge length (m) and thickness (m) of the slab that stands for a half-space in formats without one.
pub(crate) const SLAB: (f64, f64) = (1.0, 0.01);

/// Facets of a round solid in formats of triangles.
const FACETS: usize = 320;

impl Solids {
    pub fn new(problem: &Problem) -> Result<Self, ExportError> {
        let finger = |(f, finger): (usize, &FingerDescription)| {
            let links = finger.joint.iter().enumerate();
            links
                .map(|(j, joint)| pieces(&joint.link, &format!("hand.finger[{f}].joint[{j}].link")))
                .collect()
        };
        let ball = Solid::Sphere { radius: problem.hand.fingertip_radius };
        Ok(Self {
            palm: pieces(&problem.hand.palm, "hand.palm")?,
            links: problem.hand.finger.iter().enumerate().map(finger).collect::<Result<_, _>>()?,
            tip: Piece::new(Pose::identity(), ball, "hand.fingertip_radius")?,
            obstacles: problem.obstacle.iter().enumerate().map(obstacle).collect::<Result<_, _>>()?,
        })
    }
}

fn obstacle((index, obstacle): (usize, &ObstacleDescription)) -> Result<Piece, ExportError> {
    let placed = PlacedShape { shape: obstacle.shape.clone(), pose: obstacle.pose.clone() };
    piece(&placed, &format!("obstacle[{index}]"))
}

impl Piece {
    fn new(X_BS: Pose, solid: Solid, key: &str) -> Result<Self, ExportError> {
        let primitive = match solid {
            Solid::Sphere { radius } => Primitive::Sphere { radius },
            Solid::Box { half_size } => Primitive::Cuboid { half_size },
            Solid::Capsule { radius, half_height } => Primitive::Capsule { radius, half_height },
            Solid::HalfSpace => Primitive::Cuboid { half_size: Vec3::new(SLAB.0, SLAB.0, SLAB.1) / 2.0 },
            Solid::Mesh => {
                let reason = "a mesh brings its own triangles".into();
                return Err(ExportError::Shape { key: key.into(), reason });
            }
        };
        let refused = |error: MeshError| ExportError::Shape { key: key.into(), reason: error.to_string() };
        let mesh = regrasp_world::primitive_mesh(&primitive, FACETS).map_err(refused)?;
        Ok(Self { X_BS, solid, mesh })
    }

    /// The pose of the triangles in the body's frame: those of a half-space are a slab below its surface.
    pub fn X_BMesh(&self) -> Pose {
        match self.solid {
            Solid::HalfSpace => self.X_BS * Pose::translation(0.0, 0.0, -SLAB.1 / 2.0),
            _ => self.X_BS,
        }
    }
}

fn pieces(shapes: &[PlacedShape], key: &str) -> Result<Vec<Piece>, ExportError> {
    shapes.iter().enumerate().map(|(index, placed)| piece(placed, &format!("{key}[{index}]"))).collect()
}

fn piece(placed: &PlacedShape, key: &str) -> Result<Piece, ExportError> {
    let X_BS = pose(&placed.pose, || format!("{key}.pose"))?;
    let (X_inner, solid) = match &placed.shape {
        Shape::Sphere { radius } => (Pose::identity(), Solid::Sphere { radius: *radius }),
        Shape::Box { size } => (Pose::identity(), Solid::Box { half_size: Vec3::from(*size) / 2.0 }),
        Shape::Capsule { from, to, radius } => capsule(&Vec3::from(*from), &Vec3::from(*to), *radius),
        Shape::HalfSpace { normal, offset } => {
            let normal = Vec3::from(*normal).normalize();
            (along(normal * *offset, &normal), Solid::HalfSpace)
        }
        Shape::Mesh(source) => {
            let mesh = source.mesh().map_err(|error| WorldError::mesh(key, error))?;
            return Ok(Piece { X_BS, solid: Solid::Mesh, mesh });
        }
    };
    Piece::new(X_BS * X_inner, solid, key)
}

fn capsule(from: &Vec3, to: &Vec3, radius: f64) -> (Pose, Solid) {
    let length = (to - from).norm();
    // Below a nanometre there is no direction to speak of.
    if length < 1e-9 {
        return (Pose::translation(from.x, from.y, from.z), Solid::Sphere { radius });
    }
    let axis = (to - from) / length;
    (along((from + to) / 2.0, &axis), Solid::Capsule { radius, half_height: length / 2.0 })
}

/// The pose at `p` whose z axis is the unit vector `axis`.
fn along(p: Vec3, axis: &Vec3) -> Pose {
    let turn = Rotation::rotation_between_axis(&Vec3::z_axis(), &Unit::new_unchecked(*axis));
    // Opposite directions have no shortest turn: any half turn about a horizontal axis will do.
    let turn = turn.unwrap_or_else(|| Rotation::from_axis_angle(&Vec3::x_axis(), std::f64::consts::PI));
    Pose::from_parts(p.into(), turn)
}

/// The pose that a description gives, or what is wrong at `key`.
pub(crate) fn pose(description: &PoseDescription, key: impl Fn() -> String) -> Result<Pose, ExportError> {
    description.pose().map_err(|error| ExportError::Pose { key: key(), error })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn capsules_keep_their_ends() {
        for to in [Vec3::new(0.0, 0.0, -0.05), Vec3::new(0.03, 0.0, 0.04), Vec3::new(0.0, 0.0, 0.05)] {
            let (X_BS, solid) = capsule(&Vec3::zeros(), &to, 0.01);
            let Solid::Capsule { half_height, .. } = solid else { panic!("a capsule") };
            let end = X_BS * nalgebra::Point3::new(0.0, 0.0, half_height);
            assert!((end.coords - to).norm() < 1e-12, "{to:?}");
        }
        assert!(matches!(capsule(&Vec3::x(), &Vec3::x(), 0.01).1, Solid::Sphere { .. }));
    }
}
