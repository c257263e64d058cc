//! Role 2: whether a grasp is stable, by what margin, with which certificate.

use crate::{CallError, Context, FingerIndex, FingerSet, Grasp, Hint, Vec3};
use serde::{Deserialize, Serialize};

/// The verdict on one grasp.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stability {
    /// Stable.
    Stable,
    /// Not stable.
    Unstable,
    /// Too close to the boundary to say: treated as not stable.
    Undecided,
}

impl Stability {
    /// Whether the grasp counts as stable.
    pub fn is_stable(self) -> bool {
        self == Self::Stable
    }
}

/// What a test means by "stable". A plan records it, and the verifier holds the plan to it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Criterion {
    /// Force closure: the contacts resist every small wrench.
    #[default]
    Closure,
    /// Bounded contact forces hold the object's weight and this load. The verdict depends on the object's
    /// orientation.
    Equilibrium(Load),
    /// Forces within the joints' efforts, at a share of the friction, hold the object's weight and this load.
    Holding(HoldLoad),
}

/// The disturbances that a grasp must resist beside gravity, and the forces that it may use.
///
/// A force f at the object's centre of mass and a torque m with |f|/F + |m|/T ≤ 1. They count as resisted
/// where the twelve vertices of the regular icosahedron around each of the two balls are: (0, ±1, ±φ) and its
/// cyclic permutations, φ the golden ratio, along the object's axes, scaled so that the icosahedron's faces
/// touch the ball.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Load {
    /// F: the largest disturbing force (N).
    pub disturbance_force: f64,
    /// T: the largest disturbing torque (N·m).
    pub disturbance_torque: f64,
    /// The largest normal force of one contact (N).
    pub max_normal_force: f64,
}

/// What a grasp must hold, and by which means. The disturbances are the set that [`Load`] describes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HoldLoad {
    /// Whether the object's weight must be held.
    pub weight: bool,
    /// The share of the friction that forces rely on (no unit).
    pub friction_factor: f64,
    /// The largest disturbing force at the centre of mass (N); 0 for none.
    pub disturbance_force: f64,
    /// The largest disturbing torque (N·m); 0 for none.
    pub disturbance_torque: f64,
    /// The share of their torsional friction with which contacts drag while they spin (no unit), each one
    /// way or the other: forces must hold the object whichever way each drags. 0 where contacts spin freely.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub drag: f64,
    /// The largest normal force of one contact (N); absent where the joints' efforts alone bound it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub max_normal_force: Option<f64>,
}

fn is_zero(x: &f64) -> bool {
    *x == 0.0
}

/// Something that anybody can check by arithmetic and that proves a verdict.
#[derive(Clone, Debug, PartialEq)]
pub enum Certificate {
    /// Contact forces on the object in its frame (N per unit, one for each contact) with torques about the
    /// *inward* normal (N·m): balanced, strictly inside every cone. For [`Criterion::Equilibrium`] in N,
    /// balanced together with the object's weight.
    InternalForce {
        /// Force at each contact, in O.
        forces_O: Vec<Vec3>,
        /// Torsional torque about the inward normal at each contact.
        torsions: Vec<f64>,
    },
    /// A twist (velocity of the object's points at the contacts' centroid, angular velocity), against which
    /// no contact resists: the grasp is not closed.
    SeparatingTwist {
        /// Linear velocity, in O, of the point of O at the contacts' centroid.
        v_O: Vec3,
        /// Angular velocity, in O.
        w_O: Vec3,
    },
    /// None: the verdict is the test's word.
    None,
}

/// A verdict with its margin and certificate.
#[derive(Clone, Debug, PartialEq)]
pub struct Assessment {
    /// The verdict; the same as [`StabilityTest::test`] gives.
    pub stability: Stability,
    /// A certified lower bound of the margin, in the unit that the plugin documents; 0 or less when not
    /// stable.
    pub margin_lower: f64,
    /// An upper bound of the margin.
    pub margin_upper: f64,
    /// The proof of the verdict.
    pub certificate: Certificate,
}

/// Decides whether a grasp can hold the object.
///
/// Laws: invariant under a rigid motion of the object's frame (with its centre of mass and load, where those
/// count) and under permutation of the contacts; verdicts are monotone in the friction and in added contacts.
/// Pure: equal arguments give the same verdict whatever the hint holds.
pub trait StabilityTest: Send + Sync {
    /// Whether the grasp is stable. The planner's inner loop: no allocation.
    ///
    /// Engine guarantee: finite inputs, unit normals, at least one contact. `hint` may be left from an
    /// earlier call with a grasp nearby. A cone that the test cannot handle is [`CallError::Unsupported`].
    fn test(
        &self,
        grasp: &Grasp<'_>,
        hint: &mut Hint,
        context: &mut Context<'_>,
    ) -> Result<Stability, CallError>;

    /// The verdict with margin and certificate, for grasps that are reported.
    ///
    /// `length` (m) scales torques where margins of different grasps are compared; `None` takes the grasp's
    /// own size. `center_O` (m) is the point that torques are taken about; `None` takes the contacts'
    /// centroid.
    fn assess(
        &self,
        grasp: &Grasp<'_>,
        length: Option<f64>,
        center_O: Option<Vec3>,
        context: &mut Context<'_>,
    ) -> Result<Assessment, CallError>;

    /// The fingers of the grasp that may be lifted, the rest being stable.
    ///
    /// Stops early where fewer than `enough` fingers can still be found, and then returns what it has.
    fn liftable(
        &self,
        grasp: &Grasp<'_>,
        enough: usize,
        context: &mut Context<'_>,
    ) -> Result<FingerSet, CallError> {
        let mut liftable = FingerSet::EMPTY;
        let contacts = grasp.contacts();
        for (tried, finger) in contacts.iter().map(|contact| contact.finger).enumerate() {
            if liftable.len() + contacts.len() - tried < enough {
                break;
            }
            if self.stable_without(grasp, finger, context)? {
                liftable = liftable.with(finger);
            }
        }
        Ok(liftable)
    }

    /// What "stable" means for this test; force closure, or more than that, unless it says otherwise.
    fn criterion(&self) -> Criterion {
        Criterion::Closure
    }

    /// Whether grasps must say what the joints behind their contacts can do ([`Grasp::efforts`]); no unless
    /// it says so.
    fn uses_efforts(&self) -> bool {
        false
    }

    /// Whether the grasp is stable without `finger`.
    fn stable_without(
        &self,
        grasp: &Grasp<'_>,
        finger: FingerIndex,
        context: &mut Context<'_>,
    ) -> Result<bool, CallError> {
        let rest = grasp.without(finger);
        Ok(!rest.contacts().is_empty() && self.test(&rest, &mut Hint::default(), context)?.is_stable())
    }
}
const _: Option<&dyn StabilityTest> = None; // must stay object safe
