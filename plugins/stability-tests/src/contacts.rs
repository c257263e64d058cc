//! Contacts in scaled coordinates: about their centroid, lengths divided by their size, normals inward.

use regrasp_api::{CallError, Cone, FingerIndex, Grasp, GraspContact, MAX_FINGERS, Vec3};
use std::convert::Infallible;

/// A twist, or a covector of wrenches, in scaled coordinates: `a` goes with forces, `b` with torques divided
/// by length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Twist {
    /// Linear velocity of the point at the contacts' centroid, in O.
    pub a: Vec3,
    /// Angular velocity times the length, in O.
    pub b: Vec3,
}

impl Twist {
    /// The zero twist.
    pub const ZERO: Self = Self { a: Vec3::new(0.0, 0.0, 0.0), b: Vec3::new(0.0, 0.0, 0.0) };

    /// `self + s * other`.
    #[inline]
    pub fn plus(&self, s: f64, other: &Self) -> Self {
        Self { a: self.a + other.a * s, b: self.b + other.b * s }
    }

    /// `s * self`.
    #[inline]
    pub fn scaled(&self, s: f64) -> Self {
        Self { a: self.a * s, b: self.b * s }
    }

    /// The Euclidean product of all six components.
    #[inline]
    pub fn dot(&self, other: &Self) -> f64 {
        self.a.dot(&other.a) + self.b.dot(&other.b)
    }

    /// The Euclidean norm of all six components.
    #[inline]
    pub fn norm(&self) -> f64 {
        self.dot(self).sqrt()
    }

    /// The six components, `a` first.
    #[inline]
    pub fn to_array(self) -> [f64; 6] {
        [self.a.x, self.a.y, self.a.z, self.b.x, self.b.y, self.b.z]
    }

    /// From six components, `a` first.
    #[inline]
    pub fn from_array(x: [f64; 6]) -> Self {
        Self { a: Vec3::new(x[0], x[1], x[2]), b: Vec3::new(x[3], x[4], x[5]) }
    }
}

/// One contact with an elliptic cone in scaled coordinates.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ScaledContact {
    /// Position about the centroid over the length (no unit).
    pub r: Vec3,
    /// *Inward* unit normal.
    pub n: Vec3,
    /// Coefficient of friction (no unit); with a grain the smaller one.
    pub mu: f64,
    /// Torsional radius over the length (no unit).
    pub gamma: f64,
    /// Whether friction is not the same all round.
    pub grained: bool,
    /// What a grain adds (no unit; in O, orthogonal to the normal): the most power on a tangential velocity v
    /// is √(μ² |v|² + (g·v)²). Zero without one.
    pub g: Vec3,
}

impl ScaledContact {
    /// Fills a place.
    const NOTHING: Self = Self {
        r: Vec3::new(0.0, 0.0, 0.0),
        n: Vec3::new(0.0, 0.0, 0.0),
        mu: 0.0,
        gamma: 0.0,
        grained: false,
        g: Vec3::new(0.0, 0.0, 0.0),
    };

    /// The contact with its cone, neither centred nor scaled; a polyhedral one is put down as frictionless.
    fn of(contact: &GraspContact<'_>) -> Self {
        let round = Self { r: contact.p_OC, n: -contact.n_O, ..Self::NOTHING };
        match &contact.cone {
            Cone::Elliptic { mu, gamma } => Self { mu: *mu, gamma: *gamma, ..round },
            Cone::Grained(grain) => {
                let (mu, g) = grain.spread(&contact.n_O);
                Self { mu, gamma: grain.gamma, grained: g != Vec3::zeros(), g, ..round }
            }
            Cone::Polyhedral(_) => round,
        }
    }

    /// μ² a·b, and what the grain adds: the form whose root is a tangential velocity's most power.
    #[inline]
    pub fn form(&self, a: &Vec3, b: &Vec3) -> f64 {
        let round = self.mu * self.mu * a.dot(b);
        if self.grained { round + self.g.dot(a) * self.g.dot(b) } else { round }
    }

    /// The tangential force whose power is [`Self::form`]: μ² v, and what the grain adds.
    #[inline]
    pub fn squared(&self, v: &Vec3) -> Vec3 {
        let round = v * (self.mu * self.mu);
        if self.grained { round + self.g * self.g.dot(v) } else { round }
    }

