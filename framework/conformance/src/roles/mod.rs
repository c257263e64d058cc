//! The laws of each role.

pub(crate) mod contact_model;
mod stability;

use crate::law::Law;
use regrasp_api::Slot;

/// The laws of the plugins for a slot.
pub(crate) fn laws(slot: Slot) -> &'static [Law] {
    match slot {
        Slot::ContactModel => contact_model::LAWS,
        Slot::StabilityTest => stability::LAWS,
        _ => &[],
    }
}
