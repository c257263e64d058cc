//! What the user sees while a study is made.

use crate::quantity::span;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use regrasp::study::compare::{RunRecord, StudyProgress};
use std::cell::Cell;
use std::io::{self, Write};
use std::time::{Duration, Instant};

/// Where standard error is no terminal (a job of a cluster, say), a line goes there this often.
const PATIENCE: Duration = Duration::from_secs(30);

/// On standard error: how many runs are done, and how long the others will take.
pub struct Bar {
    bar: ProgressBar,
    /// When a line was last written where there is no terminal.
    last: Cell<Instant>,
    /// When the first run of this process was begun, and how many have ended since.
    begun: Cell<(Instant, u32)>,
    /// Runs that found no verified plan.
    failed: Cell<usize>,
}

impl Bar {
    pub fn new() -> Self {
        let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr());
        let style = "{bar:30} {pos} of {len} runs, {elapsed} gone{msg}";
        bar.set_style(ProgressStyle::with_template(style).expect("the template is a constant"));
        let now = Instant::now();
        Self { bar, last: Cell::new(now), begun: Cell::new((now, 0)), failed: Cell::new(0) }
    }

    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }

    /// What the bar would show, as a line of text.
    fn tell(&self) {
        if !self.bar.is_hidden() || self.last.get().elapsed() < PATIENCE {
            return;
        }
        self.last.set(Instant::now());
        let (done, total) = (self.bar.position(), self.bar.length().unwrap_or(0));
        let left = self.bar.message();
        // A reader of standard error that has gone away is no failure.
        let _ = writeln!(io::stderr(), "{done} of {total} runs{left}");
    }

    /// How long the rest will take, told once a run has shown how fast this machine is, and what failed.
    fn outlook(&self) -> String {
        let (begun, ended) = self.begun.get();
        let left = self.bar.length().unwrap_or(0).saturating_sub(self.bar.position());
        let left = left_text(begun.elapsed(), ended, left);
        match self.failed.get() {
            0 => left,
            failed => format!("{left}, {failed} without a verified plan"),
        }
    }
}

/// How long `left` runs will take where `ended` runs took a while; nothing is known before one has ended.
fn left_text(gone: Duration, ended: u32, left: u64) -> String {
    match ended {
        0 => String::new(),
        _ => format!(", about {} left", span(gone.as_secs_f64() / f64::from(ended) * left as f64)),
    }
}

impl StudyProgress for Bar {
    fn begin(&self, done: usize, total: usize) {
        self.bar.set_length(total as u64);
        self.bar.set_position(done as u64);
        // Runs from before say nothing about how fast this machine is.
        self.begun.set((Instant::now(), 0));
    }

    fn ended(&self, record: &RunRecord) {
        if !record.is_success() {
            self.failed.set(self.failed.get() + 1);
        }
        let (begun, ended) = self.begun.get();
        self.begun.set((begun, ended.saturating_add(1)));
        self.bar.inc(1);
        self.bar.set_message(self.outlook());
        self.tell();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_is_promised_before_a_run_has_ended() {
        assert_eq!(left_text(Duration::from_secs(3), 0, 40), "");
        assert_eq!(left_text(Duration::from_secs(3), 2, 40), ", about 60.0 s left");
    }
}
