//! What is asked for.

use crate::GraspsError;

/// How many grasps, and of which kind. Every field is public; [`Wish::validate`] checks the ranges.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wish {
    /// How many grasps, 1 or more.
    pub count: usize,
    /// Seed of all random choices.
    pub seed: u64,
    /// How far two grasps are apart at least (m), in 1e-6 to 1; [`crate::Twins`] says what is measured.
    pub spread: f64,
    /// The most grasps that are kept at one pose of the object, 1 to 1000: few spread the set over poses,
    /// many are found faster.
    pub per_pose: usize,
    /// The most grasps that are kept in which the same fingers touch the same facets; `None` for any number.
    pub per_facets: Option<usize>,
    /// How few and how many fingers hold, both included; as the contact model and the hand allow where
    /// `None`.
    pub fingers: Option<(usize, usize)>,
    /// Whether regrasps between the grasps of one pose are looked for.
    pub graph: bool,
}

impl Default for Wish {
    fn default() -> Self {
        Self {
            count: 1000,
            seed: 0,
            spread: 2e-3,
            per_pose: 8,
            per_facets: None,
            fingers: None,
            graph: false,
        }
    }
}

impl Wish {
    /// Refuses the first value outside its range.
    pub fn validate(&self) -> Result<(), GraspsError> {
        let bounds = [
            ("count", self.count as f64, 1.0, 1e10),
            ("spread", self.spread, 1e-6, 1.0),
            ("per_pose", self.per_pose as f64, 1.0, 1000.0),
            ("per_facets", self.per_facets.unwrap_or(1) as f64, 1.0, 1e10),
        ];
        match bounds.into_iter().find(|(_, value, low, high)| !(low..=high).contains(&value)) {
            Some((key, value, low, high)) => Err(GraspsError::Range { key, value, low, high }),
            None => Ok(()),
        }
    }
}
