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
            Lie::FindsNothing => {
                context.proceed()?;
                context.reject(Slot::Sampler, Reason::Budget);
                return Ok(None);
            }
            Lie::AdmitsAnything => task.admissible = &any,
            Lie::RepeatsItself => context.random = Random::from_key(0, 0, 0, 0),
            Lie::CountsNothing => {
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
        let Some(mut q) = RejectionSampler.sample(&task, pose, holding, context)? else { return Ok(None) };
        match (self.lie, pose) {
            (Lie::ClosesRoughly, _) => q.joints[FingerIndex(0)][1] += 1e-4,
            (Lie::LetsOneGo, _) if holding.len() == 4 => {
                // It rests, as a free finger should.
                let rest = &task.hand.finger(FingerIndex(3)).rest;
                let mut other = q.clone();
                other.contacts[FingerIndex(3)] = None;
                other.joints[FingerIndex(3)] = *rest;
                if task.admissible.admit(&task, &other, context)?.is_none() {
                    q = other;
                }
            }
            (Lie::BendsAFreeFinger, _) if holding.len() == 3 => {
                let finger = FingerIndex(1);
                let mut other = q.clone();
                other.joints[finger][0] = task.hand.finger(finger).joints[0].upper + 1e-3;
                if task.admissible.admit(&task, &other, context)?.is_none() {
                    q = other;
                }
            }
            (Lie::MovesThePose, PoseRequest::At(_)) => {
                let mut X_HO = q.X_HO;
                X_HO.translation.vector.z += 1e-7;
                if let Some(other) = self.close(&task, &X_HO, &q.contacts, &q, context)? {
                    q = other;
                }
            }
            (Lie::OnlyAtHome, _) if std::thread::current().id() != self.home => return Ok(None),
            _ => {}
        }
        Ok(Some(q))
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
        (liar!(Lie::NeverStops), "sampler-interrupt"),
        (liar!(Lie::OnlyAtHome), "sampler-pure"),
    ];
    support::judge(Slot::Sampler, &liar!(Lie::Nothing), &liars, &[]);
}
