//! Grasps at one given pose: admissible contacts of each finger are found once and combined many times.
//!
//! Where the pose is given, whether a finger may touch at a contact does not depend on the draw before; and
//! what that costs (distances to a mesh, retreats) is a hundred times what the stability of a combination
//! costs. So each finger gets a pool of contacts that are admissible for it alone, the pools grow by turns,
//! and random combinations are tried, the cheap test first.

use regrasp_api::{
    CallError, Configuration, Contact, Context, FingerIndex, FingerJoints, FingerSet, MAX_FINGERS, Reason,
    Task,
};
use std::collections::HashMap;

/// Combinations that are tried each time the pools have grown.
const COMBINATIONS: usize = 24;

/// Contacts, with joints that reach them, that one finger may have.
type Pool = Vec<(Contact, FingerJoints)>;

/// Which contact of its pool each finger takes.
type Drawn = [usize; MAX_FINGERS];

/// The pools of all fingers, at one pose.
pub(crate) struct Pools {
    holding: FingerSet,
    pools: Vec<Pool>,
    /// Why what was tried is not admissible: small pools give the same combinations again and again.
    refused: HashMap<Drawn, Reason>,
}

impl Pools {
    /// Empty pools of the fingers in `holding`, of a hand of `fingers`.
    pub fn new(holding: FingerSet, fingers: usize) -> Self {
        Self { holding, pools: vec![Pool::new(); fingers], refused: HashMap::new() }
    }

    /// Adds a contact to a finger's pool.
    pub fn add(&mut self, finger: FingerIndex, contact: Contact, joints: FingerJoints) {
        self.pools[finger.index()].push((contact, joints));
    }

    /// A combination that is admissible as a whole, if one of some random ones is; otherwise why the last was
    /// not. Of a finger whose pool is empty nothing is known but that.
    pub fn combine(
        &mut self,
        task: &Task<'_>,
        resting: &Configuration,
        context: &mut Context<'_>,
    ) -> Result<Result<Configuration, Reason>, CallError> {
        if self.holding.iter().any(|finger| self.pools[finger.index()].is_empty()) {
            return Ok(Err(Reason::Reach));
        }
        let mut last = Reason::Stability;
        for _ in 0..COMBINATIONS {
            let drawn = self.draw(context);
            last = match self.refused.get(&drawn) {
                Some(&reason) => reason,
                None => match self.admit(task, resting, &drawn, context)? {
                    Ok(q) => return Ok(Ok(q)),
                    Err(reason) => {
                        self.refused.insert(drawn, reason);
                        reason
                    }
                },
            };
        }
        Ok(Err(last))
    }

    fn draw(&self, context: &mut Context<'_>) -> Drawn {
        let mut drawn = [0; MAX_FINGERS];
        for finger in self.holding.iter() {
            drawn[finger.index()] = context.random.index(self.pools[finger.index()].len());
        }
        drawn
    }

    fn admit(
        &self,
        task: &Task<'_>,
        resting: &Configuration,
        drawn: &Drawn,
        context: &mut Context<'_>,
    ) -> Result<Result<Configuration, Reason>, CallError> {
        let mut q = resting.clone();
        for finger in self.holding.iter() {
            let (contact, joints) = self.pools[finger.index()][drawn[finger.index()]];
            (q.contacts[finger], q.joints[finger]) = (Some(contact), joints);
        }
        let refused = match task.admissible.admit_grasp(task, &q, context)? {
            None => task.admissible.admit(task, &q, context)?,
            refused => refused,
        };
        Ok(refused.map_or(Ok(q), Err))
    }
}
