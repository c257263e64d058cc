//! Which forces the fingers exert: the grip that is farthest from slipping, by a small conic program.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettings, DefaultSolver, IPSolver, SolverStatus, SupportedConeT};
use nalgebra::{Matrix6, Vector6};
use regrasp_api::{FingerIndex, FingerJoints, Vec3, any_orthogonal};

/// One finger's contact, as the program sees it; all vectors in one frame.
#[derive(Clone, Debug)]
pub(crate) struct GripContact {
    /// The finger that touches.
    pub finger: FingerIndex,
    /// The contact point from the object's centre of mass (m).
    pub r: Vec3,
    /// The outward unit normal.
    pub n: Vec3,
    /// For each joint the velocity of the fingertip's material point at the contact per joint speed (m/rad; m/m).
    pub columns: Vec<Vec3>,
    /// For each joint the largest effort (N·m; N) that the grasp may take.
    pub efforts: Vec<f64>,
}

impl GripContact {
    /// The joints' efforts (N·m; N) that exert a force (N) on the object.
    pub fn efforts_of(&self, force: &Vec3) -> FingerJoints {
        let mut efforts = FingerJoints::zeros(self.columns.len());
        efforts.iter_mut().zip(&self.columns).for_each(|(effort, column)| *effort = column.dot(force));
        efforts
    }

    /// Whether a force is within the bounds of normal force and efforts, a hundredth above them included.
    pub fn allows(&self, force: &Vec3, most: f64) -> bool {
        let mut joints = self.columns.iter().zip(&self.efforts);
        -self.n.dot(force) <= 1.01 * most
            && joints.all(|(column, effort)| column.dot(force).abs() <= 1.01 * effort)
    }
}

/// The forces of all contacts *on the object* (N), in the order of the contacts.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Grip {
    pub forces: Vec<Vec3>,
    /// The smallest distance of a force from its cone's boundary: μ f_n - |f_t| (N).
    pub margin: f64,
}

/// Weight of the squared forces (1/N) against the margin: small enough to leave the margin nearly best, large enough to make
/// the forces unique and continuous along a motion.
const REGULARISATION: f64 = 1e-3;
/// Most normal force (N) where only the joints' efforts bound it.
const UNBOUNDED: f64 = 1e3;
/// Length (m) by which rows of torque are divided, so that they compare with forces.
const LENGTH: f64 = 0.03;

/// Maximises t - ε/2 |f|² over the forces f with μ f_n - |f_t| ≥ t at each contact, Σ f = -`load_f`, Σ r × f = 0, f_n ≤ `most` (if given) and
/// joint efforts |Jᵀ f| within theirs; `None` where no forces do. A margin of 0 or less
/// says that none do so inside the cones.
///
/// In the manner of Boyd and Wegbreit, "Fast computation of optimal contact forces", T-RO 2007; solved by Clarabel (Goulart and Chen,
/// "Clarabel: an interior-point solver for conic programs with quadratic objectives", 2024).
pub(crate) fn best_grip(contacts: &[GripContact], mu: f64, load: &Vec3, most: Option<f64>) -> Option<Grip> {
    let mut program = Program::new(3 * contacts.len() + 1);
    let bases: Vec<[Vec3; 3]> = contacts.iter().map(|contact| basis(&contact.n)).collect();
    program.balance(contacts, &bases, load);
    program.bounds(contacts, &bases, most);
    program.cones(contacts.len(), mu);
    let x = program.solve()?;
    let force = |(i, basis): (usize, &[Vec3; 3])| (0..3).map(|k| basis[k] * x[3 * i + k]).sum();
    let forces: Vec<Vec3> = bases.iter().enumerate().map(force).collect();
    let margin = margin(contacts, &forces, mu);
    margin.is_finite().then_some(Grip { forces, margin })
}

/// The smallest distance of a force from its cone's boundary (N).
pub(crate) fn margin(contacts: &[GripContact], forces: &[Vec3], mu: f64) -> f64 {
    let each = contacts.iter().zip(forces).map(|(contact, force)| {
        let normal = -contact.n.dot(force);
        mu * normal - (force + contact.n * normal).norm()
    });
    each.fold(f64::INFINITY, f64::min)
}

