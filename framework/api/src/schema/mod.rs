//! Plain data against a JSON schema: where they depart from it, and what was probably meant.

mod departure;
mod example;
mod near;
mod unit;
mod walk;

pub use departure::*;
pub use example::*;
pub use near::*;
pub use unit::*;
pub use walk::*;
