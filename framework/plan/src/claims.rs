//! What a plan claims of its contacts and grasps: the verifier holds it to that.

use regrasp_api::{Cone, ConeEdge, Fingertip, Grain, ObjectModel};
pub use regrasp_api::{Criterion, Load};
use serde::{Deserialize, Serialize};

/// What the plan claims.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Claims {
    /// Which wrenches each contact transmits.
    pub contact: ContactClaim,
    /// What makes a grasp stable: closure, or equilibrium with the object's weight (mass and gravity are the
    /// scenario's) and a load.
    pub criterion: Criterion,
    /// How contacts move in a transfer.
    pub transfer_law: TransferLaw,
    /// How closure margins are measured.
    pub margin: MarginFrame,
}

/// Which wrenches every contact of the plan is claimed to transmit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ContactClaim {
    /// Id of the contact model, such as `contact-model/pcwf`.
    pub model: String,
    /// The cone that all contacts share; absent where they do not, or it is not elliptic.
    pub cone: Option<ConeClaim>,
    /// The cones of a plan whose contacts do not share one elliptic cone: each state names the one of each
    /// contact by its number here. Without them too, stability is not independently checked.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub cones: Vec<ConeRecord>,
}

/// A cone as recorded data: the wrenches that a contact transmits per unit of normal force.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ConeRecord {
    /// |f_t|²/μ² + m²/γ² ≤ f_n², or the same with a grain.
    Elliptic(ConeClaim),
    /// The cone that these edges span.
    Polyhedral(Vec<EdgeRecord>),
}

/// One edge of a polyhedral cone at unit normal force, with the tangents t1 = any_orthogonal(n) and t2 = n ×
/// t1 of the inward normal n.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct EdgeRecord {
    /// Tangential force along t1 and t2, no unit.
    pub tangential: [f64; 2],
    /// Torque about the inward normal per unit of normal force (m).
    pub torsion: f64,
}

impl ConeRecord {
    /// The record of a cone.
    pub fn of(cone: &Cone<'_>) -> Self {
        let edge = |edge: &ConeEdge| EdgeRecord { tangential: edge.tangential, torsion: edge.torsion };
        match cone {
            Cone::Polyhedral(edges) => Self::Polyhedral(edges.iter().map(edge).collect()),
            Cone::Elliptic { mu, gamma } => Self::Elliptic(ConeClaim::round(*mu, *gamma)),
            Cone::Grained(grain) => Self::Elliptic(ConeClaim::of_grain(grain)),
        }
    }

    /// The cone that is recorded.
    pub fn cone(&self) -> Cone<'static> {
        let edge = |edge: &EdgeRecord| ConeEdge { tangential: edge.tangential, torsion: edge.torsion };
        match self {
            Self::Elliptic(cone) => cone.cone(),
            Self::Polyhedral(edges) => Cone::Polyhedral(edges.iter().map(edge).collect()),
        }
    }
}

/// An elliptic cone: |f_t|²/μ² + m²/γ² ≤ f_n²; with a grain f_a²/μ_a² + f_b²/μ_b² + m²/γ² ≤ f_n², f_a along
/// it and f_b across.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ConeClaim {
    /// Coefficient of friction that the plan relies on, no unit; at most the object's. With a grain the one
    /// along it.
    pub mu: f64,
    /// Torsional friction radius (m); counted as 0 in transfers, in which contacts may spin.
    pub gamma: f64,
    /// The grain of contacts whose friction differs along and across it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub grain: Option<GrainClaim>,
}

/// A grain, as recorded.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GrainClaim {
    /// Coefficient of friction across the grain, no unit; at most the object's.
    pub mu_across: f64,
    /// Where it runs: a vector in the object's frame of any length, of which the part in a contact's tangent
    /// plane counts. Where it stands on a contact the smaller coefficient counts all round.
    pub axis_O: [f64; 3],
}

impl ConeClaim {
    /// The same friction all round.
    pub fn round(mu: f64, gamma: f64) -> Self {
        Self { mu, gamma, grain: None }
    }

    fn of_grain(grain: &Grain) -> Self {
        let [mu, mu_across] = grain.mu;
        let axis_O = grain.axis_O.into();
        Self { mu, gamma: grain.gamma, grain: Some(GrainClaim { mu_across, axis_O }) }
    }

    /// The claim for contacts with this cone; `None` where it is not elliptic.
    pub fn from_cone(cone: &Cone<'_>) -> Option<Self> {
        match cone {
            Cone::Elliptic { mu, gamma } => Some(Self::round(*mu, *gamma)),
            Cone::Grained(grain) => Some(Self::of_grain(grain)),
            Cone::Polyhedral(_) => None,
        }
    }

    /// The cone that is claimed.
    pub fn cone(&self) -> Cone<'static> {
        match self.grain() {
            Some(grain) => Cone::Grained(Box::new(grain)),
            None => Cone::Elliptic { mu: self.mu, gamma: self.gamma },
        }
    }

    /// Its grain, if it has one.
    pub fn grain(&self) -> Option<Grain> {
        let GrainClaim { mu_across, axis_O } = self.grain?;
        Some(Grain { mu: [self.mu, mu_across], gamma: self.gamma, axis_O: axis_O.into() })
    }

    /// The smallest coefficient of friction.
    pub fn least(&self) -> f64 {
        self.grain.map_or(self.mu, |grain| self.mu.min(grain.mu_across))
    }

    /// The largest coefficient of friction.
    pub fn most(&self) -> f64 {
        self.grain.map_or(self.mu, |grain| self.mu.max(grain.mu_across))
    }

    /// The same cone at a share of its friction and torsion.
    #[must_use]
    pub fn scaled(&self, part: f64) -> Self {
        let grain = self.grain.map(|grain| GrainClaim { mu_across: grain.mu_across * part, ..grain });
        Self { mu: self.mu * part, gamma: self.gamma * part, grain }
    }

    /// Whether all its numbers mean something.
    pub fn is_sound(&self) -> bool {
        let across = self.grain.map_or(0.0, |grain| grain.mu_across);
        let axis = self.grain.map_or(1.0, |grain| regrasp_api::Vec3::from(grain.axis_O).norm());
        let numbers = [self.mu, self.gamma, across].into_iter();
        numbers.into_iter().all(|x| x >= 0.0 && x.is_finite()) && axis > 0.0 && axis.is_finite()
    }
}

/// How contacts move in a transfer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum TransferLaw {
    /// The fingertips roll on the object, without slip and free to spin.
    #[default]
    Rolling,
    /// The contacts stay where they are on the object, and the fingertips' centres with them: for hands that
    /// declare point fingertips, which turn freely about their contacts.
    FixedPoint,
}

impl TransferLaw {
    /// The law of a hand's fingertips: balls roll, points stay.
    pub fn of_fingertips(fingertip: Fingertip) -> Self {
        match fingertip {
            Fingertip::Ball => Self::Rolling,
            Fingertip::Point => Self::FixedPoint,
        }
    }
}

/// Where torques are taken about and what they are divided by, so that margins of different grasps compare.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MarginFrame {
    /// The point that torques are taken about, in the object's frame (m).
    pub center_O: [f64; 3],
    /// What torques are divided by (m).
    pub length: f64,
}

impl MarginFrame {
    /// The frame that plans use: the object's centre of mass, and the largest distance of its surface from
    /// there.
    pub fn of_object(object: &ObjectModel) -> Self {
        let distance = |v: &regrasp_api::Vec3| (v - object.p_OCm).norm();
        let length = object.mesh.vertices().iter().map(distance).fold(0.0, f64::max);
        Self { center_O: object.p_OCm.into(), length }
    }
}
