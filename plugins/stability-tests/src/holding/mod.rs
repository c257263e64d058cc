//! `stability-test/holding`: forces within the joints' efforts hold the object's weight and disturbances at a
//! share of the friction.

mod settings;

pub use settings::HoldingSettings;

use crate::contacts::is_round;
use regrasp_api::{
    Assessment, Build, BuildError, CallError, Certificate, Context, Criterion, Entry, FingerIndex, Grasp,
    Hint, HoldLoad, ObjectModel, Settings, SettingsError, Slot, Stability, StabilityTest, Vec3,
    check_settings,
};
use regrasp_physics::{
    Balanced, Bearings, ContactForce, Edged, EdgesBalanced, HeldLoad, Press, smallest_share,
};

const ID: &str = "stability-test/holding";

/// Stable where contact forces inside the cones, with joint efforts Jᵀf within the limits, hold the object's
/// weight and every disturbance of a set.
///
/// The efforts come with the grasp ([`Grasp::efforts`]); a contact that carries none is bounded by
/// `max_normal_force` alone. Elliptic cones are taken exactly, and so are polyhedral ones; where a grasp has
/// both, elliptic ones count as edges on them. For the weight alone, and with each of the 24
/// wrenches that [`regrasp_api::Load`] describes, some forces must balance: then, cones and efforts being
/// convex, everything between is balanced too. Forces are found by Newton's method to the analytic centre of
/// those that balance, in the manner of Boyd & Wegbreit, "Fast computation of optimal contact forces", T-RO
/// 2007. A yes is proved by forces strictly inside, a no by a twist on which the load has more power than the
/// fingers can give, their joints at the efforts' limits; neither gives [`Stability::Undecided`].
///
/// Verdicts depend on the object's orientation, mass and centre of mass and on the fingers' postures. They
/// are monotone in friction, efforts, `max_normal_force` and added contacts.
///
/// The margin is 1 less the smallest share of the cones' friction that holds the weight (no unit). The
/// certificate of a stable grasp is forces (N) that hold the weight; that of an unstable one the object's
/// twist.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Holding {
    settings: HoldingSettings,
    load: HeldLoad,
}

impl Holding {
    /// The test with checked settings, for this object.
    pub fn new(settings: HoldingSettings, object: &ObjectModel) -> Result<Self, SettingsError> {
        settings.validate()?;
        let load = HeldLoad {
            mass: if settings.weight { object.mass } else { 0.0 },
            p_OCm: object.p_OCm,
            length: object.mesh.radius().max(1e-6),
            disturbance: (settings.disturbance_force, settings.disturbance_torque),
            press: Press {
                max_normal_force: settings.max_normal_force,
                effort_share: 1.0 - settings.reserve,
            },
        };
        Ok(Self { settings, load })
    }

    /// The parts of friction and torsional friction that count: the planner hands over less friction than
    /// there is, but all of the torsional friction.
    fn parts(&self) -> (f64, f64) {
        let part = 1.0 - self.settings.reserve;
        (part, part * self.settings.friction_factor)
    }

    /// Whether any contact drags.
    fn drags(&self, grasp: &Grasp<'_>) -> bool {
        self.settings.drag > 0.0 && grasp.has_drag()
    }

    /// The contacts as they are looked at, each dragging with this part of its drag.
    fn held(
        &self,
        grasp: &Grasp<'_>,
        lifted: Option<FingerIndex>,
        drag: impl Fn(usize) -> f64,
    ) -> Result<Held, CallError> {
        let round = is_round(grasp, lifted);
        if round && let Some(bearings) = self.load.bearings(grasp, lifted, self.parts(), drag) {
            return Ok(Held::Round(bearings));
        }
        if self.drags(grasp) {
            let reason = "polyhedral cones of contacts that drag while they spin; set `hold.drag` = 0, or \
                choose a contact model with elliptic cones";
            return Err(CallError::Unsupported { plugin: ID.into(), reason: reason.into() });
        }
        Ok(Held::Edged(self.load.edged(grasp, lifted, self.parts())))
    }

    /// The verdict whichever way the contacts drag: each with all of its drag one way or the other, and last
    /// none of it, for whose forces nobody has to know the drag.
    ///
    /// What holds for both ways of one contact, the others the same, holds for every part of its drag between
    /// them: a blend of the two forces presses there with a blend of both presses, whose drag runs from one
    /// end to the other as the blend does, and keeps all bounds, which are convex. So the corners suffice.
    fn verdict(
        &self,
        grasp: &Grasp<'_>,
        lifted: Option<FingerIndex>,
        hint: &mut Hint,
    ) -> Result<Stability, CallError> {
        for drag in self.corners(grasp) {
            let stability = self.look(&self.held(grasp, lifted, drag)?, grasp, hint).0;
            if !stability.is_stable() {
                return Ok(stability);
            }
        }
        Ok(self.look(&self.held(grasp, lifted, |_| 0.0)?, grasp, hint).0)
    }

