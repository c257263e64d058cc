//! Hand and obstacles as the page draws them.

use crate::ViewError;
use crate::mesh::MeshData;
use crate::number::{micro, nano};
use regrasp_api::{
    FingerDescription, HandDescription, JointDescription, JointKind, PlacedShape, PoseDescription, Problem,
    Shape,
};
use serde::Serialize;

/// A pose: position (m), quaternion w, x, y, z.
pub(crate) type PoseData = [f64; 7];

#[derive(Serialize)]
pub(crate) struct HandData {
    name: String,
    tip_radius: f64,
    palm: Vec<ShapeData>,
    fingers: Vec<FingerData>,
}

#[derive(Serialize)]
struct FingerData {
    name: String,
    base: PoseData,
    joints: Vec<JointData>,
    tip: [f64; 3],
    /// The joints' positions at rest.
    rest: Vec<f64>,
}

#[derive(Serialize)]
struct JointData {
    name: String,
    slides: bool,
    origin: PoseData,
    /// Of length 1.
    axis: [f64; 3],
    /// Lowest and highest position (rad; m where it slides).
    range: [f64; 2],
    /// Largest speed (rad/s; m/s).
    velocity: f64,
    /// Largest effort (N·m; N).
    effort: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    mimic: Option<MimicData>,
    shapes: Vec<ShapeData>,
}

/// q = `multiplier` · q of the finger's joint number `joint` + `offset`.
#[derive(Serialize)]
struct MimicData {
    joint: usize,
    multiplier: f64,
    offset: f64,
}

#[derive(Serialize)]
pub(crate) struct ObstacleData {
    name: String,
    shape: ShapeData,
}

/// A shape in the frame of what it belongs to.
#[derive(Serialize)]
struct ShapeData {
    pose: PoseData,
    #[serde(flatten)]
    form: Form,
}

#[derive(Serialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
enum Form {
    Sphere { radius: f64 },
    Box { size: [f64; 3] },
    Capsule { from: [f64; 3], to: [f64; 3], radius: f64 },
    HalfSpace { normal: [f64; 3], offset: f64 },
    Mesh(MeshData),
}

impl HandData {
    pub(crate) fn meshes(&mut self) -> impl Iterator<Item = &mut MeshData> {
        let links =
            self.fingers.iter_mut().flat_map(|finger| &mut finger.joints).flat_map(|joint| &mut joint.shapes);
        self.palm.iter_mut().chain(links).filter_map(ShapeData::mesh)
    }
}

impl ObstacleData {
    pub(crate) fn mesh(&mut self) -> Option<&mut MeshData> {
        self.shape.mesh()
    }
}

impl ShapeData {
    fn mesh(&mut self) -> Option<&mut MeshData> {
        match &mut self.form {
            Form::Mesh(mesh) => Some(mesh),
            _ => None,
        }
    }
}

pub(crate) fn hand(hand: &HandDescription) -> Result<HandData, ViewError> {
    let finger = |(f, finger)| self::finger(finger, &format!("hand.finger[{f}]"));
    Ok(HandData {
        name: hand.name.clone(),
        tip_radius: hand.fingertip_radius,
        palm: shapes(&hand.palm, "hand.palm")?,
        fingers: hand.finger.iter().enumerate().map(finger).collect::<Result<_, _>>()?,
    })
}

fn finger(finger: &FingerDescription, key: &str) -> Result<FingerData, ViewError> {
    let mut joints = Vec::with_capacity(finger.joint.len());
    for (j, joint) in finger.joint.iter().enumerate() {
        let key = format!("{key}.joint[{j}]");
        let length = joint.axis.iter().map(|x| x * x).sum::<f64>().sqrt();
        joints.push(JointData {
            name: joint.name.clone(),
            slides: joint.kind == JointKind::Prismatic,
            origin: pose(&joint.origin, &format!("{key}.origin"))?,
            axis: joint.axis.map(|x| x / length),
            range: [joint.lower, joint.upper],
            velocity: joint.velocity,
            effort: joint.effort,
            mimic: mimic(joint, &finger.joint),
            shapes: shapes(&joint.link, &format!("{key}.link"))?,
        });
    }
    Ok(FingerData {
        name: finger.name.clone(),
        base: pose(&finger.base, &format!("{key}.base"))?,
        joints,
        tip: finger.tip,
        rest: finger.rest.clone(),
    })
}

fn mimic(joint: &JointDescription, among: &[JointDescription]) -> Option<MimicData> {
    let mimic = joint.mimic.as_ref()?;
    let driver = among.iter().position(|other| other.name == mimic.joint)?;
    Some(MimicData { joint: driver, multiplier: mimic.multiplier, offset: mimic.offset })
}

pub(crate) fn obstacles(problem: &Problem) -> Result<Vec<ObstacleData>, ViewError> {
    let obstacle = |(i, obstacle): (usize, &regrasp_api::ObstacleDescription)| {
        let placed = PlacedShape { shape: obstacle.shape.clone(), pose: obstacle.pose.clone() };
        Ok(ObstacleData { name: obstacle.name.clone(), shape: shape(&placed, &format!("obstacle[{i}]"))? })
    };
    problem.obstacle.iter().enumerate().map(obstacle).collect()
}

fn shapes(shapes: &[PlacedShape], key: &str) -> Result<Vec<ShapeData>, ViewError> {
    shapes.iter().enumerate().map(|(i, placed)| shape(placed, &format!("{key}[{i}]"))).collect()
}

fn shape(placed: &PlacedShape, key: &str) -> Result<ShapeData, ViewError> {
    let form = match &placed.shape {
        Shape::Sphere { radius } => Form::Sphere { radius: *radius },
        Shape::Box { size } => Form::Box { size: *size },
        Shape::Capsule { from, to, radius } => Form::Capsule { from: *from, to: *to, radius: *radius },
        Shape::HalfSpace { normal, offset } => Form::HalfSpace { normal: *normal, offset: *offset },
        other => Form::Mesh(MeshData::of_shape(other, &format!("{key}.shape"))?),
    };
    Ok(ShapeData { pose: pose(&placed.pose, &format!("{key}.pose"))?, form })
}

pub(crate) fn pose(description: &PoseDescription, key: &str) -> Result<PoseData, ViewError> {
    let pose = description.pose().map_err(|error| ViewError::Pose { key: key.into(), error })?;
    let (p, q) = (pose.translation.vector, pose.rotation.quaternion());
    // Not rounded: these few stand at the root of every chain.
    Ok([p.x, p.y, p.z, q.w, q.i, q.j, q.k])
}

/// A finger's contact for the page: point, normal, and the point on the fingertip where it is known; empty
/// for none.
pub(crate) fn contact(contact: Option<&regrasp_plan::ContactRecord>) -> Vec<f64> {
    let Some(contact) = contact else { return Vec::new() };
    let points = contact.point_O.iter().map(|&x| nano(x)).chain(contact.normal_O.iter().map(|&x| micro(x)));
    points.chain(contact.point_F.iter().map(|&x| nano(x))).collect()
}
