//! The meter: self times from readings of an injected clock.

use regrasp_api::{Role, Slot};
use regrasp_planner::Clock;
use std::collections::BTreeMap;
use std::sync::atomic::{AtomicU32, AtomicU64, Ordering};

/// Of how many calls that lead to no others one is timed. A prime, so that it does not fall into step with
/// the fingers.
pub const PERIOD: u32 = 13;

/// Who takes time: the plugin of a slot, or clearance.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Source {
    Slot(Slot),
    Clearance,
}

impl Source {
    /// The place among [`names`].
    fn number(self) -> usize {
        match self {
            Self::Slot(slot) => slot as usize,
            Self::Clearance => Slot::ALL.len(),
        }
    }

    /// Whether its calls lead to calls of others.
    pub fn calls_others(self) -> bool {
        let role = match self {
            Self::Slot(slot) => slot.role(),
            Self::Clearance => return false,
        };
        matches!(role, Role::Sampler | Role::LocalPlanner | Role::GraphStrategy)
    }
}

/// The name of collision and distance among the sources of time.
pub const CLEARANCE: &str = "clearance";
/// The name of all that is neither a plugin nor clearance.
pub const FRAMEWORK: &str = "framework";

/// The names of the sources in the order of their numbers.
fn names() -> impl Iterator<Item = &'static str> {
    Slot::ALL.into_iter().map(Slot::name).chain([CLEARANCE])
}

const SOURCES: usize = Slot::ALL.len() + 1;

/// A number (s) that the roles' contract (`Sync`) wants to be atomic although one thread alone uses it.
#[derive(Debug, Default)]
struct Seconds(AtomicU64);

impl Seconds {
    fn value(&self) -> f64 {
        f64::from_bits(self.0.load(Ordering::Relaxed))
    }

    fn set(&self, value: f64) {
        self.0.store(value.to_bits(), Ordering::Relaxed);
    }

    fn add(&self, more: f64) {
        self.set(self.value() + more);
    }
}

/// Self times of one run on one thread.
pub(crate) struct Meter<'a> {
    clock: &'a dyn Clock,
    tick_s: f64,
    self_s: [Seconds; SOURCES],
    calls: [AtomicU32; SOURCES],
    collision_tests: AtomicU64,
    /// What others took within the innermost call that is being timed.
    inner_s: Seconds,
}

impl<'a> Meter<'a> {
    /// A meter at zero; reading `clock` takes `tick_s`.
    pub fn new(clock: &'a dyn Clock, tick_s: f64) -> Self {
        let (self_s, calls) = (Default::default(), Default::default());
        Self { clock, tick_s, self_s, calls, collision_tests: AtomicU64::new(0), inner_s: Seconds::default() }
    }

    /// A call that may lead to calls of others.
    pub fn outer<R>(&self, source: Source, call: impl FnOnce() -> R) -> R {
        let before_s = self.inner_s.value();
        self.inner_s.set(0.0);
        let (answer, took_s) = self.time(call);
        self.self_s[source.number()].add(took_s - self.inner_s.value());
        self.inner_s.set(before_s + took_s);
        answer
    }

    /// A call that leads to no calls of others.
    pub fn leaf<R>(&self, source: Source, call: impl FnOnce() -> R) -> R {
        if source == Source::Clearance {
            self.collision_tests.fetch_add(1, Ordering::Relaxed);
        }
        let count = &self.calls[source.number()];
        let number = count.load(Ordering::Relaxed).wrapping_add(1);
        // The middle of each period is timed: the first calls of a run are not like the others.
        if number != PERIOD / 2 {
            count.store(if number == PERIOD { 0 } else { number }, Ordering::Relaxed);
            return call();
        }
        count.store(number, Ordering::Relaxed);
        let (answer, took_s) = self.time(call);
        let all_s = took_s * f64::from(PERIOD);
        self.self_s[source.number()].add(all_s);
        self.inner_s.add(all_s);
        answer
    }

    fn time<R>(&self, call: impl FnOnce() -> R) -> (R, f64) {
        let begin = self.clock.seconds();
        let answer = call();
        (answer, (self.clock.seconds() - begin - self.tick_s).max(0.0))
    }

