//! Role 1: which wrenches a contact can transmit.

use crate::{Cone, Contact, FingerIndex};

/// Says which wrenches a contact between fingertip and object can transmit: a cone as data.
///
/// It may depend on the finger, on the contact (where on the object it lies, which way its normal points)
/// and, as the model is built for one hand and object, on those. Laws: a cone is never wider than Coulomb's,
/// `|f_t| ≤ μ f_n`; it holds the force along the normal; it depends on nothing but the arguments.
pub trait ContactModel: Send + Sync {
    /// The cone of one finger's contact under the friction coefficient `mu` ≥ 0 (no unit).
    ///
    /// Monotone: a larger `mu` gives a cone that contains the smaller one's.
    fn cone(&self, finger: FingerIndex, contact: &Contact, mu: f64) -> Cone<'_>;

    /// The cone of the same contact while it may spin about its normal, as in every transfer: a contact that
    /// spins transmits no torsion.
    ///
    /// Contained in [`ContactModel::cone`]. Provided: what is left of that cone without torsion
    /// ([`Cone::without_torsion`]).
    fn spinning_cone(&self, finger: FingerIndex, contact: &Contact, mu: f64) -> Cone<'_> {
        let cone = self.cone(finger, contact, mu);
        if cone.carries_torsion() { cone.without_torsion() } else { cone }
    }

    /// The fewest contacts that can be stable under this model: 3 for point contacts with friction.
    ///
    /// The planner searches in GS_n with n one more than this.
    fn fewest_contacts(&self) -> usize;
}
const _: Option<&dyn ContactModel> = None; // must stay object safe

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{ConeEdge, Vec3};

    struct Model(Vec<ConeEdge>);

    impl ContactModel for Model {
        fn cone(&self, _: FingerIndex, _: &Contact, mu: f64) -> Cone<'_> {
            let edges = self.0.as_slice();
            if edges.is_empty() {
                Cone::Elliptic { mu, gamma: 0.003 }
            } else {
                Cone::Polyhedral(edges.into())
            }
        }
        fn fewest_contacts(&self) -> usize {
            2
        }
    }

    #[test]
    fn a_contact_that_spins_transmits_no_torsion() {
        let contact = Contact { facet: 0, p_OC: Vec3::zeros(), n_O: Vec3::z() };
        let spinning = |edges: &[ConeEdge]| {
            let model = Model(edges.to_vec());
            model.spinning_cone(FingerIndex(0), &contact, 0.5).into_owned()
        };
        assert_eq!(spinning(&[]), Cone::Elliptic { mu: 0.5, gamma: 0.0 });
        let edge = |torsion| ConeEdge { tangential: [0.1, 0.0], torsion };
        assert_eq!(spinning(&[edge(0.0), edge(0.0)]), Cone::Polyhedral(vec![edge(0.0); 2].into()));
        assert_eq!(spinning(&[edge(-0.01), edge(0.01)]), Cone::Polyhedral(vec![edge(0.0)].into()));
    }
}
