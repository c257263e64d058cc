//! What a roadmap is bound to.

use crate::Difference;
use crate::digest::digest;
use regrasp_api::Vec3;
use regrasp_run::Setup;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

/// Something with a name, and a digest of all that it is.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Named {
    /// What it is called.
    pub name: String,
    /// The digest, in hexadecimal digits.
    pub digest: String,
}

/// What a roadmap is bound to. Start and goals are not part of it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Identity {
    /// The hand.
    pub hand: Named,
    /// The object: shape, mass, friction.
    pub object: Named,
    /// Digest of obstacles, gravity, load, limits but the budgets, and plugins.
    pub settings: String,
    /// Digest of seed and workspace, which only growing asks for.
    pub sampling: String,
}

impl Identity {
    /// That of a problem, and of roadmaps grown for it with a seed.
    pub fn of(setup: &Setup<'_>, seed: u64) -> Self {
        let problem = &setup.scenario().problem;
        let mut limits = json!(problem.limits);
        // How long to search changes nothing of what is found.
        if let Some(limits) = limits.as_object_mut() {
            limits.remove("budget");
        }
        let settings = json!({
            "obstacle": problem.obstacle, "gravity": problem.gravity, "hold": problem.hold,
            "limits": limits, "plugins": setup.choices().iter().collect::<Vec<_>>(),
        });
        let (lower, upper) = problem.sampling_box(&problem.poses().unwrap_or_default());
        let corners = [lower, upper].map(|corner: Vec3| [corner.x, corner.y, corner.z]);
        Self {
            hand: named(&problem.hand.name, &json!(problem.hand)),
            object: named(&problem.object.name, &json!(problem.object)),
            settings: digits(&settings),
            sampling: digits(&json!([seed, corners])),
        }
    }

    /// The first thing in which the problem of `self` is not that of a roadmap.
    pub fn difference(&self, of: &Self) -> Option<Difference> {
        let names = |a: &Named, b: &Named| (b.name.clone(), a.name.clone());
        if self.hand.digest != of.hand.digest {
            let (of, here) = names(&self.hand, &of.hand);
            return Some(Difference::Hand(of, here));
        }
        if self.object.digest != of.object.digest {
            let (of, here) = names(&self.object, &of.object);
            return Some(Difference::Object(of, here));
        }
        (self.settings != of.settings).then_some(Difference::Settings)
    }

    /// The same, for a roadmap that is to grow on.
    pub fn difference_to_grow(&self, of: &Self) -> Option<Difference> {
        let sampling = (self.sampling != of.sampling).then_some(Difference::Sampling);
        self.difference(of).or(sampling)
    }
}

fn named(name: &str, value: &Value) -> Named {
    Named { name: name.to_owned(), digest: digits(value) }
}

fn digits(value: &Value) -> String {
    format!("{:016x}", digest(value.to_string().as_bytes()))
}
