//! The best internal force of a grasp by a small interior-point method of our own: the general solver spends
//! nearly all of its time on setting itself up.
//!
//! With s = y less t in the normal parts, the problem is to maximise t over s in the product of the cones, a
//! free t, and seven equations A s + b t = c: balance, and normal parts that sum to 1. Primal-dual steps with
//! the scaling of Nesterov and Todd ("Primal-dual interior-point methods for self-scaled cones", SIAM J.
//! Optim. 1998), predictor and corrector of Mehrotra (SIAM J. Optim. 1992); each is one system of seven rows.
//!
//! What is found here is checked by arithmetic like any other force. Where the method does not get to the
//! end, or the best slack is hardly positive, it says nothing, and the general solver decides.

#![allow(clippy::needless_range_loop)] // rows and columns of matrices

use super::force::{Contact, Force, Forces};
use regrasp_api::{MAX_FINGERS, Vec3, any_orthogonal};

/// The most steps: eight to twelve are usual.
const MOST_STEPS: usize = 30;
/// What is left of residuals and of the gap at the end ...
const PRECISION: f64 = 2e-9;
/// ... and what may be left where rounding ends the search before that.
const ENOUGH: f64 = 1e-7;
/// How much of the way to the boundary a step goes.
const SHY: f64 = 0.99;
/// Slacks below this are the general solver's to decide.
const DOUBTFUL: f64 = 1e-6;

/// A vector of one contact's cone: normal, two tangential, torsional.
type Part = [f64; 4];
/// A right side: balance, and the sum.
type Row = [f64; 7];

/// The forces of largest slack; `None` where they were not found, or hardly have any.
pub(crate) fn best_forces(contacts: &[Contact]) -> Option<Forces> {
    let count = contacts.len();
    if !(2..=MAX_FINGERS).contains(&count) {
        return None;
    }
    let mut search = Search::new(contacts);
    for _ in 0..MOST_STEPS {
        let left = search.left();
        if left.is_below(PRECISION) || search.step(&left).is_none() {
            break;
        }
    }
    (search.left().is_below(ENOUGH) && search.t > DOUBTFUL).then(|| search.forces(contacts))
}

/// One contact: its columns and where its part of the search is.
#[derive(Clone, Copy)]
struct Block {
    /// Seven rows of four.
    A: [Part; 7],
    s: Part,
    z: Part,
    scaling: Scaling,
    /// A W.
    B: [Part; 7],
    /// W z = W⁻¹ s.
    l: Part,
}

/// W = β [w₀, w₁ᵀ; w₁, I + w₁ w₁ᵀ/(1 + w₀)], with W z = W⁻¹ s.
#[derive(Clone, Copy)]
struct Scaling {
    w: Part,
    beta: f64,
}

impl Scaling {
    /// `None` where a vector has left its cone.
    fn of(s: &Part, z: &Part) -> Option<Self> {
        let (s_form, z_form) = (form(s), form(z));
        if !(s_form > 0.0 && z_form > 0.0 && s[0] > 0.0 && z[0] > 0.0) {
            return None;
        }
        let (s_size, z_size) = (s_form.sqrt(), z_form.sqrt());
        let cosine = dot(s, z) / (s_size * z_size);
        let gamma = ((1.0 + cosine) / 2.0).sqrt();
        let part = |k: usize, sign: f64| (s[k] / s_size + sign * z[k] / z_size) / (2.0 * gamma);
        let w = [part(0, 1.0), part(1, -1.0), part(2, -1.0), part(3, -1.0)];
        Some(Self { w, beta: (s_size / z_size).sqrt() })
    }

    #[inline]
    fn times(&self, x: &Part) -> Part {
        let w = &self.w;
        let across = w[1] * x[1] + w[2] * x[2] + w[3] * x[3];
        let along = x[0] + across / (1.0 + w[0]);
        let part = |k: usize| self.beta * (x[k] + w[k] * along);
        [self.beta * (w[0] * x[0] + across), part(1), part(2), part(3)]
    }
}

/// What is left of the equations.
struct Left {
    primal: Row,
    dual: [Part; MAX_FINGERS],
    free: f64,
    /// s · z over all cones: no t is larger by more.
    gap: f64,
}

