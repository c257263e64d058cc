//! Grasps as the stability tests see them: contacts with the cones of wrenches that they can transmit.

use crate::{EffortBounds, FingerIndex, MAX_FINGERS, Vec3, any_orthogonal};
use std::borrow::Cow;

/// The wrenches that one contact can transmit, per unit of normal force.
///
/// Forces act *on the object*, along the inward normal; torques about the contact point.
#[derive(Clone, Debug, PartialEq)]
pub enum Cone<'a> {
    /// |f_t|²/μ² + m²/γ² ≤ f_n²: Coulomb friction with coefficient `mu` ≥ 0 and, where the torsional radius `gamma` ≥ 0
    /// (m) is positive, a torque m about the normal. `gamma = 0` is a point contact with friction,
    /// `mu = gamma = 0` a frictionless point.
    Elliptic {
        /// Coefficient of friction, no unit.
        mu: f64,
        /// Torsional friction radius (m).
        gamma: f64,
    },
    /// Friction that differs along and across a grain, and a torque about the normal: an elliptic cone with
    /// two coefficients.
    Grained(Box<Grain>),
    /// The cone spanned by edges in the contact frame, each with unit normal component: lent by the model
    /// that has them ready, or made for this contact (`Cone::Polyhedral(edges.into())`).
    Polyhedral(Cow<'a, [ConeEdge]>),
}

impl Cone<'_> {
    /// A frictionless contact: a force along the normal and nothing else.
    pub const FRICTIONLESS: Cone<'static> = Cone::Elliptic { mu: 0.0, gamma: 0.0 };

    /// A cone of two coefficients of friction, for contacts with a grain: `mu[0]` along the tangential part
    /// of `axis_O` (a vector in O, of any length), `mu[1]` across it, and the torsional radius `gamma` (m).
    ///
    /// Exact; see [`Grain`].
    pub fn grained(axis_O: &Vec3, mu: [f64; 2], gamma: f64) -> Cone<'static> {
        Cone::Grained(Box::new(Grain { mu, gamma, axis_O: *axis_O }))
    }

    /// The wrenches of the cone that have no torque about the normal: what a contact transmits while it may
    /// spin.
    ///
    /// Exact: the slice of a polyhedral cone is spanned where segments between its edges cross torsion zero.
    #[must_use]
    pub fn without_torsion(&self) -> Cone<'static> {
        match self {
            Self::Elliptic { mu, .. } => Cone::Elliptic { mu: *mu, gamma: 0.0 },
            Self::Grained(grain) => Cone::Grained(Box::new(Grain { gamma: 0.0, ..**grain })),
            Self::Polyhedral(edges) => {
                let flat = edges.iter().filter(|edge| edge.torsion == 0.0).copied();
                let (above, below) = (side(edges, 1.0), side(edges, -1.0));
                let between = above.iter().flat_map(|a| below.iter().map(move |b| crossing(a, b)));
                Cone::Polyhedral(flat.chain(between).collect::<Vec<_>>().into())
            }
        }
    }

    /// The same cone, with edges of its own.
    pub fn into_owned(self) -> Cone<'static> {
        match self {
            Self::Elliptic { mu, gamma } => Cone::Elliptic { mu, gamma },
            Self::Grained(grain) => Cone::Grained(grain),
            Self::Polyhedral(edges) => Cone::Polyhedral(edges.into_owned().into()),
        }
    }

    /// The largest torque about the normal per newton of normal force (m); 0 where there is none.
    pub fn torsion(&self) -> f64 {
        match self {
            Self::Elliptic { gamma, .. } => *gamma,
            Self::Grained(grain) => grain.gamma,
            Self::Polyhedral(edges) => edges.iter().map(|edge| edge.torsion.abs()).fold(0.0, f64::max),
        }
    }

    /// Whether the contact can transmit a torque about its normal.
    pub fn carries_torsion(&self) -> bool {
        match self {
            Self::Elliptic { gamma, .. } => *gamma != 0.0,
            Self::Grained(grain) => grain.gamma != 0.0,
            Self::Polyhedral(edges) => edges.iter().any(|edge| edge.torsion != 0.0),
        }
    }
}

/// Friction with a grain: f_a²/μ_a² + f_b²/μ_b² + m²/γ² ≤ f_n², with f_a the tangential force along the grain
/// and f_b the one across it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grain {
    /// Coefficients of friction along and across the grain, at least 0, no unit.
    pub mu: [f64; 2],
    /// Torsional friction radius (m), at least 0.
    pub gamma: f64,
    /// Where the grain runs: a vector in O of any length, of which the part in the contact's tangent plane
    /// counts. One that stands on the contact has no direction there: then the smaller coefficient counts
    /// all round.
    pub axis_O: Vec3,
}

