//! The contact models and the node predicate of the kit's tasks.

use regrasp_api::{
    Admissible, CallError, Cone, Configuration, Contact, ContactModel, Context, FingerIndex, FingerSet, Hint,
    Reason, Task, TipRule,
};

/// Point contacts with Coulomb friction.
#[derive(Clone, Copy, Debug, Default)]
pub struct RoundCones;

impl ContactModel for RoundCones {
    fn cone(&self, _finger: FingerIndex, _contact: &Contact, mu: f64) -> Cone<'_> {
        Cone::Elliptic { mu, gamma: 0.0 }
    }

    fn fewest_contacts(&self) -> usize {
        3
    }
}

/// Soft contacts: two of them can hold.
#[derive(Clone, Copy, Debug, Default)]
pub struct SoftCones;

/// Torsional friction radius (m) of [`SoftCones`]: under uniform pressure that of a patch of 8 mm radius with
/// μ = 0.8.
const GAMMA: f64 = 0.004;

impl ContactModel for SoftCones {
    fn cone(&self, _finger: FingerIndex, _contact: &Contact, mu: f64) -> Cone<'_> {
        Cone::Elliptic { mu, gamma: GAMMA }
    }

    fn fewest_contacts(&self) -> usize {
        2
    }
}

/// Whether a fingertip at the contact overlaps the object elsewhere.
fn reaches_in(task: &Task<'_>, contact: &Contact) -> bool {
    let radius = task.hand.fingertip_radius();
    task.surface.project(&contact.tip_center(radius), Some(contact.facet)).distance < radius - 1e-7
}

/// Admits stable grasps without collision, whose contacts keep away from sharp edges.
#[derive(Clone, Copy, Debug, Default)]
pub struct Leavable;

impl Admissible for Leavable {
    fn admit_finger(
        &self,
        task: &Task<'_>,
        q: &Configuration,
        finger: FingerIndex,
        placed: FingerSet,
        _context: &mut Context<'_>,
    ) -> Result<Option<Reason>, CallError> {
        let tip = match &q.contacts[finger] {
            Some(contact) if task.surface.edge_distance(contact) < task.resolution.edge_margin => {
                return Ok(Some(Reason::Edge));
            }
            // Where the object dents in, a ball at one place may reach into another.
            Some(contact) if reaches_in(task, contact) => return Ok(Some(Reason::Collision)),
            Some(_) => TipRule::Touches,
            None => TipRule::Clear(task.resolution.clearance),
        };
        let joints = &q.joints[finger];
        let alone = task.clearance.finger_free(finger, joints, &q.X_HO, tip).is_ok();
        let beside = |other: FingerIndex| {
            task.clearance.fingers_free((finger, joints), (other, &q.joints[other])).is_ok()
        };
        Ok(if alone && placed.iter().all(beside) { None } else { Some(Reason::Collision) })
    }

    fn admit_grasp(
        &self,
        task: &Task<'_>,
        q: &Configuration,
        context: &mut Context<'_>,
    ) -> Result<Option<Reason>, CallError> {
        // Where all fingers hold, the object is to be moved: contacts may spin then.
        let all = q.holding().len() == q.contacts.len();
        let grasp = if all { task.transfer_grasp(q, q.holding()) } else { task.grasp(q, q.holding()) };
        let stable = task.stability.test(&grasp, &mut Hint::default(), context)?.is_stable();
        Ok(if stable { None } else { Some(Reason::Stability) })
    }
}
