//! Role 1: which wrenches a contact can transmit.

use crate::{Cone, Contact};

/// Says which wrenches a contact between fingertip and object can transmit: a cone as data.
pub trait ContactModel: Send + Sync {
    /// The cone of one contact under the friction coefficient `mu` ≥ 0 (no unit).
    ///
    /// Monotone: a larger `mu` gives a cone that contains the smaller one's.
    fn cone(&self, contact: &Contact, mu: f64) -> Cone<'_>;

    /// The fewest contacts that can be stable under this model: 3 for point contacts with friction.
    ///
    /// The planner searches in GS_n with n one more than this.
    fn fewest_contacts(&self) -> usize;
}
const _: Option<&dyn ContactModel> = None; // must stay object safe