impl Left {
    fn is_below(&self, most: f64) -> bool {
        let mut each = self.primal.iter().chain(self.dual.iter().flatten()).chain([&self.free, &self.gap]);
        each.all(|x| x.abs() < most)
    }
}

/// A direction: scaled changes of s and z, and of t and λ.
struct Direction {
    s: [Part; MAX_FINGERS],
    z: [Part; MAX_FINGERS],
    t: f64,
    lambda: Row,
}

struct Search {
    blocks: Vec<Block>,
    tangents: Vec<[Vec3; 2]>,
    b: Row,
    t: f64,
    lambda: Row,
}

impl Search {
    fn new(contacts: &[Contact]) -> Self {
        let tangents: Vec<[Vec3; 2]> = contacts.iter().map(tangents).collect();
        let one = [1.0, 0.0, 0.0, 0.0];
        let block = |(contact, tangents): (&Contact, &[Vec3; 2])| {
            let (A, scaling) = (columns(contact, tangents), Scaling { w: one, beta: 1.0 });
            Block { A, s: one, z: one, scaling, B: A, l: one }
        };
        let blocks: Vec<Block> = contacts.iter().zip(&tangents).map(block).collect();
        let b = std::array::from_fn(|row| blocks.iter().map(|block| block.A[row][0]).sum());
        Self { blocks, tangents, b, t: 0.0, lambda: [0.0; 7] }
    }

    fn left(&self) -> Left {
        let dual = [[0.0; 4]; MAX_FINGERS];
        let mut left = Left { primal: [0.0; 7], dual, free: 1.0, gap: 0.0 };
        left.primal[6] = 1.0;
        for row in 0..7 {
            left.primal[row] -= self.b[row] * self.t;
            left.free += self.b[row] * self.lambda[row];
        }
        for (block, dual) in self.blocks.iter().zip(&mut left.dual) {
            *dual = block.z;
            for row in 0..7 {
                left.primal[row] -= dot(&block.A[row], &block.s);
                add(dual, &block.A[row], self.lambda[row]);
            }
            left.gap += dot(&block.s, &block.z);
        }
        left
    }

    /// One step; `None` where numbers no longer allow one.
    fn step(&mut self, left: &Left) -> Option<()> {
        let mut square = [[0.0; 7]; 7];
        for block in &mut self.blocks {
            block.scaling = Scaling::of(&block.s, &block.z)?;
            block.l = block.scaling.times(&block.z);
            for (B, A) in block.B.iter_mut().zip(&block.A) {
                *B = block.scaling.times(A);
            }
            for i in 0..7 {
                for k in 0..=i {
                    square[i][k] += dot(&block.B[i], &block.B[k]);
                }
            }
        }
        let factor = Factor::of(square)?;
        let of_b = factor.solve(self.b);
        let count = self.blocks.len();
        let mut aim = [[0.0; 4]; MAX_FINGERS];
        for (aim, block) in aim.iter_mut().zip(&self.blocks) {
            *aim = block.l.map(|x| -x);
        }
        let first = self.direction(left, &factor, &of_b, &aim);
        let [primal, dual] = self.reach(&first).map(|reach| reach.min(1.0));
        let target = (1.0 - primal.min(dual)).powi(3) * left.gap / count as f64;
        for i in 0..count {
            let l = &self.blocks[i].l;
            let (own, both) = (product(l, l), product(&first.s[i], &first.z[i]));
            let mut right: Part = std::array::from_fn(|k| -own[k] - both[k]);
            right[0] += target;
            aim[i] = quotient(l, &right);
        }
        let way = self.direction(left, &factor, &of_b, &aim);
        let [primal, dual] = self.reach(&way).map(|reach| (SHY * reach).min(1.0));
        self.advance(left, &way, primal, dual);
        (self.t.is_finite() && self.lambda.iter().all(|x| x.is_finite())).then_some(())
    }

