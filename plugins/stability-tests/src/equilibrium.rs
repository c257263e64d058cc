//! `stability-test/equilibrium`: bounded contact forces hold the object against gravity and disturbances.

use crate::balance::{Balance, Balanced, Forces};
use crate::contacts::{ScaledGrasp, Twist, is_round};
use crate::edges::{EdgeBalance, Found};
use crate::wrenches::WrenchSet;
use regrasp_api::{
    Assessment, Build, BuildError, CallError, Certificate, Context, Criterion, Entry, FingerIndex, Grasp,
    Hint, Load, Settings, SettingsError, Slot, Stability, StabilityTest, Vec3, check_settings,
};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub(crate) const ID: &str = "stability-test/equilibrium";
/// How far apart the bounds of a reported margin are, relative to the factor.
const MARGIN_GAP: f64 = 0.005;
/// The largest factor of the disturbances that a margin tells of.
const MOST: f64 = 1e6;
/// The smallest factor that it tells from 0.
const LEAST: f64 = 1e-3;
/// Vertices of the two icosahedra.
const VERTICES: usize = 24;

/// Settings of [`Equilibrium`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct EquilibriumSettings {
    /// Largest disturbing force at the centre of mass, in any direction (N), default 0.2: a light touch.
    #[schemars(range(min = 1e-3, max = 1e4), extend("x-unit" = "N"))]
    pub disturbance_force: f64,
    /// Largest disturbing torque, about any axis (N·m), default 0.002: that touch a centimetre off.
    #[schemars(range(min = 1e-6, max = 1e3), extend("x-unit" = "N·m"))]
    pub disturbance_torque: f64,
    /// Largest normal force of one contact (N), default 20, what fingers of this size can press.
    #[schemars(range(min = 1e-2, max = 1e5), extend("x-unit" = "N"))]
    pub max_normal_force: f64,
}

impl Default for EquilibriumSettings {
    fn default() -> Self {
        Self { disturbance_force: 0.2, disturbance_torque: 0.002, max_normal_force: 20.0 }
    }
}

impl Settings for EquilibriumSettings {}

/// Stable where contact forces inside the cones, with normal parts up to a bound, hold the object's weight
/// and every disturbance of a set.
///
/// For the weight alone and for the weight with each of the 24 wrenches that [`Load`] describes (they enclose
/// all forces up to `disturbance_force` at the centre of mass, all torques up to `disturbance_torque`, and
/// mixtures), some forces must balance it: then, cones being convex, everything between is balanced too.
/// Elliptic cones are taken exactly, with a grain too, and so are polyhedral ones. Forces are found by
/// Newton's method to the analytic centre of those that balance the weight, an interior-point form of the
/// grasp-force problem of Han, Trinkle, Li, "Grasp analysis as linear matrix inequality problems", T-RA
/// 2000, and Boyd & Wegbreit, "Fast computation of optimal contact forces", T-RO 2007. The centre's
/// linear response is tried for all 24 first; where it leaves a cone, Newton goes on from there. A yes is
/// proved by forces strictly inside, a no by a twist on which all contacts together have too little
/// power; neither gives [`Stability::Undecided`].
///
/// Unlike closure the verdict depends on the object's orientation (gravity in its frame), mass and centre of
/// mass: a grasp, and which of its fingers may be lifted, may be stable in one pose and not in another, and a
/// grasp that closes nothing may carry the object from below. Verdicts are monotone in friction, in
/// `max_normal_force` and in added contacts. Where no gravity is given, closure is needed.
///
/// The margin is the factor by which all disturbances may grow, less 1 (no unit; at most 1e6); `length` and
/// `center_O` of [`StabilityTest::assess`] have no effect. The certificate of a stable grasp is the forces
/// (N) that balance the weight alone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Equilibrium {
    settings: EquilibriumSettings,
    mass: f64,
    p_OCm: Vec3,
}

/// The loads on a grasp in its scaled coordinates, over the largest normal force.
struct Loads {
    /// What the contacts must give to carry the weight.
    weight: Twist,
    /// The vertices of the disturbances.
    disturbances: [Twist; VERTICES],
}

impl Equilibrium {
    /// The test with checked settings, for an object of `mass` (kg) with centre of mass `p_OCm` in O (m).
    pub fn new(settings: EquilibriumSettings, mass: f64, p_OCm: Vec3) -> Result<Self, SettingsError> {
        settings.validate()?;
        Ok(Self { settings, mass, p_OCm })
    }

    fn loads(&self, scaled: &ScaledGrasp, g_O: &Vec3) -> Loads {
        let unit = 1.0 / self.settings.max_normal_force;
        let lever = (self.p_OCm - scaled.center_O) / scaled.length;
        let at_center_of_mass = |f: Vec3| Twist { a: f, b: lever.cross(&f) };
        let force = self.settings.disturbance_force * unit;
        let torque = self.settings.disturbance_torque * unit / scaled.length;
        let mut disturbances = [Twist::ZERO; VERTICES];
        for (vertex, pair) in icosahedron().into_iter().zip(disturbances.chunks_exact_mut(2)) {
            pair[0] = at_center_of_mass(vertex * force);
            pair[1] = Twist { a: Vec3::zeros(), b: vertex * torque };
        }
        Loads { weight: at_center_of_mass(g_O * (-self.mass * unit)), disturbances }
    }

