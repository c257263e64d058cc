//! A plan's states as columns of numbers.

use regrasp::api::{FingerIndex, FingerJoints, Hand, Rotation, Vec3};
use regrasp::plan::{Plan, SegmentRecord, StateRecord};
use regrasp::world::ChainHand;

/// The distinct states of a plan in turn: the state that two segments share stands once.
pub fn states(plan: &Plan) -> impl Iterator<Item = &StateRecord> {
    let own =
        |(index, segment): (usize, &'_ SegmentRecord)| usize::from(index > 0 && !segment.states.is_empty());
    plan.segments.iter().enumerate().flat_map(move |(index, segment)| {
        let skip = own((index, segment));
        segment.states.iter().skip(skip)
    })
}

/// For each segment its first and last state, as numbers of [`states`].
pub fn spans(plan: &Plan) -> Vec<(usize, usize)> {
    let mut last = 0;
    let mut spans = Vec::with_capacity(plan.segments.len());
    for segment in &plan.segments {
        let first = last;
        last = first + segment.states.len().saturating_sub(1);
        spans.push((first, last));
    }
    spans
}

/// Columns of a plan: every vector has `states` rows.
#[derive(Default)]
pub struct Table {
    /// How many states.
    pub states: usize,
    /// How many fingers.
    pub fingers: usize,
    /// How many joints all fingers have together.
    pub joints: usize,
    /// Seconds from the motion's start: one a state.
    pub time: Vec<f64>,
    /// Position and orientation w, x, y, z of the object in H: seven a state.
    pub pose: Vec<f64>,
    /// Joint positions, finger after finger.
    pub q: Vec<f64>,
    /// For each finger point in O, outward normal in O, point in F: nine a finger; NaN where it does not
    /// hold.
    pub contact: Vec<f64>,
    /// Joint velocities as `q`, NaN in states without; empty in plans without.
    pub velocity: Vec<f64>,
    /// For each finger the force on the object in O (N); NaN where free or unknown; empty in plans without.
    pub force: Vec<f64>,
    /// What the joints must give for these forces alone (N·m; N), as `q`, NaN where unknown; empty in plans
    /// without.
    pub effort: Vec<f64>,
}

/// The columns of a plan; `Err` where a state has other fingers or joints than the first.
pub fn table(plan: &Plan) -> Result<Table, String> {
    let first = states(plan).next();
    // A plan without a motion has the columns of its hand.
    let hand = &plan.scenario.problem.hand.finger;
    let fingers = first.map_or(hand.len(), |state| state.joints.len());
    let joints = first.map_or_else(
        || hand.iter().map(|finger| finger.joint.len()).sum(),
        |state| state.joints.iter().map(Vec::len).sum(),
    );
    let mut table = Table { fingers, joints, ..Table::default() };
    for (row, state) in states(plan).enumerate() {
        table.push(state);
        let fits = table.q.len() == joints * table.states
            && state.contacts.len() == fingers
            && table.velocity.len() == joints * table.states
            && table.force.len() == 3 * fingers * table.states;
        if !fits {
            return Err(format!("state {row} has other fingers or joints than the first"));
        }
    }
    if states(plan).all(|state| state.velocities.is_none()) {
        table.velocity.clear();
    }
    match states(plan).any(|state| state.forces.is_some()) {
        true => table.effort = efforts(plan)?,
        false => table.force.clear(),
    }
    Ok(table)
}

/// Jᵀf of every state: what the joints must give to exert the forces, weights of links apart.
fn efforts(plan: &Plan) -> Result<Vec<f64>, String> {
    let hand = ChainHand::new(plan.scenario.problem.hand.clone()).map_err(|error| error.to_string())?;
    let mut efforts = Vec::new();
    for state in states(plan) {
        for (index, joints) in state.joints.iter().enumerate() {
            let fits = index < hand.finger_count()
                && joints.len() == hand.finger(FingerIndex(index as u8)).joints.len();
            if !fits {
                return Err(format!("finger {index} of a state does not fit the plan's hand"));
            }
            efforts.extend(finger_efforts(&hand, state, index));
        }
    }
    Ok(efforts)
}

fn finger_efforts(hand: &ChainHand, state: &StateRecord, index: usize) -> Vec<f64> {
    let joints = FingerJoints::from_slice(&state.joints[index]);
    let force = state.forces.as_ref().and_then(|forces| forces.get(index).copied().flatten());
    let contact = state.contacts.get(index).and_then(Option::as_ref);
    if state.forces.is_none() {
        return vec![f64::NAN; joints.len()];
    }
    let (Some(f_O), Some(contact)) = (force, contact) else { return vec![0.0; joints.len()] };
    let [w, x, y, z] = state.object.orientation;
    let f_H = Rotation::from_quaternion(nalgebra::Quaternion::new(w, x, y, z)) * Vec3::from(f_O);
    let tip = hand.tip_kinematics(FingerIndex(index as u8), &joints);
    let moment_H = (tip.R_HF * Vec3::from(contact.point_F)).cross(&f_H);
    let effort = |joint| tip.J_v.column(joint).dot(&f_H) + tip.J_w.column(joint).dot(&moment_H);
    (0..joints.len()).map(effort).collect()
}

impl Table {
    fn push(&mut self, state: &StateRecord) {
        self.states += 1;
        self.time.push(state.time);
        self.pose.extend(state.object.position.iter().chain(&state.object.orientation));
        self.q.extend(state.joints.iter().flatten());
        match &state.velocities {
            Some(velocities) => self.velocity.extend(velocities.iter().flatten()),
            None => self.velocity.extend(vec![f64::NAN; self.joints]),
        }
        match &state.forces {
            Some(forces) => self.force.extend(forces.iter().flat_map(|force| force.unwrap_or([f64::NAN; 3]))),
            None => self.force.extend(vec![f64::NAN; 3 * self.fingers]),
        }
        for contact in &state.contacts {
            match contact {
                Some(contact) => {
                    let vectors = [contact.point_O, contact.normal_O, contact.point_F];
                    self.contact.extend(vectors.iter().flatten());
                }
                None => self.contact.extend([f64::NAN; 9]),
            }
        }
    }
}
