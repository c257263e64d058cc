//! Contact forces that balance a given load where some cones are polyhedra: Newton's method to their analytic
//! centre, as [`crate::balance`] goes there where all cones are elliptic.
//!
//! A polyhedral cone's force is a sum of its edges with weights λ > 0, and its normal force Σ λ < 1; the
//! barrier is -Σ log λ - log(1 - Σ λ). The edges are taken as they are given: a yes and a no are exact.

use crate::balance::{Barrier, Force};
use crate::closure::{PolarBody, Symmetric6};
use crate::contacts::Twist;
use crate::wrenches::{Extreme, WrenchSet};

/// The most Newton steps; about fifteen from the start.
const MAX_STEPS: usize = 120;
/// The share of the way to the boundary that a step may go.
const SHY: f64 = 0.9;
/// Newton decrement at which a centre is near enough.
const CENTRED: f64 = 0.5;
/// Room that an accepted force keeps to every bound.
const ROOM: f64 = 1e-9;
/// Pivots of the grasp map's square at or below this mean that its rank is not surely 6.
const FLAT: f64 = 1e-12;

/// One contact's force, the largest allowed normal force as unit.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Part {
    /// In an elliptic cone.
    Elliptic(Force),
    /// The weights of a polyhedral cone's edges.
    Edges(Vec<f64>),
}

/// Whether some load can be balanced.
#[derive(Clone, Debug)]
pub(crate) enum Found {
    /// By these forces, strictly inside.
    Yes(Vec<Part>),
    /// No: a twist on which all contacts together have less power than the load asks for.
    No,
    /// Neither was proved.
    Unknown,
}

/// The contacts of one grasp with normal forces up to 1, some of them with polyhedral cones.
pub(crate) struct EdgeBalance<'a> {
    set: &'a WrenchSet<'a>,
    /// The wrenches of each contact's edges; none for elliptic cones.
    columns: Vec<Vec<Twist>>,
    /// Trace of the inverse of the grasp map's square.
    trace: f64,
}

impl<'a> EdgeBalance<'a> {
    /// `None` where the contacts cannot resist every direction of wrench, whatever the forces.
    pub fn new(set: &'a WrenchSet<'a>) -> Option<Self> {
        let (mut M, _) = PolarBody { grasp: &set.grasp }.grasp_map_square();
        let columns_of = |i: usize| -> Vec<Twist> {
            let edges = set.edges_of(i).unwrap_or_default();
            edges.iter().map(|edge| set.wrench(&set.edge(i, edge))).collect()
        };
        let columns: Vec<Vec<Twist>> = (0..set.contacts().len()).map(columns_of).collect();
        for (contact, columns) in set.contacts().iter().zip(&columns).filter(|(_, c)| !c.is_empty()) {
            // It was counted as frictionless.
            M.add_outer(-1.0, &Twist { a: contact.n, b: contact.r.cross(&contact.n) }.to_array());
            columns.iter().for_each(|column| M.add_outer(1.0, &column.to_array()));
        }
        let factor = M.factor(FLAT);
        (factor.smallest > FLAT).then(|| Self { set, columns, trace: factor.trace_of_inverse() })
    }

    /// Forces midway between none and the largest.
    fn start(&self) -> Vec<Part> {
        let start = |columns: &Vec<Twist>| match columns.len() {
            0 => Part::Elliptic(Force::START),
            count => Part::Edges(vec![0.5 / count as f64; count]),
        };
        self.columns.iter().map(start).collect()
    }

    /// Looks for forces whose wrench is `wanted`, near the centre of all such forces.
    pub fn centre(&self, wanted: &Twist) -> Found {
        self.search(self.start(), wanted, true)
    }

    /// Looks for any forces whose wrench is `wanted`, from forces of a load nearby.
    pub fn follow(&self, from: &[Part], wanted: &Twist) -> Found {
        self.search(from.to_vec(), wanted, false)
    }

