//! Chunks computed on threads, taken in their order, what is too like earlier grasps left out.

use crate::chunk::Chunk;
use crate::counts::Counts;
use crate::graph::Edge;
use crate::grasp::BulkGrasp;
use crate::quota::Quota;
use crate::spread::Twins;
use crate::{GraspSource, GraspsError};
use regrasp_api::{CallError, Interrupt};
use regrasp_plan::StoppedBy;
use regrasp_run::Stop;
use std::thread;

/// So many chunks in turn without one new grasp, and there are no more: some fifty thousand poses.
const BARREN: u64 = 200;

/// What is kept of one chunk.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Kept {
    /// The chunk's number.
    pub chunk: u64,
    /// The grasps.
    pub grasps: Vec<BulkGrasp>,
    /// Regrasps between them, by the numbers that they have among all.
    pub edges: Vec<Edge>,
    /// What happened in the chunk.
    pub counts: Counts,
}

/// Takes what is found, chunk by chunk.
pub trait Sink {
    /// Takes what is kept of the next chunk.
    fn take(&mut self, kept: &Kept) -> Result<(), GraspsError>;
}

impl Sink for Vec<BulkGrasp> {
    fn take(&mut self, kept: &Kept) -> Result<(), GraspsError> {
        self.extend(kept.grasps.iter().cloned());
        Ok(())
    }
}

/// Told how far the search is.
pub trait Progress {
    /// So many grasps after so many poses.
    fn found(&self, grasps: u64, poses: u64);
}

/// Why a search ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stopped {
    /// As many grasps as were asked for.
    Enough,
    /// Nothing new for a long time.
    Exhausted,
    /// From outside.
    By(StoppedBy),
}

/// What a search has come to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Ending {
    /// Grasps that were kept.
    pub grasps: u64,
    /// Regrasps between them.
    pub edges: u64,
    /// What happened.
    pub counts: Counts,
    /// Why it ended.
    pub stopped: Stopped,
}

/// A search as far as it is.
pub struct Search<'s> {
    source: &'s GraspSource<'s>,
    twins: Twins,
    quota: Quota,
    next: u64,
    grasps: u64,
    edges: u64,
    counts: Counts,
    /// Chunks since the last that gave a grasp.
    barren: u64,
}

impl<'s> Search<'s> {
    /// Begins anew.
    pub fn new(source: &'s GraspSource<'s>) -> Self {
        let wish = source.wish();
        let twins = Twins::new(wish.spread, source.task.object.mesh.radius());
        let quota = Quota::new(wish.per_facets);
        let counts = Counts::default();
        Self { source, twins, quota, next: 0, grasps: 0, edges: 0, counts, barren: 0 }
    }

    /// Takes in what an earlier run kept of the next chunk.
    pub fn resume(&mut self, kept: &Kept) {
        for grasp in &kept.grasps {
            self.twins.add(grasp);
            self.quota.add(grasp);
        }
        self.count(kept);
    }

    /// Grasps so far.
    pub fn grasps(&self) -> u64 {
        self.grasps
    }

    fn is_full(&self) -> bool {
        self.grasps >= self.source.wish().count as u64
    }

    /// Leaves out of the next chunk what is too like earlier grasps, too much of a kind, or too much at all.
    fn keep(&mut self, chunk: Chunk) -> Kept {
        let mut kept = Kept { chunk: self.next, counts: chunk.counts, ..Kept::default() };
        let mut numbers = vec![None; chunk.grasps.len()];
        for (grasp, number) in chunk.grasps.into_iter().zip(&mut numbers) {
            let next = self.grasps + kept.grasps.len() as u64;
            if next >= self.source.wish().count as u64 {
                break;
            }
            if self.twins.has_twin(&grasp.q) {
                kept.counts.twins += 1;
            } else if !self.quota.has_room(&grasp) {
                kept.counts.surplus += 1;
            } else {
                self.twins.add(&grasp);
                self.quota.add(&grasp);
                kept.grasps.push(grasp);
                *number = Some(next);
            }
        }
        let among_all = |edge: &Edge| {
            let (from, to) = (numbers[edge.from as usize]?, numbers[edge.to as usize]?);
            Some(Edge { from, to, ..*edge })
        };
        kept.edges = chunk.edges.iter().filter_map(among_all).collect();
        self.count(&kept);
        kept
    }

    fn count(&mut self, kept: &Kept) {
        self.grasps += kept.grasps.len() as u64;
        self.edges += kept.edges.len() as u64;
        self.counts.add(&kept.counts);
        self.barren = if kept.grasps.is_empty() { self.barren + 1 } else { 0 };
        self.next = kept.chunk + 1;
    }

    fn ending(&self, stopped: Stopped) -> Ending {
        let counts = self.counts.clone();
        Ending { grasps: self.grasps, edges: self.edges, counts, stopped }
    }
}

/// Searches on, on `threads` threads, until there are enough grasps or no more, or it is stopped.
///
/// What was taken by the sink is the same for any number of threads; a stop from outside leaves a beginning
/// of it, whole chunks.
pub fn collect(
    search: &mut Search<'_>,
    threads: usize,
    stop: &dyn Stop,
    progress: &dyn Progress,
    sink: &mut dyn Sink,
) -> Result<Ending, GraspsError> {
    let mut ready = Vec::new().into_iter();
    loop {
        if search.is_full() {
            return Ok(search.ending(Stopped::Enough));
        }
        if search.barren >= BARREN {
            return Ok(search.ending(Stopped::Exhausted));
        }
        let Some(chunk) = ready.next() else {
            ready = batch(search.source, search.next, threads, stop).into_iter();
            continue;
        };
        let chunk = match chunk {
            Ok(chunk) => chunk,
            Err(GraspsError::Call(CallError::Interrupted)) => {
                return Ok(search.ending(Stopped::By(stop.cause())));
            }
            Err(error) => return Err(error),
        };
        let kept = search.keep(chunk);
        sink.take(&kept)?;
        progress.found(search.grasps, search.counts.poses);
    }
}

/// The chunks from `first` on, one for each thread.
fn batch(
    source: &GraspSource<'_>,
    first: u64,
    threads: usize,
    interrupt: &dyn Stop,
) -> Vec<Result<Chunk, GraspsError>> {
    let interrupt: &dyn Interrupt = interrupt;
    if threads <= 1 {
        return vec![source.chunk(first, interrupt)];
    }
    thread::scope(|scope| {
        let spawn = |number: u64| scope.spawn(move || source.chunk(number, interrupt));
        let running: Vec<_> = (first..first + threads as u64).map(spawn).collect();
        let result = |one: thread::ScopedJoinHandle<'_, _>| {
            one.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
        };
        running.into_iter().map(result).collect()
    })
}
