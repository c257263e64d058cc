//! What was understood of a robot's file.

use regrasp_api::HandDescription;
use serde::Serialize;

/// A hand from a robot's file, and how it was understood.
#[derive(Clone, Debug, PartialEq)]
pub struct ReadHand {
    /// The hand; meshes are in place.
    pub description: HandDescription,
    /// What was understood, chosen and ignored.
    pub report: HandReport,
}

/// What was understood of a file, chosen and ignored; sentences are for people.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct HandReport {
    /// The link whose frame is the hand's.
    pub palm: String,
    /// The tip links, one a finger.
    pub tips: Vec<String>,
    /// Whether the tips were guessed.
    pub tips_guessed: bool,
    /// For each finger where its ball was put, and why there.
    pub tip_centers: Vec<String>,
    /// For each link with a shape what was made of it.
    pub shapes: Vec<String>,
    /// Pairs that touch in all sampled postures and are excluded: `palm`, a joint (the link behind it), or a
    /// finger (its tip).
    pub touching: Vec<[String; 2]>,
    /// Pairs that touch in most sampled postures, with their share: not excluded.
    pub often_touching: Vec<([String; 2], f64)>,
    /// What was ignored.
    pub ignored: Vec<String>,
    /// What was chosen or changed.
    pub notes: Vec<String>,
}
