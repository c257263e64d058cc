//! The program's clock and what stops it: Ctrl-C, its like, and the time limit.

use crate::watchdog::Heard;
use regrasp::Stopwatch;
use regrasp::api::Interrupt;
use regrasp::plan::StoppedBy;
use regrasp::planner::Clock;
use regrasp::run::Stop;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Once, OnceLock};
use std::time::{Duration, Instant};

/// Set by Ctrl-C; signals know no object to set it in.
static CTRL_C: AtomicBool = AtomicBool::new(false);
/// When it was set.
static FIRST: OnceLock<Instant> = OnceLock::new();
/// Signals that come closer together are one: `timeout` and others send theirs to the process and to its
/// group.
const SAME: Duration = Duration::from_millis(300);

/// What happens on Ctrl-C.
fn asked_to_stop() {
    let since = FIRST.get_or_init(Instant::now).elapsed();
    if CTRL_C.swap(true, Ordering::SeqCst) && since > SAME {
        std::process::exit(130);
    }
}

/// Listens to Ctrl-C, to a request to end (SIGTERM), and to a terminal that goes away (SIGHUP) unless `nohup`
/// had that ignored.
///
/// Where no listener can be installed the signals end the program, which is what they do by default.
#[cfg(unix)]
fn listen() {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    let wanted =
        [SIGINT, SIGTERM, SIGHUP].into_iter().filter(|&signal| signal != SIGHUP || !is_ignored(signal));
    if let Ok(mut signals) = signal_hook::iterator::Signals::new(wanted) {
        std::thread::spawn(move || signals.forever().for_each(|_| asked_to_stop()));
    }
}

/// Whether the process was started with this signal ignored; false where the system does not tell.
#[cfg(unix)]
fn is_ignored(signal: i32) -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok())
        .is_some_and(|mask| mask >> (signal - 1) & 1 == 1)
}

#[cfg(not(unix))]
fn listen() {
    let _ = ctrlc::set_handler(asked_to_stop);
}

/// A stopwatch that Ctrl-C stops, too.
pub struct Watch {
    time: Stopwatch,
    /// Told when somebody learns that the time is up.
    pub heard: Heard,
}

impl Watch {
    /// Starts the clock; from now on Ctrl-C asks the run to stop, and a second one ends the program at once.
    pub fn start(limit_s: Option<f64>) -> Self {
        static HANDLER: Once = Once::new();
        HANDLER.call_once(listen);
        let time = limit_s.map(Duration::from_secs_f64).map_or_else(Stopwatch::start, Stopwatch::limited);
        Self { time, heard: Heard::default() }
    }
}

impl Clock for Watch {
    fn seconds(&self) -> f64 {
        self.time.seconds()
    }
}

impl Interrupt for Watch {
    fn interrupted(&self) -> bool {
        let is_over = CTRL_C.load(Ordering::Relaxed) || self.time.interrupted();
        if is_over {
            self.heard.store(true, Ordering::Relaxed);
        }
        is_over
    }
}

impl Stop for Watch {
    fn cause(&self) -> StoppedBy {
        if CTRL_C.load(Ordering::Relaxed) { StoppedBy::Interrupt } else { self.time.cause() }
    }
}
