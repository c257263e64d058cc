//! URDF: what the XML says, and in which line.

mod document;

pub use document::parse_urdf;
