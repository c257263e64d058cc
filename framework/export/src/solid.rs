//! Shapes as other formats know them: primitives about their own frame, or triangles.

use crate::ExportError;
use regrasp_api::{
    FingerDescription, Form, Mesh, MeshError, ObstacleDescription, PlacedShape, Pose, PoseDescription,
    Primitive, Problem, Vec3, along,
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

/// A solid in its own frame.
pub(crate) enum Solid {
    Primitive(Primitive),
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
        let ball = Primitive::Sphere { radius: problem.hand.fingertip_radius };
        Ok(Self {
            palm: pieces(&problem.hand.palm, "hand.palm")?,
            links: problem.hand.finger.iter().enumerate().map(finger).collect::<Result<_, _>>()?,
            tip: Piece::new(Pose::identity(), (Solid::Primitive(ball), ball), "hand.fingertip_radius")?,
            obstacles: problem.obstacle.iter().enumerate().map(obstacle).collect::<Result<_, _>>()?,
        })
    }
}

fn obstacle((index, obstacle): (usize, &ObstacleDescription)) -> Result<Piece, ExportError> {
    let placed = PlacedShape { shape: obstacle.shape.clone(), pose: obstacle.pose.clone() };
    piece(&placed, &format!("obstacle[{index}]"))
}

impl Piece {
    /// A solid with the primitive whose facets are its triangles.
    fn new(X_BS: Pose, (solid, primitive): (Solid, Primitive), key: &str) -> Result<Self, ExportError> {
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
    match placed.shape.form() {
        Form::Primitive(primitive, X) => Piece::new(X_BS * X, (Solid::Primitive(primitive), primitive), key),
        Form::HalfSpace { normal, offset } => {
            let slab = Primitive::Cuboid { half_size: Vec3::new(SLAB.0, SLAB.0, SLAB.1) / 2.0 };
            Piece::new(X_BS * along(normal * offset, &normal), (Solid::HalfSpace, slab), key)
        }
        Form::Mesh(source) => {
            let mesh = source.mesh().map_err(|error| WorldError::mesh(key, error))?;
            Ok(Piece { X_BS, solid: Solid::Mesh, mesh })
        }
    }
}

/// The pose that a description gives, or what is wrong at `key`.
pub(crate) fn pose(description: &PoseDescription, key: impl Fn() -> String) -> Result<Pose, ExportError> {
    description.pose().map_err(|error| ExportError::Pose { key: key(), error })
}
