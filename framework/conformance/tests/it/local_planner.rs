//! For each law of local planners, in each of their slots, one liar that breaks it and no other.
use crate::support;

use crate::support::blind::{AnyGrasp, Blinkered, is_of_fingers, is_of_object, wide};
use crate::support::slide::{slide_along, way};
use regrasp_api::*;
use regrasp_conformance::reference::{EdgeClosure, FineRolling, GraspLine, LiftOver};
use regrasp_world::ChainHand;

/// What a liar does wrong.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Lie {
    Nothing,
    ForgetsTheStart,
    HalfIsWhole,
    AlmostThere,
    NoPathNoMotion,
    AlwaysRefuses,
    CountsNothing,
    CountsTwice,
    TakesAnyTarget,
    NeverStops,
    OnlyAtHome,
    WiderLimits,
    SeesFewBodies,
    TrustsEveryGrasp,
    StoresOldContacts,
    LongSteps,
    LetsGo,
    SlidesAlong,
    MovesTheObject,
    StraightThrough,
    TwiceTheStep,
    CountsItsWayBackwards,
    GoesOnWithTheOldPath,
    RefusesLongWays,
    RefusesUnevenObjects,
    SeesNoOtherFingers,
    EndsWithOldContacts,
    LiftsTooLow,
    DipsOnItsWayUp,
}

/// The honest planner for a target.
fn honest(slot: Slot) -> &'static dyn LocalPlanner {
    match slot {
        Slot::GraspPlanner => &GraspLine,
        Slot::TransferPlanner => &FineRolling,
        _ => &LiftOver,
    }
}

struct Liar {
    slot: Slot,
    lie: Lie,
    home: std::thread::ThreadId,
    wide: Option<ChainHand>,
}

/// Whether all fingertips slide in boxes and the object does not turn: then long steps leave no contact.
fn is_straight(task: &Task<'_>, path: &Path) -> bool {
    let slides = task.hand.finger(FingerIndex(0)).joints[0].kind == JointKind::Prismatic;
    let (first, last) = (&path.states[0].X_HO, &path.states[path.states.len() - 1].X_HO);
    let moved = (last.translation.vector - first.translation.vector).norm() > 1e-3;
    slides && moved && path.states.iter().all(|q| q.X_HO.rotation == first.rotation)
}

impl Liar {
    /// The honest answer to a task that may not be the true one.
    fn answer(
        &self,
        task: &Task<'_>,
        from: &Configuration,
        to: &Target<'_>,
        path: &mut Path,
        context: &mut Context<'_>,
    ) -> Result<Reached, CallError> {
        let mut own = Context::new(context.random.clone(), &Uninterrupted);
        let refused = || Reached { end: from.clone(), fraction: 0.0, stop: Some(Reason::Budget) };
        match (self.lie, to) {
            (Lie::AlwaysRefuses, _) if self.fits(to) => {
                path.restart(from);
                context.count_call(self.slot);
                context.reject(self.slot, Reason::Budget);
                Ok(refused())
            }
            (Lie::OnlyAtHome, _) if self.fits(to) && std::thread::current().id() != self.home => {
                path.restart(from);
                context.count_call(self.slot);
                context.reject(self.slot, Reason::Budget);
                Ok(refused())
            }
            (Lie::RefusesLongWays, _) if self.fits(to) && way(from, to) > 6e-3 => {
                path.restart(from);
                context.count_call(self.slot);
                context.proceed()?;
                context.reject(self.slot, Reason::Budget);
                Ok(refused())
            }
            (Lie::RefusesUnevenObjects, _)
                if self.fits(to) && !matches!(task.object.primitive, Some(Primitive::Sphere { .. })) =>
            {
                path.restart(from);
                context.count_call(self.slot);
                context.proceed()?;
                context.reject(self.slot, Reason::Budget);
                Ok(refused())
            }
            (Lie::TakesAnyTarget, _) if !self.fits(to) => {
                path.restart(from);
                Ok(refused())
            }
            (Lie::CountsTwice, _) => {
                context.count_call(self.slot);
                honest(self.slot).connect(task, from, to, Some(path), context)
            }
            (Lie::CountsNothing, _) => {
                context.count_call(self.slot);
                context.proceed()?;
                honest(self.slot).connect(task, from, to, Some(path), &mut own)
            }
            (Lie::NeverStops, _) => {
                let found = honest(self.slot).connect(task, from, to, Some(path), &mut own);
                context.tally.add(&own.tally);
                found
            }
            (Lie::SlidesAlong, Target::Transfer(to)) => slide_along(task, from, to, path, context),
            _ => honest(self.slot).connect(task, from, to, Some(path), context),
        }
    }

