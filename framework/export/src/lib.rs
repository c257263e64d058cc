//! Plans in the formats of other programs.
//!
//! [`Scene::new`] prepares a plan, [`Scene::export`] gives the files of one [`Format`] as bytes; who calls
//! writes them. Lengths are metres, angles radians, frames those of the plan: H is the hand's, O the
//! object's. A motion's states are exported as they are: between two of them joints and position move
//! linearly, orientation by slerp.

mod csv;
mod error;
mod files;
mod forces;
mod gltf;
mod grasps;
mod mjcf;
mod names;
mod npy;
mod scene;
mod solid;
mod table;
mod trajectory;
mod urdf;
mod xml;

pub use error::ExportError;
pub use grasps::{GraspRecord, Grasps};
pub use names::joint_names;
pub use npy::npy_header;
pub use scene::Scene;
pub use urdf::stl;

/// One file of an export.
#[derive(Clone, Debug, PartialEq)]
pub struct File {
    /// Its name, without a folder.
    pub name: String,
    /// What is in it.
    pub bytes: Vec<u8>,
}

/// A format of another program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// An animated glTF binary (`.glb`), for Blender and web viewers.
    Gltf,
    /// Hand and object as URDF with their meshes, and the joints' trajectory as CSV.
    Urdf,
    /// A MuJoCo model with its meshes, and a trajectory of controls with the grasp forces fed forward.
    Mjcf,
    /// A table, one row a state.
    Csv,
    /// The same as NumPy arrays.
    Npz,
}

impl Format {
    /// All formats.
    pub const ALL: [Self; 5] = [Self::Gltf, Self::Urdf, Self::Mjcf, Self::Csv, Self::Npz];

    /// What the command line calls it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Gltf => "gltf",
            Self::Urdf => "urdf",
            Self::Mjcf => "mjcf",
            Self::Csv => "csv",
            Self::Npz => "npz",
        }
    }
}
