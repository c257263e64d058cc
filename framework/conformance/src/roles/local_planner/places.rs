//! Where problems for local planners begin: configurations of the kit's hands and objects.

use crate::calls::context;
use crate::fixtures::Bench;
use crate::reference::{Closure, RejectionSampler, closure};
use regrasp_api::{
    ClosedChainSampler, Configuration, Contact, FingerIndex, Hand, PerFinger, Pose, PoseRequest, Primitive,
    Rotation, SurfaceParam, Vec3,
};

/// A configuration with all fingers in contact, by the reference sampler.
pub(super) fn somewhere(bench: &Bench, key: u64) -> Configuration {
    let pose = PoseRequest::At(Bench::center());
    let found = RejectionSampler.sample(&bench.task(), pose, bench.fingers(), &mut context(key));
    found.expect("nothing interrupts").expect("the kit's hands hold the kit's objects")
}

/// The same on the outside of the ring, where it bulges: into the hole a fingertip may touch at two places.
pub(super) fn outside(bench: &Bench, key: u64) -> Configuration {
    let out = |contact: &Contact| {
        !matches!(bench.world.object.primitive, Some(Primitive::Torus { ring_radius, .. })
            if contact.p_OC.x.hypot(contact.p_OC.y) < 1.1 * ring_radius)
    };
    let all_out = |q: &Configuration| q.contacts.iter().all(|(_, contact)| contact.as_ref().is_none_or(out));
    let found = (0..200).map(|i| somewhere(bench, key + 1000 * i)).find(all_out);
    found.expect("most of the ring's surface is outside")
}

/// The joints of a hand whose fingertips stand on the contacts; `None` if one cannot.
pub(super) fn closed(
    bench: &Bench,
    X_HO: Pose,
    contacts: &PerFinger<Option<Contact>>,
) -> Option<Configuration> {
    let hand = &*bench.world.hand;
    let rest = PerFinger::from_fn(hand.finger_count(), |finger| hand.finger(finger).rest);
    let near = Configuration { X_HO, joints: rest, contacts: *contacts };
    RejectionSampler
        .close(&bench.task(), &X_HO, contacts, &near, &mut context(0))
        .expect("nothing interrupts")
}

pub(super) fn turned(X_HO: &Pose, shift: Vec3, turn: Vec3) -> Pose {
    let p = X_HO.translation.vector + shift;
    Pose::from_parts(p.into(), Rotation::from_scaled_axis(turn) * X_HO.rotation)
}

/// Fingertips on the two widest faces of the bar, two on each, a little over their margin from its edges.
pub(super) fn clasp(bench: &Bench) -> Configuration {
    let at = [[0.05, 3e-3, 0.03], [3e-3, 0.05, 0.02], [-0.05, -3e-3, 0.03], [-3e-3, -0.05, -0.03]];
    let contact =
        |finger: FingerIndex| Some(bench.surface.project(&Vec3::from(at[finger.index()]), None).contact);
    let contacts = PerFinger::from_fn(4, contact);
    closed(bench, Bench::center(), &contacts).expect("each place is within the finger's box")
}

/// Free fingertips on a ball in these directions.
pub(super) fn on_ball(bench: &Bench, directions: [[f64; 3]; 4]) -> Configuration {
    on_directions(bench, directions).expect("each direction is within the finger's box")
}

/// Four fingertips on a ball in these directions; `None` where one does not reach.
fn on_directions(bench: &Bench, directions: [[f64; 3]; 4]) -> Option<Configuration> {
    let contact = |finger: FingerIndex| {
        let u = Vec3::from(directions[finger.index()]).normalize();
        Some(bench.surface.project(&(u * 0.05), None).contact)
    };
    closed(bench, Bench::center(), &PerFinger::from_fn(4, contact))
}

/// Fingertips before, beside and behind the ball, one a little below.
pub(super) fn ring(bench: &Bench) -> Configuration {
    on_ball(bench, [[1.0, 0.1, -0.2], [0.0, 1.0, 0.1], [-1.0, 0.1, 0.1], [0.1, -1.0, 0.0]])
}

/// Fingertips that push the ball up, all of them.
pub(super) fn slack(bench: &Bench) -> Configuration {
    let q = on_ball(bench, [[1.0, 0.0, -1.2], [0.0, 1.0, -1.2], [-1.0, 0.0, -1.2], [0.0, -1.0, -1.2]]);
    assert_eq!(closure(&bench.task().grasp(&q, q.holding())), Closure::Open, "it holds nothing");
    q
}

/// Directions of fingertips such that finger 0 passes `side` = ±1 along x on its shortest way from the first
/// set to the second.
///
/// The others hold the ball in the plane of x and z.
pub(super) fn around(side: f64) -> [[[f64; 3]; 4]; 2] {
    let (near, far) = ([side * 0.45, 0.89, 0.0], [side * 0.45, -0.89, 0.0]);
    let holders = if side < 0.0 {
        [[1.0, 0.0, 0.0], [-0.5, 0.0, 0.87], [-0.5, 0.0, -0.87]]
    } else {
        [[0.5, 0.0, 0.87], [-1.0, 0.0, 0.0], [0.5, 0.0, -0.87]]
    };
    let with = |first: [f64; 3]| [first, holders[0], holders[1], holders[2]];
    [with(near), with(far)]
}

/// The configuration with a finger at rest.
pub(super) fn at_rest(bench: &Bench, q: &Configuration, finger: u8) -> Configuration {
    let (mut q, finger) = (q.clone(), FingerIndex(finger));
    (q.contacts[finger], q.joints[finger]) = (None, bench.world.hand.finger(finger).rest);
    q
}

/// The ball to one side, so that all fingers lean there and the links of the first stand beside the pin.
pub(super) fn beside_a_pin(bench: &Bench) -> Option<Configuration> {
    let directions = [[0.95, 0.0, 0.3], [0.0, 1.0, 0.1], [-1.0, 0.1, 0.1], [0.1, -1.0, 0.0]];
    let contact = |finger: FingerIndex| {
        let u = Vec3::from(directions[finger.index()]).normalize();
        Some(bench.surface.project(&(u * 0.05), None).contact)
    };
    let X_HO = turned(&Bench::center(), Vec3::new(0.0, -0.026, 0.0), Vec3::zeros());
    let q = closed(bench, X_HO, &PerFinger::from_fn(4, contact))?;
    bench.task().clearance.configuration_free(&q, bench.fingers(), true).is_ok().then_some(q)
}

/// Two of three soft fingers on opposite sides of the ball, the third at rest.
pub(super) fn two_soft_ones(bench: &Bench) -> Option<Configuration> {
    let u = Vec3::new(0.87, -0.5, 0.0).normalize();
    let directions = [Some(u), Some(-u), None];
    let contact = |finger: FingerIndex| {
        directions[finger.index()].map(|u| bench.surface.project(&(u * 0.05), None).contact)
    };
    let q = closed(bench, Bench::center(), &PerFinger::from_fn(3, contact))?;
    let free = bench.task().clearance.configuration_free(&q, bench.fingers(), true).is_ok();
    (free && closure(&bench.task().grasp(&q, q.holding())) == Closure::Closed).then_some(q)
}