    /// How often clearance was asked.
    pub fn collision_tests(&self) -> u64 {
        self.collision_tests.load(Ordering::Relaxed)
    }

    /// Self times by name, in all `planning_s`: the framework has the rest.
    pub fn roles_s(&self, planning_s: f64) -> BTreeMap<String, f64> {
        let mut roles: BTreeMap<String, f64> =
            names().zip(&self.self_s).map(|(name, time)| (name.to_owned(), time.value().max(0.0))).collect();
        let sum: f64 = roles.values().sum();
        // Samples of short runs may say more than there is.
        if sum > planning_s && sum > 0.0 {
            roles.values_mut().for_each(|time| *time *= planning_s / sum);
        }
        roles.insert(FRAMEWORK.into(), (planning_s - sum).max(0.0));
        roles
    }
}

/// How long reading the clock takes (s): the median of many times.
pub(crate) fn tick_s(clock: &dyn Clock) -> f64 {
    let mut ticks: Vec<f64> = (0..1001).map(|_| -clock.seconds() + clock.seconds()).collect();
    ticks.sort_by(f64::total_cmp);
    ticks[ticks.len() / 2].max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A clock that only the work moves on.
    #[derive(Default)]
    struct Work(Seconds);
    impl Clock for Work {
        fn seconds(&self) -> f64 {
            self.0.value()
        }
    }

    #[test]
    fn names_follow_the_slots() {
        let names: Vec<&str> = names().collect();
        assert_eq!(names.len(), SOURCES);
        assert_eq!(names[Source::Slot(Slot::StabilityTest).number()], "stability-test");
        assert_eq!(names[Source::Slot(Slot::RegraspPlanner).number()], "local-planner.regrasp");
        assert_eq!(names[Source::Slot(Slot::GraphStrategy).number()], "graph-strategy");
        assert_eq!(names[Source::Clearance.number()], CLEARANCE);
    }

    #[test]
    fn self_time_is_what_others_did_not_take() {
        let clock = Work::default();
        let meter = Meter::new(&clock, 0.0);
        let periods = 4 * PERIOD;
        meter.outer(Source::Slot(Slot::Sampler), || {
            clock.0.add(1.0);
            meter.outer(Source::Slot(Slot::GraspPlanner), || clock.0.add(2.0));
            (0..periods).for_each(|_| meter.leaf(Source::Slot(Slot::StabilityTest), || clock.0.add(0.5)));
            clock.0.add(3.0);
        });
        (0..3).for_each(|_| meter.leaf(Source::Clearance, || ()));
        assert_eq!(meter.collision_tests(), 3, "stability tests are none");
        let leaves = f64::from(periods) * 0.5;
        let roles = meter.roles_s(10.0 + leaves);
        assert_eq!(roles["sampler"], 4.0);
        assert_eq!(roles["local-planner.grasp"], 2.0);
        assert_eq!(roles["stability-test"], leaves);
        assert_eq!(roles[FRAMEWORK], 4.0);
        assert_eq!(roles["surface"], 0.0);
    }

    #[test]
    fn times_never_exceed_planning() {
        let clock = Work::default();
        let meter = Meter::new(&clock, 0.0);
        (0..PERIOD).for_each(|_| meter.leaf(Source::Slot(Slot::Surface), || clock.0.add(1.0)));
        let roles = meter.roles_s(1.0);
        assert!((roles.values().sum::<f64>() - 1.0).abs() < 1e-12 && roles["surface"] > 0.99);
    }

    #[test]
    fn the_clocks_own_time_is_taken_off() {
        struct Slow(Seconds);
        impl Clock for Slow {
            fn seconds(&self) -> f64 {
                self.0.add(0.25);
                self.0.value()
            }
        }
        let clock = Slow(Seconds::default());
        let tick = tick_s(&clock);
        assert!((tick - 0.25).abs() < 1e-12);
        let meter = Meter::new(&clock, tick);
        meter.outer(Source::Slot(Slot::Sampler), || clock.0.add(2.0));
        assert!((meter.roles_s(3.0)["sampler"] - 2.0).abs() < 1e-12);
    }
}