    /// The symmetric root of that map: what makes the friction's ellipse of the unit circle.
    #[inline]
    pub fn stretched(&self, v: &Vec3) -> Vec3 {
        let round = v * self.mu;
        if !self.grained {
            return round;
        }
        // μ + |g|²/(μ + μ') = μ', the larger coefficient, along g.
        let more = self.mu.hypot(self.g.norm());
        round + self.g * (self.g.dot(v) / (self.mu + more))
    }

    /// The wrench of the force g here, of which what the grain adds is made.
    #[inline]
    pub fn grain_wrench(&self) -> [f64; 6] {
        Twist { a: self.g, b: self.r.cross(&self.g) }.to_array()
    }

    /// The two tangents of a grained cone with their coefficients, the larger one first.
    pub fn axes(&self) -> Option<[(Vec3, f64); 2]> {
        self.grained.then(|| {
            let size = self.g.norm();
            let along = self.g / size;
            [(along, self.mu.hypot(size)), (self.n.cross(&along), self.mu)]
        })
    }

    /// The largest power of the cone's slice f_n = 1 on the twist `w`: h(w) = v_n + sqrt(μ²|v_t|² + γ²β²).
    #[inline]
    pub fn support(&self, w: &Twist) -> f64 {
        let v = w.a + w.b.cross(&self.r);
        let v_n = v.dot(&self.n);
        let v_t = v - self.n * v_n;
        let beta = w.b.dot(&self.n);
        v_n + (self.form(&v_t, &v_t) + (self.gamma * beta).powi(2)).sqrt()
    }
}

/// The three contacts of `grasp` except that of `lifted`, inward normals, neither centred nor scaled; `None`
/// if there are not three with elliptic cones.
pub(crate) fn three_of(grasp: &Grasp<'_>, lifted: Option<FingerIndex>) -> Option<[ScaledContact; 3]> {
    let mut left = grasp.contacts().iter().filter(|contact| Some(contact.finger) != lifted);
    let mut next = || match left.next() {
        Some(GraspContact { p_OC, n_O, cone: Cone::Elliptic { mu, gamma }, .. }) => {
            Some(ScaledContact { r: *p_OC, n: -n_O, mu: *mu, gamma: *gamma, ..ScaledContact::NOTHING })
        }
        _ => None,
    };
    let three = [next()?, next()?, next()?];
    left.next().is_none().then_some(three)
}

/// Whether all contacts of `grasp` except those of `lifted` have elliptic cones.
pub(crate) fn is_round(grasp: &Grasp<'_>, lifted: Option<FingerIndex>) -> bool {
    let round = |contact: &GraspContact<'_>| !matches!(contact.cone, Cone::Polyhedral(_));
    grasp.contacts().iter().all(|contact| Some(contact.finger) == lifted || round(contact))
}

/// Contacts closer together than this share of their distance from O's origin are one point: their
/// differences are rounding.
const COINCIDENT: f64 = 1e-9;

/// The contacts of a grasp about their centroid c, lengths divided by L = max |p - c|.
///
/// Always centred: with a reference point 100 L away rounding alone makes false answers.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ScaledGrasp {
    contacts: [ScaledContact; MAX_FINGERS],
    count: usize,
    /// The contacts' centroid c in O (m).
    pub center_O: Vec3,
    /// The length L (m); 1 where all contacts coincide.
    pub length: f64,
}

impl ScaledGrasp {
    /// The contacts of `grasp` except those of `lifted`; where a cone is not elliptic `plugin` is named, and
    /// what to use in place of it.
    pub fn gather(
        grasp: &Grasp<'_>,
        lifted: Option<FingerIndex>,
        plugin: &'static str,
    ) -> Result<Self, CallError> {
        Self::put(grasp, lifted, |contact| unscaled(contact, plugin))
    }

    /// The contacts of `grasp` except those of `lifted`, whatever their cones: a polyhedral one is put down
    /// as frictionless.
    pub fn gather_points(grasp: &Grasp<'_>, lifted: Option<FingerIndex>) -> Self {
        let put = Self::put(grasp, lifted, |contact| Ok::<_, Infallible>(ScaledContact::of(contact)));
        put.unwrap_or_else(|never| match never {})
    }

