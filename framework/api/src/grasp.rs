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
    /// The cone spanned by edges in the contact frame, each with unit normal component: lent by the model
    /// that has them ready, or made for this contact (`Cone::Polyhedral(edges.into())`).
    Polyhedral(Cow<'a, [ConeEdge]>),
}

impl Cone<'_> {
    /// A frictionless contact: a force along the normal and nothing else.
    pub const FRICTIONLESS: Cone<'static> = Cone::Elliptic { mu: 0.0, gamma: 0.0 };

    /// A cone of two coefficients of friction, for contacts with a grain: `mu[0]` along the tangential part
    /// of `grain_O` (a vector in O, of any length), `mu[1]` across it, and the torsional radius `gamma` (m),
    /// for the *outward* unit normal `n_O`.
    ///
    /// It is the polyhedron of [`GRAIN_EDGES`] edges inscribed in the elliptic cone, in each of five planes
    /// of torsion where `gamma` is positive: nowhere wider, and at most 2 % narrower without torsion, 10 %
    /// with it. A grain along the normal has no direction: then the smaller coefficient counts all round.
    pub fn grained(n_O: &Vec3, grain_O: &Vec3, mu: [f64; 2], gamma: f64) -> Cone<'static> {
        let inward = -n_O;
        let [t1, t2] = tangents(&inward);
        let (x, y) = (grain_O.dot(&t1), grain_O.dot(&t2));
        let length = x.hypot(y);
        let least = mu[0].min(mu[1]);
        let (grain, mu) =
            if length > 1e-9 { ([x / length, y / length], mu) } else { ([1.0, 0.0], [least; 2]) };
        let mut edges = Vec::new();
        let levels: std::ops::RangeInclusive<i32> = if gamma > 0.0 { -2..=2 } else { 0..=0 };
        for level in levels {
            let (sin, cos) = (f64::from(level) * std::f64::consts::FRAC_PI_4).sin_cos();
            let corners = if level.abs() == 2 { 1 } else { GRAIN_EDGES };
            edges.extend((0..corners).map(|k| {
                let (b, a) = (std::f64::consts::TAU * k as f64 / GRAIN_EDGES as f64).sin_cos();
                let (along, across) = (cos * mu[0] * a, cos * mu[1] * b);
                let tangential = [grain[0] * along - grain[1] * across, grain[1] * along + grain[0] * across];
                ConeEdge { tangential, torsion: gamma * sin }
            }));
        }
        Cone::Polyhedral(edges.into())
    }

    /// The wrenches of the cone that have no torque about the normal: what a contact transmits while it may
    /// spin.
    ///
    /// Exact: the slice of a polyhedral cone is spanned where segments between its edges cross torsion zero.
    #[must_use]
    pub fn without_torsion(&self) -> Cone<'static> {
        match self {
            Self::Elliptic { mu, .. } => Cone::Elliptic { mu: *mu, gamma: 0.0 },
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
            Self::Polyhedral(edges) => Cone::Polyhedral(edges.into_owned().into()),
        }
    }

    /// Whether the contact can transmit a torque about its normal.
    pub fn carries_torsion(&self) -> bool {
        match self {
            Self::Elliptic { gamma, .. } => *gamma != 0.0,
            Self::Polyhedral(edges) => edges.iter().any(|edge| edge.torsion != 0.0),
        }
    }
}

/// How many edges [`Cone::grained`] has in a plane.
pub const GRAIN_EDGES: usize = 16;

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
        Self { contacts: [const { NOTHING }; MAX_FINGERS], count: 0, efforts: Vec::new(), g_O }
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
    fn a_grain_has_its_coefficients_along_and_across_in_every_frame() {
        let (n_O, grain_O) = (Vec3::new(0.36, 0.48, 0.8), Vec3::new(0.3, -2.0, 1.0));
        let cone = Cone::grained(&n_O, &grain_O, [0.9, 0.3], 0.0);
        let [t1, t2] = tangents(&-n_O);
        let along = (grain_O - n_O * n_O.dot(&grain_O)).normalize();
        let across = n_O.cross(&along);
        for (direction, mu) in [(along, 0.9), (-along, 0.9), (across, 0.3), (-across, 0.3)] {
            let reach = support(&cone, [direction.dot(&t1), direction.dot(&t2), 0.0]);
            assert!((reach - mu).abs() < 1e-12, "{reach} for {mu}");
        }
        let lost = Cone::grained(&n_O, &n_O, [0.9, 0.3], 0.0);
        assert!((support(&lost, [1.0, 0.0, 0.0]) - 0.3).abs() < 1e-12);
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
    }

    #[test]
    fn torsion_and_friction_share_a_grained_cone() {
        let cone = Cone::grained(&Vec3::z(), &Vec3::x(), [0.8, 0.4], 0.003);
        assert!((support(&cone, [0.0, 0.0, 1.0]) - 0.003).abs() < 1e-12);
        assert!(support(&cone.without_torsion(), [0.0, 0.0, 1.0]) == 0.0);
        let widest = |k: usize| {
            let (sin, cos) = (0.1 * k as f64).sin_cos();
            support(&cone, [cos, sin, 0.0])
        };
        assert!((0..63).all(|k| widest(k) <= 0.8 + 1e-12 && widest(k) > 0.38));
    }
}
