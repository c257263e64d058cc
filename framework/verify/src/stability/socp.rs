//! The best internal force of a grasp, found by an interior-point solver.

use super::edges::Edges;
use super::force::{Contact, Force, Forces};
use super::held::Held;
use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettings, DefaultSolver, IPSolver, SolverStatus, SupportedConeT};
use nalgebra::Vector6;
use regrasp_api::{MAX_FINGERS, Vec3, any_orthogonal};

/// Variables of one contact: normal, two tangential, torsional.
const OF_CONTACT: usize = 4;

/// Maximises the slack t over all forces y with G y = 0, Σ normal = 1 and normal - t ≥ |(tangential,
/// torsional)| for each contact, by Clarabel (Goulart and Chen, "Clarabel: an interior-point solver for conic
/// programs with quadratic objectives", 2024).
///
/// Returns the forces and t, which still have to be checked, whatever the solver thinks of them; `None` where
/// it finds none.
pub(crate) fn best_forces(contacts: &[Contact]) -> Option<(Forces, f64)> {
    let variables = OF_CONTACT * contacts.len() + 1;
    let tangents: Vec<[Vec3; 2]> = contacts.iter().map(tangents).collect();
    let mut problem = Problem::new(variables);
    problem.balance(contacts, &tangents, &Vector6::zeros());
    problem.sum_to_one(contacts.len());
    problem.cones(contacts.len());
    Some(forces_of(&problem.solve()?, &tangents))
}

/// Maximises the slack t over all forces y with G y = `wanted`, normal ≤ 1 - t and normal - t ≥ |(tangential,
/// torsional)| for each contact.
pub(crate) fn best_forces_for(contacts: &[Contact], wanted: &Vector6<f64>) -> Option<(Forces, f64)> {
    let tangents: Vec<[Vec3; 2]> = contacts.iter().map(tangents).collect();
    let mut problem = Problem::new(OF_CONTACT * contacts.len() + 1);
    problem.balance(contacts, &tangents, wanted);
    problem.at_most_one(contacts.len());
    problem.cones(contacts.len());
    Some(forces_of(&problem.solve()?, &tangents))
}

/// The same within the joints' efforts: ± effort + t ≤ 1 for each joint, normal + t ≤ `most` where there is
/// one, t ≤ 1; forces over `unit` (N).
pub(crate) fn best_within(
    held: &Held,
    length: f64,
    unit: f64,
    most: Option<f64>,
    wanted: &Vector6<f64>,
) -> Option<(Forces, f64)> {
    let contacts = &held.contacts[..];
    let tangents: Vec<[Vec3; 2]> = contacts.iter().map(tangents).collect();
    let mut problem = Problem::new(OF_CONTACT * contacts.len() + 1);
    problem.balance(contacts, &tangents, wanted);
    problem.within(held, &tangents, (length, unit), most);
    problem.cones(contacts.len());
    Some(forces_of(&problem.solve()?, &tangents))
}

/// The shares λ ≥ t, Σ λ = 1, with Σ λ times the columns zero, that have the largest t.
pub(crate) fn best_shares(columns: &[Vector6<f64>]) -> Option<Vec<f64>> {
    let count = columns.len();
    let mut problem = Problem::new(count + 1);
    for (j, column) in columns.iter().enumerate() {
        (0..6).for_each(|axis| problem.set(axis, j, column[axis]));
        problem.set(6, j, 1.0);
        // -λ + t + s = 0 with s ≥ 0.
        problem.set(7 + j, j, -1.0);
        problem.set(7 + j, count, 1.0);
    }
    problem.b = vec![0.0; 7 + count];
    problem.b[6] = 1.0;
    problem.cones = vec![SupportedConeT::ZeroConeT(7), SupportedConeT::NonnegativeConeT(count)];
    let mut solution = problem.solve()?;
    solution.truncate(count);
    Some(solution)
}

