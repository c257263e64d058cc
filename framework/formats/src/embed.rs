//! Meshes of files written out in place, so that a problem stands alone.

use crate::error::FormatError;
use crate::mesh::load_mesh;
use regrasp_api::{HandDescription, MeshSource, ObstacleDescription, PlacedShape, Shape};
use std::path::Path;

/// Loads the meshes of obstacles; files are looked for in `base`, errors name keys below `obstacle`.
pub fn embed_obstacles(obstacles: &mut [ObstacleDescription], base: &Path) -> Result<(), FormatError> {
    let embed = |(i, obstacle): (usize, &mut ObstacleDescription)| {
        embed_shape(&mut obstacle.shape, base, &format!("obstacle[{i}].shape"))
    };
    obstacles.iter_mut().enumerate().try_for_each(embed)
}

/// Loads the meshes of palm and links; files are looked for in `base`, errors name keys of the hand's own
/// file.
pub fn embed_hand(hand: &mut HandDescription, base: &Path) -> Result<(), FormatError> {
    embed_all(&mut hand.palm, base, "palm")?;
    for (f, finger) in hand.finger.iter_mut().enumerate() {
        for (j, joint) in finger.joint.iter_mut().enumerate() {
            embed_all(&mut joint.link, base, &format!("finger[{f}].joint[{j}].link"))?;
        }
    }
    Ok(())
}

fn embed_all(shapes: &mut [PlacedShape], base: &Path, key: &str) -> Result<(), FormatError> {
    let embed = |(i, placed): (usize, &mut PlacedShape)| {
        embed_shape(&mut placed.shape, base, &format!("{key}[{i}].shape"))
    };
    shapes.iter_mut().enumerate().try_for_each(embed)
}

fn embed_shape(shape: &mut Shape, base: &Path, key: &str) -> Result<(), FormatError> {
    if let Shape::Mesh(source) = shape {
        *source = MeshSource::of(&load_mesh(source, base, key)?);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use regrasp_api::{Primitive, Vec3};

    #[test]
    fn a_hand_and_obstacles_with_mesh_files_stand_alone_when_embedded() {
        let folder = tempfile::tempdir().unwrap();
        let half_size = Vec3::repeat(22.5);
        let cube = regrasp_world::primitive_mesh(&Primitive::Cuboid { half_size }, 12).unwrap();
        let mut text = String::new();
        cube.vertices().iter().for_each(|v| text.push_str(&format!("v {} {} {}\n", v.x, v.y, v.z)));
        cube.facets()
            .iter()
            .for_each(|f| text.push_str(&format!("f {} {} {}\n", f[0] + 1, f[1] + 1, f[2] + 1)));
        std::fs::write(folder.path().join("cube.obj"), text).unwrap();
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenarios/hands/four-finger.toml");
        let mut hand: HandDescription = toml::from_str(&std::fs::read_to_string(file).unwrap()).unwrap();
        let source = MeshSource { file: Some("cube.obj".into()), scale: Some(0.001), ..Default::default() };
        let shape = Shape::Mesh(source);
        hand.palm.push(PlacedShape { shape: shape.clone(), pose: Default::default() });
        hand.finger[0].joint[1].link[0].shape = shape.clone();
        let obstacle = ObstacleDescription { name: String::new(), shape, pose: Default::default() };
        let mut obstacles = [obstacle];
        embed_hand(&mut hand, folder.path()).unwrap();
        embed_obstacles(&mut obstacles, folder.path()).unwrap();
        let Shape::Mesh(written) = &obstacles[0].shape else { panic!("a mesh stays one") };
        assert!(written.file.is_none() && written.vertices.len() == 8 && written.facets.len() == 12);
        assert_eq!(hand.palm.last().unwrap().shape, obstacles[0].shape);
        let (again, nowhere) = ((hand.clone(), obstacles.clone()), Path::new("/nowhere"));
        embed_hand(&mut hand, nowhere).unwrap();
        embed_obstacles(&mut obstacles, nowhere).unwrap();
        assert_eq!((hand, obstacles), again);
    }
}