impl Grain {
    /// The grain's tangential directions at a contact with the unit normal `n_O`, of either sign: along and
    /// across, both unit vectors in O, with their coefficients.
    pub fn at(&self, n_O: &Vec3) -> [(Vec3, f64); 2] {
        let flat = self.axis_O - n_O * n_O.dot(&self.axis_O);
        let length = flat.norm();
        if length > STANDING * self.axis_O.norm() {
            let along = flat / length;
            return [(along, self.mu[0]), (n_O.cross(&along), self.mu[1])];
        }
        let least = self.mu[0].min(self.mu[1]);
        tangents(n_O).map(|tangent| (tangent, least))
    }

    /// The same as a smaller coefficient μ all round and a tangential vector g (in O) that adds to it: the
    /// most power on a tangential velocity v is √(μ² |v|² + (g·v)²), without torsion.
    pub fn spread(&self, n_O: &Vec3) -> (f64, Vec3) {
        let [a, b] = self.at(n_O);
        let (less, more) = if a.1 <= b.1 { (a, b) } else { (b, a) };
        (less.1, more.0 * (more.1 * more.1 - less.1 * less.1).max(0.0).sqrt())
    }
}

/// An axis whose tangential part is shorter than this share of it stands on the contact.
const STANDING: f64 = 1e-9;

/// The tangents that edges of polyhedral cones are given along, for the *inward* unit normal `n`: t1 =
/// [`any_orthogonal`]`(n)`, t2 = n × t1.
pub fn tangents(n: &Vec3) -> [Vec3; 2] {
    let t1 = any_orthogonal(n);
    [t1, n.cross(&t1)]
}

/// The edges whose torsion has this sign.
fn side(edges: &[ConeEdge], sign: f64) -> Vec<&ConeEdge> {
    edges.iter().filter(|edge| edge.torsion * sign > 0.0).collect()
}

/// Where the segment between two edges has no torsion.
fn crossing(above: &ConeEdge, below: &ConeEdge) -> ConeEdge {
    let s = above.torsion / (above.torsion - below.torsion);
    let at = |i: usize| above.tangential[i] + (below.tangential[i] - above.tangential[i]) * s;
    ConeEdge { tangential: [at(0), at(1)], torsion: 0.0 }
}

/// One edge of a polyhedral cone at unit normal force; see [`tangents`] for its axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConeEdge {
    /// Tangential force along t1 and t2, no unit.
    pub tangential: [f64; 2],
    /// Torque about the inward normal per unit normal force (m).
    pub torsion: f64,
}

/// One contact of a grasp, with its cone.
#[derive(Clone, Debug, PartialEq)]
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
#[derive(Clone, Debug)]
pub struct Grasp<'a> {
    contacts: [GraspContact<'a>; MAX_FINGERS],
    count: u8,
    /// One for each contact, or none at all: most tests ask for none, and pay nothing.
    efforts: Vec<EffortBounds>,
    /// See [`Grasp::drag`].
    drags: [f64; MAX_FINGERS],
    /// Acceleration of gravity in the object's frame (m/s²); zero where gravity is not modelled.
    pub g_O: Vec3,
}

impl<'a> Grasp<'a> {
    /// A grasp without contacts under the gravity `g_O` (m/s², in the object's frame).
    pub fn new(g_O: Vec3) -> Self {
        const NOTHING: GraspContact<'static> = GraspContact {
            finger: FingerIndex(0),
            p_OC: Vec3::new(0.0, 0.0, 0.0),
            n_O: Vec3::new(0.0, 0.0, 1.0),
            cone: Cone::FRICTIONLESS,
        };
        let (contacts, drags) = ([const { NOTHING }; MAX_FINGERS], [0.0; MAX_FINGERS]);
        Self { contacts, count: 0, efforts: Vec::new(), drags, g_O }
    }

    /// Adds a contact; at most [`MAX_FINGERS`].
    pub fn push(&mut self, contact: GraspContact<'a>) {
        self.contacts[usize::from(self.count)] = contact;
        self.count += 1;
    }

    /// Adds a contact with what its finger's joints can do there; either all contacts of a grasp have that or
    /// none has.
    pub fn push_bounded(&mut self, contact: GraspContact<'a>, efforts: EffortBounds) {
        debug_assert_eq!(self.efforts.len(), usize::from(self.count));
        self.efforts.push(efforts);
        self.push(contact);
    }

    /// What the joints behind the contact with this number can do; `None` where the grasp does not say.
    pub fn efforts(&self, contact: usize) -> Option<&EffortBounds> {
        self.efforts.get(contact)
    }

    /// The largest torque about the normal, per newton of normal force (m), with which the contact with this
    /// number drags while it spins, one way or the other; 0 where it does not spin, or spins freely.
    ///
    /// A spinning contact transmits no torque that a grasp could rely on, but the friction that opposes its
    /// spin is there all the same, and the other contacts must balance it.
    pub fn drag(&self, contact: usize) -> f64 {
        self.drags[contact]
    }

    /// Whether any contact drags.
    pub fn has_drag(&self) -> bool {
        self.drags.iter().any(|drag| *drag > 0.0)
    }

    /// Says that the contact that was added last drags: see [`Grasp::drag`].
    pub fn drags(&mut self, drag: f64) {
        if let Some(last) = usize::from(self.count).checked_sub(1) {
            self.drags[last] = drag;
        }
    }

    /// The contacts, in the order in which they were added.
    pub fn contacts(&self) -> &[GraspContact<'a>] {
        &self.contacts[..usize::from(self.count)]
    }

    /// The same grasp without the contact of `finger`.
    #[must_use]
    pub fn without(&self, finger: FingerIndex) -> Self {
        let mut rest = Self::new(self.g_O);
        for (i, contact) in self.contacts().iter().enumerate().filter(|(_, c)| c.finger != finger) {
            match self.efforts(i) {
                Some(efforts) => rest.push_bounded(contact.clone(), *efforts),
                None => rest.push(contact.clone()),
            }
            rest.drags(self.drags[i]);
        }
        rest
    }
}

