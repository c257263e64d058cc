//! Which fingers to regrasp, and where to, so that the object can roll on.

use super::effort::Effort;
use super::follow::{Looks, Touch, Track};
use super::route::Route;
use crate::session::Work;
use crate::shortest_path::Length;
use regrasp_api::{CallError, Configuration, FingerIndex, FingerSet, Hint, PerFinger};
use std::cmp::Reverse;

/// The points of a station's fingers are looked at in so many rounds ...
const ROUNDS: usize = 4;
/// ... and those of a finger in a round by so many parts.
const SHARES: usize = 2;

/// Another grasp at the same pose.
#[derive(Clone, Debug)]
pub(crate) struct Choice {
    /// The configuration with the fingers where they go.
    pub q: Configuration,
    /// How many fingers move.
    pub moved: usize,
    /// The place up to which it seems to roll.
    pub reach: f64,
}

/// What may be done at one place of a route.
pub(crate) struct Station<'a> {
    q: &'a Configuration,
    effort: &'a Effort,
    looks: Looks,
    /// For each finger the tracks that it may take: first as it is, then from other touches, the farthest
    /// reaching first.
    tracks: Vec<Vec<Track>>,
}

/// For each finger, which of its tracks is taken.
type Pick = PerFinger<u8>;

impl<'a> Station<'a> {
    /// Looks round at `q`, at a place of the route.
    pub fn new(
        work: &mut Work<'_>,
        route: &Route,
        (q, place): (&'a Configuration, f64),
        effort: &'a Effort,
    ) -> Result<Self, CallError> {
        let looks = Looks::ahead(work.task, route, place);
        let mut tracks: Vec<Vec<Track>> = others(work, &looks, q, effort)?;
        for (finger, tracks) in q.joints.fingers().zip(&mut tracks) {
            let own = Touch { contact: q.contacts[finger], joints: q.joints[finger] };
            tracks.insert(0, looks.follow(work.task, finger, own));
        }
        Ok(Self { q, effort, looks, tracks })
    }

    /// Choices, the most promising first: `worth` tells what reaching a place with so many regrasps is worth,
    /// the less the better.
    pub fn choices(
        &self,
        work: &mut Work<'_>,
        worth: impl Fn(usize, f64) -> f64,
    ) -> Result<Vec<Choice>, CallError> {
        let holding = self.q.holding();
        let mut picks: Vec<Pick> = Vec::new();
        for count in 1..=holding.len() {
            for draw in 0..self.effort.draws {
                let pick = self.draw(work, holding, count, draw);
                if pick.iter().any(|(_, &track)| track > 0) && !picks.contains(&pick) {
                    picks.push(pick);
                }
            }
        }
        let looks = work.parts(picks.len(), |i, work| self.looks_together(work, &picks[i]))?;
        let mut all = Vec::new();
        for (pick, looks) in picks.iter().zip(looks).filter(|(_, looks)| *looks > 1) {
            let moved = pick.iter().filter(|(_, track)| **track > 0).count();
            let q = self.configuration(pick, 0);
            all.push(Choice { q, moved, reach: self.looks.places[looks - 1] });
        }
        all.sort_by_cached_key(|choice| Length(worth(choice.moved, choice.reach)));
        Ok(all)
    }

    /// At most `count` fingers moved: those that bar the way first, or in every other draw any.
    fn draw(&self, work: &mut Work<'_>, holding: FingerSet, count: usize, draw: usize) -> Pick {
        let random = &mut work.context.random;
        let mut order: Vec<FingerIndex> = holding.iter().collect();
        if draw.is_multiple_of(2) {
            order.sort_by_key(|finger| self.tracks[finger.index()][0].len());
        } else {
            for i in 0..order.len() {
                let other = i + random.index(order.len() - i);
                order.swap(i, other);
            }
        }
        let mut pick = Pick::filled(self.q.joints.len(), 0);
        for &finger in &order[..count] {
            let others = self.tracks[finger.index()].len() - 1;
            if others > 0 {
                pick[finger] = 1 + if draw == 0 { 0 } else { random.index(others) as u8 };
            }
        }
        pick
    }

    /// At how many looks all fingers together are free of each other and hold the object.
    fn looks_together(&self, work: &mut Work<'_>, pick: &Pick) -> Result<usize, CallError> {
        let tracks =
            pick.iter().map(|(finger, &track)| self.tracks[finger.index()][usize::from(track)].len());
        let most = tracks.min().unwrap_or(0);
        let (task, mut hint) = (work.task, Hint::default());
        for look in 0..most {
            let q = self.configuration(pick, look);
            let fingers = || q.joints.iter();
            let apart = fingers().all(|a| {
                let later = fingers().skip(a.0.index() + 1);
                later.into_iter().all(|b| task.clearance.fingers_free(a, b).is_ok())
            });
            let grasp = task.transfer_grasp(&q, q.holding());
            if !apart || !task.stability.test(&grasp, &mut hint, &mut work.context)?.is_stable() {
                return Ok(look);
            }
        }
        Ok(most)
    }

    fn configuration(&self, pick: &Pick, look: usize) -> Configuration {
        let mut q = Configuration { X_HO: self.looks.poses[look], ..self.q.clone() };
        if look == 0 {
            q.X_HO = self.q.X_HO;
        }
        for (finger, &track) in pick.iter() {
            let Touch { contact, joints } = self.tracks[finger.index()][usize::from(track)][look];
            (q.contacts[finger], q.joints[finger]) = (contact, joints);
        }
        q
    }
}

/// Tracks of each finger that holds from other touches at the pose of `q`, the farthest reaching first.
///
/// In rounds of some points for each finger that has not enough: where nearly every touch is admitted, as on
/// a ball, more of them are no better.
fn others(
    work: &mut Work<'_>,
    looks: &Looks,
    q: &Configuration,
    effort: &Effort,
) -> Result<Vec<Vec<Track>>, CallError> {
    let enough = 2 * effort.kept;
    let mut all: Vec<Vec<Track>> = vec![Vec::new(); q.joints.len()];
    for _ in 0..ROUNDS {
        let wanting =
            |finger: &FingerIndex| q.contacts[*finger].is_some() && all[finger.index()].len() < enough;
        let fingers: Vec<FingerIndex> = q.joints.fingers().filter(wanting).collect();
        let found = work.parts(SHARES * fingers.len(), |i, work| {
            some_others(work, looks, (q, fingers[i / SHARES]), effort.points / (ROUNDS * SHARES))
        })?;
        for (i, found) in found.into_iter().enumerate() {
            all[fingers[i / SHARES].index()].extend(found);
        }
    }
    for found in &mut all {
        found.truncate(enough);
        found.sort_by_key(|track| Reverse(track.len()));
        found.truncate(effort.kept);
    }
    Ok(all)
}

/// Tracks of a finger from those of so many points that it may touch.
fn some_others(
    work: &mut Work<'_>,
    looks: &Looks,
    (q, finger): (&Configuration, FingerIndex),
    points: usize,
) -> Result<Vec<Track>, CallError> {
    let (task, context) = (work.task, &mut work.context);
    let (model, radius) = (task.hand.finger(finger), task.hand.fingertip_radius());
    let mut found: Vec<Track> = Vec::new();
    let (mut tried, mut near) = (q.clone(), q.joints[finger]);
    for _ in 0..points {
        let contact = task.surface.sample(&mut context.random);
        let p_HF = q.X_HO.rotation * contact.tip_center(radius) + q.X_HO.translation.vector;
        if (p_HF - model.p_HReach).norm_squared() > model.reach * model.reach {
            continue;
        }
        for &joint in &model.spare {
            near[joint] = context.random.range(model.joints[joint].lower, model.joints[joint].upper);
        }
        let Some(joints) = task.hand.inverse(finger, &p_HF, &near) else { continue };
        (tried.contacts[finger], tried.joints[finger]) = (Some(contact), joints);
        if task.admissible.admit_finger(task, &tried, finger, FingerSet::EMPTY, context)?.is_none() {
            found.push(looks.follow(task, finger, Touch { contact: Some(contact), joints }));
        }
    }
    Ok(found)
}
