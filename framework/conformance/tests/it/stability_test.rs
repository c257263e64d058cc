//! For each law of stability tests one liar that breaks it and no other.
use crate::support;

use regrasp_api::*;
use regrasp_conformance::reference::EdgeClosure;

/// What a liar does wrong.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Lie {
    Nothing,
    MoreFriction,
    MissesTheGrain,
    AlwaysNo,
    FarFromTheFramesOrigin,
    FirstFingerFirst,
    LargeObjects,
    HighFriction,
    ManyContacts,
    TrustsHints,
    AssessesNothing,
    ForcesThatPull,
    MarginsUpsideDown,
    LiftsEverything,
    PanicsOnEight,
    CountsNothing,
    OnlyAtHome,
}

struct Liar {
    lie: Lie,
    home: std::thread::ThreadId,
}

impl Liar {
    /// Whether the lie makes a "no" of every grasp like this one.
    fn refuses(&self, grasp: &Grasp<'_>) -> bool {
        let contacts = grasp.contacts();
        let center = contacts.iter().map(|c| c.p_OC).sum::<Vec3>() / contacts.len() as f64;
        let length = contacts.iter().map(|c| (c.p_OC - center).norm()).fold(0.0, f64::max);
        let friction = |c: &GraspContact<'_>| if let Cone::Elliptic { mu, .. } = c.cone { mu } else { 0.0 };
        match self.lie {
            Lie::AlwaysNo => true,
            Lie::FarFromTheFramesOrigin => center.norm() > 30.0 * length,
            Lie::FirstFingerFirst => contacts.windows(2).any(|pair| pair[0].finger > pair[1].finger),
            Lie::LargeObjects => length > 0.5,
            Lie::HighFriction => contacts.iter().any(|c| friction(c) > 1.5),
            Lie::ManyContacts => contacts.len() > 5,
            Lie::OnlyAtHome => std::thread::current().id() != self.home,
            _ => false,
        }
    }
}

/// The grasp with more friction than there is.
fn with_more_friction<'a>(grasp: &Grasp<'a>) -> Grasp<'a> {
    let mut other = Grasp::new(grasp.g_O);
    for contact in grasp.contacts() {
        let mut contact = contact.clone();
        if let Cone::Elliptic { mu, gamma } = contact.cone {
            contact.cone = Cone::Elliptic { mu: 1.5 * mu, gamma };
        }
        other.push(contact);
    }
    other
}

/// The grasp with the larger coefficient of a grain all round.
fn without_grain<'a>(grasp: &Grasp<'a>) -> Grasp<'a> {
    let mut other = Grasp::new(grasp.g_O);
    for contact in grasp.contacts() {
        let mut contact = contact.clone();
        if let Cone::Grained(grain) = &contact.cone {
            contact.cone = Cone::Elliptic { mu: grain.mu[0].max(grain.mu[1]), gamma: grain.gamma };
        }
        other.push(contact);
    }
    other
}

impl StabilityTest for Liar {
    fn test(
        &self,
        grasp: &Grasp<'_>,
        hint: &mut Hint,
        context: &mut Context<'_>,
    ) -> Result<Stability, CallError> {
        if self.lie == Lie::PanicsOnEight && grasp.contacts().len() == MAX_FINGERS {
            panic!("seven at most");
        }
        if self.lie == Lie::CountsNothing {
            let mut own = Context::new(context.random.clone(), &Uninterrupted);
            return EdgeClosure.test(grasp, hint, &mut own);
        }
        if self.lie == Lie::TrustsHints && hint.tag == 1 {
            return Ok(Stability::Stable);
        }
        if self.refuses(grasp) {
            context.count_call(Slot::StabilityTest);
            return Ok(Stability::Unstable);
        }
        match self.lie {
            Lie::MissesTheGrain => EdgeClosure.test(&without_grain(grasp), hint, context),
            Lie::MoreFriction => EdgeClosure.test(&with_more_friction(grasp), hint, context),
            _ => EdgeClosure.test(grasp, hint, context),
        }
    }

    fn assess(
        &self,
        grasp: &Grasp<'_>,
        length: Option<f64>,
        center_O: Option<Vec3>,
        context: &mut Context<'_>,
    ) -> Result<Assessment, CallError> {
        let mut found = EdgeClosure.assess(grasp, length, center_O, context)?;
        if self.lie != Lie::Nothing {
            found.stability = self.test(grasp, &mut Hint::default(), context)?;
        }
        if self.lie == Lie::AssessesNothing {
            found.stability = Stability::Undecided;
        }
        match (&mut found.certificate, self.lie) {
            (Certificate::InternalForce { forces_O, .. }, Lie::ForcesThatPull) => {
                forces_O.iter_mut().for_each(|f| *f = -*f);
            }
            (Certificate::InternalForce { .. }, Lie::Nothing) => {}
            (certificate, _) => *certificate = Certificate::None,
        }
        if !found.stability.is_stable() {
            (found.margin_lower, found.margin_upper) = (0.0, 0.0);
        }
        if self.lie == Lie::MarginsUpsideDown {
            (found.margin_lower, found.margin_upper) = (0.3, 0.2);
        }
        Ok(found)
    }

    fn liftable(
        &self,
        grasp: &Grasp<'_>,
        enough: usize,
        context: &mut Context<'_>,
    ) -> Result<FingerSet, CallError> {
        let all = grasp.contacts().iter().map(|contact| contact.finger);
        if self.lie == Lie::LiftsEverything {
            return Ok(all.collect());
        }
        let mut liftable = FingerSet::EMPTY;
        for (tried, finger) in all.enumerate() {
            if liftable.len() + grasp.contacts().len() - tried < enough {
                break;
            }
            if self.stable_without(grasp, finger, context)? {
                liftable = liftable.with(finger);
            }
        }
        Ok(liftable)
    }
}

macro_rules! liar {
    ($lie:expr) => {
        Entry {
            id: "stability-test/liar",
            slots: &[Slot::StabilityTest],
            summary: "says what it likes",
            references: &["nobody"],
            schema: NoSettings::schema,
            check: check_settings::<NoSettings>,
            build: Build::StabilityTest(|json, _| {
                NoSettings::from_json(json)?;
                Ok(Box::new(Liar { lie: $lie, home: std::thread::current().id() }))
            }),
        }
    };
}

#[test]
fn each_liar_fails_its_check_and_no_other() {
    let liars = [
        (liar!(Lie::MoreFriction), "no-false-stable"),
        (liar!(Lie::MissesTheGrain), "no-false-stable"),
        (liar!(Lie::AlwaysNo), "accepts-good-grasps"),
        (liar!(Lie::FarFromTheFramesOrigin), "rigid-motion"),
        (liar!(Lie::FirstFingerFirst), "permutation"),
        (liar!(Lie::LargeObjects), "scale"),
        (liar!(Lie::HighFriction), "monotone-in-friction"),
        (liar!(Lie::ManyContacts), "monotone-in-contacts"),
        (liar!(Lie::TrustsHints), "hint-never-decides"),
        (liar!(Lie::AssessesNothing), "test-equals-assess"),
        (liar!(Lie::ForcesThatPull), "certificate"),
        (liar!(Lie::MarginsUpsideDown), "margins"),
        (liar!(Lie::LiftsEverything), "liftable"),
        (liar!(Lie::PanicsOnEight), "unsupported-cones"),
        (liar!(Lie::CountsNothing), "stability-counted"),
        (liar!(Lie::OnlyAtHome), "stability-pure"),
    ];
    support::judge(Slot::StabilityTest, &liar!(Lie::Nothing), &liars, &[]);
}