    /// The verdict on `grasp` without `lifted`, the disturbances times `factor`.
    fn judge(
        &self,
        grasp: &Grasp<'_>,
        lifted: Option<FingerIndex>,
        factor: f64,
    ) -> Result<Stability, CallError> {
        if is_round(grasp, lifted) {
            return Ok(self.decide(&ScaledGrasp::gather(grasp, lifted, ID)?, &grasp.g_O, factor));
        }
        Ok(self.decide_edges(&WrenchSet::gather(grasp, lifted, None), &grasp.g_O, factor))
    }

    /// The verdict where some cones are polyhedra.
    fn decide_edges(&self, set: &WrenchSet<'_>, g_O: &Vec3, factor: f64) -> Stability {
        let Some(balance) = EdgeBalance::new(set) else { return Stability::Unstable };
        let loads = self.loads(&set.grasp, g_O);
        let verdict = |found: &Found| match found {
            Found::Yes(_) => Stability::Stable,
            Found::No => Stability::Unstable,
            Found::Unknown => Stability::Undecided,
        };
        let found = balance.centre(&loads.weight);
        let Found::Yes(parts) = &found else { return verdict(&found) };
        let with = |change: &Twist| verdict(&balance.follow(parts, &loads.weight.plus(factor, change)));
        let lost = loads.disturbances.iter().map(with).find(|verdict| !verdict.is_stable());
        lost.unwrap_or(Stability::Stable)
    }

    fn decide(&self, scaled: &ScaledGrasp, g_O: &Vec3, factor: f64) -> Stability {
        if scaled.components() < 6 {
            return Stability::Unstable;
        }
        let Some(balance) = Balance::new(scaled) else { return Stability::Unstable };
        let loads = self.loads(scaled, g_O);
        match balance.centre(&loads.weight) {
            Balanced::Yes(forces) => resists_all(&balance, &forces, &loads, factor),
            Balanced::No => Stability::Unstable,
            Balanced::Unknown => Stability::Undecided,
        }
    }

    /// The factor by which the disturbances may grow, where `holds` answers for one: bounds, the upper
    /// one infinite where it is above [`MOST`].
    fn factor(&self, holds: impl Fn(f64) -> bool) -> (f64, f64) {
        let (mut low, mut high) = (0.0, 1.0);
        while holds(high) {
            (low, high) = (high, 2.0 * high);
            if high > MOST {
                return (low, f64::INFINITY);
            }
        }
        while high - low > MARGIN_GAP * high && high > LEAST {
            let middle = 0.5 * (low + high);
            if holds(middle) { low = middle } else { high = middle }
        }
        (low, high)
    }

    fn certify(&self, grasp: &Grasp<'_>) -> Result<Certificate, CallError> {
        if is_round(grasp, None) {
            return Ok(self.certify_round(&ScaledGrasp::gather(grasp, None, ID)?, &grasp.g_O));
        }
        let set = WrenchSet::gather(grasp, None, None);
        let Some(balance) = EdgeBalance::new(&set) else { return Ok(Certificate::None) };
        let Found::Yes(parts) = balance.centre(&self.loads(&set.grasp, &grasp.g_O).weight) else {
            return Ok(Certificate::None);
        };
        let unit = self.settings.max_normal_force;
        let forces = || parts.iter().enumerate().map(|(i, part)| balance.force(i, part));
        Ok(Certificate::InternalForce {
            forces_O: forces().map(|force| force.f * unit).collect(),
            torsions: forces().map(|force| force.m * set.grasp.length * unit).collect(),
        })
    }

    fn certify_round(&self, scaled: &ScaledGrasp, g_O: &Vec3) -> Certificate {
        let Some(balance) = Balance::new(scaled) else { return Certificate::None };
        match balance.centre(&self.loads(scaled, g_O).weight) {
            Balanced::Yes(forces) => self.in_newtons(scaled, &forces),
            _ => Certificate::None,
        }
    }

    fn in_newtons(&self, scaled: &ScaledGrasp, forces: &Forces) -> Certificate {
        let unit = self.settings.max_normal_force;
        let each = || forces.iter().zip(scaled.contacts());
        Certificate::InternalForce {
            forces_O: each().map(|(force, contact)| force.wrench(contact).a * unit).collect(),
            torsions: each().map(|(force, c)| c.gamma * force.spin * scaled.length * unit).collect(),
        }
    }
}

