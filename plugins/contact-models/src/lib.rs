//! Built-in contact models: point contact with friction, frictionless point, soft finger.
//!
//! Each is an elliptic cone `|f_t|²/μ² + m²/γ² ≤ f_n²`, so that the exact stability tests serve all three.

mod frictionless;
mod pcwf;
mod soft_finger;

pub use frictionless::Frictionless;
pub use pcwf::Pcwf;
pub use soft_finger::{SoftFinger, SoftFingerSettings};
