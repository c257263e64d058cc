//! Start and goals: grasps that are given are checked, grasps that are not given are found.

use crate::admissible::Stable;
use crate::error::{End, PlanError, explain};
use crate::foresight::outlook;
use crate::session::{Call, Counted, Session, Work};
use crate::shortest_path::Length;
use regrasp_api::{
    Admissible, CallError, Configuration, Contact, FingerGrasp, FingerIndex, FingerJoints, FingerSet,
    PerFinger, Pose, PoseRequest, Tally, Task,
};
use std::collections::VecDeque;

/// How far a given contact point may lie from the surface (m).
const CONTACT_TOLERANCE: f64 = 1e-3;
/// How far the fingertip of given joints may lie from its contact (m).
const JOINT_TOLERANCE: f64 = 1e-3;
/// Points this near each other (m) are one: what a plan file's numbers and its fingertips' closure leave.
const SAME_POINT: f64 = 1e-5;
/// Normals this near each other are one.
const SAME_NORMAL: f64 = 1e-6;
/// How many calls of the sampler look for a grasp at a given pose before the search gives up.
const GRASP_CALLS: u64 = 40;

/// The configuration of a grasp that the problem gives, checked: reach, limits, collision, stability.
pub(crate) fn given(
    work: &mut Work<'_>,
    end: End,
    X_HO: Pose,
    grasp: &[FingerGrasp],
) -> Result<Configuration, PlanError> {
    let task = work.task;
    let count = task.hand.finger_count();
    if grasp.len() != count {
        let reason = format!(
            "{} entries for a hand of {count} fingers; give one for each, {{}} for a free one",
            grasp.len()
        );
        return Err(PlanError::Grasp { end, reason });
    }
    let mut q = Configuration {
        X_HO,
        joints: PerFinger::from_fn(count, |finger| task.hand.finger(finger).rest),
        contacts: PerFinger::filled(count, None),
    };
    for finger in q.joints.fingers() {
        let fault =
            |reason| PlanError::Finger { end, finger, name: task.hand.finger(finger).name.clone(), reason };
        place(task, &mut q, finger, &grasp[finger.index()]).map_err(fault)?;
    }
    let all = FingerSet::first(count);
    task.clearance.configuration_free(&q, all, true).map_err(|pair| PlanError::Collision { end, pair })?;
    if !stable(work, &q)? {
        return Err(PlanError::Unstable { end, friction: task.object.friction });
    }
    Ok(q)
}

/// Places one finger as its entry says; the error says what is wrong with it.
fn place(
    task: &Task<'_>,
    q: &mut Configuration,
    finger: FingerIndex,
    entry: &FingerGrasp,
) -> Result<(), String> {
    let model = task.hand.finger(finger);
    if let Some(joints) = &entry.joints {
        if joints.len() != model.joints.len() {
            return Err(format!("has {} joints, `joints` gives {}", model.joints.len(), joints.len()));
        }
        q.joints[finger] = FingerJoints::from_slice(joints);
        if !task.hand.within_limits(finger, &q.joints[finger]) {
            return Err("is outside its joint limits".into());
        }
    }
    let Some(point) = entry.contact else { return Ok(()) };
    let mut contact = on_surface(task, point.into())?;
    if entry.joints.is_some() {
        contact = leaning(task, q, finger, contact);
    }
    q.contacts[finger] = Some(contact);
    let radius = task.hand.fingertip_radius();
    let p_HF = q.contact_tip_center(finger, radius).expect("the contact was just set");
    if entry.joints.is_some()
        && (task.hand.tip_center(finger, &q.joints[finger]) - p_HF).norm() > JOINT_TOLERANCE
    {
        return Err("does not touch its `contact` with the given `joints` (more than 1 mm away)".into());
    }
    let reach = task.hand.inverse(finger, &p_HF, &q.joints[finger]);
    q.joints[finger] = reach.ok_or("cannot reach its contact within its joint limits")?;
    Ok(())
}

/// The contact at a point that should lie on the surface (m, in O).
fn on_surface(task: &Task<'_>, p_OC: regrasp_api::Vec3) -> Result<Contact, String> {
    if !p_OC.iter().all(|x| x.is_finite()) {
        return Err("has a `contact` that is not finite".into());
    }
    let projection = task.surface.project(&p_OC, None);
    if projection.distance.abs() > CONTACT_TOLERANCE {
        let far = projection.distance * 1e3;
        return Err(format!("has a `contact` {far:.2} mm off the object's surface; at most 1 mm is allowed"));
    }
    // From a little outside, the closest point has the facet's own normal, whichever side the given point lay
    // on.
    let lifted = projection.contact.p_OC + projection.contact.n_O * task.hand.fingertip_radius();
    Ok(task.surface.project(&lifted, Some(projection.contact.facet)).contact)
}

