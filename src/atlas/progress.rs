//! What the user sees while an atlas is made, and the journal behind it.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use regrasp::atlas::{AtlasError, Cell, Journal, Told};

/// A bar on standard error, if that is a terminal, before a journal.
pub struct Bar {
    bar: ProgressBar,
    pub journal: Journal,
}

impl Bar {
    /// For the members of a journal, some of which are done already.
    pub fn new(journal: Journal) -> Self {
        let members = journal.members() as u64;
        let bar = ProgressBar::with_draw_target(Some(members), ProgressDrawTarget::stderr());
        let style = "{elapsed} {wide_bar} {human_pos} of {human_len} hands and objects, {eta} left {msg}";
        bar.set_style(ProgressStyle::with_template(style).expect("the template is a constant"));
        bar.set_position(journal.cells().len() as u64);
        bar.reset_eta();
        Self { bar, journal }
    }

    /// Takes the bar away; what is left is the journal.
    pub fn finish(self) -> Journal {
        self.bar.finish_and_clear();
        self.journal
    }
}

impl Told for Bar {
    fn done(&mut self, cell: &Cell) -> Result<(), AtlasError> {
        self.bar.inc(1);
        self.journal.done(cell)
    }
}
