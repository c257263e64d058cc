//! A grasp with the cones of its contacts, as recorded forces are looked at: torques about the normals, which
//! are not recorded, count as nothing.

use super::force::{Contact, Force};
use super::held::{Held, Row};
use super::slice::Slice;
use regrasp_api::{Cone, Vec3};
use regrasp_plan::{ConeClaim, ConeRecord, ContactClaim};
use std::sync::Arc;

/// The cones that a plan claims.
pub(super) enum Cones {
    /// One for all contacts.
    Shared(ConeClaim),
    /// Those that contacts name by number, and the friction of the object.
    Own(Vec<Own>, f64),
}

/// One of the cones that contacts name.
pub(super) enum Own {
    Round(ConeClaim),
    Edged { slice: Arc<Slice>, twists: bool },
}

/// A grasp, and the polygon of each contact whose cone has edges.
///
/// The scaled coordinates of such a contact are newtons.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Grip {
    pub(super) held: Held,
    slices: Vec<Option<Arc<Slice>>>,
}

impl Cones {
    /// `None` where some cone has no meaning, or no friction in some direction of an ellipse.
    pub(super) fn new(claim: &ContactClaim, friction: f64) -> Option<Self> {
        let sound = |cone: &ConeClaim| cone.least() > 0.0 && cone.most().is_finite();
        if let Some(cone) = claim.cone {
            return Some(Self::Shared(cone)).filter(|_| sound(&cone));
        }
        let own = |record: &ConeRecord| match record {
            ConeRecord::Elliptic(cone) => sound(cone).then_some(Own::Round(*cone)),
            ConeRecord::Polyhedral(_) => {
                let cone = record.cone();
                let slice = Arc::new(Slice::of(&cone)?);
                Some(Own::Edged { slice, twists: cone.carries_torsion() })
            }
        };
        let cones: Option<Vec<Own>> = claim.cones.iter().map(own).collect();
        Some(Self::Own(cones.filter(|cones| !cones.is_empty())?, friction))
    }

    /// Adds a contact at `r` with the inward normal `n`, torsional radii over a length, with the joints
    /// behind it; whether its cone is known.
    pub(super) fn add(
        &self,
        number: Option<usize>,
        (r, n, length): (Vec3, Vec3, f64),
        rows: Vec<Row>,
        grip: &mut Grip,
    ) -> bool {
        let (cone, slice) = match self {
            Self::Shared(cone) => (cone.cone().without_torsion(), None),
            Self::Own(cones, _) => match number.and_then(|number| cones.get(number)) {
                Some(Own::Round(cone)) => (cone.cone().without_torsion(), None),
                Some(Own::Edged { slice, .. }) => {
                    (Cone::Elliptic { mu: 1.0, gamma: 0.0 }, Some(slice.clone()))
                }
                None => return false,
            },
        };
        grip.held.contacts.extend(Contact::new(r, n, &cone, length));
        grip.held.rows.push(rows);
        grip.slices.push(slice);
        true
    }

    /// Whether some contact carries torques about its normal.
    pub(super) fn have_torsion(&self) -> bool {
        match self {
            Self::Shared(cone) => cone.gamma != 0.0,
            Self::Own(cones, _) => cones.iter().any(|cone| match cone {
                Own::Round(cone) => cone.gamma != 0.0,
                Own::Edged { twists, .. } => *twists,
            }),
        }
    }

    /// The friction of which forces take a share.
    pub(super) fn most(&self) -> f64 {
        match self {
            Self::Shared(cone) => cone.most(),
            Self::Own(_, friction) => *friction,
        }
    }
}

impl Grip {
    /// The share of the friction that a contact's force needs.
    pub(super) fn friction_of(&self, i: usize, force: &Force) -> f64 {
        match &self.slices[i] {
            Some(slice) => slice.share(&self.held.contacts[i], force),
            None if force.normal > 0.0 => force.tangential.norm() / force.normal,
            None => f64::INFINITY,
        }
    }

    /// The polygon of a contact whose cone has edges.
    pub(super) fn slice(&self, i: usize) -> Option<&Slice> {
        self.slices[i].as_deref()
    }
}
