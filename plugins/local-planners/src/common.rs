//! What the three local planners share: refusals, the order of bisection, bounds of a finger's motion.

use regrasp_api::{
    CallError, Configuration, Contact, Context, FingerIndex, FingerJoints, Hand, JointKind, LONGEST_JUMP,
    Random, Reached, Reason, Resolution, Slot, SurfaceParam,
};

/// The answer of a planner that goes nowhere: the refusal is counted, the end is where it began.
pub(crate) fn refuse(slot: Slot, reason: Reason, from: &Configuration, context: &mut Context<'_>) -> Reached {
    let stop = Some(context.reject(slot, reason));
    Reached { end: from.clone(), fraction: 0.0, stop }
}

/// The error for a target that belongs to another slot.
pub(crate) fn wrong_target(plugin: &str, slot: Slot) -> CallError {
    let reason = format!("it connects targets of the slot `{}` only", slot.name());
    CallError::Unsupported { plugin: plugin.into(), reason }
}

/// How far (m) a fingertip is taken off the object to find a second place that it nearly touches.
///
/// Off an edge whose facets' normals differ by θ, a second place comes closest if its gap is below 1 mm ·
/// (1 − cos θ): for each jump of the contact over more than a plan's closure the fingertip then is some
/// micrometres to the side of where it would happen, which is what motions between two states stray. Our
/// choice.
const PROBE_LIFT: f64 = 1e-3;

/// Nearer (m) than this a second place is a matter of rounding: which of the two is the contact is no longer
/// certain where a plan is read again.
const ROUNDING: f64 = 1e-7;

/// Where a fingertip's ball touches beside its contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Second {
    /// Nowhere that matters: nearly in a mild dent at most, over which the contact may jump.
    None,
    /// In a mild dent, so nearly that rounding decides which of the two is the contact; a little before or
    /// behind it is certain.
    Even,
    /// Nearly, too far away for the contact to jump there.
    Far,
}

/// The longest jump (m) of a contact that planners make: what a plan may hold, less what rounding may add.
pub(crate) fn longest_jump(radius: f64, closure: f64) -> f64 {
    closure.max(0.9 * LONGEST_JUMP * radius)
}

/// What a fingertip's ball of `radius` (m) touches, or nearly, beside its contact. In a hollow it may touch
/// at two places. Two places closer together than half of `closure` (m) are one.
pub(crate) fn second_touch(
    surface: &dyn SurfaceParam,
    contact: &Contact,
    radius: f64,
    closure: f64,
) -> Second {
    let off = surface.project(&contact.tip_center(radius + PROBE_LIFT), Some(contact.facet)).contact;
    let apart = (off.p_OC - contact.p_OC).norm();
    // From the plane there: the place itself lies farther on where the fingertip is not lifted.
    let gap = off.n_O.dot(&(contact.tip_center(radius) - off.p_OC)) - radius;
    match apart {
        apart if apart <= 0.5 * closure => Second::None,
        apart if apart > longest_jump(radius, closure) => Second::Far,
        _ if gap > ROUNDING => Second::None,
        _ => Second::Even,
    }
}

/// One index of a bisection, between two that came before it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Halving {
    /// The index to look at now.
    pub middle: usize,
    /// Its neighbours: 0, `count`, or indices that came before.
    pub ends: (usize, usize),
}

impl Halving {
    /// Where the middle lies between its neighbours, in (0, 1).
    pub fn fraction(self) -> f64 {
        (self.middle - self.ends.0) as f64 / (self.ends.1 - self.ends.0) as f64
    }
}

/// The indices strictly between 0 and `count`, coarse to fine: a bad motion shows early.
pub(crate) fn bisection(count: usize) -> impl Iterator<Item = Halving> {
    let top = count.next_power_of_two().trailing_zeros();
    (0..top).rev().flat_map(move |level| {
        let half = 1_usize << level;
        (half..count)
            .step_by(2 * half)
            .map(move |middle| Halving { middle, ends: (middle - half, (middle + half).min(count)) })
    })
}

/// How far points of a finger move when one joint does: for each finger and joint the longest lever (m; 1
/// where prismatic).
#[derive(Clone, Debug)]
pub(crate) struct Levers(Vec<FingerJoints>);

/// Random postures in which the levers are measured, besides the corners of the joints' ranges.
const POSTURES: usize = 256;

impl Levers {
    /// Measures the fingertip's distance from each joint's axis over many postures, and adds the fingertip's
    /// radius.
    ///
    /// Links are taken to end no farther from an axis than the tip when it is stretched away from it.
    pub fn new(hand: &dyn Hand) -> Self {
        let fingers = (0..hand.finger_count()).map(|i| FingerIndex(i as u8));
        Self(fingers.map(|finger| longest_levers(hand, finger)).collect())
    }