    fn fits(&self, to: &Target<'_>) -> bool {
        let slot = match to {
            Target::Grasp(_) => Slot::GraspPlanner,
            Target::Transfer(_) => Slot::TransferPlanner,
            Target::Regrasp { .. } => Slot::RegraspPlanner,
        };
        slot == self.slot
    }

    /// Spoils an honest answer.
    fn spoil(&self, task: &Task<'_>, path: &mut Path, reached: &mut Reached, context: &mut Context<'_>) {
        let last = path.states.len() - 1;
        let whole = reached.stop.is_none();
        let moves = |f: &FingerIndex| path.states[0].joints[*f] != reached.end.joints[*f];
        let finger = path.states[0].joints.fingers().find(moves);
        match self.lie {
            Lie::ForgetsTheStart if last > 1 => drop(path.states.remove(0)),
            // Counted from the wrong end, or half a way where none was made.
            Lie::CountsItsWayBackwards if !whole => {
                reached.fraction = if reached.fraction == 0.0 { 0.5 } else { 1.0 - reached.fraction };
            }
            Lie::TwiceTheStep if last > 40 && self.slot == Slot::RegraspPlanner => {
                let kept = (0..=last).filter(|i| *i < 20 || *i + 20 > last || i % 20 == 0);
                path.states = kept.map(|i| path.states[i].clone()).collect();
            }
            Lie::TwiceTheStep if last > 12 && is_straight(task, path) => {
                let kept = (0..=last).filter(|i| i % 8 == 0 || *i == last);
                path.states = kept.map(|i| path.states[i].clone()).collect();
            }
            // A step up, half of it down again, and up.
            Lie::DipsOnItsWayUp if last > 8 && path.states[0].holding() == reached.end.holding() => {
                let back =
                    finger.map(|f| path.states[1].joints[f].interpolate(&path.states[2].joints[f], 0.5));
                let mut dip = path.states[2].clone();
                finger.iter().zip(back).for_each(|(f, joints)| dip.joints[*f] = joints);
                path.states.insert(3, dip);
            }
            // The states are right, the end keeps the contacts of the beginning.
            Lie::EndsWithOldContacts if last > 2 && self.slot == Slot::TransferPlanner => {
                reached.end.contacts = path.states[0].contacts;
                path.states[last] = reached.end.clone();
            }
            Lie::HalfIsWhole if whole => reached.fraction = 0.5,
            Lie::AlmostThere if whole => {
                let (pose, first) =
                    (&mut reached.end.X_HO.translation.vector, finger.unwrap_or(FingerIndex(0)));
                if self.slot == Slot::TransferPlanner {
                    pose.x += 1e-10;
                } else {
                    reached.end.joints[first][0] +=
                        if reached.end.joints[first][0] > 0.0 { -1e-10 } else { 1e-10 };
                }
                path.states[last] = reached.end.clone();
            }
            Lie::StoresOldContacts if last > 2 => {
                for i in (1..last).rev() {
                    path.states[i].contacts = path.states[i.saturating_sub(4)].contacts;
                }
            }
            Lie::LongSteps if last > 4 => {
                // No longer than the resolution allows where the object moves.
                let rests = path.states[0].X_HO == path.states[last].X_HO;
                let every = if rests { 20 } else { 4 };
                let kept = (0..=last).filter(|i| i % every == 0 || *i == last);
                path.states = kept.map(|i| path.states[i].clone()).collect();
            }
            Lie::LetsGo if last > 2 => {
                let q = &mut path.states[last / 2];
                let holds = |f: &FingerIndex| {
                    // As while the object moves, when soft contacts may spin.
                    let rest = task.transfer_grasp(q, q.holding().without(*f));
                    EdgeClosure.test(&rest, &mut Hint::default(), context).unwrap().is_stable()
                };
                if let Some(finger) = q.holding().iter().find(holds) {
                    q.contacts[finger] = None;
                }
            }
            Lie::MovesTheObject => {
                let end = path.states.len().saturating_sub(1).max(1);
                path.states[1..end].iter_mut().for_each(|q| q.X_HO.translation.vector.y += 1e-12);
            }
            // Lifted, and then straight to where it is to come down.
            Lie::StraightThrough if last > 24 => {
                let (a, b) = (path.states[8].joints, path.states[last - 8].joints);
                for i in 9..last - 8 {
                    let s = (i - 8) as f64 / (last - 16) as f64;
                    for (finger, joints) in a.iter() {
                        path.states[i].joints[finger] = joints.interpolate(&b[finger], s);
                    }
                }
            }
            _ => {}
        }
    }
}

