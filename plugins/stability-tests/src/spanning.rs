//! Whether wrenches span all of wrench space positively: nonnegative least squares with the columns generated
//! when they are wanted.

use crate::closure::{Factor, Symmetric6};
use crate::contacts::Twist;
use crate::wrenches::{Extreme, WrenchSet};
use regrasp_api::{Certificate, MAX_FINGERS, Vec3};

/// Steps after which a grasp is left undecided; about one a wrench of the answer is usual.
const MAX_STEPS: usize = 200;
/// A wrench whose cosine with the remainder is at most this does not lead nearer.
const NEARER: f64 = 1e-9;
/// Pivots of the grasp map's square at or below this mean that its rank is not surely 6.
const FLAT: f64 = 1e-12;
/// From this pivot on a solution needs no check.
const SOUND: f64 = 1e-5;
/// The part of every inner force that is never taken away.
const KEPT: f64 = 1e-6;

/// What a search found.
#[derive(Clone, Copy, Debug)]
#[allow(clippy::large_enum_variant)] // lives on the stack for the length of one call
pub(crate) enum Span {
    /// The wrenches span the space positively: these forces, all strictly inside, balance.
    Spans(Balance),
    /// No wrench of any contact has positive power on this twist.
    Separated(Twist),
    /// The wrenches do not surely span the space even with weights of both signs.
    Flat,
    /// The search ended without a proof.
    Undecided,
}

/// Forces that balance: one unit of every contact's inner wrench, weights on extreme ones, and the correction
/// Gᵀd of all.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Balance {
    /// The weighted extreme wrenches.
    pub extremes: [(Extreme, f64); 6],
    /// How many.
    pub count: usize,
    /// The twist d of the correction.
    pub correction: Twist,
}

/// Looks for a proof: inner forces plus extreme ones with weights of at least 0 that balance, or a twist that
/// no contact pushes along.
///
/// After Lawson & Hanson, "Solving Least Squares Problems", 1974, chapter 23: least squares over the active
/// wrenches, whose remainder says which wrench to take in next. That one is found in closed form, so the
/// linear program's columns are never listed. As the inner forces can be pushed a little without leaving
/// their cones, the search ends as soon as what remains is that little: often at once.
pub(crate) fn span(set: &WrenchSet<'_>) -> Span {
    let (M, sum) = square(set);
    let factor = M.factor(FLAT);
    if factor.smallest <= FLAT {
        return Span::Flat;
    }
    let start = sum.scaled(-1.0);
    let mut active = Active::new(start);
    for _ in 0..MAX_STEPS {
        let remainder = active.remainder();
        if absorbs(set, &factor, &remainder).is_some()
            && let Some(balance) = confirm(set, &factor, &active, &start)
        {
            return Span::Spans(balance);
        }
        let norm = remainder.norm();
        let farthest = set.farthest(&remainder);
        if farthest.value <= NEARER * norm || norm == 0.0 {
            return if norm > NEARER { Span::Separated(remainder) } else { Span::Undecided };
        }
        if active.count == 6 {
            return Span::Undecided;
        }
        active.take_in(farthest, set.wrench(&farthest).to_array());
    }
    Span::Undecided
}

/// M = C Cᵀ over the columns by which the inner forces can be pushed (1, μ, μ, γ times the units; a
/// polyhedral cone's edges over their number), and the sum of the inner wrenches.
fn square(set: &WrenchSet<'_>) -> (Symmetric6, Twist) {
    let (mut M, _) = crate::closure::PolarBody { grasp: &set.grasp }.grasp_map_square();
    let mut sum = Twist::ZERO;
    for (i, contact) in set.contacts().iter().enumerate() {
        sum = sum.plus(1.0, &set.wrench(&set.central(i)));
        if let Some(edges) = set.edges_of(i) {
            // It was counted as frictionless.
            M.add_outer(-1.0, &Twist { a: contact.n, b: contact.r.cross(&contact.n) }.to_array());
            let share = 1.0 / edges.len() as f64;
            for edge in edges {
                M.add_outer(share * share, &set.wrench(&set.edge(i, edge)).to_array());
            }
        }
    }
    (M, sum)
}

/// The twist d whose push Cᵀd of the inner forces makes up for `remainder` and leaves them inside; `None` if
/// there is none.
fn absorbs(set: &WrenchSet<'_>, factor: &Factor, remainder: &Twist) -> Option<Twist> {
    let d = Twist::from_array(factor.solve(remainder.to_array()));
    let inside = (0..set.contacts().len()).all(|i| push_stays_inside(set, i, &d));
    (inside && (factor.smallest >= SOUND || is_solution(set, factor, &d, remainder))).then_some(d)
}

