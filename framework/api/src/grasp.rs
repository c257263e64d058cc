//! Grasps as the stability tests see them: contacts with the cones of wrenches that they can transmit.

use crate::{FingerIndex, MAX_FINGERS, Vec3};

/// The wrenches that one contact can transmit, per unit of normal force.
///
/// Forces act *on the object*, along the inward normal; torques about the contact point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cone<'a> {
    /// |f_t|²/μ² + m²/γ² ≤ f_n²: Coulomb friction with coefficient `mu` ≥ 0 and, where the torsional radius `gamma` ≥ 0
    /// (m) is positive, a torque m about the normal. `gamma = 0` is a point contact with friction, `mu = gamma = 0` a
    /// frictionless point.
    Elliptic {
        /// Coefficient of friction, no unit.
        mu: f64,
        /// Torsional friction radius (m).
        gamma: f64,
    },
    /// The cone spanned by edges in the contact frame, each with unit normal component.
    Polyhedral(&'a [ConeEdge]),
}

impl Cone<'_> {
    /// Whether the contact can transmit a torque about its normal.
    pub fn carries_torsion(&self) -> bool {
        match self {
            Self::Elliptic { gamma, .. } => *gamma != 0.0,
            Self::Polyhedral(edges) => edges.iter().any(|edge| edge.torsion != 0.0),
        }
    }
}

/// One edge of a polyhedral cone at unit normal force.
///
/// The tangents are `t1 = any_orthogonal(n)` and `t2 = n × t1` with n the contact's *inward* normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConeEdge {
    /// Tangential force along t1 and t2, no unit.
    pub tangential: [f64; 2],
    /// Torque about the inward normal per unit normal force (m).
    pub torsion: f64,
}

/// One contact of a grasp, with its cone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GraspContact<'a> {
    /// The finger that touches.
    pub finger: FingerIndex,
    /// The contact point in the object's frame (m).
    pub p_OC: Vec3,
    /// The *outward* unit normal in the object's frame.
    pub n_O: Vec3,
    /// What it can transmit.
    pub cone: Cone<'a>,
}

/// A grasp: the contacts that hold the object, and the load on it.
#[derive(Clone, Copy, Debug)]
pub struct Grasp<'a> {
    contacts: [GraspContact<'a>; MAX_FINGERS],
    count: u8,
    /// Acceleration of gravity in the object's frame (m/s²); zero where gravity is not modelled.
    pub g_O: Vec3,
}

impl<'a> Grasp<'a> {
    /// A grasp without contacts under the gravity `g_O` (m/s², in the object's frame).
    pub fn new(g_O: Vec3) -> Self {
        let nothing = GraspContact {
            finger: FingerIndex(0),
            p_OC: Vec3::zeros(),
            n_O: Vec3::z(),
            cone: Cone::Elliptic { mu: 0.0, gamma: 0.0 },
        };
        Self { contacts: [nothing; MAX_FINGERS], count: 0, g_O }
    }

    /// Adds a contact; at most [`MAX_FINGERS`].
    pub fn push(&mut self, contact: GraspContact<'a>) {
        self.contacts[usize::from(self.count)] = contact;
        self.count += 1;
    }

    /// The contacts, in the order in which they were added.
    pub fn contacts(&self) -> &[GraspContact<'a>] {
        &self.contacts[..usize::from(self.count)]
    }

    /// The same grasp without the contact of `finger`.
    #[must_use]
    pub fn without(&self, finger: FingerIndex) -> Self {
        let mut rest = Self::new(self.g_O);
        self.contacts()
            .iter()
            .filter(|contact| contact.finger != finger)
            .for_each(|&contact| rest.push(contact));
        rest
    }
}

/// A small memory between calls along one path: it may change a call's cost, never its verdict.
///
/// The caller owns it, keeps one for each purpose and resets it with each path; what the numbers mean is the plugin's.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Hint {
    /// What the numbers are, as the plugin likes; 0 means "nothing known".
    pub tag: u64,
    /// The plugin's numbers, in the plugin's units.
    pub values: [f64; 8],
}