    /// The same, with what it stands on.
    fn judge(&self, grasp: &Grasp<'_>) -> Result<Judged, CallError> {
        let judged = |held: Held| {
            let (stability, found) = self.look(&held, grasp, &mut Hint::default());
            Judged { stability, found, held }
        };
        for drag in self.corners(grasp) {
            let judged = judged(self.held(grasp, None, drag)?);
            if !judged.stability.is_stable() {
                return Ok(judged);
            }
        }
        Ok(judged(self.held(grasp, None, |_| 0.0)?))
    }

    /// All ways in which each contact drags with all of its drag; none where no contact drags.
    fn corners(&self, grasp: &Grasp<'_>) -> impl Iterator<Item = impl Fn(usize) -> f64> {
        let drag = self.settings.drag;
        let corners = if self.drags(grasp) { 1_u32 << grasp.contacts().len() } else { 0 };
        (0..corners).map(move |k| move |contact: usize| if k >> contact & 1 == 0 { drag } else { -drag })
    }

    fn look(&self, held: &Held, grasp: &Grasp<'_>, hint: &mut Hint) -> (Stability, Found) {
        let (found, holds) = match held {
            Held::Round(bearings) => {
                let answer = self.load.held(bearings, &grasp.g_O, 1.0, hint);
                (Found::Round(answer.balanced), answer.holds)
            }
            Held::Edged(contacts) => {
                let answer = self.load.held_by_edges(contacts, &grasp.g_O, 1.0);
                (Found::Edged(answer.balanced), answer.holds)
            }
        };
        let stability = match found {
            Found::Round(Balanced::Yes(_)) | Found::Edged(EdgesBalanced::Yes(_)) if holds => {
                Stability::Stable
            }
            Found::Round(Balanced::Unknown) | Found::Edged(EdgesBalanced::Unknown) if held.len() > 2 => {
                Stability::Undecided
            }
            _ => Stability::Unstable,
        };
        (stability, found)
    }

    fn certificate(&self, judged: &Judged, center_O: &Vec3) -> Certificate {
        let (exerted, twist): (Vec<ContactForce>, _) = match (&judged.held, &judged.found) {
            (Held::Round(bearings), Found::Round(Balanced::Yes(forces))) => {
                (bearings.iter().zip(forces).map(|(bearing, x)| bearing.force(x)).collect(), None)
            }
            (Held::Edged(contacts), Found::Edged(EdgesBalanced::Yes(weights))) => {
                (contacts.iter().zip(weights).map(|(contact, x)| contact.force(x)).collect(), None)
            }
            (_, Found::Round(Balanced::No(twist)) | Found::Edged(EdgesBalanced::No(twist))) => {
                (Vec::new(), Some(twist))
            }
            _ => return Certificate::None,
        };
        let Some(twist) = twist else {
            return Certificate::InternalForce {
                forces_O: exerted.iter().map(|exerted| exerted.force).collect(),
                // About the inward normal.
                torsions: exerted.iter().map(|exerted| -exerted.spin).collect(),
            };
        };
        let unit = twist / twist.norm();
        let (a, w_O) = (unit.fixed_rows::<3>(0).into_owned(), unit.fixed_rows::<3>(3) / self.load.length);
        // From the centre of mass to the contacts' centroid.
        Certificate::SeparatingTwist { v_O: a + w_O.cross(&(center_O - self.load.p_OCm)), w_O }
    }

    /// The smallest share of the friction that holds the weight; `None` where none up to [`LARGEST`] does.
    fn smallest(&self, held: &Held, grasp: &Grasp<'_>) -> Option<f64> {
        let wanted = self.load.wanted(&grasp.g_O);
        if let Held::Round(bearings) = held {
            return smallest_share(bearings, &wanted, 1.0).map(|smallest| smallest.share);
        }
        let calm = HeldLoad { disturbance: (0.0, 0.0), ..self.load };
        let (part, torsion_part) = self.parts();
        let holds = |share: f64| {
            let contacts = calm.edged(grasp, None, (share * part, share * torsion_part));
            calm.held_by_edges(&contacts, &grasp.g_O, 1.0).holds
        };
        let (mut low, mut high) = (0.0, 1.0);
        while !holds(high) {
            (low, high) = (high, 2.0 * high);
            if high > LARGEST {
                return None;
            }
        }
        while high - low > NEAR * high && high > NEAR {
            let middle = 0.5 * (low + high);
            if holds(middle) { high = middle } else { low = middle }
        }
        Some(high)
    }
}

