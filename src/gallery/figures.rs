//! A plan in figures, as the gallery tells them.

use regrasp::plan::{Extreme, Plan};

/// What is told of a plan.
pub struct Figures {
    hand: String,
    object: String,
    mass_kg: f64,
    friction: f64,
    transfers: usize,
    regrasps: usize,
    duration_s: f64,
    margin: Option<f64>,
    clearance_m: Option<f64>,
    /// Friction, mass (kg) and disturbance (N) at which it still holds.
    holds: Option<[f64; 3]>,
}

impl Figures {
    /// Of a plan with its certificate.
    pub fn of(plan: &Plan) -> Self {
        let problem = &plan.scenario.problem;
        let certificate = plan.certificate.as_ref();
        let value = |extreme: &Option<Extreme>| extreme.as_ref().map(|extreme| extreme.value);
        let holds = certificate.and_then(|certificate| certificate.holds.as_ref());
        let regrasps = plan.segments.iter().filter(|segment| segment.finger.is_some()).count();
        let last = plan.segments.last().and_then(|segment| segment.states.last());
        Self {
            hand: problem.hand.name.clone(),
            object: problem.object.name.clone(),
            mass_kg: problem.object.mass,
            friction: problem.object.friction,
            transfers: plan.segments.len() - regrasps,
            regrasps,
            duration_s: last.map_or(0.0, |state| state.time),
            margin: certificate.and_then(|certificate| value(&certificate.closure_margin)),
            clearance_m: certificate.and_then(|certificate| value(&certificate.clearance)),
            holds: holds
                .map(|holds| [&holds.friction, &holds.mass, &holds.disturbance].map(|extreme| extreme.value)),
        }
    }

    /// The motion in a few words.
    pub fn motion(&self) -> String {
        let Self { transfers, regrasps, duration_s, .. } = self;
        let many =
            |count: &usize, noun: &str| format!("{count} {noun}{}", if *count == 1 { "" } else { "s" });
        format!("{}, {}, {duration_s:.1} s", many(transfers, "transfer"), many(regrasps, "regrasp"))
    }

    /// The cells of a table, named by [`Figures::HEAD`].
    pub fn cells(&self) -> [String; 7] {
        let dash = || "–".to_owned();
        let holds = self.holds.map_or(dash(), |[friction, mass, force]| {
            match friction > self.friction * (1.0 + 1e-9) {
                true => format!("not its {} kg", self.mass_kg),
                false => format!("friction {friction:.2}, {mass:.2} kg, {force:.2} N"),
            }
        });
        [
            format!("`{}`", self.hand),
            format!("`{}`, {} kg, friction {}", self.object, self.mass_kg, self.friction),
            self.regrasps.to_string(),
            format!("{:.1} s", self.duration_s),
            self.margin.map_or(dash(), |margin| format!("{margin:.3}")),
            self.clearance_m.map_or(dash(), |clearance| format!("{:.2} mm", clearance * 1e3)),
            holds,
        ]
    }

    /// What the cells say.
    pub const HEAD: [&str; 7] =
        ["hand", "object", "regrasps", "motion", "margin at least", "clearance at least", "holds"];
}
