//! `stability-test/force-closure`: exact force closure with elliptic cones.

use crate::closure::{Frame, Outcome, Search, bracket, three_points};
use crate::contacts::{ScaledGrasp, Twist, is_round, three_of};
use crate::linearised::{assess_edges, verdict};
use crate::spanning::span;
use crate::wrenches::WrenchSet;
use regrasp_api::{
    Assessment, Build, CallError, Certificate, Context, Entry, FingerIndex, Grasp, Hint, Settings,
    SettingsError, Slot, Stability, StabilityTest, Vec3, check_settings,
};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

const ID: &str = "stability-test/force-closure";
/// Hint: the values are a point of Ω where the last search ended with "closed".
const INTERIOR_POINT: u64 = 1;
/// Hint: the values are a twist that separated the last grasp.
const SEPARATING_TWIST: u64 = 2;

/// Settings of [`ForceClosure`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ForceClosureSettings {
    /// Margins (no unit: Ferrari and Canny's Q1) up to this one may be left undecided, which counts as not
    /// stable; default 1e-6.
    ///
    /// Below 1e-7 rounding decides. A grasp with a larger margin is never refused.
    #[schemars(range(min = 1e-7, max = 1e-3), extend("x-unit" = "1"))]
    pub undecided_margin: f64,
}

impl Default for ForceClosureSettings {
    fn default() -> Self {
        Self { undecided_margin: 1e-6 }
    }
}

impl Settings for ForceClosureSettings {}

/// Force closure, decided exactly for point contacts with and without friction, with a grain or without, for
/// soft fingers, with no linearised cone, and for polyhedral cones.
///
/// A grasp is force closure where internal forces exist strictly inside every cone and the grasp map has rank
/// 6. That is so exactly where the polar body Ω = {w : h_i(-w) ≤ 1} of the contacts' wrench sets is bounded,
///    h_i the support function of contact i's cone at unit
/// normal force. Newton's method towards the analytic centre of Ω ends with one of two proofs: multipliers
/// that are such a force, or a twist that no contact resists. Three point contacts with friction are decided
/// in closed form.
///
/// The margin is Q1 = min over unit twists of max_i h_i (Ferrari & Canny's with the sum of the normal forces
/// as bound), torques taken about the contacts' centroid over the largest distance from it unless the caller
/// fixes both. Verdicts do not depend on that choice, except that a margin up to `undecided_margin` may give
/// [`Stability::Undecided`].
///
/// Grasps with a polyhedral cone are decided as [`crate::Linearised`] does it, the polyhedral cones as they
/// are and the round ones round: a linear feasibility problem whose columns are found in closed form.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ForceClosure {
    tau: f64,
}

impl ForceClosure {
    /// The test with checked settings.
    pub fn new(settings: ForceClosureSettings) -> Result<Self, SettingsError> {
        settings.validate()?;
        Ok(Self { tau: settings.undecided_margin })
    }

    pub(crate) fn undecided_margin(&self) -> f64 {
        self.tau
    }

    /// The verdict on `grasp` without `lifted`; `plugin` is named where it cannot be given.
    pub(crate) fn judge(
        &self,
        grasp: &Grasp<'_>,
        lifted: Option<FingerIndex>,
        hint: &mut Hint,
        plugin: &'static str,
    ) -> Result<Stability, CallError> {
        // Three points need neither centre nor scale.
        let in_closed_form = three_of(grasp, lifted).and_then(|contacts| three_points(&contacts));
        if let Some(closed) = in_closed_form {
            return Ok(if closed { Stability::Stable } else { Stability::Unstable });
        }
        if !is_round(grasp, lifted) {
            return Ok(verdict(&span(&WrenchSet::gather(grasp, lifted, None))));
        }
        Ok(self.search(&ScaledGrasp::gather(grasp, lifted, plugin)?, hint))
    }

