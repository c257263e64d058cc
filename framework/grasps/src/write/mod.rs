//! Grasps as files for other programs: NumPy arrays, JSON lines, a MuJoCo model with keyframes, reset states.

mod columns;
mod keyframes;
mod lines;
mod npz;
mod resets;

pub use keyframes::{Keyframes, keyframes};
pub use lines::lines;
pub use npz::npz;
pub use resets::resets;

use crate::Layout;
use crate::graph::Edge;
use crate::grasp::BulkGrasp;
use regrasp_api::HandDescription;
use std::io;

/// Grasps that can be gone through again and again, wherever they are.
pub trait Rows {
    /// Every grasp in turn.
    fn each(&self, take: &mut dyn FnMut(&BulkGrasp) -> io::Result<()>) -> io::Result<()>;
    /// Every regrasp in turn.
    fn each_edge(&self, take: &mut dyn FnMut(&Edge) -> io::Result<()>) -> io::Result<()>;
}

/// What the files say beside the grasps.
#[derive(Clone, Debug)]
pub struct Set<'a> {
    /// Grasps, and regrasps between them.
    pub rows: &'a dyn Rows,
    /// How many grasps.
    pub grasps: u64,
    /// How many regrasps; `None` where they were not looked for.
    pub edges: Option<u64>,
    /// The hand.
    pub hand: &'a HandDescription,
    /// The form of the grasps.
    pub layout: &'a Layout,
    /// What the set is, as JSON text: scenario, object, plugins, seed, spread, versions.
    pub info: &'a str,
    /// The whole problem as JSON text, a plan file without motion, so that the arrays stand alone.
    pub problem: &'a str,
}

impl std::fmt::Debug for dyn Rows + '_ {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("grasps")
    }
}
