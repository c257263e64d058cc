//! What the user sees while a study is made.

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
    /// Runs that found no verified plan.
    failed: Cell<usize>,
}

impl Bar {
    pub fn new() -> Self {
        let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr());
        let style = "{bar:30} {pos} of {len} runs, {elapsed} gone, about {eta} left{msg}";
        bar.set_style(ProgressStyle::with_template(style).expect("the template is a constant"));
        Self { bar, last: Cell::new(Instant::now()), failed: Cell::new(0) }
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
        let (left, failed) = (self.bar.eta().as_secs(), self.bar.message());
        // A reader of standard error that has gone away is no failure.
        let _ = writeln!(io::stderr(), "{done} of {total} runs, about {left} s left{failed}");
    }
}

impl StudyProgress for Bar {
    fn begin(&self, done: usize, total: usize) {
        self.bar.set_length(total as u64);
        self.bar.set_position(done as u64);
        // Runs from before say nothing about how fast this machine is.
        self.bar.reset_eta();
    }

    fn ended(&self, record: &RunRecord) {
        if !record.is_success() {
            self.failed.set(self.failed.get() + 1);
            self.bar.set_message(format!(", {} without a verified plan", self.failed.get()));
        }
        self.bar.inc(1);
        self.tell();
    }
}
