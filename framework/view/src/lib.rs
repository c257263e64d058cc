//! A plan as one HTML page that plays it: hand, object and obstacles in 3-D, contacts, forces, the margins
//! over time; several plans in step; hands and objects as they were understood.
//!
//! [`page`] turns a plan file's content, and what else is known of it ([`Extras`]), into the text of the
//! page. The page stands alone: data, style, code and three.js (`third_party/three`) are inside, and nothing
//! is loaded from anywhere. Its code (`assets/`) computes in doubles what a plan means between two states,
//! with its own forward kinematics; it carries where this program puts the fingertips at some states and
//! complains where it finds them more than a micrometre away.

mod assets;
mod data;
mod error;
mod extras;
mod hand;
mod hand_page;
mod html;
mod mesh;
mod motion;
mod number;
mod object_page;
pub mod picture;
mod scene;

pub use error::ViewError;
pub use extras::{
    CheckRow, Extras, GraphEdge, GraphNode, GraphPicture, GripCurves, ReplayTrack, Shown, StateCurves,
};
pub use hand_page::{BallPlace, HandView, hand_page};
pub use html::{page, page_beside};
pub use object_page::{ObjectView, object_page};
