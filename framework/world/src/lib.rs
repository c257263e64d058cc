//! The world: hands, objects, obstacles; kinematics, collision and distance.

mod error;
mod hand;
mod mesh;
mod object;

pub use error::WorldError;
pub use hand::{ChainHand, HandError, LinkFrame, LinkFrames};
pub use mesh::{MAX_FACETS, load_mesh};
pub use object::{embed_object, load_object, primitive_mesh};
