//! Mistakes of samplers.

use crate::support::blind::Blinkered;
use regrasp_api::*;
use regrasp_conformance::reference::RejectionSampler;

struct Mistaken(String);

impl Mistaken {
    fn new(mistake: String, _: &Parts<'_>) -> Self {
        Self(mistake)
    }

    /// The request as the author understood it.
    fn pose(&self, task: &Task<'_>, asked: PoseRequest<'_>, random: &mut Random) -> Option<Pose> {
        let (lower, upper) = task.workspace;
        let p = Vec3::from_fn(|i, _| random.range(lower[i], upper[i]));
        match (self.0.as_str(), asked) {
            // Turns about the vertical axis alone.
            ("upright", PoseRequest::Anywhere) => {
                let turn = Rotation::from_axis_angle(&Vec3::z_axis(), random.range(-3.1, 3.1));
                Some(Pose::from_parts(p.into(), turn))
            }
            ("near-the-start", PoseRequest::Anywhere) => {
                let turn = Rotation::from_scaled_axis(random.direction() * (0.9 * random.unit()));
                Some(Pose::from_parts(p.into(), turn * task.landmarks[0].rotation))
            }
            ("upper-half", PoseRequest::Anywhere) => {
                let p = Vec3::new(p.x, p.y, p.z.max(0.5 * (lower.z + upper.z)));
                Some(Pose::from_parts(p.into(), random.rotation()))
            }
            ("box-for-ball", PoseRequest::Near { configuration, radius, angle }) => {
                let X_HO = configuration.X_HO;
                let d = Vec3::from_fn(|_, _| random.range(-radius, radius));
                let turn = Rotation::from_scaled_axis(random.direction() * (angle * random.unit()));
                Some(Pose::from_parts((X_HO.translation.vector + d).into(), turn * X_HO.rotation))
            }
            ("angle-for-each-axis", PoseRequest::Near { configuration, radius, angle }) => {
                let X_HO = configuration.X_HO;
                let d = random.direction() * (radius * random.unit());
                let turn = Vec3::from_fn(|_, _| random.range(-angle, angle));
                let rotation = Rotation::from_scaled_axis(turn) * X_HO.rotation;
                Some(Pose::from_parts((X_HO.translation.vector + d).into(), rotation))
            }
            ("moves-a-little", PoseRequest::At(X_HO)) => {
                let moved = X_HO.translation.vector + random.direction() * 1e-7;
                Some(Pose::from_parts(moved.into(), X_HO.rotation))
            }
            _ => None,
        }
    }

    /// A sample as the author would have it.
    fn spoil(&self, task: &Task<'_>, q: &mut Configuration) {
        let first = q.holding().iter().next().unwrap_or(FingerIndex(0));
        match self.0.as_str() {
            "tip-at-the-surface" => {
                if let Some(contact) = &q.contacts[first] {
                    let p_HF = q.X_HO.rotation * contact.p_OC + q.X_HO.translation.vector;
                    q.joints[first] =
                        task.hand.inverse(first, &p_HF, &q.joints[first]).unwrap_or(q.joints[first]);
                }
            }
            "inward-normals" => {
                q.contacts.fingers().for_each(|f| q.contacts[f].iter_mut().for_each(|c| c.n_O = -c.n_O));
            }
            "zero-for-rest" => {
                for finger in q.joints.fingers().filter(|f| q.contacts[*f].is_none()) {
                    q.joints[finger] = FingerJoints::zeros(q.joints[finger].len());
                }
            }
            "drifting-orientation" => {
                let stretched = q.X_HO.rotation.into_inner() * (1.0 + 1e-4);
                q.X_HO.rotation = Rotation::new_unchecked(stretched);
            }
            "other-finger" => {
                let free = q.contacts.fingers().find(|f| q.contacts[*f].is_none());
                if let Some(free) = free {
                    (q.contacts[free], q.contacts[first]) = (q.contacts[first], None);
                }
            }
            "clamps-joints" => {
                let model = task.hand.finger(first);
                for (x, joint) in q.joints[first].iter_mut().zip(&model.joints) {
                    *x = x.clamp(joint.lower + 0.2 * (joint.upper - joint.lower), joint.upper);
                }
            }
            _ => {}
        }
    }
}

