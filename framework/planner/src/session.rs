//! What one run shares: the plugins, the keyed random streams, the threads that compute ahead.

use rayon::prelude::*;
use regrasp_api::{
    CallError, ClosedChainSampler, Context, GraphStrategy, Interrupt, LocalPlanner, Plugins, Random, Tally,
    Task, report_fault, take_fault, unless_fault,
};
use std::collections::VecDeque;

/// The plugins that drive the search; contact model, stability test and surface are in the [`Task`].
#[derive(Clone, Copy)]
pub(crate) struct Drivers<'a> {
    /// Samples closed chains.
    pub sampler: &'a dyn ClosedChainSampler,
    /// Connects inside GS_n.
    pub grasp: &'a dyn LocalPlanner,
    /// Moves the object by rolling.
    pub transfer: &'a dyn LocalPlanner,
    /// Moves one finger.
    pub regrasp: &'a dyn LocalPlanner,
    /// Decides what to do next.
    pub strategy: &'a dyn GraphStrategy,
}

impl<'a> Drivers<'a> {
    /// Those of all plugins.
    pub fn of(plugins: &Plugins<'a>) -> Self {
        let Plugins { sampler, grasp, transfer, regrasp, strategy, .. } = *plugins;
        Self { sampler, grasp, transfer, regrasp, strategy }
    }
}

/// The kinds of expensive calls: each with its own random streams.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Call {
    /// Search for a grasp at the start's pose.
    Start = 1,
    /// Search for a grasp at a goal's pose.
    Goal = 2,
    /// One step of the strategy.
    Strategy = 3,
    /// A sample anywhere.
    Sample = 4,
    /// A sample near a node.
    Extend = 5,
    /// A path in GS_n between two nodes.
    Grasp = 6,
    /// Transfer and regrasps between two nodes.
    TransferRegrasp = 7,
    /// Decomposition of an edge.
    Decompose = 8,
    /// One try of the smoother.
    Smooth = 9,
    /// The seed of a round of a search, after the first.
    Round = 10,
    /// A relay from a leg's start to its goal.
    Relay = 11,
    /// A sample for a roadmap.
    RoadmapSample = 12,
    /// An edge of a roadmap.
    RoadmapEdge = 13,
    /// The way from a node of a roadmap to an end of a query.
    RoadmapEnd = 14,
    /// A random pair of start and goal.
    RoadmapPair = 15,
}

/// The key of a call: what it is for, and two numbers that tell calls of a kind apart.
pub(crate) type Key = (Call, u64, u64);

/// A run's shared, immutable side.
#[derive(Clone, Copy)]
pub(crate) struct Session<'a> {
    pub plugins: Drivers<'a>,
    pub seed: u64,
    pub interrupt: &'a dyn Interrupt,
    pub pool: Option<&'a rayon::ThreadPool>,
}

/// One call at work: the plugins that it may ask, what it works on, and what it draws from and counts in.
pub(crate) struct Work<'a> {
    pub session: Session<'a>,
    pub plugins: Drivers<'a>,
    pub task: &'a Task<'a>,
    pub context: Context<'a>,
}

/// The result of a call with what it counted; the counts are charged when the result is consumed.
pub(crate) struct Counted<T> {
    pub result: T,
    pub tally: Tally,
}

impl<'a> Session<'a> {
    /// The call with this key, not begun.
    pub fn work<'w>(&self, task: &'w Task<'w>, key: Key) -> Work<'w>
    where
        'a: 'w,
    {
        self.work_drawing(task, self.random(key))
    }

    fn work_drawing<'w>(&self, task: &'w Task<'w>, random: Random) -> Work<'w>
    where
        'a: 'w,
    {
        let context = Context::new(random, self.interrupt);
        Work { session: *self, plugins: self.plugins, task, context }
    }

    /// The random stream of the call with this key: it depends on nothing else but the seed.
    fn random(&self, (kind, a, b): Key) -> Random {
        Random::from_key(self.seed, kind as u64, a, b)
    }

