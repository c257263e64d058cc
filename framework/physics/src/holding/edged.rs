//! The same where some cones are polyhedra: a contact's force is a sum of its cone's edges with weights above
//! zero, and Newton's method goes to the analytic centre of the weights that balance.

use super::barrier::slopes;
use super::bearing::{FLAT, Press, UNBOUNDED, stacked};
use crate::force::ContactForce;
use nalgebra::{Cholesky, DMatrix, DVector, Dyn, Matrix6, Matrix6xX, Vector6};
use regrasp_api::{Cone, ConeEdge, EffortBounds, Vec3, tangents};
use std::f64::consts::{FRAC_PI_2, TAU};

/// The most Newton steps; about fifteen from the start.
const MAX_STEPS: usize = 100;
/// The share of the way to the boundary that a step may go.
const SHY: f64 = 0.9;
/// Room that accepted weights keep to every bound, of the weight that a search begins with.
const ROOM: f64 = 1e-9;
/// Newton decrement at which a centre is as good as exact, and that up to which a full step is surely safe.
const CENTRED: f64 = 1e-4;
const QUADRATIC: f64 = 0.25;
/// Residual of balance, relative to the largest weight, that is rounding.
const BALANCED: f64 = 1e-11;
/// Edges round an elliptic cone, and their steps of torsion, where other contacts have edges of their own.
const ROUND: usize = 24;
const LEVELS: i32 = 3;

/// One contact that bears a part of the load by edges.
#[derive(Clone, Debug, PartialEq)]
pub struct Edged {
    /// The wrench of each edge at unit normal force: force, and torque about the centre of mass over the
    /// length.
    map: Matrix6xX<f64>,
    /// The force (O) and the torque about the outward normal (m) of each edge, at unit normal force.
    edges: Vec<ContactForce>,
    /// The share of a joint's effort that each edge takes at unit normal force (1/N).
    rows: Vec<DVector<f64>>,
    /// Most normal force (N).
    most: f64,
    /// A normal force well inside the bounds (N): where searches begin.
    start: f64,
}

/// A weight (N) for each edge of each contact.
pub type Weights = Vec<DVector<f64>>;

/// Whether weights of edges balance a load; see [`super::Balanced`].
#[derive(Clone, Debug, PartialEq)]
pub enum EdgesBalanced {
    /// These do, strictly inside all bounds.
    Yes(Weights),
    /// None do: on this twist the load has more power than the efforts at their limits.
    No(Vector6<f64>),
    /// Neither was proved.
    Unknown,
}

impl Edged {
    /// The contact at `r_O` (m) from the centre of mass with the outward unit normal `n_O`, and a part of its
    /// friction and of its torsional friction; torques count over `length` (m).
    ///
    /// Edges are taken as they are given. An elliptic cone is replaced by edges on it: what they hold it
    /// holds.
    pub fn new(
        (r_O, n_O): (&Vec3, &Vec3),
        cone: &Cone<'_>,
        (part, torsion_part): (f64, f64),
        efforts: &EffortBounds,
        press: &Press,
        length: f64,
    ) -> Self {
        let [t1, t2] = tangents(&-n_O);
        let exerted = |edge: &ConeEdge| {
            let [x, y] = edge.tangential.map(|share| share * part);
            ContactForce { force: t1 * x + t2 * y - n_O, spin: -edge.torsion * torsion_part }
        };
        let edges: Vec<ContactForce> = edges_of(cone, n_O).iter().map(exerted).collect();
        let wrench = |edge: &ContactForce| {
            stacked(&edge.force, &((r_O.cross(&edge.force) + n_O * edge.spin) / length))
        };
        let map = Matrix6xX::from_columns(&edges.iter().map(wrench).collect::<Vec<_>>());
        let mut rows = Vec::new();
        for joint in efforts.joints() {
            let share = |edge: &ContactForce| joint.column_O.dot(&edge.force) + joint.spin * edge.spin;
            let limit = joint.limit * press.effort_share;
            let row = DVector::from_iterator(edges.len(), edges.iter().map(|edge| share(edge) / limit));
            if row.amax() > FLAT {
                rows.push(row);
            }
        }
        let most = press.max_normal_force.unwrap_or(UNBOUNDED.1);
        let steepest = rows.iter().map(|row: &DVector<f64>| row.mean().abs()).fold(1.0 / most, f64::max);
        let start = if rows.is_empty() { UNBOUNDED.0.min(0.5 * most) } else { 0.5 / steepest };
        Self { map, edges, rows, most, start }
    }

