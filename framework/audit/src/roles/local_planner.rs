//! Local planners under audit.

use crate::auditor::{Key, bits};
use crate::laws::{self, Chain, Ground, Motion};
use crate::{Audited, input};
use regrasp_api::{CallError, Configuration, Context, LocalPlanner, Path, Reached, Target, Task};
use serde_json::json;
use std::cell::RefCell;

/// What a call is known by: where it begins and where it is to go.
fn key(from: &Configuration, to: &Target<'_>) -> Key {
    let there = match to {
        Target::Grasp(q) => &q.X_HO.translation.vector,
        Target::Transfer(X_HO) => &X_HO.translation.vector,
        Target::Regrasp { contact, .. } => contact.map_or(&from.X_HO.translation.vector, |c| &c.p_OC),
    };
    Key::Long(bits(from.X_HO.translation.vector.iter().chain(there.iter())))
}

impl LocalPlanner for Audited<'_, dyn LocalPlanner + '_> {
    fn connect(
        &self,
        task: &Task<'_>,
        from: &Configuration,
        to: &Target<'_>,
        path: Option<&mut Path>,
        context: &mut Context<'_>,
    ) -> Result<Reached, CallError> {
        // The second call always stores its states, for the laws: whether a path is given changes no answer.
        let (given, stored) = (RefCell::new(path), RefCell::new(Path::default()));
        let first = std::cell::Cell::new(true);
        let connect = |planner: &dyn LocalPlanner, context: &mut Context<'_>| match first.replace(false) {
            true => planner.connect(task, from, to, given.borrow_mut().as_deref_mut(), context),
            false => planner.connect(task, from, to, Some(&mut stored.borrow_mut()), context),
        };
        self.call(
            ("connect", key(from, to)),
            context,
            connect,
            |context| {
                json!({
                    "from": input::configuration(from),
                    "to": input::target(to),
                    "random": input::random(context),
                })
            },
            |_, reached, context| {
                let path = stored.borrow();
                laws::reached_kept(reached)?;
                laws::fraction_kept(task, from, to, reached)?;
                laws::refusal_counted(self.slot, reached, &context.tally)?;
                let ground = Ground { mesh: &self.auditor.object.mesh, radius: self.auditor.radius };
                let chain = Chain { task, ground, closure: 0.5 * 1.05 * task.tolerances.closure };
                let motion = Motion { chain, from, to, reached, path: &path };
                laws::ends_kept(&motion)?;
                laws::target_kept(&motion)?;
                laws::states_kept(&motion, &mut context.twin())?;
                laws::lift_kept(&motion)?;
                let given = given.borrow();
                laws::ensure("pure", given.as_ref().is_none_or(|given| given.states == path.states), || {
                    "the same call again takes another way".into()
                })
            },
        )
    }
}
