//! A chain of points on a surface, pulled tight: half the sum of its squared lengths is made least by
//! Newton's method.

use super::Smooth;
use regrasp_api::{Vec3, any_orthogonal};

/// Links of a chain; even, so that its middle is one of its points.
const LINKS: usize = 16;
/// Links of a chain that is only measured.
const ROUGH: usize = 12;
/// Newton steps; half a dozen are common.
const STEPS: usize = 40;
/// The chain is tight when no point moves by more than this share of a link.
const TIGHT: f64 = 1e-3;

/// Points from one end to the other.
#[derive(Clone, Debug)]
pub(super) struct Chain([Vec3; LINKS + 1]);

/// A 2 × 2 matrix by rows.
type Block = [[f64; 2]; 2];
/// Coordinates in a point's tangent plane (m).
type Pair = [f64; 2];

fn product(a: &Block, b: &Block) -> Block {
    std::array::from_fn(|i| std::array::from_fn(|j| a[i][0] * b[0][j] + a[i][1] * b[1][j]))
}

fn times(a: &Block, v: &Pair) -> Pair {
    std::array::from_fn(|i| a[i][0] * v[0] + a[i][1] * v[1])
}

fn transposed(a: &Block) -> Block {
    [[a[0][0], a[1][0]], [a[0][1], a[1][1]]]
}

/// The inverse of a symmetric block; `None` where it is not positive definite.
fn inverse(a: &Block) -> Option<Block> {
    let determinant = a[0][0] * a[1][1] - a[0][1] * a[1][0];
    let definite = a[0][0] > 1e-9 && determinant > 1e-9;
    definite.then(|| {
        [[a[1][1] / determinant, -a[0][1] / determinant], [-a[1][0] / determinant, a[0][0] / determinant]]
    })
}

impl Chain {
    /// The length (m) of a coarse chain.
    pub fn rough(at: impl Fn(f64) -> Vec3) -> f64 {
        let points: [Vec3; ROUGH + 1] = std::array::from_fn(|i| at(i as f64 / ROUGH as f64));
        points.windows(2).map(|pair| (pair[1] - pair[0]).norm()).sum()
    }

    /// The chain through `at`, pulled tight as far as it goes.
    pub fn pulled(surface: &impl Smooth, a: &Vec3, b: &Vec3, at: impl Fn(f64) -> Vec3) -> Self {
        let mut points = std::array::from_fn(|i| at(i as f64 / LINKS as f64));
        (points[0], points[LINKS]) = (*a, *b);
        let mut chain = Self(points);
        let mut energy = chain.energy();
        for _ in 0..STEPS {
            let Some(moves) = chain.newton(surface, true).or_else(|| chain.newton(surface, false)) else {
                break;
            };
            let link = (2.0 * energy / LINKS as f64).sqrt();
            let largest = moves.iter().map(Vec3::norm).fold(0.0, f64::max);
            let mut share = (2.0 * link / largest).min(1.0);
            let shorter = (0..10).find_map(|_| {
                let next = chain.moved(surface, &moves, share);
                share /= 2.0;
                (next.energy() <= energy && next.holds(surface)).then_some(next)
            });
            let Some(next) = shorter else { break };
            (chain, energy) = (next.clone(), next.energy());
            if largest < TIGHT * link {
                break;
            }
        }
        chain
    }

    /// Length (m).
    pub fn length(&self) -> f64 {
        self.0.windows(2).map(|pair| (pair[1] - pair[0]).norm()).sum()
    }

    /// The tangent direction in which the chain begins.
    pub fn direction(&self, surface: &impl Smooth) -> Vec3 {
        let (n, first) = (surface.normal(&self.0[0]), self.0[1] - self.0[0]);
        let flat = first - n * n.dot(&first);
        flat.try_normalize(0.0).unwrap_or_else(|| any_orthogonal(&n))
    }

    /// Whether no link is a short cut through a thin solid.
    fn holds(&self, surface: &impl Smooth) -> bool {
        self.0.windows(2).all(|pair| surface.joins(&pair[0], &pair[1]))
    }

    fn energy(&self) -> f64 {
        self.0.windows(2).map(|pair| (pair[1] - pair[0]).norm_squared()).sum::<f64>() / 2.0
    }

    fn moved(&self, surface: &impl Smooth, moves: &[Vec3; LINKS + 1], share: f64) -> Self {
        let mut next = self.clone();
        for (point, change) in next.0[1..LINKS].iter_mut().zip(&moves[1..LINKS]) {
            *point = surface.onto(&(*point + change * share));
        }
        next
    }

    /// Newton's step in the tangent planes: blocks 2 I - (g·n) II on the diagonal, -TᵀT beside it, solved
    /// from end to end.
    ///
    /// g = 2 xᵢ - xᵢ₋₁ - xᵢ₊₁; II is the second fundamental form. Without it (`full` false) the matrix is
    /// definite, and convergence linear. `None` where the matrix is not definite.
    fn newton(&self, surface: &impl Smooth, full: bool) -> Option<[Vec3; LINKS + 1]> {
        let x = &self.0;
        let normals: [Vec3; LINKS + 1] = std::array::from_fn(|i| surface.normal(&x[i]));
        let planes: [[Vec3; 2]; LINKS + 1] = std::array::from_fn(|i| {
            let first = any_orthogonal(&normals[i]);
            [first, normals[i].cross(&first)]
        });
        let beside = |i: usize, j: usize| -> Block {
            std::array::from_fn(|k| std::array::from_fn(|l| -planes[i][k].dot(&planes[j][l])))
        };
        let mut inverses = [[[0.0; 2]; 2]; LINKS + 1];
        let mut right = [[0.0; 2]; LINKS + 1];
        for i in 1..LINKS {
            let pull = x[i - 1] + x[i + 1] - x[i] * 2.0;
            let mut block = [[2.0, 0.0], [0.0, 2.0]];
            if full {
                let turned = planes[i].map(|t| surface.turning(&x[i], &t));
                let press = pull.dot(&normals[i]);
                (0..4).for_each(|k| block[k / 2][k % 2] += press * planes[i][k / 2].dot(&turned[k % 2]));
            }
            right[i] = planes[i].map(|t| t.dot(&pull));
            if i > 1 {
                let back = product(&transposed(&beside(i - 1, i)), &inverses[i - 1]);
                let (less, carried) = (product(&back, &beside(i - 1, i)), times(&back, &right[i - 1]));
                (0..4).for_each(|k| block[k / 2][k % 2] -= less[k / 2][k % 2]);
                (0..2).for_each(|k| right[i][k] -= carried[k]);
            }
            inverses[i] = inverse(&block)?;
        }
        let mut moves = [Vec3::zeros(); LINKS + 1];
        let mut after = [0.0; 2];
        for i in (1..LINKS).rev() {
            if i + 1 < LINKS {
                let carried = times(&beside(i, i + 1), &after);
                (0..2).for_each(|k| right[i][k] -= carried[k]);
            }
            after = times(&inverses[i], &right[i]);
            moves[i] = planes[i][0] * after[0] + planes[i][1] * after[1];
        }
        Some(moves)
    }
}
