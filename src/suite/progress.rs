//! What the user sees while a protocol is run.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// A bar on standard error, if that is a terminal.
pub struct Bar(ProgressBar);

impl Bar {
    /// For so many trials, some of which have ended before.
    pub fn new(trials: usize, known: usize) -> Self {
        let bar = ProgressBar::with_draw_target(Some(trials as u64), ProgressDrawTarget::stderr());
        let style = "{elapsed} {wide_bar} {human_pos} of {human_len} trials, {eta} left";
        bar.set_style(ProgressStyle::with_template(style).expect("the template is a constant"));
        bar.set_position(known as u64);
        bar.reset_eta();
        Self(bar)
    }

    pub fn done(&self) {
        self.0.inc(1);
    }

    pub fn finish(&self) {
        self.0.finish_and_clear();
    }
}
