//! One finger as a chain of jointed bodies, driven by motors.

use crate::border::{from_glam, to_glam};
use crate::settings::SimulationSettings;
use rapier3d_f64::prelude::{
    ColliderBuilder, ColliderHandle, GenericJoint, GenericJointBuilder, Group, InteractionGroups,
    InteractionTestMode, JointAxesMask, MassProperties, MultibodyJointHandle, PhysicsWorld, RigidBodyBuilder,
    RigidBodyHandle, SharedShape,
};
use regrasp_api::{FingerIndex, FingerJoints, Hand, JointKind, TipKinematics, Vec3};

/// Mass of one link (kg). A hand's mass is not in its description; at the speed of manipulation it hardly
/// matters.
const LINK_MASS: f64 = 0.015;
/// Least inertia of a link about its centre (kg·m²): that of a ball of a centimetre.
const LINK_INERTIA: f64 = 2e-6;
/// Inertia of a motor reflected through its gear (kg·m²; kg where prismatic): our choice, that of a small
/// servo.
const ARMATURE: f64 = 5e-5;
const LINEAR_ARMATURE: f64 = 0.02;

/// Collision groups: fingertips meet the object's surface and what is fixed, the object's hull meets what is
/// fixed.
pub(crate) const TIPS: Group = Group::GROUP_1;
pub(crate) const OBJECT: Group = Group::GROUP_2;
/// The object's convex hull, for what is fixed.
pub(crate) const HULL: Group = Group::GROUP_3;
pub(crate) const FIXED: Group = Group::GROUP_4;

pub(crate) fn groups(is: Group, meets: Group) -> InteractionGroups {
    InteractionGroups::new(is, meets, InteractionTestMode::And)
}

struct Joint {
    handle: MultibodyJointHandle,
    /// Which of the six coordinates of rapier's joint moves.
    axis: usize,
    /// Its position (rad; m) where rapier's coordinate is 0.
    zero: f64,
    stiffness: f64,
    damping: f64,
    effort: f64,
}

/// A finger in the simulated world.
pub(crate) struct SimulatedFinger {
    joints: Vec<Joint>,
    /// The last link: it carries the fingertip.
    pub link: RigidBodyHandle,
    /// The fingertip's ball.
    pub tip: ColliderHandle,
}

/// Where a joint's axis passes and how it is directed, in H.
struct Axis {
    kind: JointKind,
    direction: Vec3,
    /// The point of a revolute axis that is nearest to the fingertip's centre (m).
    p: Vec3,
}

/// The joints' axes at a posture, from the fingertip's Jacobians alone: the velocity of the tip's centre
/// about a revolute axis is ω × (c - p), so that the axis' nearest point is p = c - J_v × J_w.
fn axes(tip: &TipKinematics, kinds: impl Iterator<Item = JointKind>) -> Vec<Axis> {
    let axis = |(j, kind): (usize, JointKind)| {
        let (v, w): (Vec3, Vec3) = (tip.J_v.column(j).into(), tip.J_w.column(j).into());
        match kind {
            JointKind::Revolute => Axis { kind, direction: w.normalize(), p: tip.p_HF - v.cross(&w) },
            JointKind::Prismatic => Axis { kind, direction: v.normalize(), p: tip.p_HF },
        }
    };
    kinds.enumerate().map(axis).collect()
}

impl SimulatedFinger {
    /// Builds the finger at rest at `joints`.
    ///
    /// A chain of bodies with the same joints' axes as the finger at this posture moves as the finger does at
    /// every posture. Links have nominal masses and no shapes but the fingertip's ball; their weight is held
    /// by the motors and left out.
    pub fn new(
        world: &mut PhysicsWorld,
        hand: &dyn Hand,
        finger: FingerIndex,
        joints: &FingerJoints,
        settings: &SimulationSettings,
    ) -> Self {
        let models = &hand.finger(finger).joints;
        let tip = hand.tip_kinematics(finger, joints);
        let axes = axes(&tip, models.iter().map(|joint| joint.kind));
        let mut parent = (world.bodies.insert(RigidBodyBuilder::fixed()), Vec3::zeros());
        let mut chain = Vec::with_capacity(axes.len());
        for (j, axis) in axes.iter().enumerate() {
            let end = axes.get(j + 1).map_or(tip.p_HF, |next| next.p);
            let link = world.bodies.insert(link(&axis.p, &end));
            let joint = joint(axis, &(axis.p - parent.1));
            let handle = world.multibody_joints.insert(parent.0, link, joint, true);
            let handle = handle.expect("a new link has no joint yet");
            chain.push(Joint::new(handle, axis.kind, joints[j], models[j].effort, settings));
            parent = (link, axis.p);
        }
        let ball = ColliderBuilder::new(SharedShape::ball(hand.fingertip_radius()))
            .translation(to_glam(&(tip.p_HF - parent.1)))
            .density(0.0)
            .friction(settings.friction.unwrap_or(0.0))
            .collision_groups(groups(TIPS, OBJECT | FIXED));
        let tip = world.colliders.insert_with_parent(ball, parent.0, &mut world.bodies);
        let finger = Self { joints: chain, link: parent.0, tip };
        finger.prepare(world);
        finger
    }

