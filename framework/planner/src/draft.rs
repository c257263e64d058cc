//! A motion while it is being smoothed: its segments, its stations, and where its goals are.

use crate::segments::moves;
use regrasp_api::{Configuration, Rotation};
use regrasp_plan::{Segment, SegmentKind};

/// A goal in a motion: the boundary between segments at which the object is there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Mark {
    /// The number of segments before it.
    pub boundary: usize,
    /// Whether the goal gives its grasp.
    pub grasp_given: bool,
}

/// A place where the object rests: boundaries `start..=end`, with the regrasps between them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Station {
    pub start: usize,
    pub end: usize,
}

/// Segments with the goals that they reach.
#[derive(Clone, Debug, Default)]
pub(crate) struct Draft {
    /// The segments in turn.
    pub segments: Vec<Segment>,
    /// The goals in turn.
    pub marks: Vec<Mark>,
}

impl Draft {
    /// Drops regrasps after the last goal is reached, where its grasp does not matter.
    pub fn trim_end(&mut self) {
        let Some(last) = self.marks.last_mut().filter(|mark| !mark.grasp_given) else { return };
        while self.segments.last().is_some_and(is_regrasp) && last.boundary == self.segments.len() {
            self.segments.pop();
            last.boundary -= 1;
        }
    }

    /// The stations in turn: start, every pose between transfers, end.
    pub fn stations(&self) -> Vec<Station> {
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

    /// The configuration between segment `k - 1` and segment `k`.
    pub fn boundary(&self, k: usize) -> &Configuration {
        let state = match self.segments.get(k) {
            Some(segment) => segment.states.first(),
            None => self.segments.last().and_then(|segment| segment.states.last()),
        };
        state.expect("a segment has at least two states, and a smoothed motion one segment")
    }

    /// Whether any grasp will do at this boundary: the motion ends there, at a goal without a grasp of its
    /// own.
    pub fn is_free_end(&self, boundary: usize) -> bool {
        boundary == self.segments.len()
            && self.marks.last().is_some_and(|mark| mark.boundary == boundary && !mark.grasp_given)
    }

    /// Whether a goal lies strictly between the two stations, or its given grasp inside one of them.
    pub fn passes_a_goal(&self, from: Station, to: Station) -> bool {
        self.marks.iter().any(|mark| {
            let inside = from.start < mark.boundary && mark.boundary < to.end;
            let at_an_end = mark.boundary <= from.end || mark.boundary >= to.start;
            inside && (mark.grasp_given || !at_an_end)
        })
    }

    /// Gives every orientation that of its two quaternions which is nearer to the one before: q and -q turn
    /// the object alike, but a plan holds numbers, and segments share theirs exactly.
    pub fn align_quaternions(&mut self) {
        let mut states = self.segments.iter_mut().flat_map(|segment| &mut segment.states);
        let Some(mut before) = states.next().map(|q| q.X_HO.rotation) else { return };
        for q in states {
            let rotation = &mut q.X_HO.rotation;
            if before.coords.dot(&rotation.coords) < 0.0 {
                *rotation = Rotation::new_unchecked(-rotation.into_inner());
            }
            before = *rotation;
        }
    }

    /// Replaces the segments of `old`, which end with a station, by those of others between the same poses
    /// that move; the goals move with them.
    pub fn replace(&mut self, old: std::ops::Range<usize>, mut segments: Vec<Segment>) {
        segments.retain(moves);
        let (start, end) = (old.start, old.end);
        let last_station =
            self.stations().into_iter().find(|station| station.end == end).map_or(end, |s| s.start);
        let new_end = start + segments.len();
        for mark in &mut self.marks {
            if mark.boundary >= end {
                mark.boundary = mark.boundary - end + new_end;
            } else if mark.boundary >= last_station {
                mark.boundary = new_end;
            } else if mark.boundary > start {
                mark.boundary = start;
            }
        }
        self.segments.splice(old, segments);
    }
}

fn is_regrasp(segment: &Segment) -> bool {
    matches!(segment.kind, SegmentKind::Regrasp(_))
}

/// How many of the segments are regrasps.
pub(crate) fn regrasps(segments: &[Segment]) -> usize {
    segments.iter().filter(|segment| is_regrasp(segment)).count()
}

#[cfg(test)]
mod tests {
    use super::*;
    use regrasp_api::{Contact, FingerIndex, PerFinger, Pose, Vec3};

