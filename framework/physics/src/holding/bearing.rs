//! Contacts in the coordinates in which forces are looked for.

use crate::force::{ContactForce, Friction};
use nalgebra::{SMatrix, Vector4, Vector6};
use regrasp_api::{EffortBounds, MAX_FINGER_JOINTS, Vec3};

/// What one contact exerts, in N: (f_n, f_t1, f_t2, m/λ), with λ = γ/μ the friction's lever; the last is 0
/// where there is no torsion.
pub type Exerted = Vector4<f64>;

/// One contact that bears a part of the load: its grasp map, its cone, and the half-spaces of its joints'
/// efforts.
///
/// The cone is |(f_t1, f_t2, m/λ)| ≤ s μ f_n, with s the share of the friction that a search allows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bearing {
    /// Wrench per unit of each coordinate: force, and torque about the centre of mass over the length.
    pub(crate) map: SMatrix<f64, 6, 4>,
    /// Force directions (inward normal and two tangents) in O; a tangent along which there is less friction
    /// is as much shorter.
    basis: [Vec3; 3],
    lever: f64,
    /// See [`Friction::drag`].
    drag: f64,
    pub(crate) mu: f64,
    rows: [Vector4<f64>; MAX_FINGER_JOINTS],
    count: usize,
    /// Most normal force (N); infinite where only the efforts bound it.
    pub(crate) most: f64,
    /// A normal force well inside the bounds (N): where searches begin.
    pub(crate) start: f64,
}

/// What all forces of a contact must keep to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Press {
    /// Most normal force of a contact (N); `None` where the joints alone bound it.
    pub max_normal_force: Option<f64>,
    /// What part of its effort limit a joint may use, in (0, 1].
    pub effort_share: f64,
}

/// The normal force (N) to begin with where nothing bounds it, and the most that is ever looked for.
pub(super) const UNBOUNDED: (f64, f64) = (10.0, 1e4);
/// A row this small (1/N) bounds nothing that matters.
pub(super) const FLAT: f64 = 1e-12;

impl Bearing {
    /// Fills a place.
    pub(crate) const NOTHING: Self = Self {
        map: SMatrix::<f64, 6, 4>::from_array_storage(nalgebra::ArrayStorage([[0.0; 6]; 4])),
        basis: [Vec3::new(0.0, 0.0, 0.0); 3],
        lever: 0.0,
        drag: 0.0,
        mu: 0.0,
        rows: [Vector4::new(0.0, 0.0, 0.0, 0.0); MAX_FINGER_JOINTS],
        count: 0,
        most: 0.0,
        start: 0.0,
    };

    /// The contact at `r_O` (m) from the centre of mass with the outward unit normal `n_O`; torques count
    /// over `length` (m).
    pub fn new(
        (r_O, n_O): (&Vec3, &Vec3),
        friction: &Friction,
        efforts: &EffortBounds,
        press: &Press,
        length: f64,
    ) -> Self {
        // Forces across a grain count in units in which the cone is round.
        let (mu, [t1, t2]) = (friction.most(), friction.tangents(n_O));
        let unit = |(tangent, own): (Vec3, f64)| if own == mu { tangent } else { tangent * (own / mu) };
        let basis = [-n_O, unit(t1), unit(t2)];
        let lever = if friction.has_torsion() { friction.lever() } else { 0.0 };
        let mut map = SMatrix::<f64, 6, 4>::zeros();
        for (column, force) in basis.iter().enumerate() {
            map.set_column(column, &stacked(force, &(r_O.cross(force) / length)));
        }
        let drag = friction.drag;
        if drag != 0.0 {
            let pressed = map.column(0) + stacked(&Vec3::zeros(), &(n_O * (drag / length)));
            map.set_column(0, &pressed);
        }
        map.set_column(3, &stacked(&Vec3::zeros(), &(n_O * (lever / length))));
        let mut rows = [Vector4::zeros(); MAX_FINGER_JOINTS];
        let mut count = 0;
        for joint in efforts.joints() {
            let along = basis.map(|force| joint.column_O.dot(&force));
            let pressing = along[0] + joint.spin * drag;
            let row = Vector4::new(pressing, along[1], along[2], joint.spin * lever);
            let row = row / (joint.limit * press.effort_share);
            if row.amax() > FLAT {
                rows[count] = row;
                count += 1;
            }
        }
        let most = press.max_normal_force.unwrap_or(f64::INFINITY);
        let steepest = rows[..count].iter().map(|row| row[0].abs()).fold(1.0 / most, f64::max);
        let start = if steepest > 0.0 { (0.5 / steepest).min(UNBOUNDED.1) } else { UNBOUNDED.0 };
        let most = if count == 0 { most.min(UNBOUNDED.1) } else { most };
        Self { map, basis, lever, drag, mu, rows, count, most, start }
    }

    /// The rows a of the efforts' bounds |a · x| ≤ 1.
    pub(crate) fn rows(&self) -> &[Vector4<f64>] {
        &self.rows[..self.count]
    }

    /// Whether the contact carries torques about its normal.
    pub(crate) fn has_torsion(&self) -> bool {
        self.lever > 0.0
    }

    /// The force and torque on the object, in O.
    pub fn force(&self, x: &Exerted) -> ContactForce {
        let force = self.basis[0] * x[0] + self.basis[1] * x[1] + self.basis[2] * x[2];
        ContactForce { force, spin: x[3] * self.lever + x[0] * self.drag }
    }

    /// The share of the friction that a force needs: |(f_t, m/λ)|/(μ f_n); infinite without pressing.
    pub fn share(&self, x: &Exerted) -> f64 {
        if x[0] > 0.0 { x.fixed_rows::<3>(1).norm() / (self.mu * x[0]) } else { f64::INFINITY }
    }

    /// The largest share of an effort limit, and of the largest normal force, that a force takes.
    pub fn effort_share(&self, x: &Exerted) -> f64 {
        self.rows().iter().map(|row| row.dot(x).abs()).fold(0.0, f64::max)
    }

    /// Room to the bounds of cone (at the share `s` of the friction), efforts and normal force; no unit,
    /// positive inside.
    pub(crate) fn room(&self, x: &Exerted, s: f64) -> f64 {
        let cone = (s * self.mu * x[0] - x.fixed_rows::<3>(1).norm()) / self.start;
        cone.min(1.0 - self.effort_share(x)).min(1.0 - x[0] / self.most)
    }
}

/// Force and torque over length as one column.
pub(crate) fn stacked(force: &Vec3, torque: &Vec3) -> Vector6<f64> {
    Vector6::new(force.x, force.y, force.z, torque.x, torque.y, torque.z)
}