    /// The same for contacts that were gathered already.
    pub(crate) fn decide(&self, grasp: &ScaledGrasp, hint: &mut Hint) -> Stability {
        match in_closed_form(grasp) {
            Some(closed) => {
                if closed {
                    Stability::Stable
                } else {
                    Stability::Unstable
                }
            }
            None => self.search(grasp, hint),
        }
    }

    /// Forces on the object (N, in O) at the contacts of `grasp`, in turn, that balance each other strictly
    /// inside every cone, the normal forces adding up to 1 N; `false`, and none, where the grasp is not
    /// closed.
    ///
    /// The proof alone, about as fast as the verdict: [`StabilityTest::assess`] measures the margin too.
    /// Cones must be elliptic.
    pub fn internal_forces(&self, grasp: &Grasp<'_>, forces_O: &mut Vec<Vec3>) -> Result<bool, CallError> {
        forces_O.clear();
        let scaled = ScaledGrasp::gather(grasp, None, ID)?;
        if scaled.components() <= 6 || in_closed_form(&scaled) == Some(false) {
            return Ok(false);
        }
        let search = Search::new(&scaled, self.tau);
        let Outcome::Closed(w) = search.run() else { return Ok(false) };
        let forces = search.forces(&w);
        let (each, scale) = (&forces.each[..scaled.contacts().len()], 1.0 / forces.normal_sum);
        forces_O.extend(each.iter().map(|(f, _)| f * scale));
        Ok(true)
    }

    fn search(&self, grasp: &ScaledGrasp, hint: &mut Hint) -> Stability {
        // Balance alone takes six independent components.
        if grasp.components() <= 6 {
            return Stability::Unstable;
        }
        let search = Search::new(grasp, self.tau);
        recall(&search, hint).unwrap_or_else(|| remember(search.run(), hint))
    }

    pub(crate) fn certify(
        &self,
        grasp: &ScaledGrasp,
        frame: &Frame,
        stability: Stability,
    ) -> (f64, f64, Certificate) {
        let search = Search::new(grasp, self.tau);
        match (stability, search.run()) {
            (Stability::Stable, Outcome::Closed(w)) => {
                let (lower, upper) = bracket(&search, frame);
                (lower, upper, internal_force(&search, &w))
            }
            (Stability::Unstable, Outcome::Separated(d)) => (0.0, 0.0, separating_twist(grasp, &d)),
            (Stability::Undecided, Outcome::Undecided(w)) => (0.0, 1.0 / frame.norm(&w), Certificate::None),
            (Stability::Unstable, _) => (0.0, 0.0, Certificate::None),
            _ => (0.0, f64::INFINITY, Certificate::None),
        }
    }
}

impl StabilityTest for ForceClosure {
    fn test(
        &self,
        grasp: &Grasp<'_>,
        hint: &mut Hint,
        context: &mut Context<'_>,
    ) -> Result<Stability, CallError> {
        context.count_call(Slot::StabilityTest);
        self.judge(grasp, None, hint, ID)
    }

    fn assess(
        &self,
        grasp: &Grasp<'_>,
        length: Option<f64>,
        center_O: Option<Vec3>,
        _context: &mut Context<'_>,
    ) -> Result<Assessment, CallError> {
        if !is_round(grasp, None) {
            return Ok(assess_edges(&WrenchSet::gather(grasp, None, None), length, center_O));
        }
        let scaled = ScaledGrasp::gather(grasp, None, ID)?;
        let stability = self.decide(&scaled, &mut Hint::default());
        let frame = Frame::new(&scaled, length, center_O);
        let (margin_lower, margin_upper, certificate) = self.certify(&scaled, &frame, stability);
        Ok(Assessment { stability, margin_lower, margin_upper, certificate })
    }

    fn stable_without(
        &self,
        grasp: &Grasp<'_>,
        finger: FingerIndex,
        context: &mut Context<'_>,
    ) -> Result<bool, CallError> {
        context.count_call(Slot::StabilityTest);
        Ok(self.judge(grasp, Some(finger), &mut Hint::default(), ID)?.is_stable())
    }
}

