//! A problem that stands alone: every mesh in place.

use crate::error::WorldError;
use crate::mesh::embedded;
use crate::object::embed_object;
use regrasp_api::{PlacedShape, Problem, Shape};
use std::path::Path;

/// The same problem with the meshes of all files written out in place, so that a plan file stands alone.
pub fn embed_problem(problem: &Problem, base: &Path) -> Result<Problem, WorldError> {
    let mut alone = problem.clone();
    alone.object = embed_object(&problem.object, base)?;
    for (i, obstacle) in alone.obstacle.iter_mut().enumerate() {
        embed_shape(&mut obstacle.shape, base, &format!("obstacle[{i}].shape"))?;
    }
    embed_all(&mut alone.hand.palm, base, "hand.palm")?;
    for (f, finger) in alone.hand.finger.iter_mut().enumerate() {
        for (j, joint) in finger.joint.iter_mut().enumerate() {
            embed_all(&mut joint.link, base, &format!("hand.finger[{f}].joint[{j}].link"))?;
        }
    }
    Ok(alone)
}

fn embed_all(shapes: &mut [PlacedShape], base: &Path, key: &str) -> Result<(), WorldError> {
    let embed = |(i, placed): (usize, &mut PlacedShape)| {
        embed_shape(&mut placed.shape, base, &format!("{key}[{i}].shape"))
    };
    shapes.iter_mut().enumerate().try_for_each(embed)
}

fn embed_shape(shape: &mut Shape, base: &Path, key: &str) -> Result<(), WorldError> {
    if let Shape::Mesh(source) = shape {
        *source = embedded(source, base, key)?;
    }
    Ok(())
}