#[inline]
fn push_stays_inside(set: &WrenchSet<'_>, i: usize, d: &Twist) -> bool {
    if let Some(edges) = set.edges_of(i) {
        let share = 1.0 / edges.len() as f64;
        return edges.iter().all(|edge| 1.0 + share * set.wrench(&set.edge(i, edge)).dot(d) >= KEPT);
    }
    let contact = &set.contacts()[i];
    let v = d.a + d.b.cross(&contact.r);
    let v_n = v.dot(&contact.n);
    let tangential = v - contact.n * v_n;
    let spin = contact.gamma * d.b.dot(&contact.n);
    let spread = (contact.form(&tangential, &tangential) + spin * spin).sqrt();
    set.inner() * (1.0 + v_n) - spread >= KEPT
}

/// Whether the push really makes up for the remainder, as far as what is kept can take.
#[cold]
fn is_solution(set: &WrenchSet<'_>, factor: &Factor, d: &Twist, remainder: &Twist) -> bool {
    let mut rest = remainder.scaled(-1.0);
    for i in 0..set.contacts().len() {
        rest = rest.plus(1.0, &push(set, i, d));
    }
    rest.dot(&rest) * factor.trace_of_inverse() <= (0.1 * KEPT).powi(2)
}

/// The wrench of contact `i`'s part of Cᵀd.
fn push(set: &WrenchSet<'_>, i: usize, d: &Twist) -> Twist {
    set.wrench(&push_force(set, i, d))
}

/// Force and torsion of contact `i`'s part of Cᵀd.
fn push_force(set: &WrenchSet<'_>, i: usize, d: &Twist) -> Extreme {
    let contact = &set.contacts()[i];
    let mut force = Extreme { contact: i, value: 0.0, ..Extreme::NONE };
    if let Some(edges) = set.edges_of(i) {
        let share = 1.0 / edges.len() as f64;
        for edge in edges.iter().map(|edge| set.edge(i, edge)) {
            let weight = share * share * set.wrench(&edge).dot(d);
            force.f += edge.f * weight;
            force.m += edge.m * weight;
        }
        return force;
    }
    let v = d.a + d.b.cross(&contact.r);
    let v_n = v.dot(&contact.n);
    force.f = contact.n * v_n + contact.squared(&(v - contact.n * v_n));
    force.m = contact.gamma * contact.gamma * d.b.dot(&contact.n);
    force
}

/// The balance, if it holds for the forces as they are and not only for the factors that they were found
/// with.
fn confirm(set: &WrenchSet<'_>, factor: &Factor, active: &Active, start: &Twist) -> Option<Balance> {
    let mut remainder = *start;
    let mut extremes = [(Extreme::NONE, 0.0); 6];
    for (k, slot) in extremes.iter_mut().enumerate().take(active.count) {
        *slot = (active.extremes[k], active.weights[k]);
        remainder = remainder.plus(-active.weights[k], &Twist::from_array(active.columns[k]));
    }
    let correction = absorbs(set, factor, &remainder)?;
    Some(Balance { extremes, count: active.count, correction })
}

/// The balancing forces as a certificate, the normal forces adding up to 1 N.
pub(crate) fn internal_force(set: &WrenchSet<'_>, balance: &Balance) -> Certificate {
    let mut each = [Extreme { f: Vec3::zeros(), ..Extreme::NONE }; MAX_FINGERS];
    for (i, force) in each.iter_mut().enumerate().take(set.contacts().len()) {
        let (central, push) = (set.central(i), push_force(set, i, &balance.correction));
        (force.f, force.m) = (central.f + push.f, central.m + push.m);
    }
    for (extreme, weight) in &balance.extremes[..balance.count] {
        each[extreme.contact].f += extreme.f * *weight;
        each[extreme.contact].m += extreme.m * weight;
    }
    let contacts = set.contacts();
    let total: f64 = contacts.iter().zip(&each).map(|(contact, force)| force.f.dot(&contact.n)).sum();
    let each = &each[..contacts.len()];
    Certificate::InternalForce {
        forces_O: each.iter().map(|force| force.f / total).collect(),
        torsions: each.iter().map(|force| force.m * set.grasp.length / total).collect(),
    }
}