    fn put<E>(
        grasp: &Grasp<'_>,
        lifted: Option<FingerIndex>,
        of: impl Fn(&GraspContact<'_>) -> Result<ScaledContact, E>,
    ) -> Result<Self, E> {
        let mut scaled = Self {
            contacts: [ScaledContact::NOTHING; MAX_FINGERS],
            count: 0,
            center_O: Vec3::zeros(),
            length: 1.0,
        };
        for contact in grasp.contacts().iter().filter(|contact| Some(contact.finger) != lifted) {
            scaled.contacts[scaled.count] = of(contact)?;
            scaled.count += 1;
        }
        scaled.normalise();
        Ok(scaled)
    }

    /// The contacts.
    #[inline]
    pub fn contacts(&self) -> &[ScaledContact] {
        &self.contacts[..self.count]
    }

    /// The same contacts with friction and torsional radius replaced, for comparisons.
    #[cfg(test)]
    pub fn with_friction(mut self, mu: f64, gamma: f64) -> Self {
        self.contacts[..self.count].iter_mut().for_each(|contact| (contact.mu, contact.gamma) = (mu, gamma));
        self
    }

    /// How many independent force components the contacts have in all; closure needs at least seven.
    pub fn components(&self) -> usize {
        let of = |contact: &ScaledContact| {
            let tangential = if contact.mu > 0.0 { 2 } else { usize::from(contact.grained) };
            1 + tangential + usize::from(contact.gamma > 0.0)
        };
        self.contacts().iter().map(of).sum()
    }

    fn normalise(&mut self) {
        let contacts = &mut self.contacts[..self.count];
        let center = contacts.iter().map(|contact| contact.r).sum::<Vec3>() / contacts.len().max(1) as f64;
        let (mut square, mut reach) = (0.0_f64, 0.0_f64);
        for contact in contacts.iter_mut() {
            reach = reach.max(contact.r.norm_squared());
            contact.r -= center;
            square = square.max(contact.r.norm_squared());
        }
        self.center_O = center;
        let coincide = square <= reach * COINCIDENT * COINCIDENT;
        self.length = if coincide { 1.0 } else { square.sqrt() };
        let scale = 1.0 / self.length;
        for contact in contacts {
            contact.r = if coincide { Vec3::zeros() } else { contact.r * scale };
            contact.gamma *= scale;
        }
    }
}

fn unscaled(contact: &GraspContact<'_>, plugin: &'static str) -> Result<ScaledContact, CallError> {
    match &contact.cone {
        Cone::Elliptic { .. } | Cone::Grained(_) => Ok(ScaledContact::of(contact)),
        Cone::Polyhedral(_) => Err(CallError::Unsupported {
            plugin: plugin.to_owned(),
            reason:
                "it decides elliptic cones exactly and takes no polyhedral ones; use an elliptic contact \
                model, or `stability-test/force-closure` or `stability-test/equilibrium`, which take \
                polyhedral cones as they are"
                    .into(),
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_support_is_the_maximum_over_the_slice() {
        let n = Vec3::new(0.6, 0.0, 0.8);
        let contact =
            ScaledContact { r: Vec3::new(0.3, -0.7, 0.5), n, mu: 0.6, gamma: 0.2, ..ScaledContact::NOTHING };
        let (t1, t2) = (Vec3::new(0.8, 0.0, -0.6), Vec3::y());
        let w = Twist { a: Vec3::new(0.3, -1.0, 0.4), b: Vec3::new(-0.5, 0.2, 0.9) };
        let mut best = f64::NEG_INFINITY;
        for i in 0..200 {
            for j in 0..=100 {
                let (phi, theta) = (f64::from(i) * 0.0314159, f64::from(j) * 0.0314159);
                let f = n + (t1 * phi.cos() + t2 * phi.sin()) * (0.6 * theta.sin());
                let torque = contact.r.cross(&f) + n * (0.2 * theta.cos());
                best = best.max(w.a.dot(&f) + w.b.dot(&torque));
            }
        }
        let h = contact.support(&w);
        assert!(best <= h + 1e-12 && best > h - 1e-3, "{best} {h}");
    }

    #[test]
    fn components_count_what_each_contact_can_resist() {
        let contact = |mu, gamma| ScaledContact { n: Vec3::z(), mu, gamma, ..ScaledContact::NOTHING };
        let contacts = [contact(0.0, 0.0), contact(0.5, 0.0), contact(0.5, 0.1)];
        let mut all = [contact(0.0, 0.0); MAX_FINGERS];
        all[..3].copy_from_slice(&contacts);
        let grasp = ScaledGrasp { contacts: all, count: 3, center_O: Vec3::zeros(), length: 1.0 };
        assert_eq!(grasp.components(), 1 + 3 + 4);
    }
}
