//! The world: hands, objects, obstacles; kinematics, collision and distance. It reads no file: meshes are
//! given in place.

mod bodies;
mod clearance;
mod error;
mod facets;
mod hand;
mod hull;
mod object;
mod remake;
mod scene;
mod shape;
mod twin;
mod workspace;

pub use bodies::{BodyFault, RigidBody, body_count, outward_bodies, rigid_body};
pub use clearance::SceneClearance;
pub use error::WorldError;
pub use facets::shape_mesh;
pub use hand::{ChainHand, Columns, HandError, LinkFrame, LinkFrames};
pub use hull::{coarse_hull, convex_hull, convex_pieces};
pub use object::{Measures, load_object, measure, object_of_mesh, primitive_mesh, signed_distances};
pub use remake::{Remade, remake};
pub use scene::{World, check_limits, check_problem, check_size, check_units};
pub use shape::ShapeFault;
pub use twin::{automatic_twin, roughness, twin_within};
pub use workspace::{FingerWorkspace, ObjectPlace, finger_workspace, object_places};
