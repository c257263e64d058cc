//! Files into plain data: meshes, and descriptions of robots. Parsing and units; no kinematics, no collision.

mod decode;
mod embed;
mod error;
mod mesh;
mod mjcf;
mod named;
mod packages;
mod robot;
mod urdf;
mod xml;

pub use decode::read_xml;
pub use embed::{embed_hand, embed_obstacles};
pub use error::{FormatError, RobotFault, RobotFileError};
pub use mesh::{ReadMesh, load_mesh, read_mesh, read_points};
pub use mjcf::read_mjcf;
pub use named::named_files;
pub use packages::{NoSuchFile, Packages};
pub use robot::*;
pub use urdf::parse_urdf;

use std::path::Path;

/// Reads a robot's file, URDF or MJCF by its outermost element.
pub fn read_robot(path: &Path) -> Result<Robot, RobotFault> {
    let text = read_xml(path)?;
    let is_mjcf = xml::parse(&text)?.root_element().tag_name().name() == "mujoco";
    if is_mjcf { read_mjcf(path) } else { parse_urdf(&text) }
}
