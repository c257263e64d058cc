//! Mistakes of planners that move one finger.

use crate::support::blind::{Blinkered, is_of_fingers};
use regrasp_api::*;
use regrasp_conformance::reference::LiftOver;

const SLOT: Slot = Slot::RegraspPlanner;

struct Mistaken(String);

/// Whether one of a pair is a link and the other such a body.
fn is_link_and(pair: &BodyPair, other: fn(&Body) -> bool) -> bool {
    let link = |body: &Body| matches!(body, Body::Link(..));
    link(&pair.0) && other(&pair.1) || other(&pair.0) && link(&pair.1)
}

impl Mistaken {
    fn new(mistake: String, _: &Parts<'_>) -> Self {
        Self(mistake)
    }

    /// What of the scene it looks at.
    fn sees(&self) -> fn(&BodyPair) -> bool {
        match self.0.as_str() {
            "no-obstacles" => |pair| !matches!(pair, (Body::Obstacle(_), _) | (_, Body::Obstacle(_))),
            "no-palm" => |pair| !matches!(pair, (Body::Palm, _) | (_, Body::Palm)),
            "fingertips-alone" => |pair| !matches!(pair, (Body::Link(..), _) | (_, Body::Link(..))),
            "no-other-fingers" => |pair| !is_of_fingers(pair),
            // What an author forgets who thinks of the finger as a point: links against one thing each.
            "links-through-the-object" => |pair| !is_link_and(pair, |body| matches!(body, Body::Object)),
            "links-through-obstacles" => |pair| !is_link_and(pair, |body| matches!(body, Body::Obstacle(_))),
            "links-through-fingertips" => {
                |pair| !is_link_and(pair, |body| matches!(body, Body::Fingertip(_)))
            }
            _ => |_| true,
        }
    }

    fn refuses(&self, from: &Configuration, to: &Target<'_>) -> bool {
        let Target::Regrasp { finger, contact, .. } = to else { return false };
        match self.0.as_str() {
            "cannot-release" => contact.is_none(),
            "cannot-place" => from.contacts[*finger].is_none(),
            "short-ways-alone" => {
                let [a, b] = [from.contacts[*finger].as_ref(), *contact];
                a.zip(b).is_some_and(|(a, b)| (a.p_OC - b.p_OC).norm() > 0.01)
            }
            "one-side-alone" => {
                let [a, b] = [from.contacts[*finger].as_ref(), *contact];
                a.zip(b).is_some_and(|(a, b)| a.n_O.dot(&b.n_O) < 0.5)
            }
            _ => false,
        }
    }

    fn spoil(&self, from: &Configuration, to: &Target<'_>, states: &mut Vec<Configuration>) {
        let &Target::Regrasp { finger, contact, .. } = to else { return };
        let last = states.len() - 1;
        match self.0.as_str() {
            "backwards" if last > 0 => states.reverse(),
            "jumps" if last > 1 => drop(states.drain(1..last)),
            "coarse" if last > 8 => {
                let kept = (0..=last).filter(|i| i % 8 == 0 || *i == last);
                *states = kept.map(|i| states[i].clone()).collect();
            }
            "keeps-its-contact" => {
                states[..last].iter_mut().for_each(|q| q.contacts[finger] = from.contacts[finger]);
            }
            "touches-early" => {
                states.iter_mut().skip(1).for_each(|q| q.contacts[finger] = contact.copied());
            }
            "old-normal" if last > 0 => {
                let normal = from.contacts[finger].map(|c| c.n_O);
                if let (Some(end), Some(n_O)) = (&mut states[last].contacts[finger], normal) {
                    end.n_O = n_O;
                }
            }
            "down-again" if last > 12 => {
                // Up, back to the first height, and up again.
                let (low, high) = (states[1].joints[finger], states[4].joints[finger]);
                for (k, s) in [0.75, 0.5, 0.25, 0.0, 0.25, 0.5, 0.75].into_iter().enumerate() {
                    let mut q = states[4].clone();
                    q.joints[finger] = low.interpolate(&high, s);
                    states.insert(5 + k, q);
                }
            }
            "another-joint" if last > 2 => {
                let other = from.joints.fingers().find(|f| *f != finger);
                other.iter().for_each(|f| states[1].joints[*f][0] += 1e-9);
            }
            _ => {}
        }
    }
}

