//! The form of a scenario file.

use regrasp_api::{
    GoalDescription, HoldDescription, Limits, ObjectDescription, ObstacleDescription, Slot, StartDescription,
    Workspace,
};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

/// What a scenario without an object is told.
const OBJECT: &str = "[object]\nfriction = 0.8\nshape = { kind = \"sphere\", radius = 0.03 }";
/// What a scenario without a goal is told.
const GOAL: &str =
    "[[goal]]\npose = { position = [0.0, 0.0, 0.085], axis = [0.0, 0.0, 1.0], angle_deg = 90.0 }";

/// A scenario file: a planning problem, where it comes from, and the plugins to solve it with. SI units;
/// angles in degrees where a key ends with `_deg`.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ScenarioFile {
    /// What the scenario is called; the file's name where absent.
    #[serde(default)]
    pub name: Option<String>,
    /// What it shows, in one line.
    #[serde(default)]
    pub summary: String,
    /// Where the problem comes from: authors, title, venue, year, and where this file departs from it.
    #[serde(default)]
    pub source: String,
    /// What was published about the problem.
    #[serde(default)]
    pub paper: Option<PaperFigures>,
    /// The hand.
    #[schemars(extend("x-example" = "[hand]\nbuiltin = \"four-finger\""))]
    pub hand: HandChoice,
    /// The object that the hand holds.
    #[schemars(extend("x-example" = OBJECT))]
    pub object: ObjectDescription,
    /// Obstacles fixed to the hand's frame.
    #[serde(default)]
    pub obstacle: Vec<ObstacleDescription>,
    /// Acceleration of gravity in the hand's frame (m/s²).
    #[serde(default = "default_gravity")]
    #[schemars(inner(range(min = -1e3, max = 1e3)), extend("x-unit" = "m/s²"))]
    pub gravity: [f64; 3],
    /// Where the object starts.
    #[schemars(extend("x-example" = "[start]\npose = { position = [0.0, 0.0, 0.085] }"))]
    pub start: StartDescription,
    /// The goals, visited in turn.
    #[schemars(extend("x-example" = GOAL))]
    pub goal: Vec<GoalDescription>,
    /// Where the object may be sampled; by default a box about start and goals, 15 mm wider on each side.
    #[serde(default)]
    pub workspace: Option<Workspace>,
    /// What grasps must hold in the world: weight, disturbances, at a share of the friction, within the
    /// joints' efforts. With it the stability test is `holding` unless the file chooses another.
    #[serde(default)]
    pub hold: Option<HoldDescription>,
    /// Tolerances, resolution and budgets.
    #[serde(default)]
    pub limits: Limits,
    /// The plugins that fill the slots; the defaults fill the others.
    #[serde(default)]
    pub plugins: PluginTables,
}

fn default_gravity() -> [f64; 3] {
    [0.0, 0.0, -9.81]
}

/// Figures that were published for a problem.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PaperFigures {
    /// What the publication calls the problem.
    pub example: String,
    /// Average time to solve it (s).
    #[schemars(extend("x-unit" = "s"))]
    pub time_s: f64,
    /// Average number of nodes that were generated.
    pub generated_nodes: usize,
    /// Average number of nodes in the graph.
    pub graph_nodes: usize,
}