impl ClosedChainSampler for Mistaken {
    fn sample(
        &self,
        task: &Task<'_>,
        pose: PoseRequest<'_>,
        holding: FingerSet,
        context: &mut Context<'_>,
    ) -> Result<Option<Configuration>, CallError> {
        let everyone = FingerSet::first(task.hand.finger_count());
        let holding = if self.0 == "all-fingers" { everyone } else { holding };
        match (self.0.as_str(), pose) {
            ("copies-its-neighbour", PoseRequest::Near { configuration, .. })
                if configuration.holding() == holding =>
            {
                context.count_call(Slot::Sampler);
                context.proceed()?;
                return Ok(Some(configuration.clone()));
            }
            ("own-seed", _) => {
                let mut own = context.twin();
                own.random = Random::from_key(1, 2, 3, 4);
                let found = RejectionSampler.sample(task, pose, holding, &mut own);
                context.tally.add(&own.tally);
                return found;
            }
            ("says-no-more", _) => {
                let mut own = context.twin();
                context.count_call(Slot::Sampler);
                return RejectionSampler.sample(task, pose, holding, &mut own);
            }
            ("forgets-the-obstacles", _) => {
                let all = task.clearance;
                let sees = |pair: &BodyPair| {
                    !matches!(pair, (Body::Object, Body::Obstacle(_)) | (Body::Obstacle(_), Body::Object))
                };
                let clearance = Blinkered { all, sees };
                let task = Task { clearance: &clearance, ..*task };
                return RejectionSampler.sample(&task, pose, holding, context);
            }
            _ => {}
        }
        let wanted = self.pose(task, pose, &mut context.random).map_or(pose, PoseRequest::At);
        let mut found = RejectionSampler.sample(task, wanted, holding, context)?;
        if let Some(q) = &mut found {
            self.spoil(task, q);
        }
        Ok(found)
    }

    fn close(
        &self,
        task: &Task<'_>,
        X_HO: &Pose,
        contacts: &PerFinger<Option<Contact>>,
        near: &Configuration,
        context: &mut Context<'_>,
    ) -> Result<Option<Configuration>, CallError> {
        let contacts = if self.0 == "own-contacts" { &near.contacts } else { contacts };
        let mut found = RejectionSampler.close(task, X_HO, contacts, near, context)?;
        match (self.0.as_str(), &mut found) {
            ("close-at-rest", Some(q)) => {
                for finger in q.holding().iter() {
                    let Some(p_HF) = q.contact_tip_center(finger, task.hand.fingertip_radius()) else {
                        continue;
                    };
                    let rest = &task.hand.finger(finger).rest;
                    q.joints[finger] = task.hand.inverse(finger, &p_HF, rest).unwrap_or(q.joints[finger]);
                }
            }
            ("close-first-finger", Some(q)) => {
                for finger in q.joints.fingers().skip(1) {
                    q.joints[finger] = near.joints[finger];
                }
            }
            ("close-what-is-near", None) => {
                return Ok(Some(Configuration { X_HO: *X_HO, contacts: *contacts, ..near.clone() }));
            }
            ("close-beyond-limits", Some(q)) => {
                for (finger, joints) in near.joints.iter() {
                    let turn = std::f64::consts::TAU;
                    let revolute = task.hand.finger(finger).joints[0].kind == JointKind::Revolute;
                    if revolute && joints[0] > 0.3 {
                        q.joints[finger][0] += turn;
                    }
                }
            }
            ("close-only-stable", Some(q)) => {
                let grasp = task.grasp(q, q.holding());
                if !task.stability.test(&grasp, &mut Hint::default(), context)?.is_stable() {
                    return Ok(None);
                }
            }
            _ => {}
        }
        Ok(found)
    }
}

#[test]
fn caught() {
    let entry = crate::mistaken!(Sampler, "sampler", &[Slot::Sampler], Mistaken::new);
    super::judge(
        &entry,
        &[
            ("upright", "sample-spreads"),
            ("near-the-start", "sample-spreads"),
            ("upper-half", "sample-spreads"),
            ("box-for-ball", "sample-pose"),
            ("angle-for-each-axis", "sample-pose"),
            ("moves-a-little", "sample-pose"),
            ("tip-at-the-surface", "sample-closed"),
            ("inward-normals", "sample-closed"),
            ("zero-for-rest", "sample-admissible|sample-limits"),
            ("drifting-orientation", "sample-closed|sample-pose"),
            ("other-finger", "sample-holding"),
            ("clamps-joints", "sample-closed"),
            ("all-fingers", "sample-holding"),
            ("copies-its-neighbour", "sample-varies"),
            ("own-seed", "sample-varies"),
            ("says-no-more", "sampler-reasons"),
            ("forgets-the-obstacles", "sample-admissible"),
            ("own-contacts", "close-exact"),
            ("close-at-rest", "close-exact"),
            ("close-first-finger", "close-exact"),
            ("close-what-is-near", "close-refuses"),
            ("close-beyond-limits", "close-exact"),
            ("close-only-stable", "close-exact"),
        ],
    );
}
