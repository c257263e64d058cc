//! The world: hands, objects, obstacles; kinematics, collision and distance. It reads no file: meshes are given in place.

mod clearance;
mod error;
mod hand;
mod hull;
mod object;
mod scene;

pub use clearance::SceneClearance;
pub use error::WorldError;
pub use hand::{
    ChainHand, FingerWorkspace, HandError, LinkFrame, LinkFrames, ObjectPlace, finger_workspace, object_place,
};
pub use hull::{coarse_hull, convex_hull, convex_pieces};
pub use object::{load_object, object_of_mesh, primitive_mesh};
pub use scene::{World, check_limits, check_problem, check_units};
