//! Reset states for learning, as NumPy arrays of 32-bit numbers, named as Isaac Lab's scenes name theirs.

use super::Set;
use super::columns::quaternion;
use super::npz::Archive;
use regrasp_export::joint_names;
use std::io::{self, Write};

/// Writes `joint_pos` and `joint_effort` (G, J), `object_pos` (G, 3), `object_quat` (G, 4: w, x, y, z), and
/// `joint_names`; poses are in the hand's frame, efforts NaN where none within their limits hold the object.
pub fn resets(set: &Set<'_>, out: &mut dyn Write) -> io::Result<()> {
    let mut archive = Archive::stream(out);
    let (grasps, joints) = (set.grasps as usize, set.layout.joints());
    let names = joint_names(set.hand);
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    archive.texts("grasps_info", None, &[set.info])?;
    archive.texts("joint_names", Some(names.len()), &names)?;
    archive.begin("joint_pos", "<f4", &[grasps, joints], 4)?;
    archive.fill(set, |g, out| g.q.joints.iter().for_each(|(_, q)| singles(q.iter(), out)))?;
    archive.begin("joint_effort", "<f4", &[grasps, joints], 4)?;
    archive.fill(set, |g, out| match &g.held {
        Some(held) => held.efforts.iter().for_each(|(_, efforts)| singles(efforts.iter(), out)),
        None => g.q.joints.iter().for_each(|(_, q)| singles(&vec![f64::NAN; q.len()], out)),
    })?;
    archive.begin("object_pos", "<f4", &[grasps, 3], 4)?;
    archive.fill(set, |g, out| singles(g.q.X_HO.translation.vector.iter(), out))?;
    archive.begin("object_quat", "<f4", &[grasps, 4], 4)?;
    archive.fill(set, |g, out| singles(&quaternion(g), out))?;
    archive.finish()
}

fn singles<'x>(numbers: impl IntoIterator<Item = &'x f64>, out: &mut Vec<u8>) {
    numbers.into_iter().for_each(|x| out.extend((*x as f32).to_le_bytes()));
}
