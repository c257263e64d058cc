//! Smoothing: fewer regrasps, shorter motions.
//!
//! A motion visits *stations*: poses at which the object rests while fingers are regrasped. A shortcut leaves station k with
//! only some of its regrasps made (or none), rolls straight to the pose of a later station l, and regrasps there to the contacts
//! with which the motion left l before. It is taken where it needs fewer regrasps. Goals stay where they are: a shortcut may
//! end or start at a goal's pose, never pass it by.

use crate::session::{Call, Counted, Session};
use crate::steps;
use regrasp_api::{CallError, Configuration, Context, FingerSet, Tally, Task};
use regrasp_plan::{Segment, SegmentKind};

/// How many stations ahead a shortcut may reach.
const REACH: usize = 3;

/// A goal in a motion: the boundary between segments at which the object is there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Mark {
    /// The number of segments before it.
    pub boundary: usize,
    /// Whether the goal gives its grasp.
    pub grasp_given: bool,
}

/// Shortens a motion in place.
pub(crate) struct Smoother<'a> {
    pub session: &'a Session<'a>,
    pub task: &'a Task<'a>,
    pub segments: Vec<Segment>,
    pub marks: Vec<Mark>,
}

/// A place where the object rests: boundaries `start..=end`, with the regrasps between them.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Station {
    start: usize,
    end: usize,
}

/// A shortcut to try: from the start of station `from`, with the fingers `first` regrasped there, to the end of station `to`.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Shortcut {
    from: Station,
    to: Station,
    first: FingerSet,
}

