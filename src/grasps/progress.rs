//! What the user sees while grasps are looked for.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use regrasp::grasps::Progress;

/// A bar on standard error, if that is a terminal.
pub struct Bar(ProgressBar);

impl Bar {
    /// For `count` grasps of which there are some already.
    pub fn new(count: u64, there: u64) -> Self {
        let bar = ProgressBar::with_draw_target(Some(count), ProgressDrawTarget::stderr());
        let style = "{elapsed} {wide_bar} {human_pos} of {human_len} grasps, {per_sec}, {eta} left {msg}";
        bar.set_style(ProgressStyle::with_template(style).expect("the template is a constant"));
        bar.set_position(there);
        bar.reset_eta();
        Self(bar)
    }

    pub fn finish(&self) {
        self.0.finish_and_clear();
    }
}

impl Progress for Bar {
    fn found(&self, grasps: u64, poses: u64) {
        self.0.set_position(grasps);
        if grasps == 0 {
            self.0.set_message(format!("({poses} poses drawn)"));
        }
    }
}
