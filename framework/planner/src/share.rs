//! How calls are shared among threads: the sequential order defines the result, and what is computed ahead of
//! it is thrown away where nobody asks for it.

use crate::session::{Counted, Session, Work, lent};
use rayon::prelude::*;
use regrasp_api::{CallError, Interrupt};
use std::collections::VecDeque;
use std::sync::atomic::{AtomicUsize, Ordering};

impl Session<'_> {
    /// The results of `call(0), call(1), …` in order, computed ahead by the threads there are.
    ///
    /// The caller may stop anywhere: with one thread nothing beyond that was computed, with several it is
    /// thrown away.
    pub fn ahead<'s, T: Send + 's>(
        &'s self,
        count: usize,
        call: impl Fn(usize) -> T + Sync + 's,
    ) -> impl Iterator<Item = T> + 's {
        self.ahead_by(self.threads(), count, call)
    }

    fn ahead_by<'s, T: Send + 's>(
        &'s self,
        many: usize,
        count: usize,
        call: impl Fn(usize) -> T + Sync + 's,
    ) -> impl Iterator<Item = T> + 's {
        let mut ready = VecDeque::new();
        let mut next = 0;
        std::iter::from_fn(move || {
            if ready.is_empty() && next < count {
                let end = count.min(next + many);
                ready.extend(self.compute(next..end, &call));
                next = end;
            }
            ready.pop_front()
        })
    }

    /// Calls in turn, so many of them at a time ahead, until one finds something; then the later ones, which
    /// nobody will ask for, are interrupted.
    pub fn until_found<'s, T: Send + 's>(
        &'s self,
        many: usize,
        count: usize,
        call: impl Fn(&Session<'_>, usize) -> Counted<Result<Option<T>, CallError>> + Sync + 's,
    ) -> impl Iterator<Item = Counted<Result<Option<T>, CallError>>> + 's {
        let first = AtomicUsize::new(usize::MAX);
        self.ahead_by(many, count, move |number| {
            let overtaken = Overtaken { interrupt: self.interrupt, first: &first, number };
            let found = call(&Session { interrupt: &overtaken, ..*self }, number);
            if matches!(found.result, Ok(Some(_))) {
                first.fetch_min(number, Ordering::Relaxed);
            }
            found
        })
    }

    /// The results of `call(0), …, call(count - 1)`, computed by the threads there are.
    pub fn draw<T: Send>(&self, count: usize, call: impl Fn(usize) -> T + Sync) -> Vec<T> {
        self.compute(0..count, &call)
    }

    /// Does `work` on each item, by the threads there are.
    pub fn each<T: Send>(&self, items: &mut [T], work: impl Fn(&mut T) + Sync) -> Result<(), CallError> {
        let done = |item| {
            lent(|| {
                work(item);
                Ok(())
            })
        };
        match self.pool {
            Some(pool) => pool.install(|| items.par_iter_mut().map(done).collect()),
            None => items.iter_mut().try_for_each(done),
        }
    }

    /// Does `work` on one of the threads that there are, which then wait for nobody when parts are computed.
    pub fn within<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        match self.pool {
            Some(pool) => pool.install(work),
            None => work(),
        }
    }

    /// How many threads compute.
    pub fn threads(&self) -> usize {
        self.pool.map_or(1, rayon::ThreadPool::current_num_threads)
    }

    fn compute<T: Send>(&self, range: std::ops::Range<usize>, call: &(impl Fn(usize) -> T + Sync)) -> Vec<T> {
        match self.pool {
            Some(pool) if range.len() > 1 => pool.install(|| range.into_par_iter().map(call).collect()),
            _ => range.map(call).collect(),
        }
    }
}

/// Interrupts a call where an earlier one has found something, too.
struct Overtaken<'a> {
    interrupt: &'a dyn Interrupt,
    /// The number of the first call that found something.
    first: &'a AtomicUsize,
    number: usize,
}

impl Interrupt for Overtaken<'_> {
    fn interrupted(&self) -> bool {
        self.first.load(Ordering::Relaxed) < self.number || self.interrupt.interrupted()
    }
}

impl Work<'_> {
    /// The results of parts of this call that know nothing of each other, in order, by the threads there are;
    /// the first error ends the call.
    pub fn parts<T: Send>(
        &mut self,
        count: usize,
        part: impl Fn(usize, &mut Work<'_>) -> Result<T, CallError> + Sync,
    ) -> Result<Vec<T>, CallError> {
        let (session, task, word) = (self.session, self.task, self.context.random.word());
        let done = session.draw(count, |i| session.part(task, (word, i), |work| part(i, work)));
        let take = |part: Counted<Result<T, CallError>>| {
            self.context.tally.add(&part.tally);
            part.result
        };
        done.into_iter().map(take).collect()
    }
}