    /// Newton's method from forces inside that need not balance (Boyd & Vandenberghe, "Convex Optimization",
    /// 2004, section 10.3).
    fn search(&self, mut parts: Vec<Part>, wanted: &Twist, centred: bool) -> Found {
        let mut feasible = false;
        for _ in 0..MAX_STEPS {
            let step = self.step(&parts, wanted);
            if !feasible && self.cannot(&step.multiplier, wanted) {
                return Found::No;
            }
            let t = (SHY * step.reach).min(1.0);
            parts.iter_mut().zip(&step.change).for_each(|(part, change)| part.add(t, change));
            feasible |= t >= 1.0;
            if feasible && (!centred || step.decrement < CENTRED) && self.balances(&parts, wanted) {
                return Found::Yes(parts);
            }
        }
        if feasible && self.balances(&parts, wanted) { Found::Yes(parts) } else { Found::Unknown }
    }

    fn step(&self, parts: &[Part], wanted: &Twist) -> Step {
        let (mut S, mut right) = (Symmetric6::zeros(), *wanted);
        for (i, part) in parts.iter().enumerate() {
            let downhill = match part {
                Part::Elliptic(force) => {
                    let barrier = Barrier::new(force);
                    barrier.add_to(&mut S, &self.set.contacts()[i]);
                    Part::Elliptic(barrier.inverse(&barrier.gradient()))
                }
                Part::Edges(weights) => {
                    let barrier = EdgeBarrier::new(weights);
                    barrier.add_to(&mut S, &self.columns[i]);
                    Part::Edges(barrier.inverse(&barrier.gradient()))
                }
            };
            right = right.plus(1.0, &self.wrench(i, &downhill)).plus(-1.0, &self.wrench(i, part));
        }
        let multiplier = Twist::from_array(S.factor(f64::MIN_POSITIVE).solve(right.to_array()));
        let mut step = Step { multiplier, change: Vec::new(), reach: f64::INFINITY, decrement: 0.0 };
        for (i, part) in parts.iter().enumerate() {
            step.take(match part {
                Part::Elliptic(force) => {
                    let barrier = Barrier::new(force);
                    let seen = Force::seen(&self.set.contacts()[i], &multiplier);
                    let uphill = seen.plus(-1.0, &barrier.gradient());
                    let change = barrier.inverse(&uphill);
                    (Part::Elliptic(change), barrier.reach(&change), uphill.dot(&change))
                }
                Part::Edges(weights) => {
                    let barrier = EdgeBarrier::new(weights);
                    let seen = self.columns[i].iter().map(|column| column.dot(&multiplier));
                    let uphill: Vec<f64> = seen.zip(barrier.gradient()).map(|(s, g)| s - g).collect();
                    let change = barrier.inverse(&uphill);
                    let decrement = uphill.iter().zip(&change).map(|(a, b)| a * b).sum();
                    let reach = barrier.reach(&change);
                    (Part::Edges(change), reach, decrement)
                }
            });
        }
        step.decrement = step.decrement.max(0.0).sqrt();
        step
    }

    /// The wrench of a part of contact `i`.
    fn wrench(&self, i: usize, part: &Part) -> Twist {
        match part {
            Part::Elliptic(force) => force.wrench(&self.set.contacts()[i]),
            Part::Edges(weights) => {
                let each = self.columns[i].iter().zip(weights);
                each.fold(Twist::ZERO, |sum, (column, weight)| sum.plus(*weight, column))
            }
        }
    }

    /// Whether all contacts together have less power on `w` than `wanted`.
    fn cannot(&self, w: &Twist, wanted: &Twist) -> bool {
        let power = |(i, columns): (usize, &Vec<Twist>)| match columns.is_empty() {
            true => self.set.contacts()[i].support(w),
            false => columns.iter().map(|column| column.dot(w)).fold(f64::NEG_INFINITY, f64::max),
        };
        let most: f64 = self.columns.iter().enumerate().map(|each| power(each).max(0.0)).sum();
        wanted.dot(w) > most + 1e-12 * w.norm()
    }

    /// Whether the forces are strictly inside and balance to far less than their room can take.
    fn balances(&self, parts: &[Part], wanted: &Twist) -> bool {
        let (mut residual, mut room) = (wanted.scaled(-1.0), f64::INFINITY);
        for (i, part) in parts.iter().enumerate() {
            residual = residual.plus(1.0, &self.wrench(i, part));
            room = room.min(part.room());
        }
        room >= ROOM && residual.dot(&residual) * self.trace <= (0.1 * room).powi(2)
    }