/// The largest share of the friction that is looked for, and how near the bounds of the smallest are.
const LARGEST: f64 = 8.0;
const NEAR: f64 = 0.02;

/// Contacts, all with elliptic cones or by their edges.
#[allow(clippy::large_enum_variant)] // it lives on the stack of an inner loop, which allocates nothing
enum Held {
    Round(Bearings),
    Edged(Vec<Edged>),
}

impl Held {
    fn len(&self) -> usize {
        match self {
            Self::Round(bearings) => bearings.len(),
            Self::Edged(contacts) => contacts.len(),
        }
    }
}

/// What a verdict stands on.
#[allow(clippy::large_enum_variant)]
enum Found {
    Round(Balanced),
    Edged(EdgesBalanced),
}

/// A verdict on a grasp, what it stands on, and the contacts.
struct Judged {
    stability: Stability,
    found: Found,
    held: Held,
}

fn centroid(grasp: &Grasp<'_>) -> Vec3 {
    let sum: Vec3 = grasp.contacts().iter().map(|contact| contact.p_OC).sum();
    sum / grasp.contacts().len().max(1) as f64
}

impl StabilityTest for Holding {
    fn test(
        &self,
        grasp: &Grasp<'_>,
        hint: &mut Hint,
        context: &mut Context<'_>,
    ) -> Result<Stability, CallError> {
        context.count_call(Slot::StabilityTest);
        self.verdict(grasp, None, hint)
    }

    fn assess(
        &self,
        grasp: &Grasp<'_>,
        _length: Option<f64>,
        _center_O: Option<Vec3>,
        _context: &mut Context<'_>,
    ) -> Result<Assessment, CallError> {
        let judged = self.judge(grasp)?;
        let stability = judged.stability;
        let mut most = self.smallest(&self.held(grasp, None, |_| 0.0)?, grasp);
        for drag in self.corners(grasp) {
            let found = self.smallest(&self.held(grasp, None, drag)?, grasp);
            most = most.zip(found).map(|(most, found)| most.max(found));
        }
        let lower = most.map_or(f64::NEG_INFINITY, |share| 1.0 - share);
        let (margin_lower, margin_upper) = if stability.is_stable() {
            (lower.max(0.0), 1.0)
        } else {
            (lower.clamp(-1e3, 0.0), lower.clamp(-1e3, 1.0))
        };
        let certificate = match judged.found {
            // What cannot be held may be so with drag alone, of which a certificate knows nothing.
            Found::Round(Balanced::No(_)) if self.drags(grasp) => Certificate::None,
            _ => self.certificate(&judged, &centroid(grasp)),
        };
        Ok(Assessment { stability, margin_lower, margin_upper, certificate })
    }

    fn criterion(&self) -> Criterion {
        let HoldingSettings { weight, friction_factor, disturbance_force, disturbance_torque, drag, .. } =
            self.settings;
        let max_normal_force = self.settings.max_normal_force;
        Criterion::Holding(HoldLoad {
            weight,
            friction_factor,
            disturbance_force,
            disturbance_torque,
            drag,
            max_normal_force,
        })
    }

    fn uses_efforts(&self) -> bool {
        true
    }

    fn stable_without(
        &self,
        grasp: &Grasp<'_>,
        finger: FingerIndex,
        context: &mut Context<'_>,
    ) -> Result<bool, CallError> {
        context.count_call(Slot::StabilityTest);
        Ok(self.verdict(grasp, Some(finger), &mut Hint::default())?.is_stable())
    }
}

regrasp_api::inventory::submit! {
    Entry {
        id: ID,
        slots: &[Slot::StabilityTest],
        summary: "Forces within the joints' efforts hold the object's weight and disturbances at a share of \
            the friction: what `[hold]` asks for.",
        references: &[
            "Han, Trinkle, Li, Grasp analysis as linear matrix inequality problems, T-RA 2000",
            "Boyd, Wegbreit, Fast computation of optimal contact forces, T-RO 2007",
            "Boyd, Vandenberghe, Convex Optimization, Cambridge 2004, section 10.3",
        ],
        schema: HoldingSettings::schema,
        check: check_settings::<HoldingSettings>,
        build: Build::StabilityTest(|json, parts| {
            let settings = HoldingSettings::from_json(json)?;
            Ok(Box::new(Holding::new(settings, parts.object).map_err(BuildError::from)?))
        }),
    }
}
