//! What one run shares: the plugins, the keyed random streams, the threads.

use regrasp_api::{
    CallError, ClosedChainSampler, Context, GraphStrategy, Interrupt, LocalPlanner, Plugins, Random, Tally,
    Task, report_fault, take_fault, unless_fault,
};

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
    /// A relay to a leg's goal from a place on the way that the graph found.
    Tail = 16,
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
pub(crate) fn lent<T>(call: impl FnOnce() -> Result<T, CallError>) -> Result<T, CallError> {
    let lender = take_fault();
    let result = unless_fault(call());
    lender.into_iter().for_each(report_fault);
    result
}

#[cfg(test)]
mod tests {
    use super::*;
    use regrasp_api::{
        Action, CallError::Interrupted, Configuration, Contact, FingerSet, GraphView, Path, PerFinger, Pose,
        PoseRequest, Reached, Target, Uninterrupted,
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
    fn calls_after_one_that_found_something_are_interrupted() {
        let pool = pool(2);
        let session = session(pool.as_ref());
        let tally = Tally::default;
        let found = session.until_found(2, 2, |session, number| {
            if number == 0 {
                return Counted { result: Ok(Some(7)), tally: tally() };
            }
            while !session.interrupt.interrupted() {
                std::thread::yield_now();
            }
            Counted { result: Err(Interrupted), tally: tally() }
        });
        let found: Vec<_> = found.map(|found| found.result).collect();
        assert_eq!(found, [Ok(Some(7)), Err(Interrupted)]);
    }

    #[test]
    fn a_lent_thread_gets_back_what_was_left_on_it() {
        let fault = |plugin: &str| CallError::Panicked { plugin: plugin.into(), message: "oh".into() };
        report_fault(fault("own"));
        let there = lent(|| {
            report_fault(fault("other"));
            Ok(())
        });
        assert_eq!((there, take_fault()), (Err(fault("other")), Some(fault("own"))));
        report_fault(fault("own"));
        assert_eq!((lent(|| Ok(3)), take_fault()), (Ok(3), Some(fault("own"))));
    }

    #[test]
    fn streams_depend_on_the_key_alone() {
        let word = |kind, a, b| session(None).random((kind, a, b)).word();
        assert_eq!(word(Call::Sample, 2, 3), word(Call::Sample, 2, 3));
        assert_ne!(word(Call::Sample, 2, 3), word(Call::Extend, 2, 3));
        assert_ne!(word(Call::Sample, 2, 3), word(Call::Sample, 2, 4));
    }
}