impl LocalPlanner for Liar {
    fn connect(
        &self,
        task: &Task<'_>,
        from: &Configuration,
        to: &Target<'_>,
        path: Option<&mut Path>,
        context: &mut Context<'_>,
    ) -> Result<Reached, CallError> {
        let mut other = *task;
        let object_counts = self.slot == Slot::RegraspPlanner;
        let sees: fn(&BodyPair) -> bool = if object_counts { is_of_object } else { |_| false };
        let few = Blinkered { all: task.clearance, sees };
        let lonely = Blinkered { all: task.clearance, sees: |pair| !is_of_fingers(pair) };
        let low = Resolution { lift: 9e-4, clearance: 2e-4, ..*task.resolution };
        match self.lie {
            Lie::WiderLimits => other.hand = self.wide.as_ref().unwrap(),
            Lie::SeesFewBodies => other.clearance = &few,
            Lie::SeesNoOtherFingers => other.clearance = &lonely,
            Lie::LiftsTooLow => other.resolution = &low,
            Lie::TrustsEveryGrasp => other.stability = &AnyGrasp,
            _ => {}
        }
        if self.lie == Lie::NoPathNoMotion && path.is_none() {
            context.proceed()?;
            if !self.fits(to) {
                return honest(self.slot).connect(task, from, to, path, context);
            }
            context.count_call(self.slot);
            let stop = Some(context.reject(self.slot, Reason::Budget));
            return Ok(Reached { end: from.clone(), fraction: 0.0, stop });
        }
        let mut own = Path::default();
        let mut reached = self.answer(&other, from, to, &mut own, context)?;
        self.spoil(task, &mut own, &mut reached, context);
        match path {
            Some(path) if self.lie == Lie::GoesOnWithTheOldPath => path.states.append(&mut own.states),
            Some(path) => *path = own,
            None => {}
        }
        Ok(reached)
    }
}

macro_rules! liar {
    ($slot:expr, $lie:expr) => {
        Entry {
            id: "local-planner/liar",
            slots: &[$slot],
            summary: "says what it likes",
            references: &["nobody"],
            schema: NoSettings::schema,
            check: check_settings::<NoSettings>,
            build: Build::LocalPlanner(|json, parts| {
                NoSettings::from_json(json)?;
                let home = std::thread::current().id();
                let wide = ($lie == Lie::WiderLimits).then(|| wide(parts.hand));
                Ok(Box::new(Liar { slot: $slot, lie: $lie, home, wide }))
            }),
        }
    };
}

