//! Newton's method on the closure equations: every fingertip's centre at its radius from the object.
//!
//! J. Yakey, S. LaValle, L. Kavraki, "Randomized path planning for linkages with closed kinematic chains",
//! IEEE T-RA 2001; the step of least norm as in D. Berenson, S. Srinivasa, J. Kuffner, "Task space regions",
//! IJRR 2011.

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
    /// What a turn by one radian counts (m): the object's radius.
    pub turn_length: f64,
}

impl Newton<'_> {
    /// Brings the configuration towards closure; some fingers may stay open.
    ///
    /// Damped Gauss-Newton: the step of least norm with J Jᵀ + λ, λ zero until a step does not make the
    /// residual smaller.
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
        for finger in unknowns.fingers().iter() {
            let tip = self.task.hand.tip_kinematics(finger, &q.joints[finger]);
            let nearest = self.projection(q, finger, &tip.p_HF);
            let (row, n_H) = (finger.index(), q.X_HO.rotation * nearest.contact.n_O);
            all.residual[row] = nearest.distance - self.task.hand.fingertip_radius();
            if matches!(unknowns, Unknowns::PoseAndJoints(_)) {
                let turn = (tip.p_HF - q.X_HO.translation.vector).cross(&n_H) / self.turn_length;
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
            self.task.hand.settle(finger, &mut next.joints[finger]);
        }
        Some(next)
    }

    fn moved(&self, X_HO: &Pose, step: &Vector6<f64>) -> Pose {
        let p = X_HO.translation.vector + step.fixed_rows::<3>(0);
        let turn = step.fixed_rows::<3>(3) / self.turn_length;
        Pose::from_parts(p.into(), Rotation::from_scaled_axis(turn) * X_HO.rotation)
    }

    fn joint_length(&self, kind: JointKind) -> f64 {
        if kind == JointKind::Prismatic { 1.0 } else { self.turn_length }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use regrasp_api::Random;
    use regrasp_conformance::fixtures::Bench;

    fn newton<'a>(task: &'a Task<'a>, region: Region) -> Newton<'a> {
        Newton { task, steps: 30, region, turn_length: task.object.mesh.radius() }
    }

    /// Fingers spread over their ranges, far from the object's edges and corners or not.
    fn start(task: &Task<'_>, random: &mut Random) -> Configuration {
        let X_HO = Pose::from_parts(Vec3::new(0.0, 0.0, 0.085).into(), random.rotation());
        let mut q = crate::chains::at_rest(task, X_HO);
        for finger in q.joints.fingers() {
            for (i, joint) in task.hand.finger(finger).joints.iter().enumerate() {
                let (middle, half) = (0.5 * (joint.lower + joint.upper), 0.3 * (joint.upper - joint.lower));
                q.joints[finger][i] = middle + half * random.range(-1.0, 1.0);
            }
        }
        q
    }

    #[test]
    fn derivatives_are_those_of_differences() {
        let step = 1e-6;
        for bench in [Bench::free_cube(), Bench::hand_ellipsoid()] {
            let task = bench.task();
            let newton = newton(&task, Region::Box(Vec3::repeat(-1.0), Vec3::repeat(1.0)));
            let (mut random, all) = (Random::from_key(1, 0, 0, 0), FingerSet::first(4));
            let mut compared = 0;
            for _ in 0..20 {
                let q = start(&task, &mut random);
                let at = newton.linearise(&q, Unknowns::PoseAndJoints(all));
                let residual = |q: &Configuration| newton.linearise(q, Unknowns::PoseAndJoints(all)).residual;
                for k in 0..6 {
                    let mut unit = Vector6::zeros();
                    unit[k] = step;
                    let moved = |sign: f64| Configuration {
                        X_HO: newton.moved(&q.X_HO, &(unit * sign)),
                        ..q.clone()
                    };
                    let slope = (residual(&moved(1.0)) - residual(&moved(-1.0))) / (2.0 * step);
                    let off = (slope - at.by_pose.column(k)).amax();
                    // Where the closest point changes from facet to facet within the step the slope is
                    // neither's.
                    compared += usize::from(off < 1e-3);
                }
                let (finger, kind) = (FingerIndex(2), task.hand.finger(FingerIndex(2)).joints[1].kind);
                let moved = |sign: f64| {
                    let mut moved = q.clone();
                    moved.joints[finger][1] += sign * step / newton.joint_length(kind);
                    residual(&moved)[2]
                };
                let slope = (moved(1.0) - moved(-1.0)) / (2.0 * step);
                compared += usize::from((slope - at.by_joints[(2, 1)]).abs() < 1e-3);
            }
            assert!(compared >= 138, "{compared} of 140 derivatives agree");
        }
    }

    #[test]
    fn free_fingertips_come_straight_to_a_ball() {
        // A slide has no curvature and the offset of a ball is a ball: one finger needs few steps, along the
        // line to the centre.
        let bench = Bench::free_sphere();
        let task = bench.task();
        let newton = newton(&task, Region::Point);
        let mut random = Random::from_key(2, 0, 0, 0);
        let mut touched = 0;
        for _ in 0..50 {
            let mut q = start(&task, &mut random);
            let before = task.hand.tip_center(FingerIndex(0), &q.joints[FingerIndex(0)]);
            let X_HO = q.X_HO;
            let Ok(contact) = newton.touch(&mut q, FingerIndex(0)) else { continue };
            touched += 1;
            assert_eq!(q.X_HO, X_HO, "the object rests");
            let after = task.hand.tip_center(FingerIndex(0), &q.joints[FingerIndex(0)]);
            let wanted = X_HO * nalgebra::Point3::from(contact.tip_center(bench.radius()));
            assert!((after - wanted.coords).norm() < 1e-9);
            // The faceted ball's normals are off the radius by a facet's half angle at most.
            let (inward, step) = (X_HO.translation.vector - before, after - before);
            let sin = step.cross(&inward).norm() / (step.norm() * inward.norm());
            assert!(step.norm() < 1e-6 || sin < 0.2, "{sin}");
        }
        assert!(touched > 30, "{touched} of 50");
    }

    #[test]
    fn all_fingers_close_together_within_limits_and_region() {
        let bench = Bench::hand_sphere();
        let task = bench.task();
        let center = Pose::translation(0.0, 0.0, 0.085);
        let region = Region::Ball(center, 0.01, std::f64::consts::PI);
        let newton = newton(&task, region);
        let (mut random, mut closed) = (Random::from_key(3, 0, 0, 0), 0);
        for _ in 0..100 {
            let mut q = start(&task, &mut random);
            let before = newton.linearise(&q, Unknowns::PoseAndJoints(FingerSet::first(4))).residual.norm();
            newton.close(&mut q, Unknowns::PoseAndJoints(FingerSet::first(4)));
            let after = newton.linearise(&q, Unknowns::PoseAndJoints(FingerSet::first(4))).residual;
            assert!(after.norm() <= before, "a step was taken that does not pay");
            closed += usize::from(after.amax() <= CLOSED);
            assert!((q.X_HO.translation.vector - center.translation.vector).norm() <= 0.01 + 1e-12);
            assert!(q.joints.iter().all(|(finger, joints)| task.hand.within_limits(finger, joints)));
        }
        assert!(closed >= 50, "{closed} of 100 starts close");
    }

    #[test]
    fn an_object_out_of_reach_is_not_touched() {
        let bench = Bench::hand_sphere();
        let task = bench.task();
        let newton = newton(&task, Region::Point);
        let mut q = start(&task, &mut Random::from_key(4, 0, 0, 0));
        q.X_HO = Pose::translation(0.0, 0.0, 1.0);
        assert!(matches!(newton.touch(&mut q, FingerIndex(1)), Err(Reason::Limits | Reason::Closure)));
    }
}