/// The contact as the fingertip of the given joints has it, where that touches at this very point: on an edge
/// a point alone does not say which way the fingertip leans.
fn leaning(task: &Task<'_>, q: &Configuration, finger: FingerIndex, contact: Contact) -> Contact {
    let p_HF = task.hand.tip_center(finger, &q.joints[finger]);
    let p_OF = q.X_HO.inverse_transform_point(&p_HF.into()).coords;
    let touched = task.surface.project(&p_OF, Some(contact.facet));
    let is_here = (touched.contact.p_OC - contact.p_OC).norm() <= SAME_POINT
        && (touched.distance - task.hand.fingertip_radius()).abs() <= JOINT_TOLERANCE;
    let leans = (touched.contact.n_O - contact.n_O).norm() > SAME_NORMAL;
    if is_here && leans { touched.contact } else { contact }
}

/// Whether the grasp is stable with the object's own friction (no planner's margin).
fn stable(work: &mut Work<'_>, q: &Configuration) -> Result<bool, CallError> {
    let task = work.task;
    let grasp = task.grasp_with_friction(q, q.holding(), task.object.friction);
    Ok(!grasp.contacts().is_empty()
        && task.stability.test(&grasp, &mut Default::default(), &mut work.context)?.is_stable())
}

/// The contacts of `from` at another pose of the object, if its fingers reach them there, nothing is in the
/// way and the grasp is stable.
///
/// Nobody asks whether its fingers can be lifted: an end need not be left by regrasps.
pub(crate) fn same_grasp(
    work: &mut Work<'_>,
    from: &Configuration,
    X_HO: &Pose,
) -> Result<Option<Configuration>, CallError> {
    let Work { plugins, task, context, .. } = work;
    let Some(q) = plugins.sampler.close(task, X_HO, &from.contacts, from, context)? else { return Ok(None) };
    Ok(Stable.admit(task, &q, context)?.is_none().then_some(q))
}

/// A warning where a given start or goal would not be admitted as a node.
pub(crate) fn warning(work: &mut Work<'_>, end: End, q: &Configuration) -> Result<Option<String>, CallError> {
    let refused = work.task.admissible.admit(work.task, q, &mut work.context)?;
    Ok(refused.map(|reason| format!("the given grasp at `{end}` may be a dead end: {}", explain(reason))))
}

/// Sorts grasps at one pose by how far the object seems to roll from there towards `others`, farthest first.
pub(crate) fn sort_by_ease<'p>(
    task: &Task<'_>,
    found: &mut [Configuration],
    others: impl Iterator<Item = &'p Pose> + Clone,
) {
    // Fractions with a small power of two below: their sums are exact, and ties keep the order in which the
    // grasps were found.
    let ease = |q: &Configuration| others.clone().map(|X_HO| outlook(task, q, X_HO).fraction).sum::<f64>();
    found.sort_by_cached_key(|q| std::cmp::Reverse(Length(ease(q))));
}

/// Grasps at a pose, found one after the other: the `k`-th is a pure function of its number.
pub(crate) struct Finder {
    kind: Call,
    leg: u64,
    X_HO: Pose,
    /// Calls of the sampler whose results were consumed.
    pub calls: u64,
    /// The results of the next ones, as far as they were computed ahead.
    ready: VecDeque<Counted<Result<Option<Configuration>, CallError>>>,
}

/// Calls that are made ahead for each thread: so many are nearly always consumed at the ends of a problem.
const AHEAD: usize = 2;

impl Finder {
    /// For the pose of an end of a leg.
    pub fn new(kind: Call, leg: u64, X_HO: Pose) -> Self {
        Self { kind, leg, X_HO, calls: 0, ready: VecDeque::new() }
    }

    /// The next grasp, or `None` after as many calls of the sampler as one search may spend.
    pub fn next(
        &mut self,
        session: &Session<'_>,
        task: &Task<'_>,
        choices: &[FingerSet],
        tally: &mut Tally,
    ) -> Result<Option<Configuration>, CallError> {
        for _ in 0..GRASP_CALLS {
            if self.ready.is_empty() {
                let many = if session.threads() > 1 { AHEAD * session.threads() } else { 1 };
                self.ready =
                    session.draw(many, |i| self.call(self.calls + i as u64, session, task, choices)).into();
            }
            let Some(found) = self.ready.pop_front() else { break };
            self.calls += 1;
            tally.add(&found.tally);
            if let Some(q) = found.result? {
                return Ok(Some(q));
            }
        }
        Ok(None)
    }

    /// Forgets what was computed ahead: what is looked for from now on is something else.
    pub fn turn(&mut self) {
        self.ready.clear();
    }

    /// The call of the sampler with this number.
    fn call(
        &self,
        number: u64,
        session: &Session<'_>,
        task: &Task<'_>,
        choices: &[FingerSet],
    ) -> Counted<Result<Option<Configuration>, CallError>> {
        session.counted(task, (self.kind, self.leg << 32 | number, 0), |work| {
            let holding = choices[work.context.random.index(choices.len())];
            let request = PoseRequest::At(self.X_HO);
            work.plugins.sampler.sample(work.task, request, holding, &mut work.context)
        })
    }
}
