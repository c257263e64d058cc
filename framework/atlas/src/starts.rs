//! Start grasps of a member.

use crate::{AtlasError, Wish};
use regrasp_api::{Configuration, Interrupt, Vec3};
use regrasp_grasps::{BulkGrasp, Counts, GraspSource, Progress, Search, Stopped, Wish as GraspWish, collect};
use regrasp_plan::StoppedBy;
use regrasp_run::{Setup, Stop};
use std::sync::atomic::{AtomicU64, Ordering};

/// Of so many grasps that are drawn one becomes a start: the one nearest to the middle.
const DRAWN: usize = 4;
/// The most poses that are drawn for the starts of a member.
const MOST_POSES: u64 = 200_000;
/// How far (m) two grasps are apart at least.
const SPREAD: f64 = 2e-3;

/// What was found.
pub(crate) struct Starts {
    /// The starts, in the order in which they were drawn.
    pub grasps: Vec<Configuration>,
    /// Grasps that were found, poses that were drawn, and why others were given up.
    pub found: u64,
    pub counts: Counts,
}

impl Starts {
    /// Draws grasps evenly over the poses that the fingers reach, one at a pose, all of them verified; keeps
    /// those that can be left, and of these the quarter nearest to the middle of all: about there a hand is
    /// used. `None` where it was stopped.
    pub fn draw(setup: &Setup<'_>, wish: &Wish, stop: &dyn Stop) -> Result<Option<Self>, AtlasError> {
        let holding = setup.task().contact_model.fewest_contacts() + 1;
        let of_grasps = GraspWish {
            count: DRAWN * wish.goals,
            seed: wish.seed,
            spread: SPREAD,
            per_pose: 1,
            fingers: Some((holding, holding)),
            ..GraspWish::default()
        };
        let source = GraspSource::new(setup, &of_grasps)?;
        let enough = Enough { stop, poses: AtomicU64::new(0) };
        let mut all: Vec<BulkGrasp> = Vec::new();
        let ending = collect(&mut Search::new(&source), 1, &enough, &enough, &mut all)?;
        if matches!(ending.stopped, Stopped::By(_)) && stop.interrupted() {
            return Ok(None);
        }
        let can_be_left = all.into_iter().filter(|grasp| !grasp.liftable.is_empty());
        let grasps = nearest_to_middle(can_be_left.map(|grasp| grasp.q).collect());
        Ok(Some(Self { grasps, found: ending.grasps, counts: ending.counts }))
    }

    /// Why there are none.
    pub fn cause(&self) -> String {
        let causes: Vec<String> =
            self.counts.causes().iter().take(3).map(|(reason, n)| format!("{} {n}", reason.name())).collect();
        let causes = if causes.is_empty() { "nothing".to_owned() } else { causes.join(", ") };
        let poses = self.counts.poses;
        match self.found {
            0 => format!("no grasp in {poses} poses; given up because of: {causes}"),
            found => format!("{found} grasps in {poses} poses, and no finger may be lifted in any of them"),
        }
    }
}

/// The quarter of the grasps, one at least, whose objects are nearest to the middle of all; in their order.
fn nearest_to_middle(grasps: Vec<Configuration>) -> Vec<Configuration> {
    let position = |q: &Configuration| q.X_HO.translation.vector;
    let middle = Vec3::from_fn(|axis, _| {
        let mut along: Vec<f64> = grasps.iter().map(|q| position(q)[axis]).collect();
        along.sort_by(f64::total_cmp);
        along.get(along.len() / 2).copied().unwrap_or_default()
    });
    let mut order: Vec<usize> = (0..grasps.len()).collect();
    let far = |&k: &usize| (position(&grasps[k]) - middle).norm();
    order.sort_by(|a, b| far(a).total_cmp(&far(b)));
    order.truncate(grasps.len().div_ceil(DRAWN));
    order.sort_unstable();
    order.into_iter().map(|k| grasps[k].clone()).collect()
}

/// Ends a search after so many poses: a count and no clock, so that it always ends in the same place.
struct Enough<'a> {
    stop: &'a dyn Stop,
    poses: AtomicU64,
}

impl Interrupt for Enough<'_> {
    fn interrupted(&self) -> bool {
        self.poses.load(Ordering::Relaxed) >= MOST_POSES || self.stop.interrupted()
    }
}

impl Stop for Enough<'_> {
    fn cause(&self) -> StoppedBy {
        self.stop.cause()
    }
}

impl Progress for Enough<'_> {
    fn found(&self, _: u64, poses: u64) {
        self.poses.store(poses, Ordering::Relaxed);
    }
}
