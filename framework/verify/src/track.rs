//! The plan's states in a form to compute with, and what must hold for that: the form of the plan.

use crate::hand::Chains;
use crate::verdict::Gauge;
use nalgebra::{Quaternion, Translation3};
use regrasp_api::{MAX_FINGERS, Pose, Rotation, Vec3, interpolate};
use regrasp_plan::{Place, SegmentName, SegmentRecord, StateRecord};

/// One segment of the plan.
#[derive(Debug)]
pub(crate) struct Leg<'p> {
    pub(crate) index: usize,
    /// The finger that moves, in a regrasp.
    pub(crate) moving: Option<usize>,
    pub(crate) states: Vec<State<'p>>,
}

/// One state of the plan.
#[derive(Debug)]
pub(crate) struct State<'p> {
    pub(crate) record: &'p StateRecord,
    /// The object's pose, its quaternion normalised.
    pub(crate) X_HO: Pose,
    /// All joints of the hand, counted through.
    pub(crate) joints: Vec<f64>,
    /// Their velocities, where the plan carries any.
    pub(crate) velocities: Option<Vec<f64>>,
}

impl State<'_> {
    /// Whether the finger holds the object here.
    pub(crate) fn holds(&self, finger: usize) -> bool {
        self.record.contacts[finger].is_some()
    }
}

impl Leg<'_> {
    /// The place of a state.
    pub(crate) fn at(&self, state: usize) -> Place {
        let time = Some(self.states[state].record.time);
        Place { segment: Some(self.index), state: Some(state), time, ..Default::default() }
    }

    /// The place a fraction in [0, 1] of the way from a state to the next.
    pub(crate) fn between(&self, state: usize, fraction: f64) -> Place {
        let t0 = self.states[state].record.time;
        let t1 = self.states.get(state + 1).map_or(t0, |next| next.record.time);
        Place { time: Some(t0 + (t1 - t0) * fraction), ..self.at(state) }
    }

    /// How far each joint moves from a state to the next (rad; m), in size.
    pub(crate) fn joint_steps(&self, state: usize) -> impl Iterator<Item = f64> {
        let (from, to) = (&self.states[state].joints, &self.states[state + 1].joints);
        from.iter().zip(to).map(|(a, b)| (b - a).abs())
    }
}

/// The plan's segments, each state checked; `Err` holds the faults.
pub(crate) fn legs<'p>(segments: &'p [SegmentRecord], hand: &Chains) -> Result<Vec<Leg<'p>>, Box<Gauge>> {
    let mut form = Gauge::faults("form");
    let mut legs = Vec::with_capacity(segments.len());
    for (index, segment) in segments.iter().enumerate() {
        let place = |state: Option<usize>, note: &str| Place {
            segment: Some(index),
            state,
            note: Some(note.into()),
            ..Default::default()
        };
        if segment.states.len() < 2 {
            form.fault(|| place(None, "a segment has at least two states"));
        }
        let moving = segment.finger.map(usize::from);
        match (segment.kind, moving) {
            (SegmentName::Transfer, None) => {}
            (SegmentName::Regrasp, Some(finger)) if finger < hand.fingers.len() => {}
            _ => {
                form.fault(|| place(None, "a regrasp names one of the hand's fingers, a transfer names none"))
            }
        }
        let mut states = Vec::with_capacity(segment.states.len());
        for (k, record) in segment.states.iter().enumerate() {
            match state(record, hand) {
                Ok(state) => states.push(state),
                Err(note) => form.fault(|| place(Some(k), note)),
            }
        }
        legs.push(Leg { index, moving, states });
    }
    let with = legs.iter().flat_map(|leg| &leg.states).filter(|state| state.velocities.is_some()).count();
    if with > 0 && with < legs.iter().map(|leg| leg.states.len()).sum() {
        form.fault(|| Place {
            note: Some("some states carry velocities, others do not".into()),
            ..Default::default()
        });
    }
    if form.worst() == Some(0.0) { Ok(legs) } else { Err(Box::new(form)) }
}

pub(crate) fn state<'p>(record: &'p StateRecord, hand: &Chains) -> Result<State<'p>, &'static str> {
    let count = hand.fingers.len();
    let fit = |rows: &[Vec<f64>]| {
        rows.len() == count && rows.iter().zip(&hand.fingers).all(|(q, chain)| q.len() == chain.joints.len())
    };
    if !fit(&record.joints) {
        return Err("not one position for each joint of the hand");
    }
    if !record.velocities.as_ref().is_none_or(|velocities| fit(velocities)) {
        return Err("not one velocity for each joint of the hand");
    }
    if record.contacts.len() != count {
        return Err("not one contact (or null) for each finger");
    }
    let joints: Vec<f64> = record.joints.concat();
    let velocities = record.velocities.as_ref().map(|rows| rows.concat());
    let contacts = record.contacts.iter().flatten();
    let contacts = contacts.flat_map(|c| c.point_O.into_iter().chain(c.normal_O).chain(c.point_F));
    let pose = record.object.position.into_iter().chain(record.object.orientation);
    let rates = velocities.iter().flatten().copied();
    let mut numbers = joints.iter().copied().chain(rates).chain(contacts).chain(pose).chain([record.time]);
    // Beyond this, differences of the motion would overflow; no hand is a kilometre wide.
    if !numbers.all(|x| x.abs() < 1e6) {
        return Err("a number that is not finite, or far beyond any hand");
    }
    let [w, x, y, z] = record.object.orientation;
    let quaternion = Quaternion::new(w, x, y, z);
    if quaternion.norm() < 1e-6 {
        return Err("a quaternion that is zero");
    }
    let p = Translation3::from(Vec3::from(record.object.position));
    Ok(State { record, X_HO: Pose::from_parts(p, Rotation::from_quaternion(quaternion)), joints, velocities })
}

