//! For each law of samplers one liar that breaks it and no other.
#![allow(missing_docs)]

mod support;

use regrasp_api::*;
use regrasp_conformance::reference::RejectionSampler;

/// What a liar does wrong.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Lie {
    Nothing,
    FindsNothing,
    ClosesRoughly,
    LetsOneGo,
    BendsAFreeFinger,
    AdmitsAnything,
    MovesThePose,
    RepeatsItself,
    MovesWhatItCloses,
    ErrsOutOfReach,
    CountsNothing,
    CountsTwice,
    NeverStops,
    OnlyAtHome,
}

struct Liar {
    lie: Lie,
    home: std::thread::ThreadId,
}

/// Admits what is free of the fingers before, whatever the grasp.
struct AnyGrasp<'a>(&'a dyn Admissible);

impl Admissible for AnyGrasp<'_> {
    fn admit_finger(
        &self,
        task: &Task<'_>,
        q: &Configuration,
        finger: FingerIndex,
        placed: FingerSet,
        context: &mut Context<'_>,
    ) -> Result<Option<Reason>, CallError> {
        self.0.admit_finger(task, q, finger, placed, context)
    }

    fn admit_grasp(
        &self,
        _: &Task<'_>,
        _: &Configuration,
        _: &mut Context<'_>,
    ) -> Result<Option<Reason>, CallError> {
        Ok(None)
    }
}

impl Liar {
    /// Spoils an honest sample.
    fn spoil(
        &self,
        task: &Task<'_>,
        q: Configuration,
        pose: PoseRequest<'_>,
        context: &mut Context<'_>,
    ) -> Result<Option<Configuration>, CallError> {
        let mut other = q.clone();
        match self.lie {
            Lie::ClosesRoughly => {
                other.joints[FingerIndex(0)][1] += 1e-4;
                return Ok(Some(other));
            }
            Lie::OnlyAtHome if std::thread::current().id() != self.home => return Ok(None),
            Lie::LetsOneGo if q.holding().len() == 4 => {
                other.contacts[FingerIndex(3)] = None;
                other.joints[FingerIndex(3)] = task.hand.finger(FingerIndex(3)).rest;
            }
            Lie::BendsAFreeFinger if q.contacts[FingerIndex(1)].is_none() => {
                other.joints[FingerIndex(1)][0] = task.hand.finger(FingerIndex(1)).joints[0].upper + 1e-3;
            }
            Lie::MovesThePose if matches!(pose, PoseRequest::At(_)) => {
                let mut X_HO = q.X_HO;
                X_HO.translation.vector.z += 1e-7;
                other = self.close(task, &X_HO, &q.contacts, &q, context)?.unwrap_or(other);
            }
            _ => return Ok(Some(q)),
        }
        // One lie at a time: what it gives is admissible.
        let fits = task.admissible.admit(task, &other, context)?.is_none();
        Ok(Some(if fits { other } else { q }))
    }
}

impl ClosedChainSampler for Liar {
    fn sample(
        &self,
        task: &Task<'_>,
        pose: PoseRequest<'_>,
        holding: FingerSet,
        context: &mut Context<'_>,
    ) -> Result<Option<Configuration>, CallError> {
        let mut task = *task;
        let any = AnyGrasp(task.admissible);
        let mut own = Context::new(context.random.clone(), &Uninterrupted);
        match self.lie {
            Lie::CountsTwice => context.count_call(Slot::Sampler),
            Lie::FindsNothing => {
                context.count_call(Slot::Sampler);
                context.proceed()?;
                context.reject(Slot::Sampler, Reason::Budget);
                return Ok(None);
            }
            Lie::AdmitsAnything => task.admissible = &any,
            Lie::RepeatsItself => context.random = Random::from_key(0, 0, 0, 0),
            Lie::CountsNothing => {
                context.count_call(Slot::Sampler);
                context.proceed()?;
                return RejectionSampler.sample(&task, pose, holding, &mut own);
            }
            Lie::NeverStops => {
                let found = RejectionSampler.sample(&task, pose, holding, &mut own);
                context.tally.add(&own.tally);
                return found;
            }
            _ => {}
        }
        match RejectionSampler.sample(&task, pose, holding, context)? {
            Some(q) => self.spoil(&task, q, pose, context),
            None => Ok(None),
        }
    }

    fn close(
        &self,
        task: &Task<'_>,
        X_HO: &Pose,
        contacts: &PerFinger<Option<Contact>>,
        near: &Configuration,
        context: &mut Context<'_>,
    ) -> Result<Option<Configuration>, CallError> {
        let mut found = RejectionSampler.close(task, X_HO, contacts, near, context)?;
        match (self.lie, &mut found) {
            (Lie::MovesWhatItCloses, Some(q)) => q.X_HO.translation.vector.x += 1e-9,
            (Lie::ErrsOutOfReach, None) => {
                let (plugin, reason) = ("sampler/liar".into(), "out of reach".into());
                return Err(CallError::Unsupported { plugin, reason });
            }
            _ => {}
        }
        Ok(found)
    }
}

macro_rules! liar {
    ($lie:expr) => {
        Entry {
            id: "sampler/liar",
            slots: &[Slot::Sampler],
            summary: "says what it likes",
            references: &["nobody"],
            schema: NoSettings::schema,
            check: check_settings::<NoSettings>,
            build: Build::Sampler(|json, _| {
                NoSettings::from_json(json)?;
                Ok(Box::new(Liar { lie: $lie, home: std::thread::current().id() }))
            }),
        }
    };
}

#[test]
fn each_liar_fails_its_check_and_no_other() {
    let liars = [
        (liar!(Lie::FindsNothing), "sample-succeeds"),
        (liar!(Lie::ClosesRoughly), "sample-closed"),
        (liar!(Lie::LetsOneGo), "sample-holding"),
        (liar!(Lie::BendsAFreeFinger), "sample-limits"),
        (liar!(Lie::AdmitsAnything), "sample-admissible"),
        (liar!(Lie::MovesThePose), "sample-pose"),
        (liar!(Lie::RepeatsItself), "sample-varies"),
        (liar!(Lie::MovesWhatItCloses), "close-exact"),
        (liar!(Lie::ErrsOutOfReach), "close-refuses"),
        (liar!(Lie::CountsNothing), "sampler-reasons"),
        (liar!(Lie::CountsTwice), "sampler-counted"),
        (liar!(Lie::NeverStops), "sampler-interrupt"),
        (liar!(Lie::OnlyAtHome), "sampler-pure"),
    ];
    support::judge(Slot::Sampler, &liar!(Lie::Nothing), &liars, &[]);
}
