//! How many grasps are kept of one choice of facets.

use crate::grasp::BulkGrasp;
use std::collections::HashMap;

/// The facets that fingers touch, finger by finger; `None` where one does not.
type Facets = Vec<Option<u32>>;

/// Counts grasps by the facets that their fingers touch.
pub(crate) struct Quota {
    most: Option<usize>,
    kept: HashMap<Facets, usize>,
}

impl Quota {
    /// At most so many of each; `None` for any number.
    pub fn new(most: Option<usize>) -> Self {
        Self { most, kept: HashMap::new() }
    }

    /// Whether one more of its kind may be kept.
    pub fn has_room(&self, grasp: &BulkGrasp) -> bool {
        self.most.is_none_or(|most| self.kept.get(&facets(grasp)).is_none_or(|&kept| kept < most))
    }

    /// Takes in a grasp that is kept.
    pub fn add(&mut self, grasp: &BulkGrasp) {
        if self.most.is_some() {
            *self.kept.entry(facets(grasp)).or_default() += 1;
        }
    }
}

fn facets(grasp: &BulkGrasp) -> Facets {
    grasp.q.contacts.iter().map(|(_, contact)| contact.map(|contact| contact.facet)).collect()
}