    fn prepare(&self, world: &mut PhysicsWorld) {
        for joint in &self.joints {
            let (multibody, id) = joint.in_world(world);
            let dof = multibody.link(id).expect("its own link").assembly_id();
            let armature = if joint.axis < 3 { LINEAR_ARMATURE } else { ARMATURE };
            multibody.armature_mut()[dof] = armature;
            multibody.damping_mut()[dof] = joint.damping;
        }
    }

    /// Sets the motors' targets: positions (rad; m), speeds (rad/s; m/s) and efforts fed forward (N·m; N).
    ///
    /// A motor is a spring k (q* - q) with a damper d (q̇* - q̇), whose sum saturates at the joint's effort.
    /// Both act implicitly: rapier's joint spring and damping, the spring's rest being q* + (d q̇* + τ)/k.
    pub fn drive(
        &self,
        world: &mut PhysicsWorld,
        target: &FingerJoints,
        speed: &FingerJoints,
        feed: &FingerJoints,
    ) {
        for (j, joint) in self.joints.iter().enumerate() {
            let (multibody, id) = joint.in_world(world);
            let link = multibody.link(id).expect("its own link");
            let (q, dof) = (link.joint().coords()[joint.axis], link.assembly_id());
            let damping = joint.damping * multibody.generalized_velocity()[dof];
            let rest = target[j] - joint.zero + (joint.damping * speed[j] + feed[j]) / joint.stiffness;
            let effort = joint.stiffness * (rest - q) - damping;
            let within = effort.clamp(-joint.effort, joint.effort);
            let rest = rest + (within - effort) / joint.stiffness;
            let link = multibody.link_mut(id).expect("its own link");
            link.joint.set_spring(joint.axis, joint.stiffness, rest);
        }
    }

    /// Centre of the fingertip in H (m).
    pub fn center(&self, world: &PhysicsWorld) -> Vec3 {
        from_glam(world.colliders[self.tip].translation())
    }
}

impl Joint {
    fn new(
        handle: MultibodyJointHandle,
        kind: JointKind,
        zero: f64,
        effort: f64,
        settings: &SimulationSettings,
    ) -> Self {
        let (axis, stiffness) = match kind {
            JointKind::Revolute => (3, settings.stiffness),
            JointKind::Prismatic => (0, settings.linear_stiffness),
        };
        Self { handle, axis, zero, stiffness, damping: stiffness * settings.damping_time, effort }
    }

    fn in_world<'a>(
        &self,
        world: &'a mut PhysicsWorld,
    ) -> (&'a mut rapier3d_f64::dynamics::Multibody, usize) {
        world.multibody_joints.get_mut(self.handle).expect("the joint was inserted")
    }
}

/// A link whose frame is at its joint, aligned with H, and which reaches to `end`.
fn link(start: &Vec3, end: &Vec3) -> RigidBodyBuilder {
    let along = end - start;
    let inertia = LINK_MASS * along.norm_squared() / 12.0 + LINK_INERTIA;
    let mass = MassProperties::new(to_glam(&(along / 2.0)), LINK_MASS, to_glam(&Vec3::repeat(inertia)));
    RigidBodyBuilder::dynamic()
        .translation(to_glam(start))
        .additional_mass_properties(mass)
        .gravity_scale(0.0)
        .can_sleep(false)
}

/// The joint that moves along rapier's first axis, turned onto ours.
fn joint(axis: &Axis, from_parent: &Vec3) -> GenericJoint {
    let free = match axis.kind {
        JointKind::Revolute => JointAxesMask::ANG_X,
        JointKind::Prismatic => JointAxesMask::LIN_X,
    };
    GenericJointBuilder::new(JointAxesMask::all() ^ free)
        .local_axis1(to_glam(&axis.direction))
        .local_axis2(to_glam(&axis.direction))
        .local_anchor1(to_glam(from_parent))
        .contacts_enabled(false)
        .build()
}

#[cfg(test)]
#[path = "finger_tests.rs"]
mod tests;
