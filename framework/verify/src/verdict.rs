//! The verifier's answer: every check with its worst value, limit and place.

use regrasp_plan::{Extreme, HoldsAt, Place, PlanCertificate};
use serde::Serialize;

/// The verifier's answer on one plan.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Verdict {
    /// Whether every check is met.
    pub valid: bool,
    /// The checks, always in the same order; only the first, `form`, where the plan's form does not allow
    /// more.
    pub checks: Vec<Check>,
    /// The figures that a plan file stores; absent where the plan's form does not allow any.
    pub certificate: Option<PlanCertificate>,
}

impl Verdict {
    pub(crate) fn new(checks: Vec<Check>, certificate: Option<PlanCertificate>) -> Self {
        Self { valid: checks.iter().all(|check| check.ok), checks, certificate }
    }

    /// Whether everything that the plan does is right, although it may not reach all goals: what a partial
    /// plan must be.
    pub fn is_sound(&self) -> bool {
        self.checks.iter().all(|check| check.ok || check.name == COMPLETE)
    }

    /// The check of this name.
    pub fn check(&self, name: &str) -> Option<&Check> {
        self.checks.iter().find(|check| check.name == name)
    }

    /// The checks that are not met.
    pub fn failures(&self) -> impl Iterator<Item = &Check> {
        self.checks.iter().filter(|check| !check.ok)
    }
}

/// The name of the check that all goals of the scenario are reached.
pub(crate) const COMPLETE: &str = "complete";

/// One check.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Check {
    /// What is checked, in kebab case.
    pub name: &'static str,
    /// The worst value over the whole plan, in `unit`; absent where there was nothing to check.
    pub worst: Option<f64>,
    /// The value that `worst` may not pass.
    pub limit: f64,
    /// On which side of the limit a value is good.
    pub side: Side,
    /// The unit of both: `m`, `rad`, `s`, `of the limit`, `faults`, `force` (fraction of the total normal
    /// force; of the largest allowed one where the plan claims equilibrium).
    pub unit: &'static str,
    /// Where the worst value is reached.
    #[serde(rename = "where")]
    pub place: Place,
    /// Whether the check is met.
    pub ok: bool,
}

/// On which side of its limit a value is good.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Side {
    /// value ≤ limit.
    AtMost,
    /// value > limit.
    Above,
}

impl Side {
    /// As it is written between a value and its limit.
    pub fn sign(self) -> &'static str {
        match self {
            Self::AtMost => "≤",
            Self::Above => ">",
        }
    }
}

/// The unit of checks that count what is wrong.
const FAULTS: &str = "faults";

/// Gathers the worst value of one check.
#[derive(Clone, Debug)]
pub(crate) struct Gauge {
    name: &'static str,
    unit: &'static str,
    limit: f64,
    side: Side,
    worst: Option<f64>,
    place: Place,
}

impl Gauge {
    pub(crate) fn new(name: &'static str, unit: &'static str, side: Side, limit: f64) -> Self {
        Self { name, unit, limit, side, worst: None, place: Place::default() }
    }

    /// A check that counts faults: none is allowed.
    pub(crate) fn faults(name: &'static str) -> Self {
        let mut gauge = Self::new(name, FAULTS, Side::AtMost, 0.0);
        gauge.worst = Some(0.0);
        gauge
    }

    /// Takes in a value; `place` is asked only where it is the worst so far. NaN is worse than anything.
    pub(crate) fn note(&mut self, value: f64, place: impl FnOnce() -> Place) {
        let worse = match self.worst {
            None => true,
            Some(worst) if worst.is_nan() => false,
            Some(worst) => {
                value.is_nan()
                    || match self.side {
                        Side::AtMost => value > worst,
                        Side::Above => value < worst,
                    }
            }
        };
        if worse {
            self.worst = Some(value);
            self.place = place();
        }
    }

    /// Takes in one more fault; the place of the first one is kept.
    pub(crate) fn fault(&mut self, place: impl FnOnce() -> Place) {
        let count = self.worst.unwrap_or(0.0);
        if count == 0.0 {
            self.place = place();
        }
        self.worst = Some(count + 1.0);
    }

