//! The time for runs: the libraries own no clock.

use crate::api::Interrupt;
use crate::plan::StoppedBy;
use crate::planner::{Clock, Silent};
use crate::run::{RunOptions, Stop};
use std::time::{Duration, Instant};

/// Times a run, and ends it at a limit where it has one.
#[derive(Clone, Copy, Debug)]
pub struct Stopwatch {
    begin: Instant,
    limit: Option<Duration>,
}

impl Stopwatch {
    /// Begins now, without a limit.
    pub fn start() -> Self {
        Self { begin: Instant::now(), limit: None }
    }

    /// Begins now, with a limit; a run that uses it comes to an end that many seconds from now.
    pub fn limited(limit: Duration) -> Self {
        Self { begin: Instant::now(), limit: Some(limit) }
    }

    /// A run with this seed under this watch: on one thread, telling nobody how far it is.
    pub fn options(&self, seed: u64) -> RunOptions<'_> {
        RunOptions { seed, threads: 1, stop: self, clock: self, progress: &Silent }
    }
}

impl Clock for Stopwatch {
    fn seconds(&self) -> f64 {
        self.begin.elapsed().as_secs_f64()
    }
}

impl Interrupt for Stopwatch {
    fn interrupted(&self) -> bool {
        self.limit.is_some_and(|limit| self.begin.elapsed() >= limit)
    }
}

impl Stop for Stopwatch {
    fn cause(&self) -> StoppedBy {
        StoppedBy::TimeLimit
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_a_limit_that_is_over_interrupts() {
        assert!(!Stopwatch::start().interrupted());
        assert!(!Stopwatch::limited(Duration::from_secs(3600)).interrupted());
        assert!(Stopwatch::limited(Duration::ZERO).interrupted());
    }

    #[test]
    fn time_goes_on() {
        let watch = Stopwatch::start();
        let first = watch.seconds();
        std::thread::sleep(Duration::from_millis(2));
        assert!(watch.seconds() >= first + 1e-3);
    }
}