/// Into how many samples each step of the plan is divided.
pub(crate) const SAMPLES: usize = 10;

/// Where everything is at one instant.
#[derive(Clone, Debug)]
pub(crate) struct Frames {
    pub(crate) X_HO: Pose,
    /// The frames of all links in H, counted through like the joints.
    pub(crate) X_HL: Vec<Pose>,
    /// The centres of the fingertips' balls in H (m).
    pub(crate) p_HTip: [Vec3; MAX_FINGERS],
}

impl Frames {
    pub(crate) fn new(hand: &Chains) -> Self {
        let X_HL = vec![Pose::identity(); hand.joint_count];
        Self { X_HO: Pose::identity(), X_HL, p_HTip: [Vec3::zeros(); MAX_FINGERS] }
    }

    /// No room at all, to stand in for a moment.
    pub(crate) fn empty() -> Self {
        Self { X_HO: Pose::identity(), X_HL: Vec::new(), p_HTip: [Vec3::zeros(); MAX_FINGERS] }
    }

    /// Places the object and all links a fraction of the way from a state to the next: joints and position
    /// linearly, orientation by slerp.
    pub(crate) fn place(&mut self, hand: &Chains, leg: &Leg<'_>, state: usize, fraction: f64) {
        let from = &leg.states[state];
        let to = leg.states.get(state + 1).unwrap_or(from);
        self.X_HO = if fraction == 0.0 { from.X_HO } else { interpolate(&from.X_HO, &to.X_HO, fraction) };
        self.place_joints(hand, |j| from.joints[j] + (to.joints[j] - from.joints[j]) * fraction);
    }

    /// The same, `start` being where everything is at the state: what rests over the step is where it is.
    pub(crate) fn place_after(
        &mut self,
        start: &Self,
        hand: &Chains,
        leg: &Leg<'_>,
        state: usize,
        fraction: f64,
    ) {
        let (from, to) = (&leg.states[state], &leg.states[state + 1]);
        let rests = from.X_HO == to.X_HO;
        self.X_HO = if rests { start.X_HO } else { interpolate(&from.X_HO, &to.X_HO, fraction) };
        for (finger, chain) in hand.fingers.iter().enumerate() {
            let range = chain.range();
            if from.joints[range.clone()] == to.joints[range.clone()] {
                self.X_HL[range.clone()].copy_from_slice(&start.X_HL[range]);
                self.p_HTip[finger] = start.p_HTip[finger];
            } else {
                let joint = |j: usize| from.joints[j] + (to.joints[j] - from.joints[j]) * fraction;
                self.place_finger(hand, finger, joint);
            }
        }
    }

    /// Places all links, joint by joint counted through.
    pub(crate) fn place_joints(&mut self, hand: &Chains, joint: impl Fn(usize) -> f64) {
        (0..hand.fingers.len()).for_each(|finger| self.place_finger(hand, finger, &joint));
    }

    /// Places the links of one finger.
    pub(crate) fn place_finger(&mut self, hand: &Chains, finger: usize, joint: impl Fn(usize) -> f64) {
        let chain = &hand.fingers[finger];
        let range = chain.range();
        let mut q = [0.0; regrasp_api::MAX_FINGER_JOINTS];
        q.iter_mut().zip(range.clone()).for_each(|(q, j)| *q = joint(j));
        chain.frames(&q[..range.len()], &mut self.X_HL[range]);
        self.p_HTip[finger] = self.tip(chain);
    }

    fn tip(&self, chain: &crate::hand::Chain) -> Vec3 {
        let last = &self.X_HL[chain.first + chain.joints.len() - 1];
        (last * nalgebra::Point3::from(chain.p_LTip)).coords
    }

    /// The frame of a finger's last link.
    pub(crate) fn last_link(&self, chain: &crate::hand::Chain) -> &Pose {
        &self.X_HL[chain.first + chain.joints.len() - 1]
    }

    /// The fingertip's centre in the object's frame (m).
    pub(crate) fn p_OTip(&self, finger: usize) -> Vec3 {
        self.X_HO.inverse_transform_point(&self.p_HTip[finger].into()).coords
    }
}
