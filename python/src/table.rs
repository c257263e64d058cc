//! A plan's states as columns of numbers.

use regrasp::plan::{Plan, SegmentRecord, StateRecord};

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
    /// For each finger point in O, outward normal in O, point in F: nine a finger; NaN where it does not hold.
    pub contact: Vec<f64>,
}

/// The columns of a plan; `Err` where a state has other fingers or joints than the first.
pub fn table(plan: &Plan) -> Result<Table, String> {
    let first = states(plan).next();
    let fingers = first.map_or(0, |state| state.joints.len());
    let joints = first.map_or(0, |state| state.joints.iter().map(Vec::len).sum());
    let mut table =
        Table { states: 0, fingers, joints, time: vec![], pose: vec![], q: vec![], contact: vec![] };
    for (row, state) in states(plan).enumerate() {
        table.push(state);
        let fits = table.q.len() == joints * table.states && state.contacts.len() == fingers;
        if !fits {
            return Err(format!("state {row} has other fingers or joints than the first"));
        }
    }
    Ok(table)
}

impl Table {
    fn push(&mut self, state: &StateRecord) {
        self.states += 1;
        self.time.push(state.time);
        self.pose.extend(state.object.position.iter().chain(&state.object.orientation));
        self.q.extend(state.joints.iter().flatten());
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