/// A small memory between calls along one path: it may change a call's cost, never its verdict.
///
/// The caller owns it, keeps one for each purpose and resets it with each path; what the numbers mean is the
/// plugin's.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Hint {
    /// What the numbers are, as the plugin likes; 0 means "nothing known".
    pub tag: u64,
    /// The plugin's numbers, in the plugin's units.
    pub values: [f64; Hint::VALUES],
}

impl Hint {
    /// How many numbers a hint holds: the forces of five point contacts, or of four soft ones.
    pub const VALUES: usize = 16;
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The largest value over the slice at unit normal force of the product with (x, y, torsion).
    fn support(cone: &Cone<'_>, w: [f64; 3]) -> f64 {
        let Cone::Polyhedral(edges) = cone else { panic!("it is polyhedral") };
        let value =
            |edge: &ConeEdge| edge.tangential[0] * w[0] + edge.tangential[1] * w[1] + edge.torsion * w[2];
        edges.iter().map(value).fold(f64::NEG_INFINITY, f64::max)
    }

    #[test]
    fn a_grain_has_its_coefficients_along_and_across() {
        let (n_O, axis_O) = (Vec3::new(0.36, 0.48, 0.8), Vec3::new(0.3, -2.0, 1.0));
        for mu in [[0.9, 0.3], [0.3, 0.9]] {
            let grain = Grain { mu, gamma: 0.0, axis_O };
            let (least, g) = grain.spread(&n_O);
            let reach = |v: &Vec3| (least * least * v.norm_squared() + g.dot(v).powi(2)).sqrt();
            let along = (axis_O - n_O * n_O.dot(&axis_O)).normalize();
            let across = n_O.cross(&along);
            assert!((reach(&along) - mu[0]).abs() < 1e-12 && (reach(&across) - mu[1]).abs() < 1e-12);
            // Between the two the support of an ellipse, whichever way the normal points.
            let v = along * 0.6 + across * 0.8;
            assert!((reach(&v) - (0.6 * mu[0]).hypot(0.8 * mu[1])).abs() < 1e-12);
            let mirrored = grain.spread(&-n_O);
            assert!(mirrored.0 == least && (mirrored.1.dot(&v).abs() - g.dot(&v).abs()).abs() < 1e-12);
        }
        // One that stands on the contact has no direction.
        assert_eq!(Grain { mu: [0.9, 0.3], gamma: 0.0, axis_O: n_O * 2.0 }.spread(&n_O).0, 0.3);
    }

    #[test]
    fn what_spins_is_the_slice_without_torsion() {
        let edge = |x, y, torsion| ConeEdge { tangential: [x, y], torsion };
        let edges =
            vec![edge(0.4, 0.0, 0.01), edge(-0.4, 0.0, 0.01), edge(0.0, 0.6, -0.01), edge(0.0, -0.6, -0.01)];
        let slice = Cone::Polyhedral(edges.into()).without_torsion();
        assert!(!slice.carries_torsion());
        // Half way between the two pairs.
        assert!((support(&slice, [1.0, 0.0, 0.0]) - 0.2).abs() < 1e-12);
        assert!((support(&slice, [0.0, 1.0, 0.0]) - 0.3).abs() < 1e-12);
        let soft = Cone::Elliptic { mu: 0.5, gamma: 0.002 };
        assert_eq!(soft.without_torsion(), Cone::Elliptic { mu: 0.5, gamma: 0.0 });
        let grained = |gamma| Cone::grained(&Vec3::x(), [0.5, 0.2], gamma);
        assert!(grained(0.002).carries_torsion() && grained(0.002).without_torsion() == grained(0.0));
    }
}
