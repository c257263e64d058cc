//! Which forces the fingers exert: the grip that is farthest from slipping, by a small conic program.

use crate::force::{ContactForce, Friction};
use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettings, DefaultSolver, IPSolver, SolverStatus, SupportedConeT};
use nalgebra::{Matrix6, Vector6};
use regrasp_api::{FingerIndex, FingerJoints, Vec3, any_orthogonal};

/// One finger's contact, as the program sees it; all vectors in one frame.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct GripContact {
    /// The finger that touches.
    pub finger: FingerIndex,
    /// The contact point from the object's centre of mass (m).
    pub r: Vec3,
    /// The outward unit normal.
    pub n: Vec3,
    /// For each joint the velocity of the fingertip's material point at the contact per joint speed (m/rad; m/m).
    pub columns: Vec<Vec3>,
    /// For each joint the angular velocity of the fingertip about `n` per joint speed (no unit; rad/m).
    pub spins: Vec<f64>,
    /// For each joint the largest effort (N·m; N) that the grasp may take.
    pub efforts: Vec<f64>,
}

impl GripContact {
    /// The joints' efforts (N·m; N) that exert this on the object.
    pub fn efforts_of(&self, exerted: &ContactForce) -> FingerJoints {
        let mut efforts = FingerJoints::zeros(self.columns.len());
        let columns = self.columns.iter().zip(&self.spins);
        efforts
            .iter_mut()
            .zip(columns)
            .for_each(|(effort, (column, spin))| *effort = column.dot(&exerted.force) + spin * exerted.spin);
        efforts
    }

    /// Whether a force is within the bounds of normal force and efforts, a hundredth above them included.
    pub fn allows(&self, exerted: &ContactForce, most: f64) -> bool {
        let efforts = self.efforts_of(exerted);
        -self.n.dot(&exerted.force) <= 1.01 * most
            && efforts.iter().zip(&self.efforts).all(|(effort, limit)| effort.abs() <= 1.01 * limit)
    }
}

/// One direction of what a contact exerts, in units of N: a force, or a torque about the normal divided by its lever.
struct Direction {
    unit: ContactForce,
    /// Force, and torque about the object's centre of mass over [`LENGTH`].
    wrench: Vector6<f64>,
}

/// Inward normal, two tangents, and with torsion the torque about the normal: what a contact exerts is a sum of these.
fn directions(contact: &GripContact, friction: &Friction) -> Vec<Direction> {
    let tangent = any_orthogonal(&contact.n);
    let forces = [-contact.n, tangent, contact.n.cross(&tangent)].map(ContactForce::pure);
    let spin = ContactForce { force: Vec3::zeros(), spin: friction.lever() };
    let spin = friction.has_torsion().then_some(spin);
    let direction = |unit: ContactForce| {
        let torque = (contact.r.cross(&unit.force) + contact.n * unit.spin) / LENGTH;
        let force = unit.force;
        Direction { unit, wrench: Vector6::new(force.x, force.y, force.z, torque.x, torque.y, torque.z) }
    };
    forces.into_iter().chain(spin).map(direction).collect()
}

/// The sum of `parts` of the directions.
fn combined<'a>(parts: impl Iterator<Item = (&'a Direction, f64)>) -> ContactForce {
    parts.fold(ContactForce::pure(Vec3::zeros()), |sum, (direction, part)| ContactForce {
        force: sum.force + direction.unit.force * part,
        spin: sum.spin + direction.unit.spin * part,
    })
}

/// What all contacts exert *on the object*, in the order of the contacts.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Grip {
    pub forces: Vec<ContactForce>,
    /// The smallest distance of a force from its cone's boundary (N): see [`Friction::margin`].
    pub margin: f64,
}

/// How hard the fingers may press, and what for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Press {
    /// Most normal force of a contact (N).
    most: f64,
    /// Weight ε of the squared forces (1/N) against the margin.
    price: f64,
    /// The margin (N) that is enough.
    enough: f64,
}

/// More than any margin or force (N): a program that nothing bounds would have no best answer.
const PLENTY: f64 = 1e3;