impl LocalPlanner for Mistaken {
    fn connect(
        &self,
        task: &Task<'_>,
        from: &Configuration,
        to: &Target<'_>,
        path: Option<&mut Path>,
        context: &mut Context<'_>,
    ) -> Result<Reached, CallError> {
        let refused = self.refuses(from, to);
        let clearance = Blinkered { all: task.clearance, sees: self.sees() };
        let low = Resolution { lift: 1.5e-3, ..*task.resolution };
        let resolution = if self.0 == "barely-up" { &low } else { task.resolution };
        let seen = Task { clearance: &clearance, resolution, ..*task };
        let mut own = Path::default();
        let mut reached = LiftOver.connect(&seen, from, to, Some(&mut own), context)?;
        match self.0.as_str() {
            _ if refused => {
                if reached.stop.is_none() {
                    context.reject(SLOT, Reason::Surface);
                    reached.stop = Some(Reason::Surface);
                }
                (reached.end, reached.fraction) = (from.clone(), 0.0);
                own.restart(from);
            }
            // What it had of a way when it gave up.
            "stores-what-failed" if !reached.is_complete() => {
                let mut q = from.clone();
                if let Target::Regrasp { finger, .. } = to {
                    q.joints[*finger][0] += 1e-3;
                }
                own.states.push(q);
            }
            "half-way-there" if !reached.is_complete() => reached.fraction = 0.5,
            "own-posture" if reached.is_complete() => {
                if let Target::Regrasp { finger, .. } = to {
                    reached.end.joints[*finger][2] += 1e-9;
                    let last = own.states.len() - 1;
                    own.states[last] = reached.end.clone();
                }
            }
            "counts-for-transfers" => {
                context.count_call(Slot::TransferPlanner);
            }
            _ => self.spoil(from, to, &mut own.states),
        }
        if let Some(path) = path {
            *path = own;
        }
        Ok(reached)
    }
}

#[test]
fn caught() {
    let entry = crate::mistaken!(LocalPlanner, "local-planner", &[SLOT], Mistaken::new);
    super::judge(
        &entry,
        &[
            ("no-obstacles", "regrasp-collision-free"),
            ("no-palm", "regrasp-collision-free"),
            ("fingertips-alone", "regrasp-collision-free"),
            ("no-other-fingers", "regrasp-collision-free"),
            ("links-through-the-object", "regrasp-collision-free"),
            ("links-through-obstacles", "regrasp-collision-free"),
            ("links-through-fingertips", "regrasp-collision-free"),
            ("cannot-release", "regrasp-succeeds"),
            ("cannot-place", "regrasp-succeeds"),
            ("short-ways-alone", "regrasp-succeeds"),
            ("one-side-alone", "regrasp-succeeds"),
            ("down-again", "regrasp-lifts"),
            ("barely-up", "regrasp-lifts"),
            ("backwards", "regrasp-ends"),
            ("jumps", "regrasp-steps"),
            ("coarse", "regrasp-steps"),
            ("keeps-its-contact", "regrasp-touches-at-ends"),
            ("touches-early", "regrasp-touches-at-ends"),
            ("old-normal", "regrasp-ends|regrasp-target"),
            ("another-joint", "regrasp-others-rest"),
            ("stores-what-failed", "regrasp-ends"),
            ("half-way-there", "regrasp-fraction"),
            ("own-posture", "regrasp-target"),
            ("counts-for-transfers", "regrasp-counted"),
        ],
    );
}
