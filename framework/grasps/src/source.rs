//! Where grasps come from: one hand, one object, their plugins, and what is asked for.

use crate::hold::Holding;
use crate::pose::PoseLaw;
use crate::{GraspsError, Layout, Wish};
use regrasp_api::{LocalPlanner, Task};
use regrasp_plan::Plan;
use regrasp_planner::Stable;
use regrasp_run::Setup;
use regrasp_verify::GraspVerifier;

/// Grasps of one problem, drawn chunk by chunk.
pub struct GraspSource<'a> {
    pub(crate) task: Task<'a>,
    pub(crate) wish: Wish,
    pub(crate) law: PoseLaw,
    /// How few and how many fingers hold.
    pub(crate) sizes: (usize, usize),
    pub(crate) holding: Holding,
    pub(crate) verifier: GraspVerifier,
    pub(crate) regrasp: Option<&'a dyn LocalPlanner>,
    plan: Plan,
}

impl<'a> GraspSource<'a> {
    /// Prepares a problem; start and goals do not count ([`Setup::without_ends`]).
    pub fn new(setup: &'a Setup<'_>, wish: &Wish) -> Result<Self, GraspsError> {
        wish.validate()?;
        let task = Task { admissible: &Stable, landmarks: &[], ..setup.task() };
        let sizes = sizes(&task, wish)?;
        let problem = &setup.scenario().problem;
        let law = PoseLaw::new(&task, problem, sizes.0);
        let plan = setup.grasp_file(wish.seed)?;
        let verifier = GraspVerifier::new(&plan).map_err(GraspsError::Verifier)?;
        let regrasp = wish.graph.then(|| setup.plugins().plugins().regrasp);
        Ok(Self { task, wish: *wish, law, sizes, holding: Holding::new(&plan), verifier, regrasp, plan })
    }

    /// What is asked for.
    pub fn wish(&self) -> &Wish {
        &self.wish
    }

    /// The problem with what is claimed of its grasps, as a plan file without motion.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// The form of its grasps.
    pub fn layout(&self) -> Layout {
        Layout::of(self.task.hand)
    }
}

fn sizes(task: &Task<'_>, wish: &Wish) -> Result<(usize, usize), GraspsError> {
    let (fewest, fingers) = (task.contact_model.fewest_contacts(), task.hand.finger_count());
    let (least, most) = wish.fingers.unwrap_or((fewest, fingers));
    if fewest <= least && least <= most && most <= fingers {
        return Ok((least, most));
    }
    Err(GraspsError::Fingers { least, most, fewest, fingers })
}