/// The forces of least norm with the resultant (force, and torque over [`LENGTH`]) that `forces` and the load `load` (N, at the origin of the
/// lever arms) leave over: taken away, they balance. `None` for a grasp whose map has no full rank.
pub(crate) fn residual_forces(contacts: &[GripContact], forces: &[Vec3], load: &Vec3) -> Option<Vec<Vec3>> {
    let mut gram = Matrix6::zeros();
    let mut left = Vector6::zeros();
    left.fixed_rows_mut::<3>(0).copy_from(load);
    for (contact, force) in contacts.iter().zip(forces) {
        for (k, &along) in force.iter().enumerate() {
            let column = wrench(&contact.r, &Vec3::ith(k, 1.0));
            gram += column * column.transpose();
            left += column * along;
        }
    }
    let factor = gram.cholesky()?;
    // A pivot that is rounding: the contacts leave a direction without force.
    let pivots = factor.l_dirty().diagonal();
    if pivots.min() < 1e-6 * pivots.max() {
        return None;
    }
    let weights = factor.solve(&left);
    let change =
        |contact: &GripContact| Vec3::from_fn(|k, _| wrench(&contact.r, &Vec3::ith(k, 1.0)).dot(&weights));
    Some(contacts.iter().map(change).collect())
}

fn wrench(r: &Vec3, force: &Vec3) -> Vector6<f64> {
    let torque = r.cross(force) / LENGTH;
    Vector6::new(force.x, force.y, force.z, torque.x, torque.y, torque.z)
}

/// Inward normal and two tangents.
fn basis(n: &Vec3) -> [Vec3; 3] {
    let tangent = any_orthogonal(n);
    [-n, tangent, n.cross(&tangent)]
}

/// min ½ xᵀP x + qᵀx subject to A x + s = b, s in the cones; x = (f_n, f_t1, f_t2 of each contact, t).
struct Program {
    rows: Vec<usize>,
    columns: Vec<usize>,
    values: Vec<f64>,
    b: Vec<f64>,
    cones: Vec<SupportedConeT<f64>>,
    variables: usize,
}

impl Program {
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

    fn balance(&mut self, contacts: &[GripContact], bases: &[[Vec3; 3]], load: &Vec3) {
        for (i, (contact, basis)) in contacts.iter().zip(bases).enumerate() {
            for (k, axis) in basis.iter().enumerate() {
                let torque = contact.r.cross(axis) / LENGTH;
                for row in 0..3 {
                    self.set(row, 3 * i + k, axis[row]);
                    self.set(3 + row, 3 * i + k, torque[row]);
                }
            }
        }
        self.b.extend([-load.x, -load.y, -load.z, 0.0, 0.0, 0.0]);
        self.cones.push(SupportedConeT::ZeroConeT(6));
    }

    /// f_n ≤ most; ±Jᵀf ≤ effort.
    fn bounds(&mut self, contacts: &[GripContact], bases: &[[Vec3; 3]], most: Option<f64>) {
        let first = self.b.len();
        for (i, (contact, basis)) in contacts.iter().zip(bases).enumerate() {
            // A program whose forces nothing bounds would have no best answer.
            self.set(self.b.len(), 3 * i, 1.0);
            self.b.push(most.unwrap_or(UNBOUNDED));
            for (column, &effort) in contact.columns.iter().zip(&contact.efforts) {
                for sign in [1.0, -1.0] {
                    let row = self.b.len();
                    for (k, axis) in basis.iter().enumerate() {
                        self.set(row, 3 * i + k, sign * column.dot(axis));
                    }
                    self.b.push(effort);
                }
            }
        }
        self.cones.push(SupportedConeT::NonnegativeConeT(self.b.len() - first));
    }

    /// (μ f_n - t, f_t) in the second-order cone.
    fn cones(&mut self, count: usize, mu: f64) {
        let t = self.variables - 1;
        for i in 0..count {
            let row = self.b.len();
            self.set(row, 3 * i, -mu);
            self.set(row, t, 1.0);
            self.set(row + 1, 3 * i + 1, -1.0);
            self.set(row + 2, 3 * i + 2, -1.0);
            self.b.extend([0.0; 3]);
            self.cones.push(SupportedConeT::SecondOrderConeT(3));
        }
    }

