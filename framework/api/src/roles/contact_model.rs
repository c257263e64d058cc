//! Role 1: which wrenches a contact can transmit.

use crate::{Cone, Contact};

/// Says which wrenches a contact between fingertip and object can transmit: a cone as data.
pub trait ContactModel: Send + Sync {
    /// The cone of one contact under the friction coefficient `mu` ≥ 0 (no unit).
    ///
    /// Monotone: a larger `mu` gives a cone that contains the smaller one's.
    fn cone(&self, contact: &Contact, mu: f64) -> Cone<'_>;

    /// The cone of the same contact while it may spin about its normal, as in every transfer: a contact that spins transmits no torsion.
    ///
    /// Contained in [`ContactModel::cone`]. Provided: the elliptic cone with γ = 0, and a polyhedral cone without torsion as it is. A
    /// model whose polyhedral cones carry torsion gives edges of its own here; the provided answer for it is a frictionless contact.
    fn spinning_cone(&self, contact: &Contact, mu: f64) -> Cone<'_> {
        match self.cone(contact, mu) {
            Cone::Elliptic { mu, .. } => Cone::Elliptic { mu, gamma: 0.0 },
            polyhedral if !polyhedral.carries_torsion() => polyhedral,
            Cone::Polyhedral(_) => Cone::Elliptic { mu: 0.0, gamma: 0.0 },
        }
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
        fn cone(&self, _: &Contact, mu: f64) -> Cone<'_> {
            if self.0.is_empty() { Cone::Elliptic { mu, gamma: 0.003 } } else { Cone::Polyhedral(&self.0) }
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
            let cone = model.spinning_cone(&contact, 0.5);
            (
                cone.carries_torsion(),
                matches!(cone, Cone::Polyhedral(_)),
                cone == Cone::Elliptic { mu: 0.5, gamma: 0.0 },
            )
        };
        assert_eq!(spinning(&[]), (false, false, true));
        let edge = |torsion| ConeEdge { tangential: [0.1, 0.0], torsion };
        assert_eq!(spinning(&[edge(0.0), edge(0.0)]), (false, true, false));
        assert_eq!(spinning(&[edge(0.0), edge(0.01)]), (false, false, false));
    }
}
