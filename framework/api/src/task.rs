//! The immutable task that all calls of one search share.

use crate::{
    CallError, Clearance, Cone, Configuration, Contact, ContactModel, Context, EffortBounds, FingerIndex,
    FingerJoints, FingerSet, Grasp, GraspContact, Hand, ObjectModel, Pose, Random, Reason, Resolution,
    StabilityTest, SurfaceParam, Tolerances, Vec3,
};

/// The planner's predicate for nodes: collision-free, stable, and easy to leave by transfers and regrasps.
///
/// A heuristic that makes the reduction property work in practice: nodes must pass it; a given start or goal
/// that fails it is warned about, not refused.
pub trait Admissible: Send + Sync {
    /// One finger that a sampler has just placed: contact away from sharp edges, finger free of palm,
    /// obstacles, object and the fingers in `placed`, able to retreat. A finger without contact must be free
    /// of all of them. `None` if it may stay.
    fn admit_finger(
        &self,
        task: &Task<'_>,
        q: &Configuration,
        finger: FingerIndex,
        placed: FingerSet,
        context: &mut Context<'_>,
    ) -> Result<Option<Reason>, CallError>;

    /// The grasp as a whole, its fingers having passed [`Admissible::admit_finger`]: stable, and enough of
    /// its fingers liftable.
    fn admit_grasp(
        &self,
        task: &Task<'_>,
        q: &Configuration,
        context: &mut Context<'_>,
    ) -> Result<Option<Reason>, CallError>;

    /// `None` if the configuration may become a node, otherwise why not: the object, each finger, the grasp.
    fn admit(
        &self,
        task: &Task<'_>,
        q: &Configuration,
        context: &mut Context<'_>,
    ) -> Result<Option<Reason>, CallError> {
        if task.clearance.object_free(&q.X_HO).is_err() {
            return Ok(Some(Reason::Collision));
        }
        let mut placed = FingerSet::EMPTY;
        for finger in q.joints.fingers() {
            if let Some(reason) = self.admit_finger(task, q, finger, placed, context)? {
                return Ok(Some(reason));
            }
            placed = placed.with(finger);
        }
        self.admit_grasp(task, q, context)
    }
}
const _: Option<&dyn Admissible> = None; // must stay object safe

/// Everything that the calls of one search share and nobody changes.
#[derive(Clone, Copy)]
pub struct Task<'a> {
    /// Kinematics and limits of the hand.
    pub hand: &'a dyn Hand,
    /// Collision and distance.
    pub clearance: &'a dyn Clearance,
    /// Which wrenches contacts transmit.
    pub contact_model: &'a dyn ContactModel,
    /// Which grasps are stable.
    pub stability: &'a dyn StabilityTest,
    /// The object's surface.
    pub surface: &'a dyn SurfaceParam,
    /// Which configurations may become nodes.
    pub admissible: &'a dyn Admissible,
    /// The object.
    pub object: &'a ObjectModel,
    /// Acceleration of gravity in H (m/s²).
    pub g_H: Vec3,
    /// What a plan must keep.
    pub tolerances: &'a Tolerances,
    /// How finely the planner works.
    pub resolution: &'a Resolution,
    /// Lowest and highest coordinates of the object's origin in H (m) for samples.
    pub workspace: (Vec3, Vec3),
    /// The object's poses at the start and the goals of the search, in turn; samplers may draw near the
    /// motion between them.
    pub landmarks: &'a [Pose],
}

