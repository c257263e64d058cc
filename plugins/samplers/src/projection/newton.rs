//! Newton's method on the closure equations: every fingertip's centre at its radius from the object.

use crate::pose::Region;
use nalgebra::{SMatrix, SVector, Vector6};
use regrasp_api::{
    Configuration, Contact, FingerIndex, FingerSet, JointKind, MAX_FINGER_JOINTS, MAX_FINGERS, Pose,
    Projection, Reason, Rotation, Task, Vec3,
};

/// A fingertip counts as touching within this distance (m): far below a plan's tolerance, far above rounding.
const CLOSED: f64 = 1e-10;
/// The damping that a step that does not pay starts with, beside diagonal entries of about 1.
const DAMPING: f64 = 1e-3;

type Equations<const COLUMNS: usize> = SMatrix<f64, MAX_FINGERS, COLUMNS>;

/// What Newton's method may move.
#[derive(Clone, Copy, Debug)]
pub(super) enum Unknowns {
    /// The object's pose and the joints of these fingers, all of which are to touch.
    PoseAndJoints(FingerSet),
    /// The joints of this finger, which is to touch.
    Joints(FingerIndex),
}

impl Unknowns {
    fn fingers(self) -> FingerSet {
        match self {
            Self::PoseAndJoints(fingers) => fingers,
            Self::Joints(finger) => FingerSet::only(finger),
        }
    }
}

/// The equations at one configuration: a row for each finger, rows of fingers that are not concerned zero.
///
/// Every unknown is a length (m): a turn counts as what it moves at the object's radius.
struct Linearised {
    /// Distance of each fingertip's centre from the object, less its radius (m).
    residual: SVector<f64, MAX_FINGERS>,
    /// Derivatives by the object's displacement and turn, no unit.
    by_pose: Equations<6>,
    /// Derivatives by each finger's own joints, no unit.
    by_joints: Equations<MAX_FINGER_JOINTS>,
}

/// Newton's method for one task.
pub(super) struct Newton<'a> {
    pub task: &'a Task<'a>,
    /// Most steps.
    pub steps: usize,
    /// Where the object may be.
    pub region: Region,
}

impl Newton<'_> {
    /// Brings the configuration towards closure; some fingers may stay open.
    ///
    /// Damped Gauss-Newton: the step of least norm with J Jᵀ + λ, λ zero until a step does not make the residual smaller.
    pub fn close(&self, q: &mut Configuration, unknowns: Unknowns) {
        let mut here = self.linearise(q, unknowns);
        let mut damping = 0.0;
        for _ in 0..self.steps {
            if here.residual.amax() <= CLOSED {
                return;
            }
            let Some(next) = self.step(q, &here, unknowns, damping) else { return };
            let there = self.linearise(&next, unknowns);
            if there.residual.norm_squared() < here.residual.norm_squared() {
                (*q, here) = (next, there);
                damping = if damping < DAMPING { 0.0 } else { 0.1 * damping };
            } else {
                damping = (10.0 * damping).max(DAMPING);
            }
        }
    }

    /// Brings one finger to the resting object: its contact, or why it does not come to touch.
    pub fn touch(&self, q: &mut Configuration, finger: FingerIndex) -> Result<Contact, Reason> {
        self.close(q, Unknowns::Joints(finger));
        let projection = self.projection(q, finger, &self.task.hand.tip_center(finger, &q.joints[finger]));
        if (projection.distance - self.task.hand.fingertip_radius()).abs() <= CLOSED {
            return Ok(projection.contact);
        }
        let joints = self.task.hand.finger(finger).joints.iter().zip(q.joints[finger].iter());
        let at_limit = joints.into_iter().any(|(joint, &at)| at <= joint.lower || at >= joint.upper);
        Err(if at_limit { Reason::Limits } else { Reason::Closure })
    }

    fn projection(&self, q: &Configuration, finger: FingerIndex, p_HF: &Vec3) -> Projection {
        let p_OF = q.X_HO.rotation.inverse() * (p_HF - q.X_HO.translation.vector);
        let facet = q.contacts[finger].map(|contact| contact.facet);
        self.task.surface.project(&p_OF, facet)
    }

    fn linearise(&self, q: &Configuration, unknowns: Unknowns) -> Linearised {
        let mut all =
            Linearised { residual: SVector::zeros(), by_pose: SMatrix::zeros(), by_joints: SMatrix::zeros() };
        let length = self.turn_length();
        for finger in unknowns.fingers().iter() {
            let tip = self.task.hand.tip_kinematics(finger, &q.joints[finger]);
            let nearest = self.projection(q, finger, &tip.p_HF);
            let (row, n_H) = (finger.index(), q.X_HO.rotation * nearest.contact.n_O);
            all.residual[row] = nearest.distance - self.task.hand.fingertip_radius();
            if matches!(unknowns, Unknowns::PoseAndJoints(_)) {
                let turn = (tip.p_HF - q.X_HO.translation.vector).cross(&n_H) / length;
                let by_pose = Vector6::new(n_H.x, n_H.y, n_H.z, turn.x, turn.y, turn.z);
                all.by_pose.set_row(row, &-by_pose.transpose());
            }
            all.by_joints.set_row(row, &(n_H.transpose() * tip.J_v));
            for (i, joint) in self.task.hand.finger(finger).joints.iter().enumerate() {
                all.by_joints[(row, i)] /= self.joint_length(joint.kind);
            }
        }
        all
    }

    /// The configuration after one step, clamped to limits and region.
    fn step(
        &self,
        q: &Configuration,
        at: &Linearised,
        unknowns: Unknowns,
        damping: f64,
    ) -> Option<Configuration> {
        let fingers = unknowns.fingers();
        let mut JJt = at.by_pose * at.by_pose.transpose();
        for row in 0..MAX_FINGERS {
            let concerned = fingers.contains(FingerIndex(row as u8));
            // Rows of fingers that are not concerned are zero: any positive diagonal leaves them out.
            JJt[(row, row)] += if concerned { at.by_joints.row(row).norm_squared() + damping } else { 1.0 };
        }
        let y = JJt.cholesky()?.solve(&-at.residual);
        let mut next = q.clone();
        if matches!(unknowns, Unknowns::PoseAndJoints(_)) {
            next.X_HO = self.region.clamp(&self.moved(&q.X_HO, &(at.by_pose.transpose() * y)));
        }
        for finger in fingers.iter() {
            let joints = next.joints[finger].iter_mut().zip(&self.task.hand.finger(finger).joints);
            for (i, (value, joint)) in joints.enumerate() {
                let step = at.by_joints[(finger.index(), i)] * y[finger.index()];
                *value = (*value + step / self.joint_length(joint.kind)).clamp(joint.lower, joint.upper);
            }
        }
        Some(next)
    }

    fn moved(&self, X_HO: &Pose, step: &Vector6<f64>) -> Pose {
        let p = X_HO.translation.vector + step.fixed_rows::<3>(0);
        let turn = step.fixed_rows::<3>(3) / self.turn_length();
        Pose::from_parts(p.into(), Rotation::from_scaled_axis(turn) * X_HO.rotation)
    }

    /// What a turn by one radian counts (m).
    fn turn_length(&self) -> f64 {
        self.task.object.mesh.radius()
    }

    fn joint_length(&self, kind: JointKind) -> f64 {
        if kind == JointKind::Prismatic { 1.0 } else { self.turn_length() }
    }
}