    /// The direction in which the scaled products are to become what `aim` says.
    fn direction(&self, left: &Left, factor: &Factor, of_b: &Row, aim: &[Part; MAX_FINGERS]) -> Direction {
        let mut right = left.primal;
        for (i, block) in self.blocks.iter().enumerate() {
            let mut sum = block.scaling.times(&left.dual[i]);
            add(&mut sum, &aim[i], 1.0);
            for row in 0..7 {
                right[row] -= dot(&block.B[row], &sum);
            }
        }
        let x = factor.solve(right);
        let t = (dot7(&self.b, &x) + left.free) / dot7(&self.b, of_b);
        let lambda: Row = std::array::from_fn(|row| x[row] - of_b[row] * t);
        let mut way = Direction { s: [[0.0; 4]; MAX_FINGERS], z: [[0.0; 4]; MAX_FINGERS], t, lambda };
        for (i, block) in self.blocks.iter().enumerate() {
            let mut z = block.scaling.times(&left.dual[i]).map(|x| -x);
            for row in 0..7 {
                add(&mut z, &block.B[row], -lambda[row]);
            }
            (way.s[i], way.z[i]) = (std::array::from_fn(|k| aim[i][k] - z[k]), z);
        }
        way
    }

    /// How far s and z may go.
    fn reach(&self, way: &Direction) -> [f64; 2] {
        let mut reach = [f64::INFINITY; 2];
        for (i, block) in self.blocks.iter().enumerate() {
            reach[0] = reach[0].min(boundary(&block.l, &way.s[i]));
            reach[1] = reach[1].min(boundary(&block.l, &way.z[i]));
        }
        reach
    }

    fn advance(&mut self, left: &Left, way: &Direction, primal: f64, dual: f64) {
        self.t += primal * way.t;
        for (lambda, change) in self.lambda.iter_mut().zip(&way.lambda) {
            *lambda += dual * change;
        }
        for (i, block) in self.blocks.iter_mut().enumerate() {
            add(&mut block.s, &block.scaling.times(&way.s[i]), primal);
            // dz = -(what is left) - Aᵀ dλ.
            let mut change = left.dual[i].map(|x| -x);
            for row in 0..7 {
                add(&mut change, &block.A[row], -way.lambda[row]);
            }
            add(&mut block.z, &change, dual);
        }
    }

    fn forces(&self, contacts: &[Contact]) -> Forces {
        let mut forces = [Force::default(); MAX_FINGERS];
        for i in 0..contacts.len() {
            let (s, [u, v]) = (&self.blocks[i].s, &self.tangents[i]);
            forces[i] = Force { normal: s[0] + self.t, tangential: u * s[1] + v * s[2], spin: s[3] };
        }
        forces
    }
}

fn tangents(contact: &Contact) -> [Vec3; 2] {
    let first = any_orthogonal(&contact.n);
    [first, contact.n.cross(&first)]
}

/// The wrenches of a contact's coordinates, and the sum's row.
fn columns(contact: &Contact, tangents: &[Vec3; 2]) -> [Part; 7] {
    let wrench =
        |normal: f64, tangential: Vec3, spin: f64| contact.wrench(&Force { normal, tangential, spin });
    let columns = [
        wrench(1.0, Vec3::zeros(), 0.0),
        wrench(0.0, tangents[0], 0.0),
        wrench(0.0, tangents[1], 0.0),
        wrench(0.0, Vec3::zeros(), 1.0),
    ];
    std::array::from_fn(|row| match row {
        6 => [1.0, 0.0, 0.0, 0.0],
        _ => columns.map(|column| column[row]),
    })
}

#[inline]
fn dot(a: &Part, b: &Part) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]
}

fn dot7(a: &Row, b: &Row) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[inline]
fn add(sum: &mut Part, x: &Part, times: f64) {
    sum.iter_mut().zip(x).for_each(|(sum, x)| *sum += x * times);
}

/// x₀² - |x₁|², in factors: near the boundary the squares cancel.
fn form(x: &Part) -> f64 {
    let across = (x[1] * x[1] + x[2] * x[2] + x[3] * x[3]).sqrt();
    (x[0] - across) * (x[0] + across)
}

/// The product of the cone's algebra.
fn product(a: &Part, b: &Part) -> Part {
    std::array::from_fn(|k| if k == 0 { dot(a, b) } else { a[0] * b[k] + b[0] * a[k] })
}

/// What times `l` is `r`.
fn quotient(l: &Part, r: &Part) -> Part {
    let across = l[1] * r[1] + l[2] * r[2] + l[3] * r[3];
    let first = (l[0] * r[0] - across) / form(l);
    std::array::from_fn(|k| if k == 0 { first } else { (r[k] - first * l[k]) / l[0] })
}