/// Whether three point contacts are closed; `None` where the closed form does not tell.
fn in_closed_form(grasp: &ScaledGrasp) -> Option<bool> {
    let round = grasp.contacts().iter().all(|contact| !contact.grained);
    round.then(|| grasp.contacts().try_into().ok().and_then(three_points)).flatten()
}

/// The verdict that the hint proves, if it proves one beyond doubt.
fn recall(search: &Search<'_>, hint: &Hint) -> Option<Stability> {
    if hint.tag == 0 {
        return None;
    }
    let [a, b, c, d, e, f, ..] = hint.values;
    let twist = Twist::from_array([a, b, c, d, e, f]);
    match hint.tag {
        INTERIOR_POINT => search.closed_from(&twist).then_some(Stability::Stable),
        SEPARATING_TWIST => search.separated_by(&twist).then_some(Stability::Unstable),
        _ => None,
    }
}

/// The verdict of an outcome, its proof kept for the next grasp.
fn remember(outcome: Outcome, hint: &mut Hint) -> Stability {
    let (stability, tag, twist) = match outcome {
        // From w = 0 a search starts anyway, and with less work.
        Outcome::Closed(w) if w == Twist::ZERO => (Stability::Stable, 0, w),
        Outcome::Closed(w) => (Stability::Stable, INTERIOR_POINT, w),
        Outcome::Separated(d) => (Stability::Unstable, SEPARATING_TWIST, d),
        Outcome::Undecided(_) => (Stability::Undecided, 0, Twist::ZERO),
    };
    *hint = Hint { tag, ..Hint::default() };
    hint.values[..6].copy_from_slice(&twist.to_array());
    stability
}

/// The internal force as a certificate, the normal forces adding up to 1 N.
fn internal_force(search: &Search<'_>, w: &Twist) -> Certificate {
    let grasp = search.body.grasp;
    let forces = search.forces(w);
    let scale = 1.0 / forces.normal_sum;
    let each = &forces.each[..grasp.contacts().len()];
    Certificate::InternalForce {
        forces_O: each.iter().map(|(f, _)| f * scale).collect(),
        torsions: each.iter().map(|(_, m)| m * scale * grasp.length).collect(),
    }
}

/// The twist as a certificate, of unit norm in scaled coordinates.
fn separating_twist(grasp: &ScaledGrasp, d: &Twist) -> Certificate {
    let unit = d.scaled(1.0 / d.norm());
    Certificate::SeparatingTwist { v_O: unit.a, w_O: unit.b / grasp.length }
}

regrasp_api::inventory::submit! {
    Entry {
        id: ID,
        slots: &[Slot::StabilityTest],
        summary: "Exact force closure with round cones, by Newton's method on the polar body; margin Q1 and \
            a certificate.",
        references: &[
            "Ferrari, Canny, Planning optimal grasps, ICRA 1992",
            "Nguyen, Constructing force-closure grasps, IJRR 1988",
            "Han, Trinkle, Li, Grasp analysis as linear matrix inequality problems, T-RA 2000",
            "Boyd, Wegbreit, Fast computation of optimal contact forces, T-RO 2007",
            "Zheng, Chew, Distance between a point and a convex cone in n-dimensional space: computation \
             and applications, T-RO 2009",
        ],
        schema: ForceClosureSettings::schema,
        check: check_settings::<ForceClosureSettings>,
        build: Build::StabilityTest(|json, _| {
            Ok(Box::new(ForceClosure::new(ForceClosureSettings::from_json(json)?)?))
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_outside_their_range_are_refused() {
        for undecided_margin in [0.0, 9e-8, 2e-3, f64::NAN] {
            let error = ForceClosure::new(ForceClosureSettings { undecided_margin }).unwrap_err();
            assert!(error.to_string().contains("undecided_margin"), "{error}");
        }
        assert!(ForceClosureSettings::from_json(r#"{"tau": 1e-6}"#).is_err());
        assert_eq!(ForceClosureSettings::from_json("").unwrap(), ForceClosureSettings::default());
    }
}