impl<'a> Task<'a> {
    /// A random touch of the object at `X_HO`: a contact drawn from the surface, and the finger's joints
    /// there; its spare joints are drawn into `near`. `None` where the finger does not reach.
    pub fn draw_touch(
        &self,
        finger: FingerIndex,
        X_HO: &Pose,
        near: &mut FingerJoints,
        random: &mut Random,
    ) -> Option<(Contact, FingerJoints)> {
        let (model, radius) = (self.hand.finger(finger), self.hand.fingertip_radius());
        let contact = self.surface.sample(random);
        let p_HF = X_HO.rotation * contact.tip_center(radius) + X_HO.translation.vector;
        if (p_HF - model.p_HReach).norm_squared() > model.reach * model.reach {
            return None;
        }
        for &joint in &model.spare {
            near[joint] = random.range(model.joints[joint].lower, model.joints[joint].upper);
        }
        Some((contact, self.hand.inverse(finger, &p_HF, near)?))
    }

    /// The friction coefficient to plan with: the object's, less the planner's margin.
    pub fn planning_friction(&self) -> f64 {
        self.object.friction * self.resolution.friction_margin
    }

    /// The grasp of the fingers in `holding` (those of them that touch) at `q`, with the planning friction.
    ///
    /// For what rests: regrasps, start and goals. While the object moves it is [`Task::transfer_grasp`]. The
    /// joints of `q` must be those that hold: where the stability test asks for them, the grasp carries what
    /// they can exert.
    pub fn grasp(&self, q: &Configuration, holding: FingerSet) -> Grasp<'a> {
        let mu = self.planning_friction();
        self.grasp_with(q, holding, |finger, contact| self.contact_model.cone(finger, contact, mu))
    }

    /// The same with the friction coefficient `mu`, without the planner's margin: for grasps that are given.
    pub fn grasp_with_friction(&self, q: &Configuration, holding: FingerSet, mu: f64) -> Grasp<'a> {
        self.grasp_with(q, holding, |finger, contact| self.contact_model.cone(finger, contact, mu))
    }

    /// The same while the object moves: contacts may spin about their normals, and then transmit no torsion,
    /// but drag with as much.
    ///
    /// A transfer, and a path in GS_n that transfers are to follow, is stable where this grasp is.
    pub fn transfer_grasp(&self, q: &Configuration, holding: FingerSet) -> Grasp<'a> {
        let mu = self.planning_friction();
        let cone =
            |finger: FingerIndex, contact: &Contact| self.contact_model.spinning_cone(finger, contact, mu);
        let mut grasp = Grasp::new(q.X_HO.rotation.inverse() * self.g_H);
        let drags = self.stability.uses_efforts();
        self.fill(&mut grasp, q, holding, cone, |grasp, finger, contact| {
            if drags {
                grasp.drags(self.contact_model.cone(finger, contact, mu).torsion());
            }
        });
        grasp
    }

    fn grasp_with(
        &self,
        q: &Configuration,
        holding: FingerSet,
        cone: impl Fn(FingerIndex, &Contact) -> Cone<'a>,
    ) -> Grasp<'a> {
        let mut grasp = Grasp::new(q.X_HO.rotation.inverse() * self.g_H);
        self.fill(&mut grasp, q, holding, cone, |_, _, _| {});
        grasp
    }

    /// Adds the contacts with their cones, and says of each what else there is to say.
    fn fill(
        &self,
        grasp: &mut Grasp<'a>,
        q: &Configuration,
        holding: FingerSet,
        cone: impl Fn(FingerIndex, &Contact) -> Cone<'a>,
        more: impl Fn(&mut Grasp<'a>, FingerIndex, &Contact),
    ) {
        let bounded = self.stability.uses_efforts();
        for (finger, contact) in q.contacts.iter() {
            if let (Some(contact), true) = (contact, holding.contains(finger)) {
                let cone = cone(finger, contact);
                let touch = GraspContact { finger, p_OC: contact.p_OC, n_O: contact.n_O, cone };
                if bounded {
                    let joints = &q.joints[finger];
                    let efforts = EffortBounds::at(self.hand, finger, joints, &q.X_HO, &contact.n_O);
                    grasp.push_bounded(touch, efforts);
                } else {
                    grasp.push(touch);
                }
                more(grasp, finger, contact);
            }
        }
    }
}