impl Press {
    /// Up to this normal force (N), for the best margin. The price leaves it nearly best, and makes the forces unique and continuous along a motion.
    pub fn up_to(most: f64) -> Self {
        Self { most, price: 1e-3, enough: PLENTY }
    }

    /// As hard as the joints can and it takes for this margin (N), and no harder.
    pub fn enough_for(margin: f64) -> Self {
        Self { most: PLENTY, price: 1e-6, enough: margin }
    }
}

/// Length (m) by which rows of torque are divided, so that they compare with forces.
const LENGTH: f64 = 0.03;

/// Maximises t - ε/2 |f|² over the forces f with μ f_n - |(f_t, m μ/γ)| ≥ t at each contact, Σ f = -`load_f`, Σ (r × f + m n) = 0, t ≤ enough, f_n ≤ most
/// and joint efforts |Jᵀ f| within theirs; `None` where no forces do. A margin of 0 or less
/// says that none do so inside the cones.
///
/// In the manner of Boyd and Wegbreit, "Fast computation of optimal contact forces", T-RO 2007; solved by Clarabel (Goulart and Chen,
/// "Clarabel: an interior-point solver for conic programs with quadratic objectives", 2024).
pub(crate) fn best_grip(
    contacts: &[GripContact],
    friction: &Friction,
    load: &Vec3,
    press: Press,
) -> Option<Grip> {
    let bases: Vec<Vec<Direction>> = contacts.iter().map(|contact| directions(contact, friction)).collect();
    let width = bases.first()?.len();
    let mut program = Program::new(width, contacts.len());
    program.balance(&bases, load);
    program.bounds(contacts, &bases, &press);
    program.cones(friction.mu);
    let x = program.solve(press.price)?;
    let exerted =
        bases.iter().zip(x.chunks(width)).map(|(basis, x)| combined(basis.iter().zip(x.iter().copied())));
    let forces: Vec<ContactForce> = exerted.collect();
    let margin = margin(contacts, &forces, friction);
    margin.is_finite().then_some(Grip { forces, margin })
}

/// The smallest distance of a force from its cone's boundary (N).
pub(crate) fn margin(contacts: &[GripContact], forces: &[ContactForce], friction: &Friction) -> f64 {
    let each = contacts.iter().zip(forces).map(|(contact, exerted)| friction.margin(&contact.n, exerted));
    each.fold(f64::INFINITY, f64::min)
}

/// The change of least norm after which `forces` balance the load `load` (N, at the origin of the lever arms); torques count over
/// the friction's lever. `None` for a grasp whose map has no full rank.
pub(crate) fn balanced(
    contacts: &[GripContact],
    forces: &[ContactForce],
    friction: &Friction,
    load: &Vec3,
) -> Option<Vec<ContactForce>> {
    let bases: Vec<Vec<Direction>> = contacts.iter().map(|contact| directions(contact, friction)).collect();
    let mut gram = Matrix6::zeros();
    let mut left = Vector6::zeros();
    left.fixed_rows_mut::<3>(0).copy_from(load);
    for ((contact, basis), exerted) in contacts.iter().zip(&bases).zip(forces) {
        let torque = (contact.r.cross(&exerted.force) + contact.n * exerted.spin) / LENGTH;
        left += Vector6::from_iterator(exerted.force.iter().chain(torque.iter()).copied());
        basis.iter().for_each(|direction| gram += direction.wrench * direction.wrench.transpose());
    }
    let factor = gram.cholesky()?;
    // A pivot that is rounding: the contacts leave a direction without force.
    let pivots = factor.l_dirty().diagonal();
    if pivots.min() < 1e-6 * pivots.max() {
        return None;
    }
    let weights = factor.solve(&left);
    let change = |(basis, exerted): (&Vec<Direction>, &ContactForce)| {
        let less = combined(basis.iter().map(|direction| (direction, direction.wrench.dot(&weights))));
        ContactForce { force: exerted.force - less.force, spin: exerted.spin - less.spin }
    };
    Some(bases.iter().zip(forces).map(change).collect())
}

