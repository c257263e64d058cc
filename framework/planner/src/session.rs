//! What one run shares: the plugins, the keyed random streams, the threads that compute ahead.

use rayon::prelude::*;
use regrasp_api::{
    CallError, ClosedChainSampler, Context, GraphStrategy, Interrupt, LocalPlanner, Pose, Random, Tally,
    Task, unless_fault,
};
use std::collections::VecDeque;

/// The plugins that drive the search; contact model, stability test and surface are in the [`Task`].
#[derive(Clone, Copy)]
pub struct Drivers<'a> {
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
}

/// A run's shared, immutable side.
pub(crate) struct Session<'a> {
    pub drivers: Drivers<'a>,
    pub seed: u64,
    pub interrupt: &'a dyn Interrupt,
    pub pool: Option<rayon::ThreadPool>,
}

/// The result of a call with what it counted; the counts are charged when the result is consumed.
pub(crate) struct Counted<T> {
    pub result: T,
    pub tally: Tally,
}

impl<'a> Session<'a> {
    /// The context of the call with the key `(kind, a, b)`: its random stream depends on nothing else but the seed.
    pub fn context(&self, kind: Call, a: u64, b: u64) -> Context<'a> {
        Context::new(Random::from_key(self.seed, kind as u64, a, b), self.interrupt)
    }

    /// Runs `call` in the context of its key, and returns its result with what it counted.
    ///
    /// A plugin that panicked where it could not return an error makes the result worthless: then it is that panic.
    pub fn counted<T>(
        &self,
        kind: Call,
        a: u64,
        b: u64,
        call: impl FnOnce(&mut Context<'_>) -> Result<T, CallError>,
    ) -> Counted<Result<T, CallError>> {
        let mut context = self.context(kind, a, b);
        let result = unless_fault(call(&mut context));
        Counted { result, tally: context.tally }
    }

    /// The results of `call(0), call(1), …` in order, computed ahead by the threads there are.
    ///
    /// The caller may stop anywhere: with one thread nothing beyond that was computed, with several it is thrown away.
    pub fn ahead<'s, T: Send + 's>(
        &'s self,
        count: usize,
        call: impl Fn(usize) -> T + Sync + 's,
    ) -> impl Iterator<Item = T> + 's {
        let mut ready = VecDeque::new();
        let mut next = 0;
        std::iter::from_fn(move || {
            if ready.is_empty() && next < count {
                let end = count.min(next + self.threads());
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

    /// How many threads compute.
    pub fn threads(&self) -> usize {
        self.pool.as_ref().map_or(1, rayon::ThreadPool::current_num_threads)
    }

    fn compute<T: Send>(&self, range: std::ops::Range<usize>, call: &(impl Fn(usize) -> T + Sync)) -> Vec<T> {
        match &self.pool {
            Some(pool) if range.len() > 1 => pool.install(|| range.into_par_iter().map(call).collect()),
            _ => range.map(call).collect(),
        }
    }
}

/// The task of one leg: the search's landmarks are its start and its goal.
pub(crate) fn leg_task<'a>(task: &Task<'a>, landmarks: &'a [Pose]) -> Task<'a> {
    Task { landmarks, ..*task }
}

#[cfg(test)]
mod tests {
    use super::*;
    use regrasp_api::{
        Action, Configuration, Contact, FingerSet, GraphView, Path, PerFinger, PoseRequest, Reached, Target,
        Uninterrupted,
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

    fn session(threads: usize) -> Session<'static> {
        let drivers =
            Drivers { sampler: &Idle, grasp: &Idle, transfer: &Idle, regrasp: &Idle, strategy: &Idle };
        let pool =
            (threads > 1).then(|| rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap());
        Session { drivers, seed: 1, interrupt: &Uninterrupted, pool }
    }

    #[test]
    fn results_come_in_order_for_any_number_of_threads() {
        for threads in [1, 2, 3] {
            let session = session(threads);
            let values: Vec<_> = session.ahead(10, |i| i * i).collect();
            assert_eq!(values, (0..10).map(|i| i * i).collect::<Vec<_>>());
        }
    }

    #[test]
    fn one_thread_computes_nothing_beyond_what_is_consumed() {
        let calls = AtomicUsize::new(0);
        let session = session(1);
        let taken = session.ahead(10, |_| calls.fetch_add(1, Ordering::Relaxed)).take(3).count();
        assert_eq!((taken, calls.load(Ordering::Relaxed)), (3, 3));
    }

    #[test]
    fn streams_depend_on_the_key_alone() {
        let word = |threads, kind, a, b| session(threads).context(kind, a, b).random.word();
        assert_eq!(word(1, Call::Sample, 2, 3), word(2, Call::Sample, 2, 3));
        assert_ne!(word(1, Call::Sample, 2, 3), word(1, Call::Extend, 2, 3));
    }
}
