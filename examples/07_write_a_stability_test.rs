//! Writes a stability test of one's own, puts it through the laws of its role, and plans with it.
//!
//! `cargo run --example 07_write_a_stability_test`
//!
//! Friction is rarely known well. This test relies on a share of it only: a grasp is stable if it is force
//! closure with that much less friction. `regrasp new-plugin stability-test doubtful` would give it a crate
//! of its own, to be loaded at run time.

use regrasp::api::{
    Assessment, Build, CallError, Certificate, Cone, Context, Entry, Grasp, Hint, Settings, Slot, Stability,
    StabilityTest, Vec3, check_settings,
};
use regrasp::plugins::stability_tests::{ForceClosure, ForceClosureSettings};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::error::Error;

/// The settings: what a scenario may say about the plugin. They check themselves.
#[derive(Clone, Copy, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
struct DoubtfulSettings {
    /// The share of the friction that is relied on, no unit.
    #[schemars(range(min = 0.1, max = 1.0), extend("x-unit" = "1"))]
    share: f64,
}

impl Default for DoubtfulSettings {
    fn default() -> Self {
        Self { share: 0.8 }
    }
}

impl Settings for DoubtfulSettings {}

/// Force closure with a share of the friction.
struct Doubtful {
    exact: ForceClosure,
    share: f64,
}

impl Doubtful {
    /// The same grasp with narrower cones; polyhedral ones are left as they are.
    fn doubted<'a>(&self, grasp: &Grasp<'a>) -> Grasp<'a> {
        let mut doubted = Grasp::new(grasp.g_O);
        for contact in grasp.contacts() {
            let mut contact = contact.clone();
            if let Cone::Elliptic { mu, gamma } = &mut contact.cone {
                (*mu, *gamma) = (*mu * self.share, *gamma * self.share);
            }
            doubted.push(contact);
        }
        doubted
    }
}

impl StabilityTest for Doubtful {
    fn test(
        &self,
        grasp: &Grasp<'_>,
        hint: &mut Hint,
        context: &mut Context<'_>,
    ) -> Result<Stability, CallError> {
        // A plugin counts its calls with `context.count_call`; the exact test has done so for us.
        let verdict = self.exact.test(&self.doubted(grasp), hint, context)?;
        Ok(if verdict.is_stable() { verdict } else { Stability::Undecided })
    }

    fn assess(
        &self,
        grasp: &Grasp<'_>,
        length: Option<f64>,
        center_O: Option<Vec3>,
        context: &mut Context<'_>,
    ) -> Result<Assessment, CallError> {
        let exact = self.exact.assess(&self.doubted(grasp), length, center_O, context)?;
        // Forces in narrow cones lie in wide ones, too: a yes, its proof and its margin hold. A no proves
        // nothing against wide cones.
        let assessed = Assessment { margin_upper: f64::INFINITY, ..exact };
        if assessed.stability.is_stable() {
            return Ok(assessed);
        }
        let (stability, certificate) = (Stability::Undecided, Certificate::None);
        Ok(Assessment { stability, margin_lower: 0.0, certificate, ..assessed })
    }
}

/// How the plugin presents itself; `submit!` adds it to the registry of this program.
const ENTRY: Entry = Entry {
    id: "stability-test/doubtful",
    slots: &[Slot::StabilityTest],
    summary: "force closure that relies on a share of the friction",
    references: &["Nguyen, Constructing force-closure grasps, IJRR 1988"],
    schema: DoubtfulSettings::schema,
    check: check_settings::<DoubtfulSettings>,
    build: Build::StabilityTest(|json, _parts| {
        let DoubtfulSettings { share } = DoubtfulSettings::from_json(json)?; // checked
        Ok(Box::new(Doubtful { exact: ForceClosure::new(ForceClosureSettings::default())?, share }))
    }),
};
regrasp::api::inventory::submit! { ENTRY }

fn main() -> Result<(), Box<dyn Error>> {
    // The kit looks for every law of the role that a plugin can break, and says where.
    regrasp_conformance::check(&ENTRY).assert_passes();
    println!("`{}` keeps the laws of its role", ENTRY.id);

    println!("\nshare of the friction  nodes  smallest margin along the plan, with all of it");
    for share in [1.0, 0.8, 0.6] {
        let mut scenario = regrasp::load("cubic")?;
        scenario.choices.use_plugin(Slot::StabilityTest, "doubtful");
        scenario.choices.set(Slot::StabilityTest, "share", share.into());
        let run = regrasp::solve(&scenario, 0)?;
        assert!(run.is_verified());
        let certificate = run.verdict.and_then(|verdict| verdict.certificate);
        let margin = certificate.and_then(|it| it.closure_margin).ok_or("the plan has grasps")?;
        println!("{share:>21} {:>6}  {:.4}", run.outcome.statistics.graph_nodes, margin.value);
    }
    Ok(())
}
