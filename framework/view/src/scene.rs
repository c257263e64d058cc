//! Everything at rest: hand, object, obstacles.

use crate::ViewError;
use crate::hand::{HandData, MeshData, ObstacleData, hand, obstacles};
use regrasp_api::Problem;
use serde::Serialize;
use std::path::Path;

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
    let object = regrasp_world::load_object(&problem.object, Path::new(""))?;
    Ok(SceneData {
        hand: hand(&problem.hand)?,
        object: ObjectData {
            name: problem.object.name.clone(),
            mass: problem.object.mass,
            friction: problem.object.friction,
            mesh: MeshData::new(&object.mesh),
        },
        obstacles: obstacles(problem)?,
    })
}
