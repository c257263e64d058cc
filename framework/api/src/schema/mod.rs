//! Plain data against a JSON schema: where they depart from it, and what was probably meant.

mod departure;
mod described;
mod example;
mod near;
mod unit;
mod walk;

pub use departure::*;
pub use described::{check_described, check_field};
pub use example::*;
pub use near::*;
pub use unit::*;
pub use walk::{check_schema, fill_defaults};

pub(crate) use described::schema_of;
