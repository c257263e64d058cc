//! `stability-test/wrench-ball`: the largest ball of wrenches that the grasp resists.

use crate::closure::{Frame, Search, floor, glance};
use crate::contacts::is_round;
use crate::force_closure::{ForceClosure, ForceClosureSettings};
use crate::hull::Until;
use crate::linearised::{hull_depth, proof, verdict};
use crate::spanning::span;
use crate::wrenches::{Ring, WrenchSet};
use regrasp_api::{
    Assessment, Build, BuildError, CallError, Certificate, Context, Entry, FingerIndex, Grasp, Hint,
    Settings, SettingsError, Slot, Stability, StabilityTest, Vec3, check_settings,
};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

const ID: &str = "stability-test/wrench-ball";
/// How far apart the bounds of a reported margin may be, relative.
const MARGIN_GAP: f64 = 0.005;

/// The point that torques are taken about.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Center {
    /// The centroid of the contacts: the margin is the same wherever the object's frame lies.
    #[default]
    Contacts,
    /// The object's centre of mass, as Ferrari and Canny take it.
    CenterOfMass,
}

/// Settings of [`WrenchBall`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct WrenchBallSettings {
    /// The margin that a stable grasp exceeds (no unit); default 0: every force closure counts.
    #[schemars(range(min = 0.0, max = 1.0), extend("x-unit" = "1"))]
    pub least_margin: f64,
    /// Edges that replace a round cone, from inside; default none: round cones as they are.
    #[schemars(range(min = 3, max = 64))]
    #[schemars(example = 8)]
    pub cone_edges: Option<usize>,
    /// What torques are divided by (m); default none: the largest distance of a contact from their centroid.
    #[schemars(range(min = 1e-4, max = 1e3), extend("x-unit" = "m"))]
    #[schemars(example = 0.03)]
    pub length: Option<f64>,
    /// The point that torques are taken about; default the contacts' centroid.
    pub center: Center,
}

impl Default for WrenchBallSettings {
    fn default() -> Self {
        Self { least_margin: 0.0, cone_edges: None, length: None, center: Center::Contacts }
    }
}

impl Settings for WrenchBallSettings {}

/// Stable where the wrench ball's radius Q1 exceeds a bound: how large a wrench, in any direction, normal
/// forces that add up to 1 N resist.
///
/// Ferrari & Canny, "Planning optimal grasps", ICRA 1992, with the L1 bound: Q1 is the distance of the origin
/// from the boundary of the convex hull of all contacts' wrenches at unit normal force. A torque counts as a
/// force by division with a length. By default that is the largest distance of a contact from the contacts'
/// centroid, about which torques are taken: then margins do not depend on frame or size, but a contact more
/// may lower one (it moves the centroid). Set `length`, and `center` to the centre of mass, to compare grasps
/// of one object; then the margin only grows with friction and contacts.
///
/// Round cones enter exactly, by their support function, or with `cone_edges` as Ferrari and Canny's
/// polyhedra inscribed in them; polyhedral cones enter as they are. Closure is decided first, as in
/// [`ForceClosure`] or `stability-test/linearised`. Where a positive bound is asked for, the ellipsoid about
/// the analytic centre gives bounds in microseconds; what they leave open is decided by an expanding polytope
/// in six dimensions with certified bounds on both sides, within milliseconds (only that allocates). Neither
/// proved means [`Stability::Undecided`].
///
/// Margins are reported within 0.5 %. A grasp that is closed but not deep enough has lower bound 0 and its
/// true upper bound.
#[derive(Clone, Debug, PartialEq)]
pub struct WrenchBall {
    settings: WrenchBallSettings,
    ring: Option<Ring>,
    closure: ForceClosure,
    /// The object's centre of mass in O (m).
    p_OCm: Vec3,
}

/// A grasp's closure, and where it can be proved the proof.
type Closure = (Stability, Certificate);

impl WrenchBall {
    /// The test with checked settings, for an object with centre of mass `p_OCm` in O (m).
    pub fn new(settings: WrenchBallSettings, p_OCm: Vec3) -> Result<Self, SettingsError> {
        settings.validate()?;
        let ring = settings.cone_edges.map(Ring::new);
        let closure = ForceClosure::new(ForceClosureSettings::default())?;
        Ok(Self { settings, ring, closure, p_OCm })
    }

