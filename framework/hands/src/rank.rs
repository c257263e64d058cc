//! In how many directions a chain of joints can move its end.

use crate::posture::{drive, moved};
use crate::tree::Tree;
use regrasp_api::{Pose, Random, Vec3};
use regrasp_formats::Kind;

/// Random postures that are looked at.
const POSTURES: usize = 6;
/// A direction counts if the joints move the end in it by this share of the best one.
const INDEPENDENT: f64 = 1e-3;

/// In how many independent directions (0 to 3) the joints of a path move a point that is fixed to its end:
/// driven joints move with their drivers. Joints whose axes are all parallel give 2.
pub(crate) fn directions(tree: &Tree<'_>, path: &[usize]) -> usize {
    let mut random = Random::from_key(0, 6, 0, 0);
    (0..POSTURES).map(|_| at_posture(tree, path, &mut random)).max().unwrap_or(0)
}

fn at_posture(tree: &Tree<'_>, path: &[usize], random: &mut Random) -> usize {
    let q: Vec<f64> = path.iter().map(|_| random.range(-0.7, 0.7)).collect();
    let (mut X, mut screws) = (Pose::identity(), Vec::new());
    for (&index, &q) in path.iter().zip(&q) {
        let joint = tree.joint(index);
        let frame = X * joint.X_PJ;
        screws.push((frame.rotation * joint.axis, frame.translation.vector));
        X *= moved(joint, q);
    }
    // No special point of the last link: one on the last axis would not feel it.
    let end = (X * nalgebra::Point3::new(0.013, 0.017, 0.019)).coords;
    let mut columns = vec![Vec3::zeros(); path.len()];
    for (place, &index) in path.iter().enumerate() {
        let joint = tree.joint(index);
        let (axis, point) = screws[place];
        let velocity = match joint.kind {
            Kind::Revolute | Kind::Continuous => axis.cross(&(end - point)),
            Kind::Prismatic => axis * 0.05,
            Kind::Fixed | Kind::Other => continue,
        };
        match drive(tree, joint) {
            Ok(None) => columns[place] += velocity,
            Ok(Some(drive)) => {
                if let Some(driver) = path.iter().position(|&other| other == drive.joint) {
                    columns[driver] += velocity * drive.multiplier;
                }
            }
            Err(_) => {}
        }
    }
    // Directions count, not how far they lead: a finger of a file in wrong units is one too.
    let columns: Vec<Vec3> = columns.iter().filter_map(|column| column.try_normalize(1e-9)).collect();
    if columns.is_empty() {
        return 0;
    }
    let J = nalgebra::Matrix3xX::from_columns(&columns);
    let values = J.svd(false, false).singular_values;
    let most = values.max();
    values.iter().filter(|value| **value > INDEPENDENT * most).count()
}