    /// The force (O) and the torque about the outward normal that weights exert on the object.
    pub fn force(&self, weights: &DVector<f64>) -> ContactForce {
        let mut sum = ContactForce::pure(Vec3::zeros());
        for (edge, weight) in self.edges.iter().zip(weights.iter()) {
            (sum.force, sum.spin) = (sum.force + edge.force * *weight, sum.spin + edge.spin * weight);
        }
        sum
    }

    /// Room to the bounds, of where a search begins; positive inside.
    fn room(&self, weights: &DVector<f64>) -> f64 {
        let efforts = self.rows.iter().map(|row| 1.0 - row.dot(weights).abs());
        let pressed = 1.0 - weights.sum() / self.most;
        efforts.fold(pressed.min(weights.min() * self.edges.len() as f64 / self.start), f64::min)
    }
}

/// The edges of a cone at the outward normal `n_O`; of an elliptic one edges on its surface.
fn edges_of(cone: &Cone<'_>, n_O: &Vec3) -> Vec<ConeEdge> {
    let (axes, gamma) = match cone {
        Cone::Polyhedral(edges) => return edges.to_vec(),
        Cone::Elliptic { mu, gamma } => (tangents(&-n_O).map(|tangent| (tangent, *mu)), *gamma),
        Cone::Grained(grain) => (grain.at(n_O), grain.gamma),
    };
    let [t1, t2] = tangents(&-n_O);
    let levels = if gamma > 0.0 { -LEVELS..=LEVELS } else { 0..=0 };
    let at = |level: i32, k: usize| {
        let (sin, cos) = (f64::from(level) / f64::from(LEVELS) * FRAC_PI_2).sin_cos();
        let (y, x) = (TAU * k as f64 / ROUND as f64).sin_cos();
        let f = axes[0].0 * (axes[0].1 * cos * x) + axes[1].0 * (axes[1].1 * cos * y);
        ConeEdge { tangential: [f.dot(&t1), f.dot(&t2)], torsion: gamma * sin }
    };
    levels.flat_map(|level| (0..ROUND).map(move |k| (level, k))).map(|(level, k)| at(level, k)).collect()
}

/// Gradient and Hessian of one contact's barrier: -Σ log λ - Σ log(1 - (a·λ)²) - log(1 - Σ λ/most).
struct Barrier {
    gradient: DVector<f64>,
    inverse: DMatrix<f64>,
}

struct Step {
    multiplier: Vector6<f64>,
    change: Weights,
    /// The largest multiple of the change that stays inside.
    reach: f64,
    /// The most power that weights within all bounds have on the multiplier; infinite where this step proves
    /// no bound.
    power: f64,
    /// Newton's decrement.
    decrement: f64,
}

impl Barrier {
    fn new(contact: &Edged, weights: &DVector<f64>) -> Option<Self> {
        let mut gradient = weights.map(|x| -1.0 / x);
        let mut hessian = DMatrix::from_diagonal(&weights.map(|x| x.powi(-2)));
        for row in &contact.rows {
            let (first, second) = slopes(row.dot(weights));
            gradient += row * first;
            hessian += row * row.transpose() * second;
        }
        let slope = contact.slope(weights);
        gradient.add_scalar_mut(slope);
        hessian.add_scalar_mut(slope * slope);
        Some(Self { gradient, inverse: Cholesky::<f64, Dyn>::new(hessian)?.inverse() })
    }
}

impl Edged {
    fn slope(&self, weights: &DVector<f64>) -> f64 {
        1.0 / (self.most - weights.sum())
    }

    /// The most power that this contact's forces can have on the step's multiplier, by weak duality: what the
    /// contact sees of it is exactly a part in the edges, and parts along the efforts' rows and the bound.
    fn power(&self, weights: &DVector<f64>, d: &DVector<f64>) -> f64 {
        let of_edges = weights.iter().zip(d.iter()).map(|(x, d)| (d / x - 1.0) / x);
        let over = of_edges.fold(0.0, f64::max);
        let slope = self.slope(weights);
        let pressed = (slope + slope * slope * d.sum()).max(0.0);
        let efforts = self.rows.iter().map(|row| {
            let (first, second) = slopes(row.dot(weights));
            (first + second * row.dot(d)).abs()
        });
        (over + pressed) * self.most + efforts.sum::<f64>()
    }

    /// The largest multiple of `d` that may be added to `weights` within the bounds.
    fn reach(&self, weights: &DVector<f64>, d: &DVector<f64>) -> f64 {
        let each = weights.iter().zip(d.iter()).filter(|(_, d)| **d < 0.0).map(|(x, d)| -x / d);
        let efforts = self.rows.iter().map(|row| (row.dot(weights), row.dot(d)));
        let efforts = efforts.filter(|(_, du)| *du != 0.0).map(|(u, du)| (du.signum() - u) / du);
        let sum = d.sum();
        let pressed = if sum > 0.0 { (self.most - weights.sum()) / sum } else { f64::INFINITY };
        each.chain(efforts).fold(pressed, f64::min)
    }
}

