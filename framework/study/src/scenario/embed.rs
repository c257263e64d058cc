//! Meshes of files written out in place, so that a problem stands alone.

use regrasp_api::{
    HandDescription, Mesh, MeshSource, ObjectDescription, ObjectModel, ObjectShape, ObstacleDescription,
    Shape,
};
use regrasp_world::{WorldError, load_mesh};
use std::path::Path;

/// Replaces the object's file by the mesh that was loaded from it.
pub(super) fn embed_object(description: &mut ObjectDescription, object: &ObjectModel) {
    if let ObjectShape::Mesh(source) = &mut description.shape {
        *source = in_place(&object.mesh);
    }
}

/// Loads the meshes of obstacles; files are looked for in `folder`.
pub(super) fn embed_obstacles(
    obstacles: &mut [ObstacleDescription],
    folder: &Path,
) -> Result<(), WorldError> {
    for (i, obstacle) in obstacles.iter_mut().enumerate() {
        embed_shape(&mut obstacle.shape, folder, &format!("obstacle[{i}].shape"))?;
    }
    Ok(())
}

/// Loads the meshes of palm and links; files are looked for in `folder`.
pub(super) fn embed_hand(hand: &mut HandDescription, folder: &Path) -> Result<(), WorldError> {
    for (i, placed) in hand.palm.iter_mut().enumerate() {
        embed_shape(&mut placed.shape, folder, &format!("palm[{i}].shape"))?;
    }
    for (f, finger) in hand.finger.iter_mut().enumerate() {
        for (j, joint) in finger.joint.iter_mut().enumerate() {
            for (i, placed) in joint.link.iter_mut().enumerate() {
                embed_shape(&mut placed.shape, folder, &format!("finger[{f}].joint[{j}].link[{i}].shape"))?;
            }
        }
    }
    Ok(())
}

fn embed_shape(shape: &mut Shape, folder: &Path, key: &str) -> Result<(), WorldError> {
    if let Shape::Mesh(source) = shape {
        *source = in_place(&load_mesh(source, folder, key)?);
    }
    Ok(())
}

fn in_place(mesh: &Mesh) -> MeshSource {
    MeshSource {
        vertices: mesh.vertices().iter().map(|&v| v.into()).collect(),
        facets: mesh.facets().to_vec(),
        ..MeshSource::default()
    }
}
