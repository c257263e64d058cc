//! Inverse kinematics of one finger: which joints, by which method.

mod numeric;
mod parallel;
mod range;
mod spare;
mod triple;

pub(super) use range::JointRange;
pub(super) use spare::Conditioning;
pub(super) use triple::Triple;

use super::chain::FingerChain;
use super::coupling;
use nalgebra::Matrix3;
use parallel::{Lone, Parallel};
use regrasp_api::{FingerJoints, JointKind, Vec3};

/// How the three joints are solved for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Method {
    /// Closed form: two of three revolute joints are parallel.
    Parallel(Lone),
    /// Closed form: three prismatic joints.
    Prismatic,
    /// Levenberg-Marquardt.
    Numeric,
}

/// What can be prepared where no joint is spare.
#[derive(Clone, Debug)]
enum Solver {
    Parallel(Parallel),
    /// The inverse of the matrix of the axes, and the tip at 0.
    Prismatic(Matrix3<f64>, Vec3),
    Numeric(Triple),
}

/// Inverse kinematics of one finger.
#[derive(Clone, Debug)]
pub(super) struct Inverse {
    /// The joints that are solved for, ascending.
    solved: [usize; 3],
    method: Method,
    ranges: [JointRange; 3],
    rest: [f64; 3],
    /// The solver, where no joint is spare.
    prepared: Option<Solver>,
}

impl Inverse {
    /// Chooses the joints and the method.
    pub fn new(
        chain: &FingerChain,
        ranges: &[JointRange],
        rest: &FingerJoints,
    ) -> Result<Self, Conditioning> {
        let (solved, method) = spare::choose(chain, ranges)?;
        let mut inverse = Self {
            solved,
            method,
            ranges: solved.map(|joint| ranges[joint]),
            rest: solved.map(|joint| rest[joint]),
            prepared: None,
        };
        if rest.len() == 3 && chain.couplings.is_empty() {
            inverse.prepared = inverse.solver(Triple::new(chain, &solved, rest));
        }
        Ok(inverse)
    }

    /// The joints that are solved for, ascending.
    pub fn solved(&self) -> [usize; 3] {
        self.solved
    }

    /// Whether the solution is in closed form.
    pub fn is_closed_form(&self) -> bool {
        self.method != Method::Numeric
    }

    fn solver(&self, triple: Triple) -> Option<Solver> {
        Some(match self.method {
            Method::Parallel(lone) => Solver::Parallel(Parallel::new(&triple, lone)),
            Method::Prismatic => {
                let axes = Matrix3::from_columns(&triple.screws.map(|screw| screw.axis));
                Solver::Prismatic(axes.try_inverse()?, triple.p0)
            }
            Method::Numeric => Solver::Numeric(triple),
        })
    }

    /// Joint positions that put the fingertip at `p_HF` (m), the spare ones as in `near`.
    #[inline]
    pub fn solve(&self, chain: &FingerChain, p_HF: &Vec3, near: &FingerJoints) -> Option<FingerJoints> {
        let found = match &self.prepared {
            _ if !chain.couplings.is_empty() => self.solve_coupled(chain, p_HF, near)?,
            Some(solver) => self.run(solver, p_HF, near)?,
            None => self.run(&self.solver(Triple::new(chain, &self.solved, near))?, p_HF, near)?,
        };
        let mut joints = *near;
        for (&joint, q) in self.solved.iter().zip(found) {
            joints[joint] = q;
        }
        coupling::settle(&chain.couplings, &mut joints);
        Some(joints)
    }

    /// Levenberg-Marquardt on the whole chain: a driven joint moves with its driver, so no three screws tell
    /// the motion.
    fn solve_coupled(&self, chain: &FingerChain, p_HF: &Vec3, near: &FingerJoints) -> Option<[f64; 3]> {
        let tip_jacobian = |q: &[f64; 3]| {
            let mut joints = *near;
            self.solved.iter().zip(q).for_each(|(&joint, &q)| joints[joint] = q);
            let tip = chain.tip_kinematics(&joints);
            (tip.p_HF, Matrix3::from_columns(&self.solved.map(|joint| tip.J_v.column(joint).into_owned())))
        };
        let near = self.solved.map(|joint| near[joint]);
        numeric::solve(&tip_jacobian, p_HF, &self.ranges, &near, &self.rest)
    }

    #[inline]
    fn run(&self, solver: &Solver, p: &Vec3, near: &FingerJoints) -> Option<[f64; 3]> {
        let near = self.solved.map(|joint| near[joint]);
        match solver {
            Solver::Parallel(parallel) => parallel.solve(p, &self.ranges, &near),
            Solver::Prismatic(inverse, p0) => {
                let q = inverse * (p - p0);
                Some([self.ranges[0].fit(q.x)?, self.ranges[1].fit(q.y)?, self.ranges[2].fit(q.z)?])
            }
            Solver::Numeric(triple) => {
                numeric::solve(&|q| triple.tip_jacobian(q), p, &self.ranges, &near, &self.rest)
            }
        }
    }
}

/// Which method solves the chain in closed form, if any.
fn method(triple: &Triple) -> Method {
    if triple.screws.iter().all(|screw| screw.kind == JointKind::Prismatic) {
        return Method::Prismatic;
    }
    Lone::find(triple).map_or(Method::Numeric, Method::Parallel)
}

/// The best solution so far: the closest to `near`, by the sum of squares.
struct Choice<'a> {
    near: &'a [f64; 3],
    best: [f64; 3],
    distance: f64,
}

impl<'a> Choice<'a> {
    fn new(near: &'a [f64; 3]) -> Self {
        Self { near, best: [0.0; 3], distance: f64::INFINITY }
    }

    #[inline]
    fn offer(&mut self, q: [f64; 3]) {
        let distance = q.iter().zip(self.near).map(|(a, b)| (a - b) * (a - b)).sum();
        if distance < self.distance {
            (self.best, self.distance) = (q, distance);
        }
    }

    fn taken(self) -> Option<[f64; 3]> {
        (self.distance < f64::INFINITY).then_some(self.best)
    }
}
