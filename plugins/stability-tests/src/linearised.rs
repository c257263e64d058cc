//! `stability-test/linearised`: force closure with cones of m edges.

use crate::closure::Frame;
use crate::hull::{Depth, Until, depth};
use crate::spanning::{Span, internal_force, separating_twist, span};
use crate::wrenches::{Ring, WrenchSet};
use regrasp_api::{
    Assessment, Build, CallError, Certificate, Context, Entry, FingerIndex, Grasp, Hint, Settings,
    SettingsError, Slot, Stability, StabilityTest, Vec3, check_settings,
};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

const ID: &str = "stability-test/linearised";
/// How far apart the bounds of a reported margin may be, relative.
const MARGIN_GAP: f64 = 0.005;

/// Settings of [`Linearised`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct LinearisedSettings {
    /// Edges of a cone, default 8 as is usual in grasp planning; a soft finger has as many on its equator and
    /// more on the way to its poles.
    #[schemars(range(min = 3, max = 64))]
    pub edges: usize,
}

impl Default for LinearisedSettings {
    fn default() -> Self {
        Self { edges: 8 }
    }
}

impl Settings for LinearisedSettings {}

/// Force closure with every round cone replaced by m edges on its surface; cones that come as edges are taken
/// as they are.
///
/// A grasp is closed where its edges' wrenches span the space of wrenches positively: the linear feasibility
/// problem that grasp planners have solved since Kerr & Roth, "Analysis of multifingered hands", IJRR 1986,
/// and Liu, "Qualitative test and force optimization of 3-D frictional form-closure grasps using linear
/// programming", T-RA 1999. It is solved by an active-set method on fixed-size arrays, an edge at a time,
/// each found in closed form.
///
/// The edges lie *on* the cone, so a yes is a yes for the round cone too (its certificate is a force strictly
/// inside it), and some grasps near the boundary are missed: the friction that a grasp needs is overestimated
/// by up to 1/cos(π/m) - 1, 8 % for 8 edges and 2 % for 16. A soft finger's ellipsoid has edges at m
/// longitudes and about m/2 latitudes. Polyhedral cones are decided exactly. Where the first edge points
/// follows the object's frame, so within those few percent a verdict may change with it.
///
/// The margin is Q1, the depth of the origin in the hull of all edges' wrenches, in the frame that
/// [`crate::ForceClosure`] uses.
#[derive(Clone, Debug, PartialEq)]
pub struct Linearised {
    ring: Ring,
}

impl Linearised {
    /// The test with checked settings.
    pub fn new(settings: LinearisedSettings) -> Result<Self, SettingsError> {
        settings.validate()?;
        Ok(Self { ring: Ring::new(settings.edges) })
    }
}

/// The verdict of a search for positive combinations.
pub(crate) fn verdict(found: &Span) -> Stability {
    match found {
        Span::Spans(_) => Stability::Stable,
        Span::Separated(_) | Span::Flat => Stability::Unstable,
        Span::Undecided => Stability::Undecided,
    }
}

/// What proves it.
pub(crate) fn proof(set: &WrenchSet<'_>, found: &Span) -> Certificate {
    match found {
        Span::Spans(balance) => internal_force(set, balance),
        Span::Separated(twist) => separating_twist(set, twist),
        Span::Flat | Span::Undecided => Certificate::None,
    }
}

/// Verdict, margin and proof by the contacts' sets of wrenches.
pub(crate) fn assess_edges(set: &WrenchSet<'_>, length: Option<f64>, center_O: Option<Vec3>) -> Assessment {
    let found = span(set);
    let (stability, certificate) = (verdict(&found), proof(set, &found));
    let frame = Frame::new(&set.grasp, length, center_O);
    let (margin_lower, margin_upper) = match stability {
        Stability::Stable => {
            let depth = hull_depth(set, &frame, Until::Gap(MARGIN_GAP));
            (depth.lower.max(0.0), depth.upper.max(0.0))
        }
        Stability::Unstable => (0.0, 0.0),
        Stability::Undecided => (0.0, f64::INFINITY),
    };
    Assessment { stability, margin_lower, margin_upper, certificate }
}

/// The depth of the origin in the hull of the contacts' wrenches, in the coordinates of `frame`.
pub(crate) fn hull_depth(set: &WrenchSet<'_>, frame: &Frame, until: Until) -> Depth {
    depth(|w| frame.wrench(&set.wrench(&set.farthest(&frame.twist(w)))), until)
}

impl StabilityTest for Linearised {
    fn test(
        &self,
        grasp: &Grasp<'_>,
        _hint: &mut Hint,
        context: &mut Context<'_>,
    ) -> Result<Stability, CallError> {
        context.count_call(Slot::StabilityTest);
        Ok(verdict(&span(&WrenchSet::gather(grasp, None, Some(&self.ring)))))
    }

    fn assess(
        &self,
        grasp: &Grasp<'_>,
        length: Option<f64>,
        center_O: Option<Vec3>,
        _context: &mut Context<'_>,
    ) -> Result<Assessment, CallError> {
        Ok(assess_edges(&WrenchSet::gather(grasp, None, Some(&self.ring)), length, center_O))
    }

    fn stable_without(
        &self,
        grasp: &Grasp<'_>,
        finger: FingerIndex,
        context: &mut Context<'_>,
    ) -> Result<bool, CallError> {
        context.count_call(Slot::StabilityTest);
        let rest = WrenchSet::gather(grasp, Some(finger), Some(&self.ring));
        Ok(verdict(&span(&rest)).is_stable())
    }
}

regrasp_api::inventory::submit! {
    Entry {
        id: ID,
        slots: &[Slot::StabilityTest],
        summary: "Force closure with cones of m edges, from inside: a linear feasibility problem; takes \
            polyhedral cones.",
        references: &[
            "Kerr, Roth, Analysis of multifingered hands, IJRR 1986",
            "Liu, Qualitative test and force optimization of 3-D frictional form-closure grasps using \
                linear programming, T-RA 1999",
            "Lawson, Hanson, Solving Least Squares Problems, Prentice-Hall 1974, chapter 23",
        ],
        schema: LinearisedSettings::schema,
        check: check_settings::<LinearisedSettings>,
        build: Build::StabilityTest(|json, _| Ok(Box::new(Linearised::new(LinearisedSettings::from_json(json)?)?))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_outside_their_range_are_refused() {
        for edges in [0, 2, 65] {
            let error = Linearised::new(LinearisedSettings { edges }).unwrap_err();
            assert_eq!(error.to_string(), format!("`edges` = {edges} is outside 3..=64"));
        }
        assert!(LinearisedSettings::from_json(r#"{"edges": -1}"#).is_err());
        assert_eq!(LinearisedSettings::from_json("").unwrap().edges, 8);
    }
}
