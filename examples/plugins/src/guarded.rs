//! A transfer planner that wraps the default: a roll that ends with a joint close to its limit is refused, as
//! the next one would stop there.

use regrasp_api::{
    Build, CallError, Configuration, Context, Entry, LocalPlanner, Path, Reached, Settings, Slot, Target,
    Task, check_settings, inventory,
};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Settings of [`Guarded`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct GuardedSettings {
    /// How far every joint must stay from its limits at the end (rad; m where prismatic).
    #[schemars(range(min = 0.0, max = 0.2), extend("x-unit" = "rad"))]
    pub reserve: f64,
}

impl Default for GuardedSettings {
    fn default() -> Self {
        Self { reserve: 1e-3 }
    }
}

impl Settings for GuardedSettings {}

/// Another planner's transfers, but for those that end at a limit.
struct Guarded {
    inner: Box<dyn LocalPlanner>,
    reserve: f64,
}

/// The least distance of a joint from its limits.
fn reserve(task: &Task<'_>, q: &Configuration) -> f64 {
    let of_finger = |(finger, joints): (_, &regrasp_api::FingerJoints)| {
        let models = &task.hand.finger(finger).joints;
        let gap = |(x, model): (&f64, &regrasp_api::JointModel)| (x - model.lower).min(model.upper - x);
        joints.iter().zip(models).map(gap).fold(f64::INFINITY, f64::min)
    };
    let holds = |(finger, _): &(regrasp_api::FingerIndex, _)| q.contacts[*finger].is_some();
    q.joints.iter().filter(holds).map(of_finger).fold(f64::INFINITY, f64::min)
}

impl LocalPlanner for Guarded {
    fn connect(
        &self,
        task: &Task<'_>,
        from: &Configuration,
        to: &Target<'_>,
        mut path: Option<&mut Path>,
        context: &mut Context<'_>,
    ) -> Result<Reached, CallError> {
        // The wrapped planner counts the call, and its own refusals.
        let reached = self.inner.connect(task, from, to, path.as_deref_mut(), context)?;
        if !reached.is_complete() {
            return Ok(reached);
        }
        let left = reserve(task, &reached.end);
        context.note(Slot::TransferPlanner, "joint_reserve", left);
        if left >= self.reserve {
            return Ok(reached);
        }
        if let Some(path) = path {
            path.restart(from);
        }
        let stop = Some(context.reject_for(Slot::TransferPlanner, "near-a-limit"));
        Ok(Reached { end: from.clone(), fraction: 0.0, stop })
    }
}

/// How the plugin presents itself.
pub const ENTRY: Entry = Entry {
    id: "local-planner/guarded",
    slots: &[Slot::TransferPlanner],
    summary: "the default transfers, but for those that end with a joint close to its limit",
    references: &[
        "Liegeois, Automatic supervisory control of the configuration of multibody mechanisms, SMC 1977",
    ],
    schema: GuardedSettings::schema,
    check: check_settings::<GuardedSettings>,
    build: Build::LocalPlanner(|json, parts| {
        let settings = GuardedSettings::from_json(json)?;
        let inner = parts.plugins.local_planner(Slot::TransferPlanner, None, "", parts)?;
        Ok(Box::new(Guarded { inner, reserve: settings.reserve }))
    }),
};
inventory::submit! { ENTRY }
