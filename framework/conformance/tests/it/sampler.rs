//! For each law of samplers one liar that breaks it and no other.
use crate::support;
use crate::support::blind::{Blinkered, is_of_object};

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
    NearInABox,
    ForgetsTheObject,
    StaysUpright,
    StaysInTheMiddle,
    TakesOneSide,
    KnowsBallsAlone,
    PointsHaveNoRadius,
    CountsElsewhere,
    ClosesFromRest,
    ClosesWhatHolds,
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

/// A surface that draws points of one half alone.
struct Half<'a>(&'a dyn SurfaceParam);

impl SurfaceParam for Half<'_> {
    fn sample(&self, random: &mut Random) -> Contact {
        loop {
            let contact = self.0.sample(random);
            if contact.p_OC.x > 0.0 || contact.p_OC.y > 0.0 || contact.p_OC.z > 0.0 {
                return contact;
            }
        }
    }
    fn geodesic(
        &self,
        from: &Contact,
        to: &Contact,
        path: &mut SurfacePath,
        context: &mut Context<'_>,
    ) -> Result<bool, CallError> {
        self.0.geodesic(from, to, path, context)
    }
    fn project(&self, p_OF: &Vec3, hint: Option<u32>) -> Projection {
        self.0.project(p_OF, hint)
    }
    fn walk(&self, from: &Contact, direction_O: &Vec3, distance: f64) -> Contact {
        self.0.walk(from, direction_O, distance)
    }
    fn edge_distance(&self, contact: &Contact) -> f64 {
        self.0.edge_distance(contact)
    }
}

/// The pose that a liar draws in place of the right one.
fn misdrawn(lie: Lie, task: &Task<'_>, request: PoseRequest<'_>, random: &mut Random) -> Option<Pose> {
    let (lower, upper) = task.workspace;
    match (lie, request) {
        (Lie::StaysUpright, PoseRequest::Anywhere) => Some(Pose::translation(
            random.range(lower.x, upper.x),
            random.range(lower.y, upper.y),
            random.range(lower.z, upper.z),
        )),
        (Lie::StaysInTheMiddle, PoseRequest::Anywhere) => {
            Some(Pose::from_parts(((lower + upper) / 2.0).into(), random.rotation()))
        }
        // Each coordinate within the radius, which is a cube.
        (Lie::NearInABox, PoseRequest::Near { configuration, radius, .. }) => {
            let shift = Vec3::from_fn(|_, _| random.range(-radius, radius));
            let p = configuration.X_HO.translation.vector + shift;
            Some(Pose::from_parts(p.into(), configuration.X_HO.rotation))
        }
        _ => None,
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
            Lie::PointsHaveNoRadius if task.hand.fingertip() == Fingertip::Point => {
                let first = FingerIndex(0);
                let contact = q.contacts[first].unwrap();
                let p_HF = q.X_HO * nalgebra::Point3::from(contact.p_OC);
                if let Some(joints) = task.hand.inverse(first, &p_HF.coords, &q.joints[first]) {
                    other.joints[first] = joints;
                    return Ok(Some(other));
                }
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
        // The object passes through what stands still.
        let sees = |pair: &BodyPair| {
            !is_of_object(pair)
                || matches!(
                    pair,
                    (Body::Fingertip(_) | Body::Link(..), _) | (_, Body::Fingertip(_) | Body::Link(..))
                )
        };
        let (ghost, half) = (Blinkered { all: task.clearance, sees }, Half(task.surface));
        let mut pose = pose;
        if let Some(X_HO) = misdrawn(self.lie, &task, pose, &mut context.random) {
            pose = PoseRequest::At(X_HO);
        }
        match self.lie {
            Lie::ForgetsTheObject => task.clearance = &ghost,
            Lie::TakesOneSide => task.surface = &half,
            Lie::KnowsBallsAlone
                if task.object.primitive.is_none_or(|p| matches!(p, Primitive::Torus { .. })) =>
            {
                context.count_call(Slot::Sampler);
                context.proceed()?;
                context.reject(Slot::Sampler, Reason::Surface);
                return Ok(None);
            }
            Lie::CountsElsewhere => {
                context.count_call(Slot::Sampler);
                let found = RejectionSampler.sample(&task, pose, holding, &mut own);
                context.proceed()?;
                context.reject(Slot::Surface, Reason::Reach);
                return found;
            }
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
        let mut rest = near.clone();
        if self.lie == Lie::ClosesFromRest {
            rest.joints =
                PerFinger::from_fn(task.hand.finger_count(), |finger| task.hand.finger(finger).rest);
        }
        let mut found = RejectionSampler.close(task, X_HO, contacts, &rest, context)?;
        match (self.lie, &mut found) {
            (Lie::ClosesWhatHolds, Some(q)) => {
                let grasp = task.grasp(q, q.holding());
                let stable = task.stability.test(&grasp, &mut Hint::default(), context)?.is_stable();
                found = found.filter(|_| stable);
            }
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
        (liar!(Lie::NearInABox), "sample-pose"),
        (liar!(Lie::ForgetsTheObject), "sample-admissible"),
        (liar!(Lie::StaysUpright), "sample-spreads"),
        (liar!(Lie::StaysInTheMiddle), "sample-spreads"),
        (liar!(Lie::TakesOneSide), "sample-spreads"),
        (liar!(Lie::KnowsBallsAlone), "sample-succeeds"),
        (liar!(Lie::PointsHaveNoRadius), "sample-closed"),
        (liar!(Lie::CountsElsewhere), "sampler-reasons"),
        (liar!(Lie::ClosesFromRest), "close-exact"),
        (liar!(Lie::ClosesWhatHolds), "close-exact"),
    ];
    support::judge(Slot::Sampler, &liar!(Lie::Nothing), &liars, &[]);
}
