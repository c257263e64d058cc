//! `stability-test/socp`: force closure as a second-order cone program, solved by Clarabel.

use crate::contacts::{ScaledContact, ScaledGrasp, Twist};
use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettingsBuilder, DefaultSolver, IPSolver, SolverStatus, SupportedConeT};
use nalgebra::{DMatrix, DVector};
use regrasp_api::{
    Assessment, Build, CallError, Certificate, Context, Entry, Grasp, Hint, Settings, SettingsError, Slot,
    Stability, StabilityTest, Vec3, any_orthogonal, check_settings,
};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

const ID: &str = "stability-test/socp";

/// Settings of [`Socp`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct SocpSettings {
    /// Slacks t (no unit) below this in absolute value are left undecided; default 1e-8, where the solver's
    /// sign becomes noise.
    #[schemars(range(min = 1e-9, max = 0.1), extend("x-unit" = "1"))]
    pub undecided_slack: f64,
    /// Smallest singular value of the scaled grasp map (no unit) that counts as rank 6; default 1e-9.
    #[schemars(range(min = 1e-12, max = 0.1), extend("x-unit" = "1"))]
    pub rank_tolerance: f64,
}

impl Default for SocpSettings {
    fn default() -> Self {
        Self { undecided_slack: 1e-8, rank_tolerance: 1e-9 }
    }
}

impl Settings for SocpSettings {}

/// Force closure as a second-order cone program: maximise t with G f = 0, Σ f_n = 1 and f_n - t ≥ |(f_t/μ,
/// m/γ)| at every contact.
///
/// Closed where t > 0 and the scaled grasp map has rank 6. The formulation of Han, Trinkle, Li, "Grasp
/// analysis as linear matrix inequality problems", T-RA 2000, as cones (Lobo, Vandenberghe, Boyd, Lebret,
/// "Applications of second-order cone programming", 1998), solved by the interior-point method of Goulart &
/// Chen, "Clarabel", 2024. A few hundred times the cost of `stability-test/force-closure`, and independent of
/// it: the reference.
///
/// The margin is t: the largest force, as a share of the sum of the normal forces, by which every contact
/// stays inside its cone. It takes torques about the contacts' centroid and does not depend on a length, so
/// `length` and `center_O` of [`StabilityTest::assess`] have no effect on it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Socp {
    settings: SocpSettings,
}

impl Socp {
    /// The test with checked settings.
    pub fn new(settings: SocpSettings) -> Result<Self, SettingsError> {
        settings.validate()?;
        Ok(Self { settings })
    }

    fn decide(&self, solution: &Solution, grasp_map: &DMatrix<f64>) -> Stability {
        let slack = self.settings.undecided_slack.max(10.0 * solution.doubt);
        if solution.t < -slack {
            return Stability::Unstable;
        }
        if !has_full_rank(grasp_map, self.settings.rank_tolerance) {
            return Stability::Unstable;
        }
        if solution.t > slack { Stability::Stable } else { Stability::Undecided }
    }

    fn certify(
        &self,
        grasp: &ScaledGrasp,
        solution: &Solution,
        grasp_map: &DMatrix<f64>,
        stability: Stability,
    ) -> (f64, f64, Certificate) {
        let upper = solution.t + self.settings.undecided_slack;
        match stability {
            Stability::Stable => {
                let forces = balanced(&solution.forces, grasp_map);
                let lower = smallest_slack(grasp, &forces);
                (lower, upper.max(lower), internal_force(grasp, &forces))
            }
            Stability::Undecided => (0.0, upper.max(0.0), Certificate::None),
            Stability::Unstable => (solution.t.min(0.0), 0.0, separating_twist(grasp, solution, grasp_map)),
        }
    }
}

impl StabilityTest for Socp {
    fn test(
        &self,
        grasp: &Grasp<'_>,
        _hint: &mut Hint,
        context: &mut Context<'_>,
    ) -> Result<Stability, CallError> {
        context.count_call(Slot::StabilityTest);
        let scaled = ScaledGrasp::gather(grasp, None, ID)?;
        let grasp_map = scaled_grasp_map(&scaled);
        Ok(self.decide(&solve(&scaled, &grasp_map)?, &grasp_map))
    }

    fn assess(
        &self,
        grasp: &Grasp<'_>,
        _length: Option<f64>,
        _center_O: Option<Vec3>,
        _context: &mut Context<'_>,
    ) -> Result<Assessment, CallError> {
        let scaled = ScaledGrasp::gather(grasp, None, ID)?;
        let grasp_map = scaled_grasp_map(&scaled);
        let solution = solve(&scaled, &grasp_map)?;
        let stability = self.decide(&solution, &grasp_map);
        let (margin_lower, margin_upper, certificate) =
            self.certify(&scaled, &solution, &grasp_map, stability);
        Ok(Assessment { stability, margin_lower, margin_upper, certificate })
    }
}

/// What the program's optimum says.
struct Solution {
    t: f64,
    /// How far off t may be, where the solver says so.
    doubt: f64,
    /// The contacts' force components, each as [`components`] says, one contact after the other.
    forces: DVector<f64>,
    /// The multipliers of G f = 0.
    twist: Twist,
}