    /// Takes in what the same check gathered later in the plan, as if one gauge had seen both.
    pub(crate) fn join(&mut self, later: Self) {
        match later.worst {
            None => {}
            Some(count) if self.unit == FAULTS => {
                let before = self.worst.unwrap_or(0.0);
                if before == 0.0 && count > 0.0 {
                    self.place = later.place;
                }
                self.worst = Some(before + count);
            }
            Some(value) => self.note(value, || later.place),
        }
    }

    /// Says something about the check as a whole.
    pub(crate) fn remark(&mut self, note: &str) {
        self.place.note = Some(note.into());
    }

    pub(crate) fn worst(&self) -> Option<f64> {
        self.worst
    }

    pub(crate) fn limit(&self) -> f64 {
        self.limit
    }

    pub(crate) fn place(&self) -> &Place {
        &self.place
    }

    /// The worst value as it stands at the samples, for the certificate.
    pub(crate) fn extreme(&self) -> Option<Extreme> {
        Some(Extreme::new(self.worst?, self.place.clone(), HoldsAt::Samples))
    }

    pub(crate) fn check(self) -> Check {
        let good = |value: f64| match self.side {
            Side::AtMost => value <= self.limit,
            Side::Above => value > self.limit,
        };
        let ok = self.worst.is_none_or(good);
        Check {
            name: self.name,
            worst: self.worst,
            limit: self.limit,
            side: self.side,
            unit: self.unit,
            place: self.place,
            ok,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(state: usize) -> Place {
        Place { state: Some(state), ..Default::default() }
    }

    #[test]
    fn the_worst_value_and_its_place_are_kept() {
        let mut most = Gauge::new("a", "m", Side::AtMost, 2.0);
        [1.0, 3.0, 2.0].iter().enumerate().for_each(|(k, &value)| most.note(value, || at(k)));
        let check = most.check();
        assert_eq!((check.worst, check.place, check.ok), (Some(3.0), at(1), false));
        let mut least = Gauge::new("b", "m", Side::Above, 1.0);
        [3.0, 1.5].iter().enumerate().for_each(|(k, &value)| least.note(value, || at(k)));
        assert!(least.clone().check().ok);
        least.note(1.0, || at(2));
        assert!(!least.check().ok, "the limit itself is not above it");
    }

    #[test]
    fn nan_is_never_good() {
        for side in [Side::AtMost, Side::Above] {
            let mut gauge = Gauge::new("a", "m", side, 2.0);
            gauge.note(f64::NAN, || at(0));
            gauge.note(1.0, || at(1));
            gauge.note(3.0, || at(2));
            assert_eq!(gauge.place(), &at(0));
            assert!(!gauge.check().ok);
        }
    }

    #[test]
    fn joined_gauges_are_as_one_that_saw_all() {
        let values = [1.0, 3.0, f64::NAN, 3.0, 4.0];
        for cut in 0..=values.len() {
            for until in [2, 4] {
                let gauge = |range: std::ops::Range<usize>| {
                    let mut gauge = Gauge::new("a", "m", Side::AtMost, 2.0);
                    let mut faults = Gauge::faults("b");
                    for k in range.filter(|&k| k != until) {
                        gauge.note(values[k], || at(k));
                        faults.fault(|| at(k));
                    }
                    (gauge, faults)
                };
                let (mut first, whole) = (gauge(0..cut), gauge(0..values.len()));
                let later = gauge(cut..values.len());
                first.0.join(later.0);
                first.1.join(later.1);
                assert_eq!(format!("{first:?}"), format!("{whole:?}"), "{cut} {until}");
            }
        }
    }

    #[test]
    fn faults_are_counted_and_nothing_to_check_is_fine() {
        let mut faults = Gauge::faults("a");
        assert!(faults.clone().check().ok);
        faults.fault(|| at(4));
        faults.fault(|| at(5));
        let check = faults.check();
        assert_eq!((check.worst, check.place, check.ok), (Some(2.0), at(4), false));
        assert!(Gauge::new("b", "m", Side::Above, 0.0).check().ok);
    }
}
