//! Files into plain data: meshes, and descriptions of robots. Parsing and units; no kinematics, no collision.

mod embed;
mod error;
mod mesh;
mod packages;
mod robot;
mod urdf;

pub use embed::{embed_hand, embed_obstacles};
pub use error::{FormatError, RobotFault, RobotFileError};
pub use mesh::{load_mesh, read_points};
pub use packages::Packages;
pub use robot::*;
pub use urdf::parse_urdf;