/// How many components a contact's force has: normal, two tangential if μ > 0, torsional if γ > 0, the last
/// three over μ and γ.
fn components(contact: &ScaledContact) -> usize {
    1 + 2 * usize::from(has_friction(contact)) + usize::from(contact.gamma > 0.0)
}

fn has_friction(contact: &ScaledContact) -> bool {
    contact.mu > 0.0 || contact.grained
}

/// The largest tangential forces in two directions at right angles, for unit normal force.
fn tangential(contact: &ScaledContact) -> [Vec3; 2] {
    if let Some([(a, along), (b, across)]) = contact.axes() {
        return [a * along, b * across];
    }
    let t1 = any_orthogonal(&contact.n);
    [t1 * contact.mu, contact.n.cross(&t1) * contact.mu]
}

/// The wrenches of unit components: the columns of G scaled by 1, μ, μ, γ.
fn scaled_grasp_map(grasp: &ScaledGrasp) -> DMatrix<f64> {
    let mut columns = Vec::with_capacity(4 * grasp.contacts().len());
    for contact in grasp.contacts() {
        let mut force = |f: Vec3| columns.extend(f.iter().chain(&contact.r.cross(&f)));
        force(contact.n);
        if has_friction(contact) {
            tangential(contact).into_iter().for_each(&mut force);
        }
        if contact.gamma > 0.0 {
            columns.extend(Vec3::zeros().iter().chain(&(contact.n * contact.gamma)));
        }
    }
    DMatrix::from_vec(6, columns.len() / 6, columns)
}

/// Whether the smallest of six singular values is above `tolerance` times the largest.
fn has_full_rank(grasp_map: &DMatrix<f64>, tolerance: f64) -> bool {
    let values = grasp_map.singular_values();
    values.len() == 6 && values.min() > tolerance * values.max()
}

/// Solves max t with G f = 0, Σ f_n = 1, (f_n - t, f_u) in every cone, in the variables (f, t).
///
/// Clarabel's form is A x + s = b with s in a product of cones: six zeros and one for the equations, then one
/// cone a contact.
fn solve(grasp: &ScaledGrasp, grasp_map: &DMatrix<f64>) -> Result<Solution, CallError> {
    let size = grasp_map.ncols();
    let mut A = DMatrix::<f64>::zeros(7 + size, size + 1);
    A.view_mut((0, 0), (6, size)).copy_from(grasp_map);
    let mut cones = vec![SupportedConeT::ZeroConeT(7)];
    let mut first = 0;
    for contact in grasp.contacts() {
        A[(6, first)] = 1.0;
        A[(7 + first, size)] = 1.0;
        let dimension = components(contact);
        for row in first..first + dimension {
            A[(7 + row, row)] = -1.0;
        }
        cones.push(match dimension {
            1 => SupportedConeT::NonnegativeConeT(1),
            _ => SupportedConeT::SecondOrderConeT(dimension),
        });
        first += dimension;
    }
    let mut b = vec![0.0; 7 + size];
    b[6] = 1.0;
    let mut cost = vec![0.0; size + 1];
    cost[size] = -1.0;
    optimum(&compressed(&A), &b, &cost, &cones)
}

/// The optimum to the precision that the sign of t needs, or, on a degenerate grasp, to the solver's usual
/// one.
fn optimum(
    A: &CscMatrix<f64>,
    b: &[f64],
    cost: &[f64],
    cones: &[SupportedConeT<f64>],
) -> Result<Solution, CallError> {
    for tolerance in [1e-11, 1e-8] {
        if let Some(solution) = attempt(A, b, cost, cones, tolerance)? {
            return Ok(solution);
        }
    }
    let forces = DVector::zeros(cost.len() - 1);
    Ok(Solution { t: 0.0, doubt: f64::INFINITY, forces, twist: Twist::ZERO })
}

fn attempt(
    A: &CscMatrix<f64>,
    b: &[f64],
    cost: &[f64],
    cones: &[SupportedConeT<f64>],
    tolerance: f64,
) -> Result<Option<Solution>, CallError> {
    let failed = |reason: String| CallError::Contract { plugin: ID.to_owned(), reason };
    let settings = DefaultSettingsBuilder::default()
        .verbose(false)
        .max_threads(1)
        .tol_gap_abs(tolerance)
        .tol_gap_rel(tolerance)
        .tol_feas(tolerance)
        .build()
        .map_err(|error| failed(error.to_string()))?;
    let P = CscMatrix::zeros((cost.len(), cost.len()));
    let mut solver =
        DefaultSolver::new(&P, cost, A, b, cones, settings).map_err(|e| failed(e.to_string()))?;
    solver.solve();
    let found = &solver.solution;
    let (&t, forces) = found.x.split_last().expect("the program has t as its last variable");
    let (t, doubt) = match found.status {
        SolverStatus::Solved => (t, 0.0),
        // Asked for more than double precision has: the answer counts as far as its gap and residuals allow.
        SolverStatus::AlmostSolved | SolverStatus::InsufficientProgress | SolverStatus::MaxIterations => {
            (t, (found.obj_val - found.obj_val_dual).abs() + found.r_prim.abs() + found.r_dual.abs())
        }
        // No force at all balances with normal parts that add up to 1.
        SolverStatus::PrimalInfeasible | SolverStatus::AlmostPrimalInfeasible => (f64::NEG_INFINITY, 0.0),
        _ => return Ok(None),
    };
    let twist = Twist::from_array(std::array::from_fn(|i| found.z[i]));
    let usable = !t.is_nan() && !doubt.is_nan();
    Ok(usable.then(|| Solution { t, doubt, forces: DVector::from_column_slice(forces), twist }))
}

