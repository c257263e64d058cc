//! A roll along a route, as far as it goes.

use super::route::Route;
use crate::session::Work;
use crate::steps::transfer;
use regrasp_api::{CallError, Configuration};
use regrasp_plan::{Segment, SegmentKind};

/// What was rolled: states with their places on the route.
pub(crate) struct Roll {
    pub states: Vec<Configuration>,
    pub places: Vec<f64>,
    /// Where one straight motion ends and the next begins: there transfers end, too.
    corners: Vec<usize>,
    /// Whether it reached the route's target.
    pub is_complete: bool,
}

impl Roll {
    /// Rolls from a configuration at `place` towards the route's target.
    pub fn along(
        work: &mut Work<'_>,
        route: &Route,
        from: &Configuration,
        place: f64,
    ) -> Result<Self, CallError> {
        let mut roll =
            Self { states: vec![from.clone()], places: vec![place], corners: Vec::new(), is_complete: true };
        for (X_HO, there) in route.ahead(place) {
            let (q, before) = (roll.end().clone(), roll.reached());
            let (reached, segment) = transfer(work, &q, X_HO)?;
            let origin = (&q.X_HO, before);
            let states = segment.states.into_iter().skip(1);
            for state in states {
                roll.places.push(route.place_of(origin, &state.X_HO).min(there));
                roll.states.push(state);
            }
            if !reached.is_complete() {
                roll.is_complete = false;
                break;
            }
            *roll.places.last_mut().expect("it has its start") = there;
            roll.corners.push(roll.states.len() - 1);
        }
        Ok(roll)
    }

    /// The last configuration.
    pub fn end(&self) -> &Configuration {
        &self.states[self.states.len() - 1]
    }

    /// The last place.
    pub fn reached(&self) -> f64 {
        self.places[self.places.len() - 1]
    }

    /// The transfers up to the state with this index.
    pub fn transfers(&self, last: usize) -> Vec<Segment> {
        let inner = self.corners.iter().copied().filter(|&corner| 0 < corner && corner < last);
        let ends: Vec<usize> = std::iter::once(0).chain(inner).chain([last]).collect();
        let transfer =
            |pair: &[usize]| Segment::new(SegmentKind::Transfer, self.states[pair[0]..=pair[1]].to_vec());
        ends.windows(2).map(transfer).collect()
    }
}