/// The weights λ ≥ t of each contact's edges, with Σ λ + t ≤ 1 at each contact and the wanted wrench, that
/// have the largest t.
pub(crate) fn best_weights(columns: &[Vec<Vector6<f64>>], wanted: &Vector6<f64>) -> Option<Vec<f64>> {
    let count: usize = columns.iter().map(Vec::len).sum();
    let mut problem = Problem::new(count + 1);
    problem.b.extend(wanted.iter());
    problem.cones.push(SupportedConeT::ZeroConeT(6));
    let mut j = 0;
    for (i, columns) in columns.iter().enumerate() {
        for column in columns {
            (0..6).for_each(|axis| problem.set(axis, j, column[axis]));
            problem.set(6 + i, j, 1.0);
            j += 1;
        }
        problem.set(6 + i, count, 1.0);
        problem.b.push(1.0);
    }
    for j in 0..count {
        let row = problem.b.len();
        problem.set(row, j, -1.0);
        problem.set(row, count, 1.0);
        problem.b.push(0.0);
    }
    problem.cones.push(SupportedConeT::NonnegativeConeT(columns.len() + count));
    let mut solution = problem.solve()?;
    solution.truncate(count);
    Some(solution)
}

/// The same within the joints' efforts: weights λ ≥ t, ± effort + t ≤ 1 for each joint, Σ λ + t ≤ `most` at
/// each contact where there is one, t ≤ 1.
pub(super) fn best_weights_within(
    contacts: &[Edges],
    most: Option<f64>,
    wanted: &Vector6<f64>,
) -> Option<Vec<f64>> {
    let count: usize = contacts.iter().map(|contact| contact.columns.len()).sum();
    let mut problem = Problem::new(count + 1);
    problem.b.extend(wanted.iter());
    problem.cones.push(SupportedConeT::ZeroConeT(6));
    let mut first = 0;
    for contact in contacts {
        let own = contact.columns.len();
        for (j, column) in contact.columns.iter().enumerate() {
            (0..6).for_each(|axis| problem.set(axis, first + j, column[axis]));
            problem.at_most(0.0, [(first + j, -1.0)]);
        }
        for effort in &contact.efforts {
            for sign in [1.0, -1.0] {
                problem.at_most(1.0, effort.iter().enumerate().map(|(j, share)| (first + j, sign * share)));
            }
        }
        if let Some(most) = most {
            problem.at_most(most, (0..own).map(|j| (first + j, 1.0)));
        }
        first += own;
    }
    problem.at_most(1.0, []);
    problem.cones.push(SupportedConeT::NonnegativeConeT(problem.b.len() - 6));
    let mut solution = problem.solve()?;
    solution.truncate(count);
    Some(solution)
}

fn forces_of(solution: &[f64], tangents: &[[Vec3; 2]]) -> (Forces, f64) {
    let mut forces = [Force::default(); MAX_FINGERS];
    for (i, force) in forces.iter_mut().take(tangents.len()).enumerate() {
        let y = &solution[OF_CONTACT * i..];
        let tangential = tangents[i][0] * y[1] + tangents[i][1] * y[2];
        *force = Force { normal: y[0], tangential, spin: y[3] };
    }
    (forces, solution[OF_CONTACT * tangents.len()])
}

fn tangents(contact: &Contact) -> [Vec3; 2] {
    let first = any_orthogonal(&contact.n);
    [first, contact.n.cross(&first)]
}

/// min qᵀx subject to A x + s = b, s in the cones.
struct Problem {
    rows: Vec<usize>,
    columns: Vec<usize>,
    values: Vec<f64>,
    b: Vec<f64>,
    cones: Vec<SupportedConeT<f64>>,
    variables: usize,
}

impl Problem {
    fn new(variables: usize) -> Self {
        Self { rows: vec![], columns: vec![], values: vec![], b: vec![], cones: vec![], variables }
    }

    fn set(&mut self, row: usize, column: usize, value: f64) {
        if value != 0.0 {
            self.rows.push(row);
            self.columns.push(column);
            self.values.push(value);
        }
    }

    /// One more row of the nonnegative cone: the terms and t sum to at most `bound`.
    fn at_most(&mut self, bound: f64, terms: impl IntoIterator<Item = (usize, f64)>) {
        let (row, t) = (self.b.len(), self.variables - 1);
        terms.into_iter().for_each(|(column, value)| self.set(row, column, value));
        self.set(row, t, 1.0);
        self.b.push(bound);
    }