/// The liars that every slot has, and its own.
macro_rules! judge_slot {
    ($slot:expr, $prefix:literal, $($own:expr),* $(,)?) => {{
        let liars = [
            (liar!($slot, Lie::ForgetsTheStart), concat!($prefix, "-ends")),
            (liar!($slot, Lie::HalfIsWhole), concat!($prefix, "-reached")),
            (liar!($slot, Lie::GoesOnWithTheOldPath), concat!($prefix, "-ends")),
            (liar!($slot, Lie::CountsItsWayBackwards), concat!($prefix, "-fraction")),
            (liar!($slot, Lie::TwiceTheStep), concat!($prefix, "-steps")),
            (liar!($slot, Lie::RefusesUnevenObjects), concat!($prefix, "-succeeds")),
            (liar!($slot, Lie::AlmostThere), concat!($prefix, "-target")),
            (liar!($slot, Lie::NoPathNoMotion), concat!($prefix, "-path-optional")),
            (liar!($slot, Lie::AlwaysRefuses), concat!($prefix, "-succeeds")),
            (liar!($slot, Lie::CountsNothing), concat!($prefix, "-reasons")),
            (liar!($slot, Lie::CountsTwice), concat!($prefix, "-counted")),
            (liar!($slot, Lie::TakesAnyTarget), concat!($prefix, "-wrong-target")),
            (liar!($slot, Lie::NeverStops), concat!($prefix, "-interrupt")),
            (liar!($slot, Lie::OnlyAtHome), concat!($prefix, "-pure")),
            (liar!($slot, Lie::WiderLimits), concat!($prefix, "-limits")),
            (liar!($slot, Lie::SeesFewBodies), concat!($prefix, "-collision-free")),
            (liar!($slot, Lie::TrustsEveryGrasp), concat!($prefix, "-stable")),
            $($own),*
        ];
        support::judge($slot, &liar!($slot, Lie::Nothing), &liars, &[]);
    }};
}

#[test]
fn each_liar_of_the_grasp_slot_fails_its_check_and_no_other() {
    const SLOT: Slot = Slot::GraspPlanner;
    judge_slot!(
        SLOT,
        "grasp",
        (liar!(SLOT, Lie::StoresOldContacts), "grasp-contacts"),
        (liar!(SLOT, Lie::RefusesLongWays), "grasp-succeeds"),
        (liar!(SLOT, Lie::SeesNoOtherFingers), "grasp-collision-free"),
        (liar!(SLOT, Lie::LongSteps), "grasp-closed"),
        (liar!(SLOT, Lie::LetsGo), "grasp-same-fingers"),
    );
}

#[test]
fn each_liar_of_the_transfer_slot_fails_its_check_and_no_other() {
    const SLOT: Slot = Slot::TransferPlanner;
    judge_slot!(
        SLOT,
        "transfer",
        (liar!(SLOT, Lie::StoresOldContacts), "transfer-contacts"),
        (liar!(SLOT, Lie::EndsWithOldContacts), "transfer-contacts"),
        (liar!(SLOT, Lie::RefusesLongWays), "transfer-succeeds"),
        (liar!(SLOT, Lie::LongSteps), "transfer-closed"),
        (liar!(SLOT, Lie::LetsGo), "transfer-same-fingers"),
        (liar!(SLOT, Lie::SlidesAlong), "transfer-no-slip"),
    );
}

#[test]
fn each_liar_of_the_regrasp_slot_fails_its_check_and_no_other() {
    const SLOT: Slot = Slot::RegraspPlanner;
    judge_slot!(
        SLOT,
        "regrasp",
        (liar!(SLOT, Lie::MovesTheObject), "regrasp-others-rest"),
        (liar!(SLOT, Lie::SeesNoOtherFingers), "regrasp-collision-free"),
        (liar!(SLOT, Lie::LiftsTooLow), "regrasp-lifts"),
        (liar!(SLOT, Lie::DipsOnItsWayUp), "regrasp-lifts"),
        (liar!(SLOT, Lie::StraightThrough), "regrasp-touches-at-ends"),
    );
}
