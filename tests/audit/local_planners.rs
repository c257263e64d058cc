//! Mistakes of local planners, in the slots for transfers and regrasps.

use regrasp::api::{
    CallError, Configuration, Context, FingerIndex, LocalPlanner, Parts, Path, Reached, Reason, Slot, Target,
    Task,
};

struct Liar {
    lie: String,
    transfer: Box<dyn LocalPlanner>,
    regrasp: Box<dyn LocalPlanner>,
}

/// Spoils the states and the answer.
fn spoil(lie: &str, from: &Configuration, states: &mut Vec<Configuration>, reached: &mut Reached) {
    let (last, far) = (states.len() - 1, states.len() > 6);
    match lie {
        // The mistake that went through to a plan before: as if the target were reached.
        "half-is-whole" if reached.fraction > 0.3 => {
            (reached.stop, reached.fraction) = (None, reached.fraction.min(0.5))
        }
        "no-way-to-one" if reached.is_complete() => reached.fraction = 0.999,
        "long-steps" if far => *states = states.iter().step_by(5).chain([&reached.end]).cloned().collect(),
        "ends-beside" if reached.is_complete() && last > 0 => {
            reached.end.X_HO.translation.vector.x += 1e-9;
            reached.end.joints[FingerIndex(0)][0] += 1e-9;
            states[last] = reached.end.clone();
        }
        "forgets-the-start" if far => drop(states.remove(0)),
        "old-contacts" if far => (1..last).for_each(|i| states[i].contacts = from.contacts),
        "nudges-others" if far => states[2].joints[FingerIndex(3)][0] += 1e-6,
        _ => {}
    }
}

impl LocalPlanner for Liar {
    fn connect(
        &self,
        task: &Task<'_>,
        from: &Configuration,
        to: &Target<'_>,
        path: Option<&mut Path>,
        context: &mut Context<'_>,
    ) -> Result<Reached, CallError> {
        let honest = if matches!(to, Target::Transfer(_)) { &self.transfer } else { &self.regrasp };
        let mut own = Path::default();
        let mut reached = honest.connect(task, from, to, Some(&mut own), context)?;
        if self.lie == "silent" && !reached.is_complete() {
            reached.stop = Some(Reason::Surface);
        }
        if self.lie == "impure" && super::odd() {
            reached.fraction *= 0.5;
        }
        spoil(&self.lie, from, &mut own.states, &mut reached);
        if let Some(path) = path {
            *path = own;
        }
        Ok(reached)
    }
}

crate::liar!(
    LocalPlanner,
    "local-planner",
    &[Slot::TransferPlanner, Slot::RegraspPlanner],
    |lie, parts: &Parts<'_>| {
        let [transfer, regrasp] = [Slot::TransferPlanner, Slot::RegraspPlanner]
            .map(|slot| parts.plugins.local_planner(slot, None, "", parts));
        Ok(Liar { lie, transfer: transfer?, regrasp: regrasp? })
    }
);

#[test]
fn transfers_are_caught() {
    super::judge(
        Slot::TransferPlanner,
        &[
            ("half-is-whole", "reached"),
            ("no-way-to-one", "reached"),
            ("long-steps", "steps|closed-between"),
            ("ends-beside", "target|closed"),
            ("forgets-the-start", "ends"),
            ("old-contacts", "closed|no-slip"),
            ("silent", "reasons"),
            ("impure", "pure"),
        ],
    );
}

#[test]
fn regrasps_are_caught() {
    super::judge(
        Slot::RegraspPlanner,
        &[
            ("no-way-to-one", "reached"),
            ("long-steps", "steps"),
            ("ends-beside", "target|regrasp-others-rest"),
            ("forgets-the-start", "ends"),
            ("old-contacts", "regrasp-touches-at-ends"),
            ("nudges-others", "regrasp-others-rest"),
            ("impure", "pure|reached"),
        ],
    );
}
