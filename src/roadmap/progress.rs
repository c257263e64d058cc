//! What the user sees while a roadmap grows.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// A bar on standard error, if that is a terminal.
pub struct Bar(ProgressBar);

impl Bar {
    /// For a roadmap that is to have `nodes`, of which there are some already.
    pub fn new(nodes: usize, there: usize) -> Self {
        let most = (nodes < usize::MAX).then_some(nodes as u64);
        let bar = ProgressBar::with_draw_target(most, ProgressDrawTarget::stderr());
        let style = match most {
            Some(_) => "{elapsed} {wide_bar} {human_pos} of {human_len} nodes, {per_sec}, {eta} left",
            None => "{spinner} {elapsed} {human_pos} nodes, {per_sec}",
        };
        bar.set_style(ProgressStyle::with_template(style).expect("the template is a constant"));
        bar.set_position(there as u64);
        bar.reset_eta();
        Self(bar)
    }

    pub fn show(&self, nodes: usize) {
        self.0.set_position(nodes as u64);
    }

    pub fn finish(&self) {
        self.0.finish_and_clear();
    }
}
