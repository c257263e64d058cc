//! What the user sees while a protocol is run.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// A bar on standard error, if that is a terminal.
pub struct Bar(ProgressBar);

impl Bar {
    /// For so many trials.
    pub fn new(trials: usize) -> Self {
        let bar = ProgressBar::with_draw_target(Some(trials as u64), ProgressDrawTarget::stderr());
        let style = "{elapsed} {wide_bar} {human_pos} of {human_len} trials, {eta} left";
        bar.set_style(ProgressStyle::with_template(style).expect("the template is a constant"));
        Self(bar)
    }

    pub fn done(&self) {
        self.0.inc(1);
    }

    pub fn finish(&self) {
        self.0.finish_and_clear();
    }
}
