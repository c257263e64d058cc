//! What hands can do with objects: an atlas of the orientations that they reach, by size, shape, friction and
//! mass.
//!
//! For each [`Member`] of a family (a hand with an object) start grasps are drawn, and from each the object
//! is to be turned into an orientation drawn uniformly from all ([`explore`]). Whether a verified plan takes
//! it there, and with how many regrasps, is an [`Attempt`]. [`Summary`] makes shares with intervals of these,
//! [`page`] draws them. A [`Journal`] keeps what was found, member by member, so that an atlas that was
//! killed goes on.
//!
//! A share is a lower bound: an orientation that was not reached may be beyond the budget and not beyond the
//! hand.

mod attempt;
mod bins;
mod error;
mod explore;
mod hand;
mod journal;
mod member;
mod page;
mod starts;
mod summary;
mod tables;
mod text;
mod wish;

pub use attempt::{Attempt, Cell, Found};
pub use bins::{ANGLES_DEG, Sector};
pub use error::AtlasError;
pub use explore::{Ended, Told, explore};
pub use hand::AtlasHand;
pub use journal::Journal;
pub use member::{Member, Shape};
pub use page::page;
pub use summary::{Bin, CellSummary, Share, Summary};
pub use tables::{attempts_csv, cells_csv, json};
pub use wish::Wish;
