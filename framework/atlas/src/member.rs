//! One hand with one object.

use crate::AtlasHand;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

/// The shapes of objects. Their size is their length along their longest axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Shape {
    /// A ball: size is its diameter.
    Sphere,
    /// A cube: size is its edge.
    Cube,
    /// A cylinder as high as wide: size is both.
    Cylinder,
    /// An ellipsoid two thirds as thick as long.
    Ellipsoid,
    /// A bar half as wide and thick as long.
    Bar,
}

impl Shape {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::Sphere, Self::Cube, Self::Cylinder, Self::Ellipsoid, Self::Bar];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Sphere => "sphere",
            Self::Cube => "cube",
            Self::Cylinder => "cylinder",
            Self::Ellipsoid => "ellipsoid",
            Self::Bar => "bar",
        }
    }

    /// The shape of a size (m), as scenarios have it.
    fn description(self, size: f64) -> Value {
        match self {
            Self::Sphere => json!({ "kind": "sphere", "radius": size / 2.0 }),
            Self::Cube => json!({ "kind": "cuboid", "size": [size, size, size] }),
            Self::Cylinder => json!({ "kind": "cylinder", "radius": size / 2.0, "height": size }),
            Self::Ellipsoid => {
                json!({ "kind": "ellipsoid", "semi_axes": [size / 2.0, size / 3.0, size / 3.0] })
            }
            Self::Bar => json!({ "kind": "cuboid", "size": [size, size / 2.0, size / 2.0] }),
        }
    }
}

/// A hand with an object.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Member {
    /// The hand, as it is called in the atlas.
    pub hand: String,
    /// The object's shape.
    pub shape: Shape,
    /// Its size (m).
    pub size: f64,
    /// Its coefficient of friction.
    pub friction: f64,
    /// Its mass (kg) where its weight is to be held.
    pub mass: Option<f64>,
}

/// The mass (kg) of objects whose weight does not count.
const WEIGHTLESS: f64 = 0.1;

impl Member {
    /// What messages call it.
    pub fn title(&self) -> String {
        let mass = self.mass.map_or(String::new(), |mass| format!(", {} g", mass * 1e3));
        let size = self.size_mm();
        format!("{} with a {} of {size} mm, friction {}{mass}", self.hand, self.shape.name(), self.friction)
    }

    /// Its size (mm), to a hundredth.
    pub fn size_mm(&self) -> f64 {
        (self.size * 1e5).round() / 100.0
    }

    /// Its scenario as JSON text for searches of at most this many nodes; start and goal count for nothing.
    pub(crate) fn scenario(&self, hand: &AtlasHand, nodes: usize) -> String {
        let mut scenario = json!({
            "name": self.title(),
            "hand": hand.choice,
            "object": {
                "name": self.shape.name(),
                "mass": self.mass.unwrap_or(WEIGHTLESS),
                "friction": self.friction,
                "shape": self.shape.description(self.size),
            },
            "start": { "pose": {} },
            "goal": [{ "pose": { "position": [1.0, 0.0, 0.0] } }],
            "limits": { "budget": { "max_nodes": nodes } },
        });
        if self.mass.is_some() {
            scenario["hold"] = json!({});
        }
        if hand.is_soft() {
            scenario["plugins"]["contact-model"]["use"] = json!("contact-model/soft-finger");
        }
        if !hand.rolls() {
            scenario["plugins"]["local-planner"]["transfer"]["use"] = json!("local-planner/fixed-point");
        }
        scenario.to_string()
    }
}
