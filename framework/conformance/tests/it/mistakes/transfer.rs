//! Mistakes of planners that roll the object.

use crate::support::blind::Blinkered;
use regrasp_api::*;
use regrasp_conformance::reference::FineRolling;
use std::collections::BTreeMap;
use std::sync::Mutex;

const SLOT: Slot = Slot::TransferPlanner;

struct Mistaken {
    mistake: String,
    /// Ends by where the object was.
    known: Mutex<BTreeMap<[u64; 3], Reached>>,
}

/// Soft contacts that never spin.
struct Unspun<'a>(&'a dyn ContactModel);

impl ContactModel for Unspun<'_> {
    fn cone(&self, finger: FingerIndex, contact: &Contact, mu: f64) -> Cone<'_> {
        self.0.cone(finger, contact, mu)
    }
    fn spinning_cone(&self, finger: FingerIndex, contact: &Contact, mu: f64) -> Cone<'_> {
        self.0.cone(finger, contact, mu)
    }
    fn fewest_contacts(&self) -> usize {
        self.0.fewest_contacts()
    }
}

impl Mistaken {
    fn new(mistake: String, _: &Parts<'_>) -> Self {
        Self { mistake, known: Mutex::default() }
    }

    /// What of the scene it looks at.
    fn sees(&self) -> fn(&BodyPair) -> bool {
        match self.mistake.as_str() {
            "fingertips-alone" => |pair| !matches!(pair, (Body::Link(..), _) | (_, Body::Link(..))),
            "no-obstacles" => |pair| !matches!(pair, (Body::Obstacle(_), _) | (_, Body::Obstacle(_))),
            "no-other-fingers" => |pair| {
                use Body::{Fingertip, Link};
                !matches!(pair, (Fingertip(_) | Link(..), Fingertip(_) | Link(..)))
            },
            "no-object" => |pair| !matches!(pair, (Body::Object, _) | (_, Body::Object)),
            _ => |_| true,
        }
    }

    fn refusal(&self, from: &Configuration, to: &Target<'_>) -> Option<Reason> {
        let Target::Transfer(X_HO) = to else { return None };
        let turn = angle_between(&from.X_HO.rotation, &X_HO.rotation);
        let way = (X_HO.translation.vector - from.X_HO.translation.vector).norm();
        match self.mistake.as_str() {
            "all-stray" => Some(Reason::Stray),
            "all-slip" => Some(Reason::Slip),
            "turns-refused" => (turn > 1e-3).then_some(Reason::Reach),
            "shifts-refused" => (way > 2e-3).then_some(Reason::Reach),
            "all-fingers-or-none" => (from.holding().len() < from.joints.len()).then_some(Reason::Closure),
            _ => None,
        }
    }

    fn spoil(
        &self,
        from: &Configuration,
        to: &Target<'_>,
        states: &mut Vec<Configuration>,
        reached: &mut Reached,
    ) {
        let (last, Target::Transfer(X_HO)) = (states.len() - 1, to) else { return };
        match self.mistake.as_str() {
            "every-fifth-state" if last > 8 => {
                let kept = (0..=last).filter(|i| i % 5 == 0 || *i == last);
                *states = kept.map(|i| states[i].clone()).collect();
            }
            "steps-added-up" if reached.is_complete() => {
                reached.end.X_HO.translation.vector.x +=
                    1e-16 + reached.end.X_HO.translation.vector.x * 1e-15;
                states[last] = reached.end.clone();
            }
            "goal-for-the-end" if !reached.is_complete() => {
                reached.end.X_HO = **X_HO;
                states[last] = reached.end.clone();
            }
            "end-not-stored" if last > 0 && !reached.is_complete() => drop(states.pop()),
            "contacts-of-the-start" => {
                states.iter_mut().for_each(|q| q.contacts = from.contacts);
                reached.end.contacts = from.contacts;
            }
            "mirrored-normals" if last > 2 => {
                let q = &mut states[last / 2];
                q.contacts.fingers().for_each(|f| q.contacts[f].iter_mut().for_each(|c| c.n_O = -c.n_O));
            }
            "fraction-of-the-goal" if !reached.is_complete() => {
                reached.fraction = 1.0 - 0.5 * (1.0 - reached.fraction);
            }
            "free-fingers-follow" if last > 0 => {
                for finger in from.joints.fingers().filter(|f| from.contacts[*f].is_none()) {
                    let own = states[last].contacts.iter().find_map(|(_, contact)| *contact);
                    states[last].contacts[finger] = own;
                }
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
        let clearance = Blinkered { all: task.clearance, sees: self.sees() };
        let unspun = Unspun(task.contact_model);
        let mut seen = Task { clearance: &clearance, ..*task };
        if self.mistake == "cones-at-rest" {
            seen.contact_model = &unspun;
        }
        let mut own = Path::default();
        if let Some(stop) = self.refusal(from, to) {
            context.count_call(SLOT);
            context.proceed()?;
            if task.hand.fingertip() != Fingertip::Ball {
                let reason = "it rolls".into();
                return Err(CallError::Unsupported { plugin: "local-planner/mistaken".into(), reason });
            }
            let stop = Some(context.reject(SLOT, stop));
            own.restart(from);
            if let Some(path) = path {
                *path = own;
            }
            return Ok(Reached { end: from.clone(), fraction: 0.0, stop });
        }
        let mut reached = FineRolling.connect(&seen, from, to, Some(&mut own), context)?;
        if self.mistake == "remembers-the-start-alone" {
            let key = from.X_HO.translation.vector.map(f64::to_bits).into();
            reached = self.known.lock().unwrap().entry(key).or_insert(reached).clone();
        }
        self.spoil(from, to, &mut own.states, &mut reached);
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
            ("fingertips-alone", "transfer-collision-free"),
            ("no-obstacles", "transfer-collision-free"),
            ("no-other-fingers", "transfer-collision-free"),
            ("no-object", "transfer-collision-free"),
            ("all-stray", "transfer-succeeds"),
            ("all-slip", "transfer-succeeds"),
            ("turns-refused", "transfer-succeeds"),
            ("shifts-refused", "transfer-succeeds"),
            ("all-fingers-or-none", "transfer-succeeds"),
            ("every-fifth-state", "transfer-steps|transfer-closed"),
            ("steps-added-up", "transfer-target"),
            ("goal-for-the-end", "transfer-contacts|transfer-closed"),
            ("end-not-stored", "transfer-ends"),
            ("contacts-of-the-start", "transfer-contacts"),
            ("mirrored-normals", "transfer-contacts"),
            ("fraction-of-the-goal", "transfer-fraction"),
            ("free-fingers-follow", "transfer-same-fingers|transfer-ends"),
            ("cones-at-rest", "transfer-stable"),
            ("remembers-the-start-alone", "transfer-pure"),
        ],
    );
}
