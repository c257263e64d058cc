//! Built-in stability tests: exact force closure, the conic program that it is checked against, cones of
//! edges, the wrench ball, equilibrium, holding.

mod balance;
mod closure;
mod contacts;
mod edges;
mod equilibrium;
mod force_closure;
mod holding;
mod hull;
mod linearised;
mod socp;
mod spanning;
mod wrench_ball;
mod wrenches;

pub use equilibrium::{Equilibrium, EquilibriumSettings};
pub use force_closure::{ForceClosure, ForceClosureSettings};
pub use holding::{Holding, HoldingSettings};
pub use linearised::{Linearised, LinearisedSettings};
pub use socp::{Socp, SocpSettings};
pub use wrench_ball::{Center, WrenchBall, WrenchBallSettings};