/// Where searches begin: all edges alike.
pub(crate) fn start(contacts: &[Edged]) -> Weights {
    let each = |contact: &Edged| {
        let count = contact.edges.len();
        DVector::from_element(count, contact.start / count as f64)
    };
    contacts.iter().map(each).collect()
}

/// Looks for weights whose wrench is `wanted`, from weights inside that need not balance (S. Boyd, L.
/// Vandenberghe, "Convex Optimization", 2004, section 10.3).
pub(crate) fn balance(contacts: &[Edged], from: &Weights, wanted: &Vector6<f64>) -> EdgesBalanced {
    run(contacts, from, wanted, f64::INFINITY)
}

/// Looks for the analytic centre of the weights whose wrench is `wanted`: unique, and continuous in all data.
pub(crate) fn centre_of_weights(contacts: &[Edged], from: &Weights, wanted: &Vector6<f64>) -> EdgesBalanced {
    run(contacts, from, wanted, CENTRED)
}

fn run(contacts: &[Edged], from: &Weights, wanted: &Vector6<f64>, precision: f64) -> EdgesBalanced {
    let (mut weights, mut feasible) = (from.clone(), false);
    for _ in 0..MAX_STEPS {
        let Some(step) = step(contacts, &weights, wanted) else { return EdgesBalanced::Unknown };
        if !feasible && wanted.dot(&step.multiplier) > step.power * (1.0 + 1e-9) {
            return EdgesBalanced::No(step.multiplier);
        }
        let mut t = (SHY * step.reach).min(1.0);
        if feasible && step.decrement > QUADRATIC {
            t = t.min(1.0 / (1.0 + step.decrement));
        }
        weights.iter_mut().zip(&step.change).for_each(|(x, d)| *x += d * t);
        feasible |= t >= 1.0;
        if feasible && step.decrement < precision && balances(contacts, &weights, wanted) {
            return EdgesBalanced::Yes(weights);
        }
    }
    EdgesBalanced::Unknown
}

/// Whether a search may begin with these weights.
pub(crate) fn may_start(contacts: &[Edged], weights: &Weights) -> bool {
    let fits = |(contact, weights): (&Edged, &DVector<f64>)| {
        weights.len() == contact.edges.len() && contact.room(weights) >= ROOM
    };
    contacts.len() == weights.len() && contacts.iter().zip(weights).all(fits)
}

fn balances(contacts: &[Edged], weights: &Weights, wanted: &Vector6<f64>) -> bool {
    let (mut residual, mut largest) = (*wanted, wanted.amax());
    for (contact, weights) in contacts.iter().zip(weights) {
        residual -= &contact.map * weights;
        largest = largest.max(weights.amax());
        if contact.room(weights) < ROOM {
            return false;
        }
    }
    residual.amax() <= BALANCED * largest
}

fn step(contacts: &[Edged], weights: &Weights, wanted: &Vector6<f64>) -> Option<Step> {
    let (mut S, mut right, mut barriers) = (Matrix6::zeros(), *wanted, Vec::new());
    for (contact, weights) in contacts.iter().zip(weights) {
        let barrier = Barrier::new(contact, weights)?;
        let mapped = &contact.map * &barrier.inverse;
        S += &mapped * contact.map.transpose();
        right += &mapped * &barrier.gradient - &contact.map * weights;
        barriers.push(barrier);
    }
    let multiplier = Cholesky::new(S)?.solve(&right);
    let mut step = Step { multiplier, change: Vec::new(), reach: f64::INFINITY, power: 0.0, decrement: 0.0 };
    for ((contact, weights), barrier) in contacts.iter().zip(weights).zip(&barriers) {
        let uphill = contact.map.transpose() * multiplier - &barrier.gradient;
        let d = &barrier.inverse * &uphill;
        step.decrement += d.dot(&uphill);
        step.reach = step.reach.min(contact.reach(weights, &d));
        step.power += contact.power(weights, &d);
        step.change.push(d);
    }
    step.decrement = step.decrement.max(0.0).sqrt();
    Some(step)
}

/// G Gᵀ of all edges.
pub(super) fn square(contacts: &[Edged]) -> Matrix6<f64> {
    contacts.iter().map(|contact| &contact.map * contact.map.transpose()).sum()
}