    fn solve(self) -> Option<Vec<f64>> {
        let n = self.variables;
        let diagonal: Vec<usize> = (0..n - 1).collect();
        let P = CscMatrix::new_from_triplets(n, n, diagonal.clone(), diagonal, vec![REGULARISATION; n - 1]);
        let A = CscMatrix::new_from_triplets(self.b.len(), n, self.rows, self.columns, self.values);
        let mut q = vec![0.0; n];
        q[n - 1] = -1.0;
        let settings = DefaultSettings { verbose: false, ..Default::default() };
        let mut solver = DefaultSolver::new(&P, &q, &A, &self.b, &self.cones, settings).ok()?;
        solver.solve();
        let good = matches!(solver.solution.status, SolverStatus::Solved | SolverStatus::AlmostSolved);
        (good && solver.solution.x.iter().all(|x| x.is_finite())).then_some(solver.solution.x)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn contact(finger: u8, n: Vec3) -> GripContact {
        let n = n.normalize();
        GripContact { finger: FingerIndex(finger), r: n * 0.03, n, columns: vec![], efforts: vec![] }
    }

    fn ring() -> Vec<GripContact> {
        [Vec3::x(), Vec3::y(), -Vec3::x(), -Vec3::y()]
            .into_iter()
            .zip(0..)
            .map(|(n, i)| contact(i, n))
            .collect()
    }

    #[test]
    fn a_ring_of_contacts_shares_the_weight_and_takes_the_best_margin() {
        let weight = Vec3::new(0.0, 0.0, -1.0);
        let grip = best_grip(&ring(), 0.5, &weight, Some(3.0)).unwrap();
        let sum: Vec3 = grip.forces.iter().sum();
        assert!((sum + weight).norm() < 1e-6);
        // By symmetry each carries a quarter; the normal force is at its bound: 0.5 · 3 - 0.25.
        assert!((grip.margin - 1.25).abs() < 1e-3, "{}", grip.margin);
        assert!((grip.forces[0] - Vec3::new(-3.0, 0.0, 0.25)).norm() < 1e-3, "{:?}", grip.forces);
    }

    #[test]
    fn least_change_balances_any_forces() {
        let contacts = ring();
        let forces = [Vec3::new(-1.0, 0.3, 0.2), Vec3::y(), Vec3::x(), Vec3::new(0.1, 0.2, 0.9)];
        let load = Vec3::new(0.0, 0.1, -1.0);
        let change = residual_forces(&contacts, &forces, &load).unwrap();
        let balanced: Vec<Vec3> = forces.iter().zip(&change).map(|(force, change)| force - change).collect();
        let sum: Vec3 = balanced.iter().sum();
        let torque: Vec3 =
            contacts.iter().zip(&balanced).map(|(contact, force)| contact.r.cross(force)).sum();
        assert!((sum + load).norm() < 1e-12 && torque.norm() < 1e-12);
        let again = residual_forces(&contacts, &balanced, &load).unwrap();
        assert!(again.iter().all(|change| change.norm() < 1e-12));
        assert!(residual_forces(&contacts[..2], &forces[..2], &load).is_none());
    }

    #[test]
    fn efforts_bound_the_forces() {
        let mut contacts = ring();
        for contact in &mut contacts {
            contact.columns = vec![-contact.n * 0.1];
            contact.efforts = vec![0.2];
        }
        let grip = best_grip(&contacts, 0.5, &Vec3::new(0.0, 0.0, -1.0), Some(3.0)).unwrap();
        assert!((grip.margin - 0.75).abs() < 1e-3, "{}", grip.margin);
    }

    #[test]
    fn too_heavy_or_not_closed_has_no_grip() {
        let heavy = best_grip(&ring(), 0.5, &Vec3::new(0.0, 0.0, -7.0), Some(3.0)).unwrap();
        // Each carries 7/4 N, and 0.5 · 3 N is what friction gives.
        assert!((heavy.margin + 0.25).abs() < 1e-3, "{}", heavy.margin);
        let two = best_grip(&ring()[..2], 0.5, &Vec3::new(0.0, 0.0, -0.1), Some(3.0));
        assert!(two.is_none_or(|grip| grip.margin <= 1e-6));
    }
}