    /// Makes the call with this key, and returns its result with what it counted.
    pub fn counted<T>(
        &self,
        task: &Task<'_>,
        key: Key,
        call: impl FnOnce(&mut Work<'_>) -> Result<T, CallError>,
    ) -> Counted<Result<T, CallError>> {
        counted(self.work(task, key), call)
    }

    /// Does one of the parts of a call that know nothing of each other: its random stream depends on a word
    /// of the call's and on its number.
    pub fn part<T>(
        &self,
        task: &Task<'_>,
        (word, number): (u64, usize),
        part: impl FnOnce(&mut Work<'_>) -> Result<T, CallError>,
    ) -> Counted<Result<T, CallError>> {
        counted(self.work_drawing(task, Random::from_key(word, number as u64, 0, 0)), part)
    }

    /// Ends the run where it should stop.
    pub fn proceed(&self) -> Result<(), CallError> {
        Context::new(Random::from_key(0, 0, 0, 0), self.interrupt).proceed()
    }

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

    /// [`Self::ahead`] by so many at a time.
    pub fn ahead_by<'s, T: Send + 's>(
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

fn counted<T>(
    mut work: Work<'_>,
    call: impl FnOnce(&mut Work<'_>) -> Result<T, CallError>,
) -> Counted<Result<T, CallError>> {
    let result = lent(|| call(&mut work));
    Counted { result, tally: work.context.tally }
}

/// The result of a call on a thread that may have been lent to it while it waits for parts of another call.
///
/// A plugin that panicked where it could not return an error makes the result worthless: then it is that
/// panic. What the other call left on the thread stays there.
fn lent<T>(call: impl FnOnce() -> Result<T, CallError>) -> Result<T, CallError> {
    let lender = take_fault();
    let result = unless_fault(call());
    lender.into_iter().for_each(report_fault);
    result
}

#[cfg(test)]
mod tests {
    use super::*;
    use regrasp_api::{
        Action, Configuration, Contact, FingerSet, GraphView, Path, PerFinger, Pose, PoseRequest, Reached,
        Target, Uninterrupted,
    };
    use std::sync::atomic::{AtomicUsize, Ordering};

    /// Fills every driver's place; none is called.
    struct Idle;
    impl ClosedChainSampler for Idle {
        fn sample(
            &self,
            _: &Task<'_>,
            _: PoseRequest<'_>,
            _: FingerSet,
            _: &mut Context<'_>,
        ) -> Result<Option<Configuration>, CallError> {
            unreachable!()
        }
        fn close(
            &self,
            _: &Task<'_>,
            _: &Pose,
            _: &PerFinger<Option<Contact>>,
            _: &Configuration,
            _: &mut Context<'_>,
        ) -> Result<Option<Configuration>, CallError> {
            unreachable!()
        }
    }
    impl LocalPlanner for Idle {
        fn connect(
            &self,
            _: &Task<'_>,
            _: &Configuration,
            _: &Target<'_>,
            _: Option<&mut Path>,
            _: &mut Context<'_>,
        ) -> Result<Reached, CallError> {
            unreachable!()
        }
    }
    impl GraphStrategy for Idle {
        fn next(&self, _: &dyn GraphView, _: &mut Context<'_>) -> Result<Action, CallError> {
            unreachable!()
        }
    }

    fn pool(threads: usize) -> Option<rayon::ThreadPool> {
        (threads > 1).then(|| rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap())
    }

    fn session(pool: Option<&rayon::ThreadPool>) -> Session<'_> {
        let plugins =
            Drivers { sampler: &Idle, grasp: &Idle, transfer: &Idle, regrasp: &Idle, strategy: &Idle };
        Session { plugins, seed: 1, interrupt: &Uninterrupted, pool }
    }

    #[test]
    fn results_come_in_order_for_any_number_of_threads() {
        for threads in [1, 2, 3] {
            let pool = pool(threads);
            let session = session(pool.as_ref());
            let values: Vec<_> = session.ahead(10, |i| i * i).collect();
            assert_eq!(values, (0..10).map(|i| i * i).collect::<Vec<_>>());
        }
    }

    #[test]
    fn one_thread_computes_nothing_beyond_what_is_consumed() {
        let calls = AtomicUsize::new(0);
        let session = session(None);
        let taken = session.ahead(10, |_| calls.fetch_add(1, Ordering::Relaxed)).take(3).count();
        assert_eq!((taken, calls.load(Ordering::Relaxed)), (3, 3));
    }

    #[test]
    fn streams_depend_on_the_key_alone() {
        let word = |kind, a, b| session(None).random((kind, a, b)).word();
        assert_eq!(word(Call::Sample, 2, 3), word(Call::Sample, 2, 3));
        assert_ne!(word(Call::Sample, 2, 3), word(Call::Extend, 2, 3));
        assert_ne!(word(Call::Sample, 2, 3), word(Call::Sample, 2, 4));
    }
}