/// The hand: exactly one of `builtin`, `file`, `urdf` and `mjcf`; the other keys say how a URDF or MJCF is
/// read.
#[derive(Clone, Debug, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HandChoice {
    /// The name of a built-in hand, such as `four-finger`.
    #[serde(default)]
    pub builtin: Option<String>,
    /// A hand file, relative to the scenario file.
    #[serde(default)]
    #[schemars(example = &"my-hand.toml")]
    pub file: Option<String>,
    /// A URDF file, relative to the scenario file; `regrasp hand FILE.urdf` shows how it is understood.
    #[serde(default)]
    #[schemars(example = &"my-hand.urdf")]
    pub urdf: Option<String>,
    /// An MJCF file, relative to the scenario file; `regrasp hand FILE.xml` shows how it is understood.
    #[serde(default)]
    #[schemars(example = &"my-hand.xml")]
    pub mjcf: Option<String>,
    /// The fingertip links (bodies of an MJCF), one a finger, in the order in which the fingers are counted;
    /// guessed and printed where absent.
    #[serde(default)]
    #[schemars(extend("examples" = [["thumb_tip", "index_tip", "middle_tip", "ring_tip"]]))]
    pub tips: Vec<String>,
    /// Radius of the balls that stand for the fingertips (m); where absent, that of the tip links' own
    /// balls, or fitted to their shapes.
    #[serde(default)]
    #[schemars(range(min = 1e-4, max = 0.2), extend("x-unit" = "m"))]
    #[schemars(example = 0.012)]
    pub fingertip_radius: Option<f64>,
    /// Centres of these balls in the frames of the tip links (m): one for all, or one for each finger; where
    /// absent, they are fitted to the tip links' shapes.
    #[serde(default)]
    #[schemars(extend("examples" = [[[0.0, 0.0, 0.01]]]))]
    #[schemars(extend("x-unit" = "m"))]
    pub tip_offset: Vec<[f64; 3]>,
    /// The link whose frame is the hand's; where absent, the last one that all fingertips hang on.
    #[serde(default)]
    #[schemars(example = &"palm_link")]
    pub palm: Option<String>,
    /// The posture of an MJCF (a key frame) in which joints stand that no finger has, and from which the
    /// fingers' resting posture is sought.
    #[serde(default)]
    #[schemars(example = &"home")]
    pub keyframe: Option<String>,
    /// Folders that hold the packages of `package://` paths, relative to the scenario file.
    #[serde(default)]
    #[schemars(extend("examples" = [["../ros/src"]]))]
    pub packages: Vec<String>,
    /// The most convex pieces (1 to 64) that each mesh is taken apart into; 1, its convex hull, where absent.
    #[serde(default)]
    #[schemars(range(min = 1, max = 64))]
    #[schemars(example = 4)]
    pub mesh_pieces: Option<usize>,
    /// What all lengths of the file are multiplied with (no unit): 0.001 for a file in millimetres.
    #[serde(default)]
    #[schemars(range(min = 1e-6, max = 1e6), extend("x-unit" = "1"))]
    #[schemars(example = 0.001)]
    pub scale: Option<f64>,
    /// What the coordinates of all its meshes are multiplied with (no unit).
    #[serde(default)]
    #[schemars(range(min = 1e-6, max = 1e6), extend("x-unit" = "1"))]
    #[schemars(example = 0.001)]
    pub mesh_scale: Option<f64>,
    /// Largest acceleration of every joint (rad/s²); where absent, what the URDF says, or else 20.
    #[serde(default)]
    #[schemars(range(min = 1e-3, max = 1e9), extend("x-unit" = "rad/s²"))]
    #[schemars(example = 20.0)]
    pub acceleration: Option<f64>,
    /// Largest velocity (rad/s) of joints for which the URDF says none, or 0.
    #[serde(default)]
    #[schemars(range(min = 1e-3, max = 1e9), extend("x-unit" = "rad/s"))]
    #[schemars(example = 3.0)]
    pub velocity: Option<f64>,
    /// Largest effort (N·m) of joints for which the URDF says none, or 0.
    #[serde(default)]
    #[schemars(range(min = 1e-6, max = 1e9), extend("x-unit" = "N·m"))]
    #[schemars(example = 1.0)]
    pub effort: Option<f64>,
    /// Range (rad) of joints for which the file says none, or one of no width: lowest and highest position.
    #[serde(default)]
    #[schemars(inner(range(min = -12.57, max = 12.57)), extend("x-unit" = "rad"))]
    #[schemars(extend("examples" = [[-0.3, 1.6]]))]
    pub limits: Option<[f64; 2]>,
    /// What holds for joints by name, whatever the file says.
    #[serde(default)]
    pub joint: Vec<JointTable>,
}