    fn gather<'a>(&'a self, grasp: &'a Grasp<'_>, lifted: Option<FingerIndex>) -> WrenchSet<'a> {
        WrenchSet::gather(grasp, lifted, self.ring.as_ref())
    }

    /// Whether the hull is that of round cones only.
    fn is_round(&self, set: &WrenchSet<'_>) -> bool {
        self.ring.is_none() && !set.is_polyhedral()
    }

    fn frame(&self, set: &WrenchSet<'_>) -> Frame {
        let center = (self.settings.center == Center::CenterOfMass).then_some(self.p_OCm);
        Frame::new(&set.grasp, self.settings.length, center)
    }

    fn closed(&self, set: &WrenchSet<'_>, hint: &mut Hint) -> Stability {
        if self.is_round(set) { self.closure.decide(&set.grasp, hint) } else { verdict(&span(set)) }
    }

    fn decide(&self, set: &WrenchSet<'_>, hint: &mut Hint) -> Stability {
        let closed = self.closed(set, hint);
        if !closed.is_stable() || self.settings.least_margin <= 0.0 {
            return closed;
        }
        self.is_deep(set)
    }

    /// The verdict on `grasp` without `lifted`.
    fn judge(
        &self,
        grasp: &Grasp<'_>,
        lifted: Option<FingerIndex>,
        hint: &mut Hint,
    ) -> Result<Stability, CallError> {
        // Where closure is all that is asked, round cones need no set of wrenches.
        let closure_only = self.ring.is_none() && self.settings.least_margin <= 0.0;
        if closure_only && is_round(grasp, lifted) {
            return self.closure.judge(grasp, lifted, hint, ID);
        }
        Ok(self.decide(&self.gather(grasp, lifted), hint))
    }

    /// Whether a closed grasp's margin exceeds the least one.
    fn is_deep(&self, set: &WrenchSet<'_>) -> Stability {
        let (least, frame) = (self.settings.least_margin, self.frame(set));
        if self.is_round(set) {
            let search = Search::new(&set.grasp, self.closure.undecided_margin());
            if floor(&search, &frame) > least {
                return Stability::Stable;
            }
            let (lower, upper) = glance(&search, &frame);
            if lower > least {
                return Stability::Stable;
            }
            if upper <= least {
                return Stability::Unstable;
            }
        }
        let depth = hull_depth(set, &frame, Until::Decided(least));
        if depth.lower > least {
            Stability::Stable
        } else if depth.upper <= least {
            Stability::Unstable
        } else {
            Stability::Undecided
        }
    }

    fn prove(&self, set: &WrenchSet<'_>) -> Closure {
        if self.is_round(set) {
            let frame = Frame::new(&set.grasp, None, None);
            let stability = self.closure.decide(&set.grasp, &mut Hint::default());
            return (stability, self.closure.certify(&set.grasp, &frame, stability).2);
        }
        let found = span(set);
        (verdict(&found), proof(set, &found))
    }
}

impl StabilityTest for WrenchBall {
    fn test(
        &self,
        grasp: &Grasp<'_>,
        hint: &mut Hint,
        context: &mut Context<'_>,
    ) -> Result<Stability, CallError> {
        context.count_call(Slot::StabilityTest);
        self.judge(grasp, None, hint)
    }

    fn assess(
        &self,
        grasp: &Grasp<'_>,
        length: Option<f64>,
        center_O: Option<Vec3>,
        _context: &mut Context<'_>,
    ) -> Result<Assessment, CallError> {
        let set = self.gather(grasp, None);
        let (closed, certificate) = self.prove(&set);
        if !closed.is_stable() {
            let margin_upper = if closed == Stability::Unstable { 0.0 } else { f64::INFINITY };
            return Ok(Assessment { stability: closed, margin_lower: 0.0, margin_upper, certificate });
        }
        let stability = self.decide(&set, &mut Hint::default());
        let own = (self.settings.center == Center::CenterOfMass).then_some(self.p_OCm);
        let frame = Frame::new(&set.grasp, length.or(self.settings.length), center_O.or(own));
        let depth = hull_depth(&set, &frame, Until::Gap(MARGIN_GAP));
        let (lower, margin_upper) = (depth.lower.max(0.0), depth.upper.max(0.0));
        let (margin_lower, certificate) =
            if stability.is_stable() { (lower, certificate) } else { (0.0, Certificate::None) };
        Ok(Assessment { stability, margin_lower, margin_upper, certificate })
    }

    fn stable_without(
        &self,
        grasp: &Grasp<'_>,
        finger: FingerIndex,
        context: &mut Context<'_>,
    ) -> Result<bool, CallError> {
        context.count_call(Slot::StabilityTest);
        Ok(self.judge(grasp, Some(finger), &mut Hint::default())?.is_stable())
    }
}

regrasp_api::inventory::submit! {
    Entry {
        id: ID,
        slots: &[Slot::StabilityTest],
        summary: "Ferrari and Canny's wrench ball (L1): stable where its radius exceeds a bound; exact or \
            linearised cones.",
        references: &[
            "Ferrari, Canny, Planning optimal grasps, ICRA 1992",
            "van den Bergen, Proximity queries and penetration depth computation on 3D game objects, GDC \
                2001",
            "Barber, Dobkin, Huhdanpaa, The Quickhull algorithm for convex hulls, ACM TOMS 1996",
        ],
        schema: WrenchBallSettings::schema,
        check: check_settings::<WrenchBallSettings>,
        build: Build::StabilityTest(|json, parts| {
            let settings = WrenchBallSettings::from_json(json)?;
            Ok(Box::new(WrenchBall::new(settings, parts.object.p_OCm).map_err(BuildError::from)?))
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_outside_their_range_are_refused() {
        let refused = |json: &str, key: &str| {
            let error = WrenchBallSettings::from_json(json).unwrap_err().to_string();
            assert!(error.contains(key), "{error}");
        };
        refused(r#"{"cone_edges": 2}"#, "`cone_edges` = 2 is outside 3..=64");
        refused(r#"{"least_margin": -0.1}"#, "least_margin");
        refused(r#"{"length": 0}"#, "length");
        refused(r#"{"center": "origin"}"#, "origin");
        let settings = WrenchBallSettings::from_json(r#"{"center": "center-of-mass", "cone_edges": 64}"#);
        assert_eq!(settings.unwrap().center, Center::CenterOfMass);
    }
}