    /// A bound (m) of how far any point of the finger travels while its joints move by `differences`.
    pub fn travel(&self, finger: FingerIndex, differences: impl Iterator<Item = f64>) -> f64 {
        self.0[finger.index()]
            .iter()
            .zip(differences)
            .map(|(lever, difference)| lever * difference.abs())
            .sum()
    }

    /// The same between two postures of the finger.
    pub fn between(&self, finger: FingerIndex, a: &FingerJoints, b: &FingerJoints) -> f64 {
        self.travel(finger, a.iter().zip(b.iter()).map(|(a, b)| a - b))
    }
}

fn longest_levers(hand: &dyn Hand, finger: FingerIndex) -> FingerJoints {
    let joints = &hand.finger(finger).joints;
    let mut levers = FingerJoints::zeros(joints.len());
    let mut random = Random::from_key(0, 0, 0, u64::from(finger.0));
    let corners = 1_usize << joints.len();
    for posture in 0..corners + POSTURES {
        let mut q = FingerJoints::zeros(joints.len());
        for (j, joint) in joints.iter().enumerate() {
            let corner = [joint.lower, joint.upper][posture >> j & 1];
            q[j] = if posture < corners { corner } else { random.range(joint.lower, joint.upper) };
        }
        let tip = hand.tip_kinematics(finger, &q);
        levers.iter_mut().enumerate().for_each(|(j, lever)| *lever = lever.max(tip.J_v.column(j).norm()));
    }
    for (lever, joint) in levers.iter_mut().zip(joints) {
        if joint.kind == JointKind::Revolute {
            *lever += hand.fingertip_radius();
        }
    }
    levers
}

/// The most (m) that a finger's points may travel between two stored states, by the bound of the levers.
///
/// States keep `clearance`; what happens in between is certified by the verifier, which halves its steps
/// where bodies move by more than that. Our choice: the bound is two to three times what the points really
/// travel.
pub(crate) fn largest_travel(resolution: &Resolution) -> f64 {
    (12.0 * resolution.clearance).max(resolution.transfer_step)
}

/// `near` with the spare joints of the finger a fraction `s` of the way from `a` to `b`, the others as in
/// `near`.
///
/// Inverse kinematics keeps the spare joints that it is given, so a redundant finger arrives in the posture
/// wished for.
pub(crate) fn with_spare(
    spare: &[usize],
    near: &FingerJoints,
    (a, b): (&FingerJoints, &FingerJoints),
    s: f64,
) -> FingerJoints {
    let mut joints = *near;
    for &j in spare {
        joints[j] = a[j] + (b[j] - a[j]) * s;
    }
    joints
}

#[cfg(test)]
mod tests {
    use super::*;
    use regrasp_api::{Primitive, Vec3};
    use regrasp_surfaces::geodesic::{Geodesic, GeodesicSettings};
    use regrasp_world::primitive_mesh;

    /// On a ring's inner side the ball touches two facets where it is just between them; which one is certain
    /// a few micrometres beside, and not where rounding decides.
    #[test]
    fn between_two_facets_of_a_hollow_a_ball_touches_twice() {
        const RADIUS: f64 = 0.01;
        let ring = Primitive::Torus { ring_radius: 0.0286, tube_radius: 0.008 };
        let mesh = primitive_mesh(&ring, 1280).unwrap();
        let surface = Geodesic::new(&GeodesicSettings::default(), &mesh, RADIUS).unwrap();
        let second = |beside: f64| {
            let mut p_OF = Vec3::new(0.0105, beside, 0.0);
            for _ in 0..50 {
                p_OF.x += surface.project(&p_OF, None).distance - RADIUS;
            }
            second_touch(&surface, &surface.project(&p_OF, None).contact, RADIUS, 20e-6)
        };
        assert_eq!([0.0, 1e-8].map(second), [Second::Even; 2]);
        assert_eq!([1e-5, 1e-4, 1e-3].map(second), [Second::None; 3]);
    }

    #[test]
    fn bisection_meets_every_index_once_between_known_ones() {
        for count in 0..70 {
            let mut known: Vec<usize> = vec![0, count];
            for halving in bisection(count) {
                assert!(known.contains(&halving.ends.0) && known.contains(&halving.ends.1), "{halving:?}");
                assert!(!known.contains(&halving.middle) && halving.middle < count);
                assert!(0.0 < halving.fraction() && halving.fraction() < 1.0);
                known.push(halving.middle);
            }
            known.sort_unstable();
            known.dedup();
            assert_eq!(known, (0..=count).collect::<Vec<_>>());
        }
    }
}
