//! The smallest share of the friction with which a grasp holds its load.

use super::bearing::Bearing;
use super::newton::{Balanced, Forces, Search};
use nalgebra::Vector6;

/// How near the bounds of the smallest share are, relative to it.
const NEAR: f64 = 0.02;
/// The most searches for one share.
const MOST: usize = 14;
/// The largest share that is looked for: a grasp that needs more holds by no friction worth the name.
pub(crate) const LARGEST: f64 = 8.0;
/// Shares below this are as good as none.
pub(crate) const LEAST: f64 = 0.02;

/// The smallest share of the friction at which some forces balance a load within the efforts, and such
/// forces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Smallest {
    /// Forces that need no more than this share are known ...
    pub share: f64,
    /// ... these.
    pub forces: Forces,
}

/// The largest share that a contact's force needs.
pub(crate) fn share_of(bearings: &[Bearing], forces: &Forces) -> f64 {
    bearings.iter().zip(forces).map(|(bearing, x)| bearing.share(x)).fold(0.0, f64::max)
}

/// Looks for the smallest share, beginning at `from`; `None` where none up to eight times the friction holds.
///
/// For each share it is a question of second-order cones and half-spaces, answered by Newton's method with a
/// proof either way; every yes brings the bound down to what its forces need, every no halves what is left
/// (S. Boyd, B. Wegbreit, "Fast computation of optimal contact forces", IEEE T-RO 2007, bisect over bounds in
/// the same manner).
pub fn smallest_share(bearings: &[Bearing], wanted: &Vector6<f64>, from: f64) -> Option<Smallest> {
    share_between(bearings, wanted, (0.0, from), (LARGEST, NEAR))
}

/// The same where shares up to `low` are known to be too small, none above `most` is of use, and the bounds
/// of the smallest share need only be as `near`, relative to it.
pub(crate) fn share_between(
    bearings: &[Bearing],
    wanted: &Vector6<f64>,
    (mut low, from): (f64, f64),
    (most, near): (f64, f64),
) -> Option<Smallest> {
    let find = |share: f64| {
        let search = Search { bearings, share };
        match search.any(&search.start(), wanted) {
            Balanced::Yes(forces) => Some(Smallest { share: share_of(bearings, &forces).max(LEAST), forces }),
            _ => None,
        }
    };
    let mut share = from;
    let mut best = loop {
        if let Some(found) = find(share) {
            break found;
        }
        if share >= most {
            return None;
        }
        (low, share) = (share, (2.0 * share).min(most));
    };
    for _ in 0..MOST {
        if best.share - low <= near * best.share || best.share <= LEAST {
            break;
        }
        let middle = 0.5 * (low + best.share);
        match find(middle) {
            Some(found) => best = found,
            None => low = middle,
        }
    }
    Some(best)
}
