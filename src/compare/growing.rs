//! `--watch`: the report of what is finished, as a page that grows.

use super::progress::Bar;
use crate::serve::Live;
use regrasp::study::compare::{self, RunRecord, Study, StudyProgress, report};
use std::cell::{Cell, RefCell};
use std::time::{Duration, Instant};

/// Between two pages: to make one takes a moment, which the runs lose.
const STEP: Duration = Duration::from_secs(1);

/// Tells the bar, and shows the page.
pub struct Growing<'a> {
    bar: &'a Bar,
    study: &'a Study,
    live: &'a Live,
    records: RefCell<Vec<RunRecord>>,
    last: Cell<Option<Instant>>,
}

impl<'a> Growing<'a> {
    /// Shows the runs that are there from before.
    pub fn new(bar: &'a Bar, study: &'a Study, live: &'a Live, records: Vec<RunRecord>) -> Self {
        let growing = Self { bar, study, live, records: RefCell::new(records), last: Cell::new(None) };
        growing.show();
        growing
    }

    fn show(&self) {
        if self.last.get().is_some_and(|last| last.elapsed() < STEP) {
            return;
        }
        let records = self.records.borrow();
        let rows = compare::analyse(self.study, &records);
        let family = compare::judge_all(self.study, &rows);
        self.live.show(report::html(self.study, &rows, &family, &[]));
        self.last.set(Some(Instant::now()));
    }
}

impl StudyProgress for Growing<'_> {
    fn begin(&self, done: usize, total: usize) {
        self.bar.begin(done, total);
    }

    fn ended(&self, record: &RunRecord) {
        self.bar.ended(record);
        self.records.borrow_mut().push(record.clone());
        self.show();
    }
}