impl Smoother<'_> {
    /// Tries shortcuts, station by station, at most `tries` in all; stops early where the run is interrupted.
    pub fn run(&mut self, tries: usize, tally: &mut Tally) -> Result<(), CallError> {
        self.trim_end();
        let (mut left, mut improved) = (tries, true);
        while improved && left > 0 {
            improved = false;
            let mut place = 0;
            while left > 0 && place < self.stations().len() {
                if self.improve(place, &mut left, tally)? {
                    improved = true;
                } else {
                    place += 1;
                }
            }
        }
        Ok(())
    }

    /// Drops regrasps after the last goal is reached, where its grasp does not matter.
    fn trim_end(&mut self) {
        let Some(last) = self.marks.last_mut().filter(|mark| !mark.grasp_given) else { return };
        while self.segments.last().is_some_and(is_regrasp) && last.boundary == self.segments.len() {
            self.segments.pop();
            last.boundary -= 1;
        }
    }

    /// Takes the first shortcut from the station at `place` that works; whether there was one.
    fn improve(&mut self, place: usize, left: &mut usize, tally: &mut Tally) -> Result<bool, CallError> {
        let shortcuts = self.shortcuts(place);
        let count = shortcuts.len().min(*left);
        let mut found = None;
        {
            let this = &*self;
            for (i, tried) in
                this.session.ahead(count, |i| this.attempt(&shortcuts[i], (place, i))).enumerate()
            {
                *left -= 1;
                tally.add(&tried.tally);
                if let Some(segments) = tried.result? {
                    found = Some((shortcuts[i], segments));
                    break;
                }
            }
        }
        let Some((shortcut, segments)) = found else { return Ok(false) };
        self.replace(&shortcut, segments);
        Ok(true)
    }

    /// The shortcuts worth trying from the station at `place`, the most rewarding first.
    fn shortcuts(&self, place: usize) -> Vec<Shortcut> {
        let stations = self.stations();
        let from = stations[place];
        let mut all = Vec::new();
        for &to in stations[place + 1..].iter().take(REACH).rev() {
            if !self.passes_a_goal(from, to) {
                all.push(Shortcut { from, to, first: FingerSet::EMPTY });
            }
        }
        if let Some(&to) = stations.get(place + 1).filter(|&&to| !self.passes_a_goal(from, to)) {
            let moved = steps::differing(self.boundary(from.start), self.boundary(from.end));
            let subsets =
                (1..=u8::MAX).map(FingerSet::from_bits).filter(|&set| set.intersection(moved) == set);
            let mut subsets: Vec<_> = subsets.filter(|set| set.len() < moved.len()).collect();
            subsets.sort_by_key(|set| set.len());
            all.extend(subsets.into_iter().map(|first| Shortcut { from, to, first }));
        }
        all.retain(|shortcut| self.fewest_regrasps(shortcut) < regrasps(self.range(shortcut)));
        all
    }

    /// The segments of a shortcut if it works and needs fewer regrasps.
    fn attempt(
        &self,
        shortcut: &Shortcut,
        key: (usize, usize),
    ) -> Counted<Result<Option<Vec<Segment>>, CallError>> {
        self.session.counted(Call::Smooth, key.0 as u64, key.1 as u64, |context| {
            let segments = self.segments_of(shortcut, context)?;
            Ok(segments.filter(|segments| regrasps(segments) < regrasps(self.range(shortcut))))
        })
    }

    fn segments_of(
        &self,
        shortcut: &Shortcut,
        context: &mut Context<'_>,
    ) -> Result<Option<Vec<Segment>>, CallError> {
        let (session, task) = (self.session, self.task);
        let (start, leave) = (self.boundary(shortcut.from.start), self.boundary(shortcut.from.end));
        let mut there = start.clone();
        for finger in shortcut.first.iter() {
            (there.joints[finger], there.contacts[finger]) = (leave.joints[finger], leave.contacts[finger]);
        }
        let Some(mut segments) = steps::regrasp_all(session, task, start, &there, context)? else {
            return Ok(None);
        };
        let to = self.boundary(shortcut.to.end);
        let rest = if self.is_free_end(shortcut.to.end) {
            let (reached, segment) = steps::transfer(session, task, &there, to, context)?;
            reached.is_complete().then(|| vec![segment])
        } else {
            steps::transfer_then_regrasp(session, task, &there, to, context)?
        };
        Ok(rest.map(|rest| {
            segments.extend(rest);
            segments
        }))
    }

    /// The regrasps that a shortcut needs at least: after a roll every holding finger has drifted.
    fn fewest_regrasps(&self, shortcut: &Shortcut) -> usize {
        let at_end = if self.is_free_end(shortcut.to.end) {
            0
        } else {
            self.boundary(shortcut.to.end).holding().len()
        };
        shortcut.first.len() + at_end
    }

    /// Whether any grasp will do at this boundary: the motion ends there, at a goal without a grasp of its own.
    fn is_free_end(&self, boundary: usize) -> bool {
        boundary == self.segments.len()
            && self.marks.last().is_some_and(|mark| mark.boundary == boundary && !mark.grasp_given)
    }

    /// Whether a goal lies strictly between the two stations, or its given grasp inside one of them.
    fn passes_a_goal(&self, from: Station, to: Station) -> bool {
        self.marks.iter().any(|mark| {
            let inside = from.start < mark.boundary && mark.boundary < to.end;
            let at_an_end = mark.boundary <= from.end || mark.boundary >= to.start;
            inside && (mark.grasp_given || !at_an_end)
        })
    }

    fn replace(&mut self, shortcut: &Shortcut, segments: Vec<Segment>) {
        let (start, end) = (shortcut.from.start, shortcut.to.end);
        let new_end = start + segments.len();
        for mark in &mut self.marks {
            if mark.boundary >= end {
                mark.boundary = mark.boundary - end + new_end;
            } else if mark.boundary >= shortcut.to.start {
                mark.boundary = new_end;
            } else if mark.boundary > start {
                mark.boundary = start;
            }
        }
        self.segments.splice(start..end, segments);
    }

    fn range(&self, shortcut: &Shortcut) -> &[Segment] {
        &self.segments[shortcut.from.start..shortcut.to.end]
    }

    /// The configuration between segment `k - 1` and segment `k`.
    fn boundary(&self, k: usize) -> &Configuration {
        let state = match self.segments.get(k) {
            Some(segment) => segment.states.first(),
            None => self.segments.last().and_then(|segment| segment.states.last()),
        };
        state.expect("a segment has at least two states, and a smoothed motion one segment")
    }

    /// The stations in turn: start, every pose between transfers, end.
    fn stations(&self) -> Vec<Station> {
        let mut stations = vec![Station { start: 0, end: 0 }];
        for (k, segment) in self.segments.iter().enumerate() {
            if is_regrasp(segment) {
                stations.last_mut().expect("never empty").end = k + 1;
            } else {
                stations.push(Station { start: k + 1, end: k + 1 });
            }
        }
        stations
    }
}

fn is_regrasp(segment: &Segment) -> bool {
    matches!(segment.kind, SegmentKind::Regrasp(_))
}

/// How many of the segments are regrasps.
pub(crate) fn regrasps(segments: &[Segment]) -> usize {
    segments.iter().filter(|segment| is_regrasp(segment)).count()
}
