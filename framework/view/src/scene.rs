//! Everything at rest: hand, object, obstacles.

use crate::ViewError;
use crate::hand::{HandData, ObstacleData, hand, obstacles};
use crate::mesh::{MeshData, thin};
use regrasp_api::Problem;
use serde::Serialize;

#[derive(Serialize)]
pub(crate) struct SceneData {
    hand: HandData,
    object: ObjectData,
    obstacles: Vec<ObstacleData>,
}

#[derive(Serialize)]
struct ObjectData {
    name: String,
    mass: f64,
    friction: f64,
    #[serde(flatten)]
    mesh: MeshData,
}

pub(crate) fn scene(problem: &Problem) -> Result<SceneData, ViewError> {
    let object = regrasp_world::load_object(&problem.object)?;
    let mut scene = SceneData {
        hand: hand(&problem.hand)?,
        object: ObjectData {
            name: problem.object.name.clone(),
            mass: problem.object.mass,
            friction: problem.object.friction,
            mesh: MeshData::new(&object.mesh),
        },
        obstacles: obstacles(problem)?,
    };
    let obstacles = scene.obstacles.iter_mut().filter_map(ObstacleData::mesh);
    thin(scene.hand.meshes().chain(obstacles).chain([&mut scene.object.mesh]));
    Ok(scene)
}
