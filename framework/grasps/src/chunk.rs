//! One chunk of work: a pure function of its number.

use crate::combine::Combiner;
use crate::counts::Counts;
use crate::graph::{self, Edge};
use crate::grasp::BulkGrasp;
use crate::hold::Candidate;
use crate::pools::Pools;
use crate::spread::Twins;
use crate::{GraspSource, GraspsError};
use regrasp_api::{Context, FingerSet, Interrupt, Random, Reason, take_fault};
use regrasp_verify::GraspJudge;

/// Poses that are drawn for one chunk.
const POSES: u64 = 256;
/// Combinations that are tried at one pose for each grasp that may be kept there.
const TRIES: usize = 8;
/// The kind of the random streams.
const STREAM: u64 = 0x6772_6173_7073;

/// What one chunk gives.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Chunk {
    pub grasps: Vec<BulkGrasp>,
    /// Regrasps between them, by their places.
    pub edges: Vec<Edge>,
    pub counts: Counts,
}

impl GraspSource<'_> {
    /// The chunk with this number.
    pub(crate) fn chunk(&self, number: u64, interrupt: &dyn Interrupt) -> Result<Chunk, GraspsError> {
        let mut chunk = Chunk::default();
        let mut judge = self.verifier.judge();
        for pose in number * POSES..(number + 1) * POSES {
            let random = Random::from_key(self.wish.seed, STREAM, pose, 0);
            let mut context = Context::new(random, interrupt);
            context.proceed()?;
            chunk.counts.poses += 1;
            let found = self.at_pose(pose, &mut chunk, &mut judge, &mut context);
            if let Some(fault) = take_fault() {
                return Err(fault.into());
            }
            if let Some(reason) = found? {
                chunk.counts.reject(reason);
            }
        }
        Ok(chunk)
    }

    /// The grasps at one pose; why there are none.
    fn at_pose(
        &self,
        number: u64,
        chunk: &mut Chunk,
        judge: &mut GraspJudge<'_>,
        context: &mut Context<'_>,
    ) -> Result<Option<Reason>, GraspsError> {
        let X_HO = self.law.draw(&mut context.random);
        let near = self.law.may_reach(&self.task, &X_HO);
        if near.len() < self.sizes.0 {
            return Ok(Some(Reason::Reach));
        }
        if self.task.clearance.object_free(&X_HO).is_err() {
            return Ok(Some(Reason::Collision));
        }
        let pools = match Pools::find(&self.task, X_HO, near, self.sizes.0, context)? {
            Ok(pools) => pools,
            Err(reason) => return Ok(Some(reason)),
        };
        chunk.counts.reached += 1;
        let first = chunk.grasps.len();
        self.combine(number, &pools, chunk, judge, context)?;
        if let Some(planner) = self.regrasp {
            let found = graph::edges(&self.task, planner, &chunk.grasps[first..], context)?;
            let offset = first as u64;
            chunk.edges.extend(found.iter().map(|e| Edge { from: e.from + offset, to: e.to + offset, ..*e }));
        }
        Ok(None)
    }

    /// Combines contacts until enough grasps are found at the pose, or enough was tried.
    fn combine(
        &self,
        number: u64,
        pools: &Pools,
        chunk: &mut Chunk,
        judge: &mut GraspJudge<'_>,
        context: &mut Context<'_>,
    ) -> Result<(), GraspsError> {
        let mut combiner = Combiner::new(&self.task, pools, self.sizes);
        if !combiner.is_hopeful() {
            chunk.counts.reject(Reason::Collision);
            return Ok(());
        }
        let mut twins = Twins::new(self.wish.spread, self.law.radius());
        let (mut kept, mut last) = (0, None);
        for _ in 0..TRIES * self.wish.per_pose {
            if kept == self.wish.per_pose {
                break;
            }
            let choice = match last.filter(|_| self.regrasp.is_some()) {
                Some(last) => combiner.vary(&last, &mut context.random),
                None => combiner.draw(&mut context.random),
            };
            // What was drawn before was refused, or would be a twin of itself.
            if !combiner.is_new(&choice) {
                continue;
            }
            chunk.counts.tried += 1;
            let q = match combiner.configuration(&choice) {
                Ok(q) => q,
                Err(reason) => {
                    chunk.counts.reject(reason);
                    continue;
                }
            };
            if let Some(reason) = combiner.refusal(&q, context)? {
                chunk.counts.reject(reason);
                continue;
            }
            let candidate = Candidate { q, pose: number, liftable: FingerSet::EMPTY, held: None };
            let Some(grasp) = self.finish(candidate, &twins, chunk, judge, context)? else { continue };
            twins.add(&grasp);
            chunk.grasps.push(grasp);
            (kept, last) = (kept + 1, Some(choice));
        }
        Ok(())
    }

    /// What else is to be known of a stable grasp; `None` where it is a twin, or the verifier refuses it.
    fn finish(
        &self,
        mut candidate: Candidate,
        twins: &Twins,
        chunk: &mut Chunk,
        judge: &mut GraspJudge<'_>,
        context: &mut Context<'_>,
    ) -> Result<Option<BulkGrasp>, GraspsError> {
        if twins.has_twin(&candidate.q) {
            chunk.counts.twins += 1;
            return Ok(None);
        }
        let holding = candidate.q.holding();
        if holding.len() > self.task.contact_model.fewest_contacts() {
            let grasp = self.task.grasp(&candidate.q, holding);
            candidate.liftable = self.task.stability.liftable(&grasp, 0, context)?;
        }
        candidate.held = self.holding.forces(&self.task, &candidate.q)?;
        match candidate.judged(&self.task, judge) {
            Ok(grasp) => Ok(Some(grasp)),
            Err(_) => {
                chunk.counts.refused += 1;
                Ok(None)
            }
        }
    }
}