    /// Force (in O) and torque about the inward normal over the length, of a part of contact `i`.
    pub fn force(&self, i: usize, part: &Part) -> Extreme {
        let contact = &self.set.contacts()[i];
        match part {
            Part::Elliptic(force) => {
                Extreme { f: force.wrench(contact).a, m: contact.gamma * force.spin, ..Extreme::NONE }
            }
            Part::Edges(weights) => {
                let mut sum = Extreme { f: contact.n * 0.0, ..Extreme::NONE };
                for (edge, weight) in self.set.edges_of(i).unwrap_or_default().iter().zip(weights) {
                    let edge = self.set.edge(i, edge);
                    (sum.f, sum.m) = (sum.f + edge.f * *weight, sum.m + edge.m * weight);
                }
                sum
            }
        }
    }
}

/// One Newton step.
struct Step {
    multiplier: Twist,
    change: Vec<Part>,
    /// The largest multiple of the change that stays inside.
    reach: f64,
    decrement: f64,
}

impl Step {
    fn take(&mut self, (change, reach, decrement): (Part, f64, f64)) {
        self.change.push(change);
        self.reach = self.reach.min(reach);
        self.decrement += decrement;
    }
}

impl Part {
    /// Adds a multiple of a change of the same kind.
    fn add(&mut self, t: f64, change: &Self) {
        match (self, change) {
            (Self::Elliptic(force), Self::Elliptic(change)) => *force = force.plus(t, change),
            (Self::Edges(weights), Self::Edges(change)) => {
                weights.iter_mut().zip(change).for_each(|(weight, d)| *weight += t * d);
            }
            _ => {}
        }
    }

    /// By how much all numbers may change together and stay inside.
    fn room(&self) -> f64 {
        match self {
            Self::Elliptic(force) => force.room(),
            Self::Edges(weights) => {
                let least = weights.iter().copied().fold(f64::INFINITY, f64::min);
                let left = 1.0 - weights.iter().sum::<f64>();
                least.min(left / (weights.len() as f64).sqrt())
            }
        }
    }
}

/// The barrier of a polyhedral cone's weights.
struct EdgeBarrier<'a> {
    weights: &'a [f64],
    /// 1 - Σ λ.
    left: f64,
    /// Weight of the bound's term in the inverse Hessian, by Sherman and Morrison.
    weight: f64,
}

impl<'a> EdgeBarrier<'a> {
    fn new(weights: &'a [f64]) -> Self {
        let left = 1.0 - weights.iter().sum::<f64>();
        let (curvature, squares) = (left.powi(-2), weights.iter().map(|x| x * x).sum::<f64>());
        Self { weights, left, weight: curvature / (1.0 + curvature * squares) }
    }

    fn gradient(&self) -> Vec<f64> {
        self.weights.iter().map(|x| 1.0 / self.left - 1.0 / x).collect()
    }

    /// The inverse Hessian times `c`.
    fn inverse(&self, c: &[f64]) -> Vec<f64> {
        let squares = || self.weights.iter().map(|x| x * x);
        let along: f64 = squares().zip(c).map(|(square, c)| square * c).sum();
        squares().zip(c).map(|(square, c)| square * (c - self.weight * along)).collect()
    }

    /// Adds G H⁻¹ Gᵀ of the contact.
    fn add_to(&self, S: &mut Symmetric6, columns: &[Twist]) {
        let mut sum = Twist::ZERO;
        for (weight, column) in self.weights.iter().zip(columns) {
            S.add_outer(weight * weight, &column.to_array());
            sum = sum.plus(weight * weight, column);
        }
        S.add_outer(-self.weight, &sum.to_array());
    }

    /// The largest step along `d` that stays inside.
    fn reach(&self, d: &[f64]) -> f64 {
        let sum: f64 = d.iter().sum();
        let bound = if sum > 0.0 { self.left / sum } else { f64::INFINITY };
        let each = self.weights.iter().zip(d).filter(|(_, d)| **d < 0.0).map(|(weight, d)| -weight / d);
        each.fold(bound, f64::min)
    }
}