/// Whether forces near those that carry the weight carry each disturbance, times `factor`, too.
fn resists_all(balance: &Balance<'_>, forces: &Forces, loads: &Loads, factor: f64) -> Stability {
    let response = balance.response(forces);
    for disturbance in &loads.disturbances {
        // Contacts must give the opposite; the vertices come in opposite pairs, so the sign does not matter.
        let change = disturbance.scaled(factor);
        if response.absorbs(&change) {
            continue;
        }
        match balance.follow(forces, &loads.weight.plus(1.0, &change)) {
            Balanced::Yes(_) => {}
            Balanced::No => return Stability::Unstable,
            Balanced::Unknown => return Stability::Undecided,
        }
    }
    Stability::Stable
}

/// The vertices of the regular icosahedron around the unit ball.
fn icosahedron() -> [Vec3; VERTICES / 2] {
    let golden = 0.5 * (1.0 + 5.0_f64.sqrt());
    // The inscribed ball of (0, ±1, ±φ) has radius φ²/√3.
    let scale = 3.0_f64.sqrt() / (golden * golden);
    let (short, long) = (scale, golden * scale);
    let mut vertices = [Vec3::zeros(); VERTICES / 2];
    for (k, vertex) in vertices.iter_mut().enumerate() {
        let (axis, signs) = (k / 4, k % 4);
        vertex[(axis + 1) % 3] = if signs & 1 == 0 { short } else { -short };
        vertex[(axis + 2) % 3] = if signs & 2 == 0 { long } else { -long };
    }
    vertices
}

impl StabilityTest for Equilibrium {
    fn test(
        &self,
        grasp: &Grasp<'_>,
        _hint: &mut Hint,
        context: &mut Context<'_>,
    ) -> Result<Stability, CallError> {
        context.count_call(Slot::StabilityTest);
        self.judge(grasp, None, 1.0)
    }

    fn assess(
        &self,
        grasp: &Grasp<'_>,
        _length: Option<f64>,
        _center_O: Option<Vec3>,
        _context: &mut Context<'_>,
    ) -> Result<Assessment, CallError> {
        let stability = self.judge(grasp, None, 1.0)?;
        let holds = |factor: f64| self.judge(grasp, None, factor).is_ok_and(|found| found.is_stable());
        let (low, high) = self.factor(holds);
        let (margin_lower, margin_upper, certificate) = if stability.is_stable() {
            ((low - 1.0).max(0.0), high - 1.0, self.certify(grasp)?)
        } else {
            ((low - 1.0).min(0.0), (high - 1.0).max(low - 1.0), Certificate::None)
        };
        Ok(Assessment { stability, margin_lower, margin_upper, certificate })
    }

    fn criterion(&self) -> Criterion {
        Criterion::Equilibrium(Load {
            disturbance_force: self.settings.disturbance_force,
            disturbance_torque: self.settings.disturbance_torque,
            max_normal_force: self.settings.max_normal_force,
        })
    }

    fn stable_without(
        &self,
        grasp: &Grasp<'_>,
        finger: FingerIndex,
        context: &mut Context<'_>,
    ) -> Result<bool, CallError> {
        context.count_call(Slot::StabilityTest);
        Ok(self.judge(grasp, Some(finger), 1.0)?.is_stable())
    }
}

regrasp_api::inventory::submit! {
    Entry {
        id: ID,
        slots: &[Slot::StabilityTest],
        summary: "Bounded contact forces hold the object's weight and a set of disturbances; depends on the \
            object's pose.",
        references: &[
            "Han, Trinkle, Li, Grasp analysis as linear matrix inequality problems, T-RA 2000",
            "Boyd, Wegbreit, Fast computation of optimal contact forces, T-RO 2007",
            "Boyd, Vandenberghe, Convex Optimization, Cambridge 2004, section 10.3",
        ],
        schema: EquilibriumSettings::schema,
        check: check_settings::<EquilibriumSettings>,
        build: Build::StabilityTest(|json, parts| {
            let settings = EquilibriumSettings::from_json(json)?;
            let test = Equilibrium::new(settings, parts.object.mass, parts.object.p_OCm);
            Ok(Box::new(test.map_err(BuildError::from)?))
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_outside_their_range_are_refused() {
        for (json, key) in [
            (r#"{"disturbance_force": 0}"#, "disturbance_force"),
            (r#"{"disturbance_torque": -1}"#, "disturbance_torque"),
            (r#"{"max_normal_force": 1e6}"#, "max_normal_force"),
        ] {
            let error = EquilibriumSettings::from_json(json).unwrap_err().to_string();
            assert!(error.contains(key), "{error}");
        }
    }

    #[test]
    fn the_icosahedron_touches_the_ball_from_outside() {
        let vertices = icosahedron();
        let mut random = regrasp_api::Random::from_key(2, 0, 0, 0);
        let mut least = f64::INFINITY;
        for _ in 0..20_000 {
            let u = random.direction();
            least = least.min(vertices.iter().map(|v| v.dot(&u)).fold(f64::NEG_INFINITY, f64::max));
        }
        assert!((1.0..1.01).contains(&least), "{least}");
        assert!(vertices.iter().all(|v| (v.norm() - 1.258_408_572).abs() < 1e-6));
    }
}