/// min ½ xᵀP x + qᵀx subject to A x + s = b, s in the cones; x = (f_n, f_t1, f_t2 and with torsion m μ/γ of each contact, t).
struct Program {
    rows: Vec<usize>,
    columns: Vec<usize>,
    values: Vec<f64>,
    b: Vec<f64>,
    cones: Vec<SupportedConeT<f64>>,
    /// Variables of one contact.
    width: usize,
    contacts: usize,
}

impl Program {
    fn new(width: usize, contacts: usize) -> Self {
        Self { rows: vec![], columns: vec![], values: vec![], b: vec![], cones: vec![], width, contacts }
    }

    fn set(&mut self, row: usize, column: usize, value: f64) {
        if value != 0.0 {
            self.rows.push(row);
            self.columns.push(column);
            self.values.push(value);
        }
    }

    fn balance(&mut self, bases: &[Vec<Direction>], load: &Vec3) {
        for (column, direction) in bases.iter().flatten().enumerate() {
            for row in 0..6 {
                self.set(row, column, direction.wrench[row]);
            }
        }
        self.b.extend([-load.x, -load.y, -load.z, 0.0, 0.0, 0.0]);
        self.cones.push(SupportedConeT::ZeroConeT(6));
    }

    /// f_n ≤ most; ±Jᵀf ≤ effort; t ≤ enough.
    fn bounds(&mut self, contacts: &[GripContact], bases: &[Vec<Direction>], press: &Press) {
        let first = self.b.len();
        for (i, (contact, basis)) in contacts.iter().zip(bases).enumerate() {
            self.set(self.b.len(), self.width * i, 1.0);
            self.b.push(press.most);
            let efforts: Vec<FingerJoints> =
                basis.iter().map(|direction| contact.efforts_of(&direction.unit)).collect();
            for (joint, &limit) in contact.efforts.iter().enumerate() {
                for sign in [1.0, -1.0] {
                    let row = self.b.len();
                    for (k, effort) in efforts.iter().enumerate() {
                        self.set(row, self.width * i + k, sign * effort[joint]);
                    }
                    self.b.push(limit);
                }
            }
        }
        self.set(self.b.len(), self.width * self.contacts, 1.0);
        self.b.push(press.enough);
        self.cones.push(SupportedConeT::NonnegativeConeT(self.b.len() - first));
    }

    /// (μ f_n - t, f_t, m μ/γ) in the second-order cone.
    fn cones(&mut self, mu: f64) {
        let t = self.width * self.contacts;
        for i in 0..self.contacts {
            let row = self.b.len();
            self.set(row, self.width * i, -mu);
            self.set(row, t, 1.0);
            for k in 1..self.width {
                self.set(row + k, self.width * i + k, -1.0);
            }
            self.b.resize(row + self.width, 0.0);
            self.cones.push(SupportedConeT::SecondOrderConeT(self.width));
        }
    }

    fn solve(self, price: f64) -> Option<Vec<f64>> {
        let n = self.width * self.contacts + 1;
        let diagonal: Vec<usize> = (0..n - 1).collect();
        let P = CscMatrix::new_from_triplets(n, n, diagonal.clone(), diagonal, vec![price; n - 1]);
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
        GripContact {
            finger: FingerIndex(finger),
            r: n * 0.03,
            n,
            columns: vec![],
            spins: vec![],
            efforts: vec![],
        }
    }

    fn point() -> Friction {
        Friction::point(0.5)
    }

    fn soft() -> Friction {
        Friction { mu: 0.5, gamma: 0.004 }
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
        let grip = best_grip(&ring(), &point(), &weight, Press::up_to(3.0)).unwrap();
        let sum: Vec3 = grip.forces.iter().map(|exerted| exerted.force).sum();
        assert!((sum + weight).norm() < 1e-6);
        // By symmetry each carries a quarter; the normal force is at its bound: 0.5 · 3 - 0.25.
        assert!((grip.margin - 1.25).abs() < 1e-3, "{}", grip.margin);
        assert!((grip.forces[0].force - Vec3::new(-3.0, 0.0, 0.25)).norm() < 1e-3, "{:?}", grip.forces);
    }

