//! A robot as plain data: links, joints and shapes, each with its line in the file that it comes from.

use crate::error::RobotFault;
use regrasp_api::{Pose, Vec3};
use std::collections::BTreeMap;

/// A robot as its file has it.
#[derive(Debug, Default)]
pub struct Robot {
    /// What it is called.
    pub name: String,
    /// Its links, in the file's order.
    pub links: Vec<Link>,
    /// Its joints, in the file's order.
    pub joints: Vec<Joint>,
    /// Pairs of links that never count as touching.
    pub excluded: Vec<[String; 2]>,
    /// Postures that the file names.
    pub key_frames: Vec<KeyFrame>,
    /// What of the file is not known, or not used although it might have been meant to change the hand: with
    /// lines, for people.
    pub remarks: Vec<String>,
    /// What of the file says nothing that planning needs: with lines, for people.
    pub ignored: Vec<String>,
}

/// A posture with a name.
#[derive(Clone, Debug, PartialEq)]
pub struct KeyFrame {
    /// What it is called.
    pub name: String,
    /// Where joints stand (rad; m), by name.
    pub positions: BTreeMap<String, f64>,
}

/// A rigid body.
#[derive(Debug)]
pub struct Link {
    /// What it is called.
    pub name: String,
    /// Its line in the file, counted from 1.
    pub line: usize,
    /// Shapes that touch. What is wrong with the shapes of a link matters only where they are used.
    pub collision: Result<Vec<Solid>, RobotFault>,
    /// Shapes that are seen.
    pub visual: Result<Vec<Solid>, RobotFault>,
    /// Its mass (kg), where the file has it.
    pub mass: Option<f64>,
}

/// A geometry with its pose in the link's frame.
#[derive(Clone, Debug)]
pub struct Solid {
    /// Its line in the file, counted from 1.
    pub line: usize,
    /// Its pose in the link's frame.
    pub X_LS: Pose,
    /// Its form.
    pub geometry: Geometry,
}

/// The form of a solid, about its own origin; cylinders and capsules along z. Lengths in metres.
#[derive(Clone, Debug)]
pub enum Geometry {
    /// A box of these edges.
    Box {
        /// The edges (m).
        size: [f64; 3],
    },
    /// A ball.
    Sphere {
        /// Its radius (m).
        radius: f64,
    },
    /// An ellipsoid along the axes.
    Ellipsoid {
        /// Half its lengths along x, y and z (m).
        semi_axes: [f64; 3],
    },
    /// A cylinder.
    Cylinder {
        /// Its radius (m).
        radius: f64,
        /// Its length (m).
        length: f64,
    },
    /// A cylinder with half balls at its ends.
    Capsule {
        /// Its radius (m).
        radius: f64,
        /// The length of its straight part (m).
        length: f64,
    },
    /// A mesh of a file.
    Mesh {
        /// The file, as the robot's file names it.
        file: String,
        /// What its coordinates are multiplied with.
        scale: [f64; 3],
    },
}

/// How a joint moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// It does not.
    Fixed,
    /// It turns within limits.
    Revolute,
    /// It turns without end.
    Continuous,
    /// It slides.
    Prismatic,
    /// `floating`, `planar` or `spherical`.
    Other,
}

/// What joins two links.
#[derive(Debug)]
pub struct Joint {
    /// What it is called.
    pub name: String,
    /// Its line in the file, counted from 1.
    pub line: usize,
    /// How it moves.
    pub kind: Kind,
    /// The link that carries it.
    pub parent: String,
    /// The link that it moves.
    pub child: String,
    /// The joint's frame at position 0, in the parent link's frame.
    pub X_PJ: Pose,
    /// Its axis, of length 1, in its own frame.
    pub axis: Vec3,
    /// Its limits.
    pub limit: Option<Limit>,
    /// Limits of its controller.
    pub soft: Option<Soft>,
    /// What drives it; absent where it moves by itself.
    pub mimic: Option<Mimic>,
}

/// What `<limit>` says; `None` for an attribute that it lacks.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Limit {
    /// Its line in the file, counted from 1.
    pub line: usize,
    /// Lowest position (rad; m).
    pub lower: Option<f64>,
    /// Highest position (rad; m).
    pub upper: Option<f64>,
    /// Largest speed (rad/s; m/s).
    pub velocity: Option<f64>,
    /// Largest effort (N·m; N).
    pub effort: Option<f64>,
    /// Largest acceleration (rad/s²; m/s²).
    pub acceleration: Option<f64>,
}

/// Limits of a joint's controller, inside those of the joint; `None` for an attribute that it lacks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Soft {
    /// Its line in the file, counted from 1.
    pub line: usize,
    /// Lowest position (rad; m).
    pub lower: Option<f64>,
    /// Highest position (rad; m).
    pub upper: Option<f64>,
}

/// q = multiplier · q of the driving joint + offset.
#[derive(Clone, Debug, PartialEq)]
pub struct Mimic {
    /// Its line in the file, counted from 1.
    pub line: usize,
    /// The driving joint.
    pub joint: String,
    /// By what its position is multiplied.
    pub multiplier: f64,
    /// What is added (rad; m).
    pub offset: f64,
}
