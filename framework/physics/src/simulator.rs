//! Steps the simulated world along a schedule and measures what happens to the object.

use crate::border::{from_glam, pose_from_glam, pose_to_glam, to_glam};
use crate::finger::{FIXED, HULL, OBJECT, SimulatedFinger, TIPS, groups};
use crate::fixed::{self, Placed};
use crate::{Bounds, Failure, Happening, Outcome, SimulationSettings};
use rapier3d_f64::dynamics::{FrictionModel, IntegrationParameters, SpringCoefficients};
use rapier3d_f64::prelude::{
    ColliderBuilder, ColliderHandle, MassProperties, PhysicsWorld, RigidBodyBuilder, RigidBodyHandle,
    SharedShape,
};
use regrasp_api::{
    FingerIndex, FingerJoints, FingerSet, Hand, ObjectModel, PerFinger, Pose, Vec3, angle_between,
    interpolate,
};

/// What the motors are told at one time, and what the plan means then.
#[derive(Clone, Debug)]
pub(crate) struct Knot {
    /// Time from the start of the simulation (s).
    pub time: f64,
    pub X_HO: Pose,
    pub joints: PerFinger<FingerJoints>,
    /// Efforts fed forward (N·m; N).
    pub feed: PerFinger<FingerJoints>,
    /// The fingers that hold from here to the next knot.
    pub holding: FingerSet,
}

/// Fingertips closer than this to the object (m) are looked at as contacts.
const PREDICTION: f64 = 1e-3;

/// The simulated world of one hand and one object.
pub(crate) struct Simulator {
    world: PhysicsWorld,
    fingers: Vec<SimulatedFinger>,
    object: RigidBodyHandle,
    surface: ColliderHandle,
    radius: f64,
    slip_O: PerFinger<Vec3>,
}

/// Hand, object, what is fixed, and gravity (m/s², in H), with shapes as rapier has them.
#[derive(Clone, Copy)]
pub(crate) struct Scene<'a> {
    pub hand: &'a dyn Hand,
    pub object: &'a ObjectModel,
    /// The object's surface as fingertips meet it.
    pub shape: &'a SharedShape,
    /// Palm and obstacles, in H.
    pub fixed: &'a [Placed],
    /// The object as they meet it.
    pub hull: Option<&'a SharedShape>,
    pub g_H: Vec3,
}

fn parameters(settings: &SimulationSettings) -> IntegrationParameters {
    IntegrationParameters {
        dt: settings.time_step,
        contact_softness: SpringCoefficients::new(0.1 / settings.time_step, 1.0),
        friction_model: FrictionModel::Coulomb,
        friction_in_bias_pass: true,
        contact_recycling: false,
        contact_clustering: false,
        normalized_allowed_linear_error: 1e-5,
        normalized_prediction_distance: PREDICTION,
        max_ccd_substeps: 0,
        num_solver_iterations: 1,
        ..Default::default()
    }
}

impl Simulator {
    /// The world at rest at the first knot.
    pub fn new(scene: &Scene<'_>, settings: &SimulationSettings, start: &Knot) -> Self {
        let mut world = PhysicsWorld {
            gravity: to_glam(&scene.g_H),
            integration_parameters: parameters(settings),
            ..Default::default()
        };
        let friction = settings.friction.unwrap_or(scene.object.friction);
        let settings = SimulationSettings { friction: Some(friction), ..*settings };
        let fingers = start
            .joints
            .iter()
            .map(|(finger, joints)| SimulatedFinger::new(&mut world, scene.hand, finger, joints, &settings))
            .collect();
        fixed::insert(&mut world, scene.fixed);
        let (object, surface) = insert_object(&mut world, scene, &settings, &start.X_HO);
        let slip_O = PerFinger::filled(start.joints.len(), Vec3::zeros());
        Self { world, fingers, object, surface, radius: scene.hand.fingertip_radius(), slip_O }
    }

    /// Goes through the knots and takes what happens into the outcome, until something happens that must not.
    /// Net slip counts from here. `passed` is told the time (s) and the object's pose at each knot but the
    /// first, and where the run ends early.
    pub fn run(
        &mut self,
        knots: &[Knot],
        bounds: &Bounds,
        outcome: &mut Outcome,
        passed: &mut dyn FnMut(f64, Pose),
    ) {
        self.slip_O = PerFinger::filled(self.slip_O.len(), Vec3::zeros());
        let dt = self.world.integration_parameters.dt;
        for (state, pair) in knots.windows(2).enumerate() {
            let span = pair[1].time - pair[0].time;
            let steps = (span / dt).ceil().max(1.0);
            // A knot is met exactly: the last few steps may be shorter than asked for, never longer.
            self.world.integration_parameters.dt = (span / steps).max(1e-6);
            for step in 1..=steps as usize {
                let s = step as f64 / steps;
                self.drive(pair, s, span);
                self.world.step();
                if let Some(what) = self.measure(pair, s, bounds, outcome) {
                    let time = pair[0].time + s * span;
                    outcome.failure = Some(Failure { what, time, state });
                    passed(time, self.pose());
                    self.world.integration_parameters.dt = dt;
                    return;
                }
            }
            passed(pair[1].time, self.pose());
        }
        self.world.integration_parameters.dt = dt;
    }

