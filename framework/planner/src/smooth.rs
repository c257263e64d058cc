//! Smoothing: fewer regrasps, shorter motions.
//!
//! A motion visits *stations*: poses at which the object rests while fingers are regrasped. A shortcut leaves
//! station k with only some of its regrasps made (or none), rolls straight to the pose of a later station l,
//! and regrasps there to the contacts with which the motion left l before. It is taken where it needs fewer
//! regrasps. Goals stay where they are: a shortcut may end or start at a goal's pose, never pass it by.
//!
//! The idea of shortcuts is that of R. Geraerts and M. Overmars, "Creating high-quality paths for motion
//! planning", IJRR 2007; what a shortcut is here, and that it counts regrasps before lengths, is our own: the
//! paper (A. Sahbani, J.-P. Saut, V. Perdereau, SSD 2007, "Solving dexterous manipulation queries") smooths
//! "to eliminate unnecessary motions" and does not say how.

use crate::draft::{Draft, Station, regrasps};
use crate::foresight::barred_half_way;
use crate::order::regrasp_all;
use crate::segments::{differing, moves};
use crate::session::{Call, Counted, Session, Work};
use crate::steps::{transfer, transfer_then_regrasp};
use regrasp_api::{CallError, Configuration, FingerSet, Tally, Task};
use regrasp_plan::Segment;
use std::collections::HashSet;
use std::hash::{Hash, Hasher};

/// How many stations ahead a shortcut may reach.
const REACH: usize = 3;

/// Shortens a motion in place.
pub(crate) struct Smoother<'a> {
    pub session: &'a Session<'a>,
    pub task: &'a Task<'a>,
    pub draft: Draft,
    /// Shortcuts that failed before, by their keys: later sweeps leave them out.
    pub failed: HashSet<u64>,
}

/// A shortcut to try: from the start of station `from`, with the fingers `first` regrasped there, to the end
/// of station `to`.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Shortcut {
    from: Station,
    to: Station,
    first: FingerSet,
}

