//! The world: hands, objects, obstacles; kinematics, collision and distance.

mod clearance;
mod error;
mod hand;
mod mesh;
mod object;
mod scene;

pub use clearance::SceneClearance;
pub use error::WorldError;
pub use hand::{
    ChainHand, FingerWorkspace, HandError, LinkFrame, LinkFrames, ObjectPlace, UrdfError, UrdfHand,
    UrdfOptions, UrdfReport, finger_workspace, object_place, read_urdf,
};
pub use mesh::{MAX_FACETS, load_mesh};
pub use object::{load_object, primitive_mesh};
pub use scene::{World, check_limits, check_problem, check_units, embed_hand, embed_object, embed_obstacles};
