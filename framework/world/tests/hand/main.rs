//! Hands: forward kinematics and Jacobians against independent formulas, inverse kinematics, limits, reach,
//! bad descriptions.

mod bad;
mod batch;
mod driven;
mod forward;
mod hands;
mod inverse;
mod oracle;
mod reach;
