//! The program's clock and what stops it: Ctrl-C and the time limit.

use regrasp::Stopwatch;
use regrasp::api::Interrupt;
use regrasp::plan::StoppedBy;
use regrasp::planner::Clock;
use regrasp::run::Stop;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Set by Ctrl-C; signals know no object to set it in.
static CTRL_C: AtomicBool = AtomicBool::new(false);
/// When it was set.
static FIRST: OnceLock<Instant> = OnceLock::new();
/// Signals that come closer together are one: `timeout` and others send theirs to the process and to its group.
const SAME: Duration = Duration::from_millis(300);

/// A stopwatch that Ctrl-C stops, too.
pub struct Watch(Stopwatch);

impl Watch {
    /// Starts the clock; from now on Ctrl-C asks the run to stop, and a second one ends the program at once.
    pub fn start(limit_s: Option<f64>) -> Self {
        // Without a handler Ctrl-C ends the program, which is what it does by default.
        let _ = ctrlc::set_handler(|| {
            let since = FIRST.get_or_init(Instant::now).elapsed();
            if CTRL_C.swap(true, Ordering::SeqCst) && since > SAME {
                std::process::exit(130);
            }
        });
        Self(limit_s.map(Duration::from_secs_f64).map_or_else(Stopwatch::start, Stopwatch::limited))
    }
}

impl Clock for Watch {
    fn seconds(&self) -> f64 {
        self.0.seconds()
    }
}

impl Interrupt for Watch {
    fn interrupted(&self) -> bool {
        CTRL_C.load(Ordering::Relaxed) || self.0.interrupted()
    }
}

impl Stop for Watch {
    fn cause(&self) -> StoppedBy {
        if CTRL_C.load(Ordering::Relaxed) { StoppedBy::Interrupt } else { self.0.cause() }
    }
}
