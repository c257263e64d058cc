//! Forces that hold a load inside friction cones and within the joints' efforts: which there are, and how
//! little friction they need.

mod barrier;
mod bearing;
mod edged;
mod ldl;
mod load;
mod newton;
mod share;

pub(crate) use bearing::stacked;
pub use bearing::{Bearing, Exerted, Press};
pub use edged::{Edged, EdgesBalanced, Weights};
pub(crate) use edged::{balance, centre_of_weights, may_start, start};
pub use load::{Answer, Bearings, EdgesAnswer, HeldLoad};
pub(crate) use newton::Search;
pub use newton::{Balanced, Forces};
pub(crate) use share::{LARGEST, LEAST, share_between, share_of};
pub use share::{Smallest, smallest_share};

#[cfg(test)]
mod tests;
