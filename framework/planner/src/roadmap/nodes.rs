//! The grasps of a roadmap as rows of 32-bit words.
//!
//! A row says where the object is, and of each finger where its tip is on the object and how its joints
//! stand, to 24 bits: some nanometres. The grasp itself is what surface and inverse kinematics make of these,
//! exact to the last bit of a double and the same each time.

use nalgebra::Quaternion;
use regrasp_api::{
    Configuration, FingerIndex, FingerJoints, FingerSet, Hand, MAX_FINGER_JOINTS, MAX_FINGERS, PerFinger,
    Pose, Rotation, Task, Vec3,
};

/// Words before those of the fingers: which of them hold, and the pose.
const HEAD: usize = 1 + 7;
/// Words of a finger beside its joints: the tip's centre.
const TIP: usize = 3;

/// A pose in single precision: w, x, y, z, and the position.
pub(crate) type ScanPose = [f32; 7];

/// Rows of grasps.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Nodes {
    /// How many joints each finger has.
    joints: Vec<usize>,
    rows: Vec<u32>,
    /// The poses once more, together: what is looked at for every node of a roadmap must be near.
    poses: Vec<ScanPose>,
}

impl Nodes {
    /// No grasps of a hand.
    pub fn of(hand: &dyn Hand) -> Self {
        let joints = |finger: usize| hand.finger(FingerIndex(finger as u8)).joints.len();
        let joints = (0..hand.finger_count()).map(joints).collect();
        Self { joints, rows: Vec::new(), poses: Vec::new() }
    }

    /// The grasps of a hand with so many joints a finger; `None` where the words are no rows of numbers.
    pub fn from_rows(joints: Vec<usize>, rows: Vec<u32>) -> Option<Self> {
        if joints.len() > MAX_FINGERS || joints.iter().any(|&count| count > MAX_FINGER_JOINTS) {
            return None;
        }
        let words = words(&joints);
        let is_number = |row: &[u32]| row[1..].iter().all(|&word| f32::from_bits(word).is_finite());
        if !rows.len().is_multiple_of(words) || !rows.chunks_exact(words).all(is_number) {
            return None;
        }
        let poses = rows.chunks_exact(words).map(scan_pose).collect();
        Some(Self { joints, rows, poses })
    }

    /// How many.
    pub fn len(&self) -> usize {
        self.poses.len()
    }

    /// How many joints each finger has.
    pub fn joints(&self) -> &[usize] {
        &self.joints
    }

    /// All rows.
    pub fn rows(&self) -> &[u32] {
        &self.rows
    }

    /// All poses.
    pub fn poses(&self) -> &[ScanPose] {
        &self.poses
    }

    /// Appends a row.
    pub fn push(&mut self, row: &[u32]) {
        self.poses.push(scan_pose(row));
        self.rows.extend_from_slice(row);
    }

    /// Takes out all but the first.
    pub fn truncate(&mut self, count: usize) {
        self.poses.truncate(count);
        self.rows.truncate(count * words(&self.joints));
    }

    /// The grasp with this number; `None` where hand or surface are not those that it was made with.
    pub fn get(&self, task: &Task<'_>, node: u32) -> Option<Configuration> {
        let words = words(&self.joints);
        let begin = node as usize * words;
        decode(task, &self.joints, &self.rows[begin..begin + words])
    }
}

/// Words of a row.
fn words(joints: &[usize]) -> usize {
    HEAD + joints.iter().map(|count| TIP + count).sum::<usize>()
}

fn scan_pose(row: &[u32]) -> ScanPose {
    std::array::from_fn(|i| f32::from_bits(row[1 + i]))
}

/// The row of a grasp.
pub(crate) fn encode(task: &Task<'_>, q: &Configuration) -> Vec<u32> {
    let mut row = vec![u32::from(q.holding().bits())];
    let mut put = |x: f64| row.push((x as f32).to_bits());
    let turn = q.X_HO.rotation.quaternion();
    [turn.w, turn.i, turn.j, turn.k].into_iter().for_each(&mut put);
    q.X_HO.translation.vector.iter().copied().for_each(&mut put);
    for finger in q.joints.fingers() {
        let tip = q.contacts[finger].map(|contact| contact.tip_center(task.hand.fingertip_radius()));
        tip.unwrap_or_default().iter().copied().for_each(&mut put);
        q.joints[finger].iter().copied().for_each(&mut put);
    }
    row
}

/// The grasp of a row, each finger exactly at its contact; `None` where one cannot be there.
pub(crate) fn decode(task: &Task<'_>, joints: &[usize], row: &[u32]) -> Option<Configuration> {
    let fits = |finger: FingerIndex| task.hand.finger(finger).joints.len() == joints[finger.index()];
    if task.hand.finger_count() != joints.len() || !FingerSet::first(joints.len()).iter().all(fits) {
        return None;
    }
    let float = |i: usize| f64::from(f32::from_bits(row[i]));
    let vector = |i: usize| Vec3::new(float(i), float(i + 1), float(i + 2));
    let turn = Quaternion::new(float(1), float(2), float(3), float(4));
    let X_HO = Pose::from_parts(vector(5).into(), Rotation::try_new(turn, 0.5)?);
    let mut q = Configuration {
        X_HO,
        joints: PerFinger::filled(joints.len(), FingerJoints::default()),
        contacts: PerFinger::filled(joints.len(), None),
    };
    let (holding, mut place) = (FingerSet::from_bits(row[0] as u8), HEAD);
    for finger in q.joints.fingers() {
        let count = joints[finger.index()];
        let numbers: Vec<f64> = (0..count).map(|j| float(place + TIP + j)).collect();
        q.joints[finger] = within_limits(task.hand, finger, &numbers);
        if holding.contains(finger) {
            // The closest point is the same whatever the hint.
            q.contacts[finger] = Some(task.surface.project(&vector(place), None).contact);
            let p_HF = q.contact_tip_center(finger, task.hand.fingertip_radius())?;
            q.joints[finger] = task.hand.inverse(finger, &p_HF, &q.joints[finger])?;
        }
        place += TIP + count;
    }
    Some(q)
}

/// Joints that rounding may have taken beyond their limits.
fn within_limits(hand: &dyn Hand, finger: FingerIndex, numbers: &[f64]) -> FingerJoints {
    let mut joints = FingerJoints::from_slice(numbers);
    for (q, model) in joints.iter_mut().zip(&hand.finger(finger).joints) {
        *q = q.clamp(model.lower, model.upper);
    }
    hand.settle(finger, &mut joints);
    joints
}
