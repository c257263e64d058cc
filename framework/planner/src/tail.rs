//! A way that the graph found, with a relay in place of its end.
//!
//! Such a way goes from sample to sample, and many of its regrasps serve nothing but that. From a place that
//! is nearer to the goal than the start a relay often gets there where none did from the start.

use crate::draft::regrasps;
use crate::relay::{Effort, QUICK, Route, THOROUGH, relay};
use crate::run::Run;
use crate::segments::end;
use crate::session::Call;
use regrasp_api::{CallError, NodeId};
use regrasp_plan::{Segment, SegmentKind};

/// Ways of so many regrasps are left as they are. Our choice: relays need that many where they get through.
const FEW: usize = 8;
/// For ways of more regrasps than this relays try hard, too.
const MANY: usize = 16;
/// Relays that are tried, from places evenly along the way. Our choice.
const RELAYS: usize = 8;

impl Run<'_> {
    /// The way of a leg with the relay in place of its end that leaves the fewest regrasps.
    pub fn with_relayed_end(
        &mut self,
        leg: usize,
        start: NodeId,
        way: Vec<Segment>,
    ) -> Result<Vec<Segment>, CallError> {
        if self.relays(leg) == 0 || regrasps(&way) <= FEW {
            return Ok(way);
        }
        let mut found = self.relay_to_the_end(leg, &way, &QUICK)?;
        if found.is_none() && regrasps(&way) > MANY {
            found = self.relay_to_the_end(leg, &way, &THOROUGH)?;
        }
        let Some((place, steps)) = found else { return Ok(way) };
        let shorter: Vec<Segment> = way.into_iter().take(place).chain(steps).collect();
        if let Some(last) = shorter.last() {
            self.enter_way(start, end(last).clone(), &shorter);
        }
        Ok(shorter)
    }

    /// The segment of a way that the best relay begins before, and its steps.
    fn relay_to_the_end(
        &mut self,
        leg: usize,
        way: &[Segment],
        effort: &Effort,
    ) -> Result<Option<(usize, Vec<Segment>)>, CallError> {
        let (session, task) = (&self.session, &self.task);
        let (poses, turn_length) = (&self.poses[leg..], self.request.object.mesh.radius());
        let places = places(way);
        let tried = session.ahead(places.len(), |i| {
            session.counted(task, (Call::Tail, leg as u64, i as u64), |work| {
                let from = &way[places[i]].states[0];
                let through = std::iter::once(from.X_HO).chain(poses[1..].iter().copied());
                relay(work, from, &Route::new(through.collect(), 1, turn_length), effort)
            })
        });
        let (mut best, mut least) = (None, regrasps(way));
        for (&place, found) in places.iter().zip(tried) {
            let before = regrasps(&way[..place]);
            if before >= least {
                break;
            }
            self.tally.add(&found.tally);
            let steps = match found.result {
                // The way is complete as it is.
                Err(CallError::Interrupted) => break,
                found => found?,
            };
            if let Some(steps) = steps.filter(|steps| before + regrasps(steps) < least) {
                least = before + regrasps(&steps);
                best = Some((place, steps));
            }
        }
        Ok(best)
    }
}

/// Transfers of a way, evenly along it.
fn places(way: &[Segment]) -> Vec<usize> {
    let is_transfer = |&k: &usize| matches!(way[k].kind, SegmentKind::Transfer);
    let transfers: Vec<usize> = (0..way.len()).filter(is_transfer).collect();
    let mut places: Vec<usize> =
        (0..RELAYS).filter_map(|i| transfers.get(i * transfers.len() / RELAYS).copied()).collect();
    places.dedup();
    places
}

#[cfg(test)]
mod tests {
    use super::*;
    use regrasp_api::FingerIndex;

    #[test]
    fn relays_begin_where_the_object_moves_all_along_the_way() {
        let kinds = |count: usize| {
            let kind =
                |k| if k % 3 == 0 { SegmentKind::Transfer } else { SegmentKind::Regrasp(FingerIndex(0)) };
            (0..count).map(kind).map(|kind| Segment::new(kind, Vec::new())).collect::<Vec<_>>()
        };
        assert_eq!(places(&kinds(48)), [0, 6, 12, 18, 24, 30, 36, 42]);
        assert_eq!(places(&kinds(7)), [0, 3, 6]);
        assert!(places(&[]).is_empty());
    }
}
