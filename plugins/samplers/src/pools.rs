//! Grasps at one given pose: admissible contacts of each finger are found once and combined many times.
//!
//! Where the pose is given, whether a finger may touch at a contact does not depend on the draw before; and
//! what that costs (distances to a mesh, retreats) is a hundred times what the stability of a combination
//! costs. So each finger gets a pool of contacts that are admissible for it alone, the pools grow by turns,
//! and random combinations are tried, the cheap test first.

use regrasp_api::{
    CallError, Configuration, Contact, Context, FingerIndex, FingerJoints, FingerSet, Reason, Task,
};

/// Combinations that are tried each time the pools have grown.
const COMBINATIONS: usize = 24;

/// Contacts, with joints that reach them, that one finger may have.
type Pool = Vec<(Contact, FingerJoints)>;

/// The pools of all fingers, at one pose.
pub(crate) struct Pools {
    holding: FingerSet,
    pools: Vec<Pool>,
}

impl Pools {
    /// Empty pools of the fingers in `holding`, of a hand of `fingers`.
    pub fn new(holding: FingerSet, fingers: usize) -> Self {
        Self { holding, pools: vec![Pool::new(); fingers] }
    }

    /// Adds a contact to a finger's pool.
    pub fn add(&mut self, finger: FingerIndex, contact: Contact, joints: FingerJoints) {
        self.pools[finger.index()].push((contact, joints));
    }

    /// A combination that is admissible as a whole, if one of some random ones is; otherwise why the last was
    /// not. Of a finger whose pool is empty nothing is known but that.
    pub fn combine(
        &self,
        task: &Task<'_>,
        resting: &Configuration,
        context: &mut Context<'_>,
    ) -> Result<Result<Configuration, Reason>, CallError> {
        if self.holding.iter().any(|finger| self.pools[finger.index()].is_empty()) {
            return Ok(Err(Reason::Reach));
        }
        let mut last = Reason::Stability;
        for _ in 0..COMBINATIONS {
            let q = self.draw(resting, context);
            last = match task.admissible.admit_grasp(task, &q, context)? {
                Some(reason) => reason,
                None => match task.admissible.admit(task, &q, context)? {
                    Some(reason) => reason,
                    None => return Ok(Ok(q)),
                },
            };
        }
        Ok(Err(last))
    }

    fn draw(&self, resting: &Configuration, context: &mut Context<'_>) -> Configuration {
        let mut q = resting.clone();
        for finger in self.holding.iter() {
            let pool = &self.pools[finger.index()];
            let (contact, joints) = pool[context.random.index(pool.len())];
            (q.contacts[finger], q.joints[finger]) = (Some(contact), joints);
        }
        q
    }
}
