//! What the user sees while a run takes its time.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use regrasp::planner::Progress;
use std::time::{Duration, Instant};

/// A line on standard error, if that is a terminal and the run is not over at once.
pub struct Line {
    bar: ProgressBar,
    start: Instant,
}

/// Most runs are over before a line could be read.
const PATIENCE: Duration = Duration::from_millis(300);

impl Line {
    pub fn new() -> Self {
        let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr());
        let style = ProgressStyle::with_template("{spinner} {elapsed} {msg}");
        bar.set_style(style.expect("the template is a constant"));
        Self { bar, start: Instant::now() }
    }

    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }

    fn show(&self, text: impl FnOnce() -> String) {
        if !self.bar.is_hidden() && self.start.elapsed() > PATIENCE {
            self.bar.set_message(text());
            self.bar.tick();
        }
    }
}

impl Progress for Line {
    fn search(&self, leg: usize, nodes: usize, components: usize) {
        self.show(|| format!("goal {}: {nodes} nodes in {components} components", leg + 1));
    }

    fn smoothing(&self, segments: usize) {
        self.show(|| format!("smoothing {segments} segments"));
    }
}