    /// Rows 0 to 5: the forces' wrench is `wanted`.
    fn balance(&mut self, contacts: &[Contact], tangents: &[[Vec3; 2]], wanted: &Vector6<f64>) {
        for (i, (contact, tangents)) in contacts.iter().zip(tangents).enumerate() {
            let [u, v] = tangents.map(|tangent| contact.stretch(&tangent));
            let forces = [contact.n, u, v, Vec3::zeros()];
            for (k, force) in forces.iter().enumerate() {
                let mut torque = contact.r.cross(force);
                match k {
                    0 => torque += contact.n * contact.drag,
                    3 => torque = contact.n * contact.gamma,
                    _ => {}
                }
                for axis in 0..3 {
                    self.set(axis, OF_CONTACT * i + k, force[axis]);
                    self.set(3 + axis, OF_CONTACT * i + k, torque[axis]);
                }
            }
        }
        self.b.extend(wanted.iter());
        self.cones.push(SupportedConeT::ZeroConeT(6));
    }

    /// The normal forces sum to 1.
    fn sum_to_one(&mut self, count: usize) {
        let row = self.b.len();
        (0..count).for_each(|i| self.set(row, OF_CONTACT * i, 1.0));
        self.b.push(1.0);
        self.cones.push(SupportedConeT::ZeroConeT(1));
    }

    /// normal + t ≤ 1 for each contact.
    fn at_most_one(&mut self, count: usize) {
        let (row, t) = (self.b.len(), self.variables - 1);
        for i in 0..count {
            self.set(row + i, OF_CONTACT * i, 1.0);
            self.set(row + i, t, 1.0);
            self.b.push(1.0);
        }
        self.cones.push(SupportedConeT::NonnegativeConeT(count));
    }

    /// Efforts, normal forces and t within their bounds.
    fn within(&mut self, held: &Held, tangents: &[[Vec3; 2]], (length, unit): (f64, f64), most: Option<f64>) {
        let (first, t) = (self.b.len(), self.variables - 1);
        for (i, (contact, rows)) in held.contacts.iter().zip(&held.rows).enumerate() {
            for row in rows {
                let (normal, tangential, spin) = row.of(contact, length, unit);
                let [u, v] = tangents[i].map(|tangent| tangential.dot(&tangent));
                for sign in [1.0, -1.0] {
                    let place = self.b.len();
                    for (k, value) in [normal, u, v, spin].into_iter().enumerate() {
                        self.set(place, OF_CONTACT * i + k, sign * value);
                    }
                    self.set(place, t, 1.0);
                    self.b.push(1.0);
                }
            }
            if let Some(most) = most {
                let place = self.b.len();
                self.set(place, OF_CONTACT * i, 1.0);
                self.set(place, t, 1.0);
                self.b.push(most);
            }
        }
        let place = self.b.len();
        self.set(place, t, 1.0);
        self.b.push(1.0);
        self.cones.push(SupportedConeT::NonnegativeConeT(self.b.len() - first));
    }

    /// For each contact: (normal - t, tangential, torsional) in the second-order cone.
    fn cones(&mut self, count: usize) {
        let t = self.variables - 1;
        for i in 0..count {
            let row = self.b.len();
            self.set(row, t, 1.0);
            for k in 0..OF_CONTACT {
                self.set(row + k, OF_CONTACT * i + k, -1.0);
            }
            self.b.extend([0.0; OF_CONTACT]);
            self.cones.push(SupportedConeT::SecondOrderConeT(OF_CONTACT));
        }
    }

    fn solve(self) -> Option<Vec<f64>> {
        let n = self.variables;
        let P = CscMatrix::zeros((n, n));
        let A = CscMatrix::new_from_triplets(self.b.len(), n, self.rows, self.columns, self.values);
        let mut q = vec![0.0; n];
        q[n - 1] = -1.0;
        let settings = DefaultSettings { verbose: false, ..Default::default() };
        let mut solver = DefaultSolver::new(&P, &q, &A, &self.b, &self.cones, settings).ok()?;
        solver.solve();
        // Where rounding stops the solver short of its own tolerances, its last iterate is nearly the best:
        // the caller checks whatever comes from here.
        let good = matches!(
            solver.solution.status,
            SolverStatus::Solved
                | SolverStatus::AlmostSolved
                | SolverStatus::InsufficientProgress
                | SolverStatus::NumericalError
                | SolverStatus::MaxIterations
        );
        (good && solver.solution.x.iter().all(|x| x.is_finite())).then_some(solver.solution.x)
    }
}