    fn resultant(contacts: &[GripContact], forces: &[ContactForce]) -> (Vec3, Vec3) {
        let torque = |(contact, exerted): (&GripContact, &ContactForce)| {
            contact.r.cross(&exerted.force) + contact.n * exerted.spin
        };
        (forces.iter().map(|exerted| exerted.force).sum(), contacts.iter().zip(forces).map(torque).sum())
    }

    #[test]
    fn least_change_balances_any_forces() {
        let contacts = ring();
        let forces = [Vec3::new(-1.0, 0.3, 0.2), Vec3::y(), Vec3::x(), Vec3::new(0.1, 0.2, 0.9)];
        let forces = forces.map(|force| ContactForce { force, spin: 0.002 });
        let load = Vec3::new(0.0, 0.1, -1.0);
        for friction in [point(), soft()] {
            let changed = balanced(&contacts, &forces, &friction, &load).unwrap();
            let (sum, torque) = resultant(&contacts, &changed);
            assert!((sum + load).norm() < 1e-12 && torque.norm() < 1e-12);
            let again = balanced(&contacts, &changed, &friction, &load).unwrap();
            assert!(again.iter().zip(&changed).all(|(a, b)| (a.force - b.force).norm() < 1e-12));
            let spins = changed.iter().any(|exerted| (exerted.spin - 0.002).abs() > 1e-6);
            assert_eq!(spins, friction.has_torsion());
        }
        assert!(balanced(&contacts[..1], &forces[..1], &soft(), &load).is_none());
        assert!(balanced(&contacts[..2], &forces[..2], &point(), &load).is_none());
    }

    /// Two soft fingers on a horizontal line with a weight beside it: they carry its torque about the line by friction alone.
    #[test]
    fn two_soft_contacts_carry_a_torque_about_their_line() {
        let mut contacts = [contact(0, Vec3::x()), contact(2, -Vec3::x())];
        // The centre of mass is 2 mm beside the line.
        contacts.iter_mut().for_each(|contact| contact.r += Vec3::new(0.0, 2e-3, 0.0));
        let weight = Vec3::new(0.0, 0.0, -1.0);
        let grip = best_grip(&contacts, &soft(), &weight, Press::up_to(6.0)).unwrap();
        let (sum, torque) = resultant(&contacts, &grip.forces);
        assert!((sum + weight).norm() < 1e-6 && torque.norm() < 1e-7, "{sum} {torque}");
        // Each carries half of the torque, 1e-3 N·m, and half of the weight: 0.5 · 6 - √(0.5² + (1e-3 · 0.5/0.004)²).
        assert!((grip.margin - (3.0 - 0.5_f64.hypot(0.125))).abs() < 1e-3, "{}", grip.margin);
        assert!(
            best_grip(&contacts, &point(), &weight, Press::up_to(6.0)).is_none_or(|grip| grip.margin <= 1e-6)
        );
    }

    #[test]
    fn efforts_bound_the_forces() {
        let mut contacts = ring();
        for contact in &mut contacts {
            contact.columns = vec![-contact.n * 0.1];
            contact.spins = vec![0.0];
            contact.efforts = vec![0.2];
        }
        let grip = best_grip(&contacts, &point(), &Vec3::new(0.0, 0.0, -1.0), Press::up_to(3.0)).unwrap();
        assert!((grip.margin - 0.75).abs() < 1e-3, "{}", grip.margin);
    }

    #[test]
    fn too_heavy_or_not_closed_has_no_grip() {
        let heavy = best_grip(&ring(), &point(), &Vec3::new(0.0, 0.0, -7.0), Press::up_to(3.0)).unwrap();
        // Each carries 7/4 N, and 0.5 · 3 N is what friction gives.
        assert!((heavy.margin + 0.25).abs() < 1e-3, "{}", heavy.margin);
        let two = best_grip(&ring()[..2], &point(), &Vec3::new(0.0, 0.0, -0.1), Press::up_to(3.0));
        assert!(two.is_none_or(|grip| grip.margin <= 1e-6));
    }
}