/// What holds for the joints of some names.
#[derive(Clone, Debug, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct JointTable {
    /// A joint's name; `*` stands for any letters.
    #[schemars(example = &"thumb_*")]
    pub name: String,
    /// Lowest position (rad; m where prismatic), together with `upper`.
    #[serde(default)]
    #[schemars(range(min = -12.57, max = 12.57), extend("x-unit" = "rad"))]
    #[schemars(example = -0.3)]
    pub lower: Option<f64>,
    /// Highest position (rad; m where prismatic), together with `lower`.
    #[serde(default)]
    #[schemars(range(min = -12.57, max = 12.57), extend("x-unit" = "rad"))]
    #[schemars(example = 1.6)]
    pub upper: Option<f64>,
    /// Largest velocity (rad/s; m/s where prismatic).
    #[serde(default)]
    #[schemars(range(min = 1e-3, max = 1e9), extend("x-unit" = "rad/s"))]
    #[schemars(example = 3.0)]
    pub velocity: Option<f64>,
    /// Largest effort (N·m; N where prismatic).
    #[serde(default)]
    #[schemars(range(min = 1e-6, max = 1e9), extend("x-unit" = "N·m"))]
    #[schemars(example = 0.7)]
    pub effort: Option<f64>,
    /// Largest acceleration (rad/s²; m/s² where prismatic).
    #[serde(default)]
    #[schemars(range(min = 1e-3, max = 1e9), extend("x-unit" = "rad/s²"))]
    #[schemars(example = 20.0)]
    pub acceleration: Option<f64>,
    /// Where the joint stands (rad; m where prismatic) if no finger has it.
    #[serde(default)]
    #[schemars(range(min = -12.57, max = 12.57), extend("x-unit" = "rad"))]
    #[schemars(example = 0.0)]
    pub position: Option<f64>,
}

/// One table for each slot.
#[derive(Clone, Debug, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default, rename_all = "kebab-case")]
pub struct PluginTables {
    /// Plugins and settings that belong together, under one name: `default` or `paper`. The tables below
    /// change it.
    #[schemars(example = &"paper")]
    pub preset: Option<String>,
    /// Slot `contact-model`.
    pub contact_model: PluginTable,
    /// Slot `stability-test`.
    pub stability_test: PluginTable,
    /// Slot `surface`.
    pub surface: PluginTable,
    /// Slot `sampler`.
    pub sampler: PluginTable,
    /// The three slots of local planners.
    pub local_planner: LocalPlannerTables,
    /// Slot `graph-strategy`.
    pub graph_strategy: PluginTable,
}

/// One table for each slot of local planners.
#[derive(Clone, Debug, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct LocalPlannerTables {
    /// Slot `local-planner.grasp`.
    pub grasp: PluginTable,
    /// Slot `local-planner.transfer`.
    pub transfer: PluginTable,
    /// Slot `local-planner.regrasp`.
    pub regrasp: PluginTable,
}

/// A plugin and, as further keys, its settings (`regrasp plugins ID` shows them).
#[derive(Clone, Debug, Default, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct PluginTable {
    /// The plugin's id; its role can be omitted. Where absent, the settings are for the default plugin.
    #[serde(rename = "use")]
    pub id: Option<String>,
    /// The settings.
    #[serde(flatten)]
    pub settings: Map<String, Value>,
}

impl PluginTables {
    /// The table of one slot.
    pub fn table(&self, slot: Slot) -> &PluginTable {
        match slot {
            Slot::ContactModel => &self.contact_model,
            Slot::StabilityTest => &self.stability_test,
            Slot::Surface => &self.surface,
            Slot::Sampler => &self.sampler,
            Slot::GraspPlanner => &self.local_planner.grasp,
            Slot::TransferPlanner => &self.local_planner.transfer,
            Slot::RegraspPlanner => &self.local_planner.regrasp,
            Slot::GraphStrategy => &self.graph_strategy,
        }
    }
}

/// The JSON schema of scenario files, as text for a person or an editor to read.
pub fn schema() -> String {
    let schema = schemars::schema_for!(ScenarioFile).to_value();
    serde_json::to_string_pretty(&schema).expect("a JSON value is JSON")
}

/// The JSON schema of hand files.
pub fn hand_schema() -> String {
    let schema = schemars::schema_for!(regrasp_api::HandDescription).to_value();
    serde_json::to_string_pretty(&schema).expect("a JSON value is JSON")
}
