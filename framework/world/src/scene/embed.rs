//! Meshes of files written out in place, so that a problem stands alone.

use crate::error::WorldError;
use crate::mesh::{in_memory, load_mesh};
use regrasp_api::{
    HandDescription, ObjectDescription, ObjectModel, ObjectShape, ObstacleDescription, PlacedShape, Shape,
};
use std::path::Path;

/// Replaces the object's file by the mesh that was loaded from it.
pub fn embed_object(description: &mut ObjectDescription, object: &ObjectModel) {
    if let ObjectShape::Mesh(source) = &mut description.shape {
        *source = in_memory(&object.mesh);
    }
}

/// Loads the meshes of obstacles; files are looked for in `base`, errors name keys below `obstacle`.
pub fn embed_obstacles(obstacles: &mut [ObstacleDescription], base: &Path) -> Result<(), WorldError> {
    let embed = |(i, obstacle): (usize, &mut ObstacleDescription)| {
        embed_shape(&mut obstacle.shape, base, &format!("obstacle[{i}].shape"))
    };
    obstacles.iter_mut().enumerate().try_for_each(embed)
}

/// Loads the meshes of palm and links; files are looked for in `base`, errors name keys of the hand's own file.
pub fn embed_hand(hand: &mut HandDescription, base: &Path) -> Result<(), WorldError> {
    embed_all(&mut hand.palm, base, "palm")?;
    for (f, finger) in hand.finger.iter_mut().enumerate() {
        for (j, joint) in finger.joint.iter_mut().enumerate() {
            embed_all(&mut joint.link, base, &format!("finger[{f}].joint[{j}].link"))?;
        }
    }
    Ok(())
}

fn embed_all(shapes: &mut [PlacedShape], base: &Path, key: &str) -> Result<(), WorldError> {
    let embed = |(i, placed): (usize, &mut PlacedShape)| {
        embed_shape(&mut placed.shape, base, &format!("{key}[{i}].shape"))
    };
    shapes.iter_mut().enumerate().try_for_each(embed)
}

fn embed_shape(shape: &mut Shape, base: &Path, key: &str) -> Result<(), WorldError> {
    if let Shape::Mesh(source) = shape {
        *source = in_memory(&load_mesh(source, base, key)?);
    }
    Ok(())
}
