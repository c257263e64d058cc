//! The built-in local planners: `linear` inside GS_n; `rolling`, `fixed-point` and (feature `rapier`)
//! `rapier-checked` for transfers; `rrt` and `lift-slide-touch` for regrasps.
//!
//! Each connects two configurations inside one kind of subspace (Sahbani, Saut, Perdereau, "An efficient
//! algorithm for dexterous manipulation planning", SSD 2007, section IV).

mod common;
pub mod fixed_point;
pub mod lift_slide_touch;
pub mod linear;
#[cfg(feature = "rapier")]
pub mod rapier_checked;
mod regrasp;
pub mod rolling;
pub mod rrt;
mod transfer;

pub use fixed_point::{FixedPoint, FixedPointSettings};
pub use lift_slide_touch::{LiftSlideTouch, LiftSlideTouchSettings};
pub use linear::{Linear, LinearSettings};
#[cfg(feature = "rapier")]
pub use rapier_checked::{RapierChecked, RapierCheckedSettings};
pub use rolling::{Rolling, RollingSettings};
pub use rrt::{Rrt, RrtSettings};
