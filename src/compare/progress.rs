//! What the user sees while a study is made.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use regrasp::study::compare::{RunRecord, StudyProgress};
use std::cell::Cell;

/// A line on standard error, if that is a terminal: how many runs are done, and how long the others will take.
pub struct Bar {
    bar: ProgressBar,
    /// Runs that found no verified plan.
    failed: Cell<usize>,
}

impl Bar {
    pub fn new() -> Self {
        let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr());
        let style = "{bar:30} {pos} of {len} runs, {elapsed} gone, about {eta} left{msg}";
        bar.set_style(ProgressStyle::with_template(style).expect("the template is a constant"));
        Self { bar, failed: Cell::new(0) }
    }

    pub fn finish(&self) {
        self.bar.finish_and_clear();
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
    }
}