fn compressed(dense: &DMatrix<f64>) -> CscMatrix<f64> {
    let (mut starts, mut rows, mut values) = (vec![0], Vec::new(), Vec::new());
    for column in dense.column_iter() {
        for (row, &value) in column.iter().enumerate().filter(|(_, value)| **value != 0.0) {
            rows.push(row);
            values.push(value);
        }
        starts.push(rows.len());
    }
    CscMatrix::new(dense.nrows(), dense.ncols(), starts, rows, values)
}

/// The nearest forces that balance to rounding, in the least-squares sense.
fn balanced(forces: &DVector<f64>, grasp_map: &DMatrix<f64>) -> DVector<f64> {
    let svd = grasp_map.clone().svd(true, true);
    let correct = |f: DVector<f64>| {
        let step = svd.solve(&(grasp_map * &f), 1e-12).expect("both singular bases were asked for");
        f - step
    };
    correct(correct(forces.clone()))
}

/// min over the contacts of (f_n - |f_u|) / Σ f_n.
fn smallest_slack(grasp: &ScaledGrasp, forces: &DVector<f64>) -> f64 {
    let (mut first, mut slack, mut normal_sum) = (0, f64::INFINITY, 0.0);
    for contact in grasp.contacts() {
        let dimension = components(contact);
        normal_sum += forces[first];
        slack = slack.min(forces[first] - forces.rows(first + 1, dimension - 1).norm());
        first += dimension;
    }
    slack / normal_sum
}

fn internal_force(grasp: &ScaledGrasp, forces: &DVector<f64>) -> Certificate {
    let (mut forces_O, mut torsions) = (Vec::new(), Vec::new());
    let mut first = 0;
    for contact in grasp.contacts() {
        let mut f = contact.n * forces[first];
        if has_friction(contact) {
            let [u, v] = tangential(contact);
            f += u * forces[first + 1] + v * forces[first + 2];
        }
        let dimension = components(contact);
        let spins = contact.gamma > 0.0;
        let torsion = if spins { forces[first + dimension - 1] * contact.gamma * grasp.length } else { 0.0 };
        forces_O.push(f);
        torsions.push(torsion);
        first += dimension;
    }
    Certificate::InternalForce { forces_O, torsions }
}

/// The program's multipliers, or a twist in the null space of Gᵀ, where arithmetic confirms that no contact
/// resists it.
fn separating_twist(grasp: &ScaledGrasp, solution: &Solution, grasp_map: &DMatrix<f64>) -> Certificate {
    let square = grasp_map * grasp_map.transpose();
    let eigen = square.symmetric_eigen();
    let least = eigen.eigenvectors.column(eigen.eigenvalues.imin());
    let null = Twist::from_array(std::array::from_fn(|i| least[i]));
    for twist in [solution.twist, solution.twist.scaled(-1.0), null, null.scaled(-1.0)] {
        let unit = twist.scaled(1.0 / twist.norm());
        let back = unit.scaled(-1.0);
        if grasp.contacts().iter().all(|contact| contact.support(&back) <= 1e-12) {
            return Certificate::SeparatingTwist { v_O: unit.a, w_O: unit.b / grasp.length };
        }
    }
    Certificate::None
}

regrasp_api::inventory::submit! {
    Entry {
        id: ID,
        slots: &[Slot::StabilityTest],
        summary: "Force closure as a second-order cone program (Clarabel): slow and independent, the \
            reference.",
        references: &[
            "Han, Trinkle, Li, Grasp analysis as linear matrix inequality problems, T-RA 2000",
            "Lobo, Vandenberghe, Boyd, Lebret, Applications of second-order cone programming, Linear \
                Algebra and its Applications, 1998",
            "Goulart, Chen, Clarabel: an interior-point solver for conic programs with quadratic \
                objectives, arXiv 2405.12762, 2024",
        ],
        schema: SocpSettings::schema,
        check: check_settings::<SocpSettings>,
        build: Build::StabilityTest(|json, _| Ok(Box::new(Socp::new(SocpSettings::from_json(json)?)?))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_outside_their_range_are_refused() {
        let slack = SocpSettings { undecided_slack: 1e-10, ..SocpSettings::default() };
        assert!(Socp::new(slack).unwrap_err().to_string().contains("undecided_slack"));
        let rank = SocpSettings { rank_tolerance: f64::NAN, ..SocpSettings::default() };
        assert!(Socp::new(rank).unwrap_err().to_string().contains("rank_tolerance"));
    }
}
