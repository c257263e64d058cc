//! Cones as edges.

use super::force::Contact;
use crate::touch::Touch;
use nalgebra::{DVector, Vector6};
use regrasp_api::{Cone, ConeEdge, Vec3, tangents};

/// The force (O) and the torque about the inward normal of each edge of a contact's cone at unit normal
/// force, with a share of the friction.
pub(super) fn exerted(touch: &Touch, cone: &Cone<'_>, share: f64) -> Vec<(Vec3, f64)> {
    let n = -touch.n_O;
    let [t1, t2] = tangents(&n);
    let force = |edge: &ConeEdge| {
        let [x, y] = edge.tangential.map(|tangential| tangential * share);
        (n + t1 * x + t2 * y, edge.torsion * share)
    };
    edges(cone, &n).iter().map(force).collect()
}

/// The edges of a cone at the inward normal `n`; of an elliptic one, edges on its surface: 48 round it, in
/// steps of torsion as fine.
pub(super) fn edges(cone: &Cone<'_>, n: &Vec3) -> Vec<ConeEdge> {
    const ROUND: usize = 48;
    const LEVELS: i32 = 12;
    let gamma = match cone {
        Cone::Polyhedral(edges) => return edges.to_vec(),
        Cone::Elliptic { gamma, .. } => *gamma,
        Cone::Grained(grain) => grain.gamma,
    };
    let [t1, t2] = tangents(n);
    let contact = Contact::new(Vec3::zeros(), *n, cone, 1.0);
    // From the unit circle to the largest tangential forces.
    let rim = |x: f64, y: f64| {
        let f = contact.as_ref().map_or(Vec3::zeros(), |contact| contact.stretch(&(t1 * x + t2 * y)));
        [f.dot(&t1), f.dot(&t2)]
    };
    let levels = if gamma > 0.0 { -LEVELS..=LEVELS } else { 0..=0 };
    let level = |level: i32| {
        let (sin, cos) = (f64::from(level) / f64::from(LEVELS) * std::f64::consts::FRAC_PI_2).sin_cos();
        (0..ROUND).map(move |k| {
            let (y, x) = (std::f64::consts::TAU * k as f64 / ROUND as f64).sin_cos();
            ConeEdge { tangential: rim(cos * x, cos * y), torsion: gamma * sin }
        })
    };
    levels.flat_map(level).collect()
}

/// One contact: the wrenches of its cone's edges at unit normal force, and what each takes of each joint's
/// effort, of its limit (1/N).
pub(super) struct Edges {
    pub(super) columns: Vec<Vector6<f64>>,
    pub(super) efforts: Vec<DVector<f64>>,
}

impl Edges {
    /// The same with weights over a unit (N).
    pub(super) fn over(&self, unit: f64) -> Self {
        let efforts = self.efforts.iter().map(|effort| effort * unit).collect();
        Self { columns: self.columns.clone(), efforts }
    }

    /// How fast a sum of weights, or an effort, grows with the length of a change of the weights.
    pub(super) fn steepest(&self) -> f64 {
        let sum = (self.columns.len() as f64).sqrt();
        self.efforts.iter().map(|effort| effort.norm()).fold(sum, f64::max)
    }
}