impl Smoother<'_> {
    /// Tries shortcuts, station by station, at most `tries` in all; stops early where the run is interrupted.
    pub fn run(&mut self, tries: usize, tally: &mut Tally) -> Result<(), CallError> {
        self.draft.trim_end();
        let (mut left, mut improved) = (tries, true);
        while improved && left > 0 {
            improved = false;
            let mut place = 0;
            while left > 0 && place < self.draft.stations().len() {
                if self.improve(place, &mut left, tally)? {
                    improved = true;
                } else {
                    place += 1;
                }
            }
        }
        Ok(())
    }

    /// Takes the first shortcut from the station at `place` that works; whether there was one.
    fn improve(&mut self, place: usize, left: &mut usize, tally: &mut Tally) -> Result<bool, CallError> {
        let shortcuts = self.shortcuts(place);
        let count = shortcuts.len().min(*left);
        let (mut found, mut failed) = (None, Vec::new());
        {
            let (this, number) = (&*self, *left);
            let attempts = this.session.until_found(this.session.threads(), count, |session, i| {
                this.attempt(session, &shortcuts[i], number - i)
            });
            for (i, tried) in attempts.enumerate() {
                *left -= 1;
                tally.add(&tried.tally);
                match tried.result? {
                    None => failed.push(self.key(&shortcuts[i])),
                    Some(segments) => {
                        found = Some((shortcuts[i], segments));
                        break;
                    }
                }
            }
        }
        self.failed.extend(failed);
        let Some((shortcut, segments)) = found else { return Ok(false) };
        self.draft.replace(shortcut.from.start..shortcut.to.end, segments);
        Ok(true)
    }

    /// The shortcuts worth trying from the station at `place`, the most rewarding first.
    fn shortcuts(&self, place: usize) -> Vec<Shortcut> {
        let stations = self.draft.stations();
        let from = stations[place];
        let mut all = Vec::new();
        for &to in stations[place + 1..].iter().take(REACH).rev() {
            if !self.draft.passes_a_goal(from, to) {
                all.push(Shortcut { from, to, first: FingerSet::EMPTY });
            }
        }
        if let Some(&to) = stations.get(place + 1).filter(|&&to| !self.draft.passes_a_goal(from, to)) {
            let moved = differing(self.draft.boundary(from.start), self.draft.boundary(from.end));
            let subsets =
                (1..=u8::MAX).map(FingerSet::from_bits).filter(|&set| set.intersection(moved) == set);
            let mut subsets: Vec<_> = subsets.filter(|set| set.len() < moved.len()).collect();
            subsets.sort_by_key(|set| set.len());
            all.extend(subsets.into_iter().map(|first| Shortcut { from, to, first }));
        }
        all.retain(|shortcut| {
            self.fewest_regrasps(shortcut) < self.regrasps_between(shortcut)
                && !self.failed.contains(&self.key(shortcut))
                && barred_half_way(self.task, &self.departure(shortcut), &self.arrival(shortcut).X_HO)
                    .is_none()
        });
        all
    }

    /// The segments of a shortcut if it works and needs fewer regrasps; `number` tells the tries apart.
    fn attempt(
        &self,
        session: &Session<'_>,
        shortcut: &Shortcut,
        number: usize,
    ) -> Counted<Result<Option<Vec<Segment>>, CallError>> {
        session.counted(self.task, (Call::Smooth, number as u64, 0), |work| {
            let segments = self.segments_of(work, shortcut)?;
            Ok(segments.filter(|segments| regrasps(segments) < self.regrasps_between(shortcut)))
        })
    }

    fn segments_of(
        &self,
        work: &mut Work<'_>,
        shortcut: &Shortcut,
    ) -> Result<Option<Vec<Segment>>, CallError> {
        let (start, there) = (self.draft.boundary(shortcut.from.start), self.departure(shortcut));
        let Some(mut segments) = regrasp_all(work, start, &there)? else { return Ok(None) };
        let to = self.arrival(shortcut);
        let rest = if self.draft.is_free_end(shortcut.to.end) {
            let (reached, segment) = transfer(work, &there, &to.X_HO)?;
            reached.is_complete().then(|| vec![segment])
        } else {
            transfer_then_regrasp(work, &there, to)?
        };
        let Some(rest) = rest else { return Ok(None) };
        segments.extend(rest);
        // Without any motion there would be no segment left to smooth.
        Ok(Some(segments).filter(|segments| segments.iter().any(moves)))
    }

    /// The configuration in which a shortcut leaves its first station.
    fn departure(&self, shortcut: &Shortcut) -> Configuration {
        let leave = self.draft.boundary(shortcut.from.end);
        let mut there = self.draft.boundary(shortcut.from.start).clone();
        for finger in shortcut.first.iter() {
            (there.joints[finger], there.contacts[finger]) = (leave.joints[finger], leave.contacts[finger]);
        }
        there
    }

    /// The configuration in which a shortcut ends.
    fn arrival(&self, shortcut: &Shortcut) -> &Configuration {
        self.draft.boundary(shortcut.to.end)
    }

    /// What tells a shortcut's motion from any other: joints at departure and arrival, to the last bit.
    fn key(&self, shortcut: &Shortcut) -> u64 {
        let mut hasher = std::hash::DefaultHasher::new();
        for q in [&self.departure(shortcut), self.arrival(shortcut)] {
            let joints = q.joints.iter().flat_map(|(_, joints)| joints.iter());
            joints.for_each(|joint| joint.to_bits().hash(&mut hasher));
        }
        hasher.finish()
    }

    /// The regrasps that a shortcut needs at least: after a roll every holding finger has drifted.
    fn fewest_regrasps(&self, shortcut: &Shortcut) -> usize {
        let at_end = if self.draft.is_free_end(shortcut.to.end) {
            0
        } else {
            self.draft.boundary(shortcut.to.end).holding().len()
        };
        shortcut.first.len() + at_end
    }

    fn regrasps_between(&self, shortcut: &Shortcut) -> usize {
        regrasps(&self.draft.segments[shortcut.from.start..shortcut.to.end])
    }
}