/// A twist along which no contact pushes as a certificate: backwards no contact resists it.
///
/// Only if the round cones push no more than the edges inside them; else the verdict is one about edges,
/// which proves nothing of the cones.
pub(crate) fn separating_twist(set: &WrenchSet<'_>, pushed: &Twist) -> Certificate {
    let unit = pushed.scaled(1.0 / pushed.norm());
    let round = |i: &usize| set.edges_of(*i).is_none();
    let pushes = (0..set.contacts().len()).filter(round).any(|i| set.contacts()[i].support(&unit) > NEARER);
    if pushes {
        return Certificate::None;
    }
    Certificate::SeparatingTwist { v_O: -unit.a, w_O: -unit.b / set.grasp.length }
}

/// The active wrenches with their weights, and the orthogonal factors of the wrenches.
struct Active {
    count: usize,
    extremes: [Extreme; 6],
    columns: [[f64; 6]; 6],
    weights: [f64; 6],
    /// Orthonormal basis of the columns, and their coefficients in it.
    basis: [[f64; 6]; 6],
    upper: [[f64; 6]; 6],
    /// Coefficients of the right-hand side in the basis.
    right: [f64; 6],
    target: [f64; 6],
    rest: [f64; 6],
}

impl Active {
    fn new(target: Twist) -> Self {
        let (zeros, target) = ([[0.0; 6]; 6], target.to_array());
        Self {
            count: 0,
            extremes: [Extreme::NONE; 6],
            columns: zeros,
            weights: [0.0; 6],
            basis: zeros,
            upper: zeros,
            right: [0.0; 6],
            target,
            rest: target,
        }
    }

    fn remainder(&self) -> Twist {
        Twist::from_array(self.rest)
    }

    /// Takes one more wrench in; those whose weights would turn negative leave.
    fn take_in(&mut self, extreme: Extreme, column: [f64; 6]) {
        self.extremes[self.count] = extreme;
        self.columns[self.count] = column;
        self.weights[self.count] = 0.0;
        self.count += 1;
        self.orthogonalise(self.count - 1);
        loop {
            let free = self.unconstrained();
            if free[..self.count].iter().all(|&x| x > 0.0) {
                self.weights = free;
                return;
            }
            self.go_towards(&free);
        }
    }

    /// Moves towards the unconstrained weights until the first is zero, and drops that one.
    fn go_towards(&mut self, free: &[f64; 6]) {
        let (mut step, mut first) = (f64::INFINITY, 0);
        for k in (0..self.count).filter(|&k| free[k] <= 0.0) {
            let ratio = self.weights[k] / (self.weights[k] - free[k]).max(f64::MIN_POSITIVE);
            if ratio < step {
                (step, first) = (ratio, k);
            }
        }
        for (weight, free) in self.weights[..self.count].iter_mut().zip(free) {
            *weight = (*weight + step * (free - *weight)).max(0.0);
        }
        self.extremes.copy_within(first + 1..self.count, first);
        self.columns.copy_within(first + 1..self.count, first);
        self.weights.copy_within(first + 1..self.count, first);
        self.count -= 1;
        self.rest = self.target;
        let again = std::mem::replace(&mut self.count, 0);
        for k in 0..again {
            self.count = k + 1;
            self.orthogonalise(k);
        }
    }

    /// Modified Gram-Schmidt of column `k` and of the remainder.
    fn orthogonalise(&mut self, k: usize) {
        let mut q = self.columns[k];
        for j in 0..k {
            let c = dot(&self.basis[j], &q);
            self.upper[j][k] = c;
            subtract(&mut q, c, &self.basis[j]);
        }
        let norm = dot(&q, &q).sqrt().max(f64::MIN_POSITIVE);
        self.upper[k][k] = norm;
        q.iter_mut().for_each(|x| *x /= norm);
        self.right[k] = dot(&q, &self.rest);
        subtract(&mut self.rest, self.right[k], &q);
        self.basis[k] = q;
    }

    /// The weights that leave the least remainder, whatever their signs.
    fn unconstrained(&self) -> [f64; 6] {
        let mut x = self.right;
        for k in (0..self.count).rev() {
            for j in k + 1..self.count {
                x[k] -= self.upper[k][j] * x[j];
            }
            x[k] /= self.upper[k][k];
        }
        x
    }
}

#[inline]
fn dot(a: &[f64; 6], b: &[f64; 6]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[inline]
fn subtract(a: &mut [f64; 6], c: f64, b: &[f64; 6]) {
    a.iter_mut().zip(b).for_each(|(a, b)| *a -= c * b);
}
