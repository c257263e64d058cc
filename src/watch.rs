//! The program's clock and what stops it: Ctrl-C and the time limit. The libraries own neither.

use regrasp::api::Interrupt;
use regrasp::plan::StoppedBy;
use regrasp::planner::Clock;
use regrasp::study::Stop;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Set by Ctrl-C; signals know no object to set it in.
static CTRL_C: AtomicBool = AtomicBool::new(false);

/// A clock that started with the run, and its deadline.
pub struct Watch {
    start: Instant,
    limit: Option<Duration>,
}

impl Watch {
    /// Starts the clock; from now on Ctrl-C asks the run to stop, and a second one ends the program at once.
    pub fn start(limit_s: Option<f64>) -> Self {
        // Without a handler Ctrl-C ends the program, which is what it does by default.
        let _ = ctrlc::set_handler(|| {
            if CTRL_C.swap(true, Ordering::SeqCst) {
                std::process::exit(130);
            }
        });
        Self { start: Instant::now(), limit: limit_s.map(Duration::from_secs_f64) }
    }
}

impl Clock for Watch {
    fn seconds(&self) -> f64 {
        self.start.elapsed().as_secs_f64()
    }
}

impl Interrupt for Watch {
    fn interrupted(&self) -> bool {
        CTRL_C.load(Ordering::Relaxed) || self.limit.is_some_and(|limit| self.start.elapsed() >= limit)
    }
}

impl Stop for Watch {
    fn cause(&self) -> StoppedBy {
        if CTRL_C.load(Ordering::Relaxed) { StoppedBy::Interrupt } else { StoppedBy::TimeLimit }
    }
}
