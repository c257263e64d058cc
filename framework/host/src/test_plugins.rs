//! Small entries for the tests of this crate.

use crate::Choices;
use regrasp_api::{
    Build, BuildError, Built, Cone, Contact, ContactModel, Entry, FingerIndex, FingerJoints, FingerModel,
    Hand, Mesh, NoSettings, ObjectModel, Parts, Settings, Slot, StabilityTest, TipKinematics, Vec3,
    check_settings,
};
use serde::{Deserialize, Serialize};

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct AlwaysSettings {
    #[schemars(range(min = 3, max = 64))]
    pub edges: usize,
}

impl Default for AlwaysSettings {
    fn default() -> Self {
        Self { edges: 8 }
    }
}

impl Settings for AlwaysSettings {}

struct Point;
impl ContactModel for Point {
    fn cone(&self, _: FingerIndex, _: &Contact, mu: f64) -> Cone<'_> {
        Cone::Elliptic { mu, gamma: 0.0 }
    }

    fn fewest_contacts(&self) -> usize {
        3
    }
}

fn refuse<T: ?Sized>(_: &str, _: &Parts<'_>) -> Built<T> {
    Err(BuildError::Unsupported("for tests of the registry only".into()))
}

fn point(_: &str, _: &Parts<'_>) -> Built<dyn ContactModel> {
    Ok(Box::new(Point))
}

const fn plain(id: &'static str, slots: &'static [Slot], build: Build) -> Entry {
    let (schema, check) = (NoSettings::schema as fn() -> String, check_settings::<NoSettings>);
    Entry { id, slots, summary: "", references: &[], schema, check, build }
}

const fn always(id: &'static str) -> Entry {
    let (schema, check) = (AlwaysSettings::schema as fn() -> String, check_settings::<AlwaysSettings>);
    let build = Build::StabilityTest(refuse::<dyn StabilityTest>);
    Entry { id, slots: &[Slot::StabilityTest], summary: "", references: &[], schema, check, build }
}

pub static ALWAYS: Entry = always("stability-test/always");
pub static ALWAYS_AGAIN: Entry = always("stability-test/always");
pub static MISNAMED: Entry = always("sampler/always");
pub static POINT: Entry = plain("contact-model/point", &[Slot::ContactModel], Build::ContactModel(point));
pub static LINEAR: Entry = plain("local-planner/linear", &[Slot::GraspPlanner], Build::LocalPlanner(refuse));
static MOVES: Entry =
    plain("local-planner/moves", &[Slot::TransferPlanner, Slot::RegraspPlanner], Build::LocalPlanner(refuse));
static FLAT: Entry = plain("surface/flat", &[Slot::Surface], Build::Surface(refuse));
static SAMPLER: Entry = plain("sampler/none", &[Slot::Sampler], Build::Sampler(refuse));
static STRATEGY: Entry = plain("graph-strategy/none", &[Slot::GraphStrategy], Build::GraphStrategy(refuse));

/// One plugin at least for each slot, not in order.
pub fn entries() -> [&'static Entry; 7] {
    [&MOVES, &ALWAYS, &SAMPLER, &POINT, &LINEAR, &STRATEGY, &FLAT]
}

/// A choice that fits [`entries`].
pub fn all_choices() -> Choices {
    let ids = ["point", "always", "flat", "none", "linear", "moves", "moves", "none"];
    let mut choices = Choices::default();
    Slot::ALL.into_iter().zip(ids).for_each(|(slot, id)| choices.use_plugin(slot, id));
    choices
}

/// A hand that knows how many fingers it has, and nothing else.
pub struct Fingers(pub usize);
impl Hand for Fingers {
    fn finger_count(&self) -> usize {
        self.0
    }

    fn finger(&self, _: FingerIndex) -> &FingerModel {
        unreachable!("the tests build no plugin that looks at fingers")
    }

    fn fingertip_radius(&self) -> f64 {
        0.01
    }

    fn tip_center(&self, _: FingerIndex, _: &FingerJoints) -> Vec3 {
        Vec3::zeros()
    }

    fn tip_kinematics(&self, _: FingerIndex, _: &FingerJoints) -> TipKinematics {
        unreachable!("the tests build no plugin that moves fingers")
    }

    fn inverse(&self, _: FingerIndex, _: &Vec3, _: &FingerJoints) -> Option<FingerJoints> {
        None
    }
}

/// The least object.
pub fn tetrahedron() -> ObjectModel {
    let corners = [Vec3::zeros(), Vec3::x(), Vec3::y(), Vec3::z()];
    let facets = vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
    let mesh = Mesh::new(corners.to_vec(), facets).expect("a tetrahedron is closed");
    ObjectModel::new(mesh, None, 0.1, 0.8)
}
