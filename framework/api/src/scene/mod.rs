//! Descriptions: hand, object, obstacles, start and goals as plain data, the way files hold them. SI units.

mod contact_surface;
mod hand;
mod hold;
mod limits;
mod mesh_source;
mod object;
mod pose;
mod problem;
mod shape;

pub use contact_surface::*;
pub use hand::*;
pub use hold::*;
pub use limits::*;
pub use mesh_source::*;
pub use object::*;
pub use pose::*;
pub use problem::*;
pub use shape::*;