/// The smallest positive multiple of `d` with which `l`, inside the cone, comes to its boundary.
fn boundary(l: &Part, d: &Part) -> f64 {
    let bilinear = |a: &Part, b: &Part| 2.0 * a[0] * b[0] - dot(a, b);
    let (constant, slope, curve) = (form(l), bilinear(l, d), bilinear(d, d));
    let root = slope * slope - curve * constant;
    let down = if root > 0.0 { root.sqrt() - slope } else { -slope };
    if root >= 0.0 && down > 0.0 { constant / down } else { f64::INFINITY }
}

/// L D Lᵀ of seven rows.
struct Factor {
    lower: [[f64; 7]; 7],
    inverse: Row,
}

impl Factor {
    fn of(mut lower: [[f64; 7]; 7]) -> Option<Self> {
        let (mut pivots, mut inverse) = ([0.0; 7], [0.0; 7]);
        for j in 0..7 {
            let scaled: Row = std::array::from_fn(|k| lower[j][k] * pivots[k]);
            let whole = lower[j][j];
            let pivot = whole - (0..j).map(|k| lower[j][k] * scaled[k]).sum::<f64>();
            // Of what rounding leaves nothing can be said.
            if pivot.is_nan() || pivot <= 1e-13 * whole {
                return None;
            }
            (pivots[j], inverse[j]) = (pivot, 1.0 / pivot);
            for row in &mut lower[j + 1..] {
                let entry = row[j] - (0..j).map(|k| row[k] * scaled[k]).sum::<f64>();
                row[j] = entry * inverse[j];
            }
        }
        Some(Self { lower, inverse })
    }

    fn solve(&self, mut x: Row) -> Row {
        for i in 1..7 {
            for k in 0..i {
                x[i] -= x[k] * self.lower[i][k];
            }
        }
        (0..7).for_each(|i| x[i] *= self.inverse[i]);
        for i in (0..6).rev() {
            for k in i + 1..7 {
                x[i] -= x[k] * self.lower[k][i];
            }
        }
        x
    }
}

#[cfg(test)]
mod tests {
    use super::super::{force, socp};
    use super::*;
    use regrasp_api::Random;

    #[test]
    fn the_forces_are_as_good_as_those_of_the_general_solver() {
        let mut random = Random::from_key(17, 0, 0, 0);
        let (mut found, mut stable) = (0, 0);
        for round in 0..400 {
            let (count, mu) = (3 + round % 3, 0.3 + 0.7 * random.unit());
            let gamma = if round % 4 == 0 { 0.2 } else { 0.0 };
            let drag = if round % 5 == 0 { 0.05 } else { 0.0 };
            let contact = |random: &mut Random| {
                let n = -(random.direction() * 0.4 + random.direction()).normalize();
                let more = (round % 7 == 0).then(|| (any_orthogonal(&n), 0.2));
                Contact { r: random.direction(), n, mu, gamma, drag, more }
            };
            let contacts: Vec<Contact> = (0..count).map(|_| contact(&mut random)).collect();
            let Some((_, best)) = socp::best_forces(&contacts) else { continue };
            stable += usize::from(best > 1e-4);
            let Some(forces) = best_forces(&contacts) else { continue };
            found += 1;
            let proof = force::prove(&contacts, &forces).expect("a force of positive slack proves closure");
            assert!((proof.slack - best).abs() < 1e-6, "{} {best}", proof.slack);
        }
        assert!(stable > 80 && found > stable * 9 / 10, "{found} of {stable}");
    }

    #[test]
    fn what_does_not_close_is_left_to_the_general_solver() {
        let contact = |p: Vec3, n: Vec3| Contact { r: p, n, mu: 0.5, gamma: 0.0, drag: 0.0, more: None };
        let (x, y, z) = (Vec3::x(), Vec3::y(), Vec3::z());
        assert!(best_forces(&[]).is_none());
        assert!(best_forces(&[contact(x, -x), contact(-x, x)]).is_none());
        let face = [x, y, -x - y].map(|p| contact(p * 0.5 + z, -z));
        assert!(best_forces(&face).is_none());
    }
}