    fn drive(&mut self, pair: &[Knot], s: f64, span: f64) {
        for (finger, simulated) in self.fingers.iter().enumerate() {
            let finger = FingerIndex(finger as u8);
            let (a, b) = (&pair[0].joints[finger], &pair[1].joints[finger]);
            let feed = pair[0].feed[finger].interpolate(&pair[1].feed[finger], s);
            let mut speed = *b;
            speed
                .iter_mut()
                .zip(a.iter())
                .for_each(|(b, a)| *b = if span > 0.0 { (*b - a) / span } else { 0.0 });
            simulated.drive(&mut self.world, &a.interpolate(b, s), &speed, &feed);
        }
    }

    /// Takes the state after a step into the outcome; says what must not happen.
    fn measure(
        &mut self,
        pair: &[Knot],
        s: f64,
        bounds: &Bounds,
        outcome: &mut Outcome,
    ) -> Option<Happening> {
        let X_HO = self.pose();
        let planned = interpolate(&pair[0].X_HO, &pair[1].X_HO, s);
        let distance = (X_HO.translation.vector - planned.translation.vector).norm();
        let angle = angle_between(&X_HO.rotation, &planned.rotation);
        outcome.distance = outcome.distance.max(distance);
        outcome.angle = outcome.angle.max(angle);
        if !(distance <= bounds.distance && angle <= bounds.angle) {
            return Some(Happening::Stray);
        }
        pair[0].holding.iter().find_map(|finger| self.measure_contact(&X_HO, finger, bounds, outcome))
    }

    fn measure_contact(
        &mut self,
        X_HO: &Pose,
        finger: FingerIndex,
        bounds: &Bounds,
        outcome: &mut Outcome,
    ) -> Option<Happening> {
        let (gap, n_H) = self.contact(finger).unwrap_or((PREDICTION, Vec3::zeros()));
        outcome.gap[finger] = outcome.gap[finger].max(gap);
        if gap > bounds.gap {
            return Some(Happening::Lift(finger));
        }
        let simulated = &self.fingers[finger.index()];
        let p_H = to_glam(&(simulated.center(&self.world) - n_H * self.radius));
        let (link, object) = (&self.world.bodies[simulated.link], &self.world.bodies[self.object]);
        let v_H = from_glam(link.velocity_at_point(p_H) - object.velocity_at_point(p_H));
        let along_H = v_H - n_H * n_H.dot(&v_H);
        let dt = self.world.integration_parameters.dt;
        self.slip_O[finger] += X_HO.rotation.inverse() * along_H * dt;
        let slip = self.slip_O[finger].norm();
        outcome.slip[finger] = outcome.slip[finger].max(slip);
        (slip > bounds.slip).then_some(Happening::Slip(finger))
    }

    /// The gap (m) between fingertip and object, and the normal outward from the object; `None` where they
    /// are far apart.
    fn contact(&self, finger: FingerIndex) -> Option<(f64, Vec3)> {
        let tip = self.fingers[finger.index()].tip;
        let pair = self.world.narrow_phase.contact_pair(tip, self.surface)?;
        let (manifold, point) = pair.find_deepest_contact()?;
        let normal = from_glam(manifold.data.normal);
        // From the pair's first collider to its second.
        let outward = if pair.collider1 == tip { -normal } else { normal };
        Some((point.dist, outward))
    }

    /// The object's pose.
    pub fn pose(&self) -> Pose {
        pose_from_glam(self.world.bodies[self.object].position())
    }
}

fn insert_object(
    world: &mut PhysicsWorld,
    scene: &Scene<'_>,
    settings: &SimulationSettings,
    X_HO: &Pose,
) -> (RigidBodyHandle, ColliderHandle) {
    let model = scene.object;
    let mass = settings.mass.unwrap_or(model.mass);
    let inertia = model.inertia_OCm * (mass / model.mass);
    let properties = MassProperties::with_inertia_matrix(to_glam(&model.p_OCm), mass, matrix(&inertia));
    let body = RigidBodyBuilder::dynamic()
        .pose(pose_to_glam(X_HO))
        .additional_mass_properties(properties)
        .can_sleep(false);
    let body = world.bodies.insert(body);
    let collider = ColliderBuilder::new(scene.shape.clone())
        .density(0.0)
        .friction(settings.friction.unwrap_or(model.friction))
        .collision_groups(groups(OBJECT, TIPS));
    let collider = world.colliders.insert_with_parent(collider, body, &mut world.bodies);
    if let Some(hull) = scene.hull {
        let hull = ColliderBuilder::new(hull.clone())
            .density(0.0)
            .friction(model.friction)
            .collision_groups(groups(HULL, FIXED));
        world.colliders.insert_with_parent(hull, body, &mut world.bodies);
    }
    (body, collider)
}

fn matrix(m: &regrasp_api::Mat3) -> rapier3d_f64::math::Matrix {
    let column = |j| to_glam(&m.column(j).into());
    rapier3d_f64::math::Matrix::from_cols(column(0), column(1), column(2))
}