    /// The object at x, one finger with a contact numbered `touch`.
    fn q(x: f64, touch: u32) -> Configuration {
        let contact = Contact { facet: touch, p_OC: Vec3::zeros(), n_O: Vec3::z() };
        Configuration {
            X_HO: Pose::translation(x, 0.0, 0.0),
            joints: PerFinger::filled(1, Default::default()),
            contacts: PerFinger::filled(1, Some(contact)),
        }
    }

    fn segment(kind: SegmentKind, from: (f64, u32), to: (f64, u32)) -> Segment {
        Segment::new(kind, vec![q(from.0, from.1), q(to.0, to.1)])
    }

    /// Transfer, regrasp, transfer, regrasp, transfer, regrasp.
    fn motion() -> Vec<Segment> {
        let regrasp = SegmentKind::Regrasp(FingerIndex(0));
        (0..3)
            .flat_map(|i| {
                let (x, touch) = (f64::from(i), 2 * i as u32);
                let roll = segment(SegmentKind::Transfer, (x, touch), (x + 1.0, touch + 1));
                [roll, segment(regrasp, (x + 1.0, touch + 1), (x + 1.0, touch + 2))]
            })
            .collect()
    }

    fn draft(marks: Vec<Mark>) -> Draft {
        Draft { segments: motion(), marks }
    }

    #[test]
    fn stations_are_where_the_object_rests() {
        let stations = draft(vec![]).stations();
        let ends: Vec<_> = stations.iter().map(|station| (station.start, station.end)).collect();
        assert_eq!(ends, [(0, 0), (1, 2), (3, 4), (5, 6)]);
    }

    #[test]
    fn regrasps_after_the_last_goal_are_dropped_unless_its_grasp_is_given() {
        for (grasp_given, left) in [(false, 5), (true, 6)] {
            let mark = Mark { boundary: 6, grasp_given };
            let mut draft = draft(vec![mark]);
            draft.trim_end();
            assert_eq!((draft.segments.len(), draft.marks[0].boundary), (left, left));
        }
    }

    #[test]
    fn one_orientation_has_one_quaternion_throughout() {
        let mut draft = draft(vec![]);
        for (k, segment) in draft.segments.iter_mut().enumerate() {
            let turned = Rotation::from_axis_angle(&Vec3::z_axis(), 0.3 * k as f64);
            let quaternion = if k % 2 == 0 { turned.into_inner() } else { -turned.into_inner() };
            segment.states.iter_mut().for_each(|q| q.X_HO.rotation = Rotation::new_unchecked(quaternion));
        }
        let before = draft.clone();
        draft.align_quaternions();
        assert!(draft.segments.iter().flat_map(|segment| &segment.states).all(|q| q.X_HO.rotation.w > 0.0));
        assert_eq!(draft.segments, before.segments, "the orientations are the same");
    }

    #[test]
    fn rests_are_left_out() {
        let mut draft = draft(vec![Mark { boundary: 3, grasp_given: false }]);
        let mut rest = segment(SegmentKind::Transfer, (0.0, 0), (0.0, 0));
        rest.states.truncate(1);
        draft.replace(0..2, vec![rest, segment(SegmentKind::Transfer, (0.0, 0), (1.0, 2))]);
        assert_eq!((draft.segments.len(), draft.marks[0].boundary), (5, 2));
        assert!(draft.segments.iter().all(moves));
    }

    #[test]
    fn no_shortcut_passes_a_goal_and_marks_move_with_the_motion() {
        let marks = vec![Mark { boundary: 3, grasp_given: false }, Mark { boundary: 6, grasp_given: true }];
        let mut draft = draft(marks);
        let stations = draft.stations();
        assert!(draft.passes_a_goal(stations[1], stations[3]));
        assert!(!draft.passes_a_goal(stations[1], stations[2]));
        assert!(!draft.passes_a_goal(stations[2], stations[3]));
        let direct = segment(SegmentKind::Transfer, (0.0, 0), (1.0, 2));
        draft.replace(0..2, vec![direct]);
        let boundaries: Vec<_> = draft.marks.iter().map(|mark| mark.boundary).collect();
        assert_eq!(boundaries, [2, 5]);
        assert_eq!(draft.boundary(2).X_HO, q(2.0, 0).X_HO, "the mark still stands at its goal's pose");
    }
}
