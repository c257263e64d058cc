//! Problems for local planners: starts and targets.

use super::links::through_something;
use super::places::{
    around, at_rest, beside_a_pin, clasp, closed, on_ball, outside, ring, slack, somewhere, turned,
    two_soft_ones,
};
use crate::calls::random;
use crate::fixtures::{Bench, to_hand};
use crate::reference::{Closure, closure};
use regrasp_api::{
    Configuration, Contact, FingerIndex, FingerJoints, FingerSet, Hand, Pose, Random, Slot, SurfaceParam,
    Target, TipRule, Vec3,
};
use std::sync::OnceLock;

/// A target that owns its data.
#[derive(Clone, Debug)]
pub(crate) enum Goal {
    Grasp(Box<Configuration>),
    Transfer(Pose),
    Regrasp { finger: FingerIndex, contact: Option<Contact>, joints: FingerJoints },
}

impl Goal {
    pub fn target(&self) -> Target<'_> {
        match self {
            Self::Grasp(q) => Target::Grasp(q),
            Self::Transfer(X_HO) => Target::Transfer(X_HO),
            Self::Regrasp { finger, contact, joints } => {
                Target::Regrasp { finger: *finger, contact: contact.as_ref(), joints }
            }
        }
    }
}

/// One problem.
pub(crate) struct Case {
    pub bench: &'static Bench,
    pub from: Configuration,
    pub goal: Goal,
    /// A way with nothing in it, of which most of the same kind are to be solved; `None` where something may
    /// be in the way.
    pub clear: Option<&'static str>,
}

/// The problems of a slot, made once.
pub(crate) fn cases(slot: Slot) -> &'static [Case] {
    static GRASP: OnceLock<Vec<Case>> = OnceLock::new();
    static TRANSFER: OnceLock<Vec<Case>> = OnceLock::new();
    static REGRASP: OnceLock<Vec<Case>> = OnceLock::new();
    match slot {
        Slot::GraspPlanner => GRASP.get_or_init(grasps),
        Slot::TransferPlanner => TRANSFER.get_or_init(transfers),
        _ => REGRASP.get_or_init(regrasps),
    }
}

fn benches() -> [&'static Bench; 4] {
    [Bench::free_sphere(), Bench::hand_sphere(), Bench::hand_ellipsoid(), Bench::free_cube()]
}

fn transfers() -> Vec<Case> {
    let mut random = random(81);
    let mut cases = Vec::new();
    let mut add = |bench, from: Configuration, shift: Vec3, turn: Vec3, clear| {
        let goal = Goal::Transfer(turned(&from.X_HO, shift, turn));
        cases.push(Case { bench, from, goal, clear });
    };
    let (free, point) = (Bench::free_sphere(), Bench::point_sphere());
    for (key, bench) in benches().into_iter().chain([point, point]).enumerate() {
        let (shift, turn) = (random.direction() * 1e-3, random.direction() * 0.03);
        add(bench, somewhere(bench, key as u64), shift, turn, Some("short"));
    }
    for (key, bench) in [free, Bench::hand_sphere(), point].into_iter().enumerate() {
        let from = somewhere(bench, 11 + key as u64);
        add(bench, from, random.direction() * 5e-3, random.direction() * 0.4, None);
    }
    // Up until a joint's limit stops it, sideways into a wall, and from a grasp that holds nothing.
    for (open, walled) in [(free, Bench::walled_sphere()), (point, Bench::walled_points())] {
        add(open, ring(open), Vec3::new(0.0, 0.0, 0.09), Vec3::zeros(), None);
        add(walled, ring(walled), Vec3::new(0.02, 0.0, 0.0), Vec3::zeros(), None);
        add(open, slack(open), Vec3::new(0.0, 2e-3, 1e-3), Vec3::zeros(), None);
    }
    let soft = Bench::soft_sphere();
    for (key, clear) in [(6, Some("with two soft contacts to spare")), (14, None)] {
        let (shift, turn) = if clear.is_some() { (1e-3, 0.03) } else { (5e-3, 0.4) };
        add(soft, somewhere(soft, key), random.direction() * shift, random.direction() * turn, clear);
    }
    // Two soft contacts hold what rests; when they may spin, as hard ones do, they do not.
    two_soft_ones(soft).into_iter().for_each(|from| {
        add(soft, from, Vec3::new(0.0, 0.0, 2e-3), Vec3::zeros(), None);
    });
    for bench in [Bench::pinned_palm(), Bench::pinned_scene()] {
        beside_a_pin(bench).into_iter().for_each(|from| {
            add(bench, from, Vec3::new(0.0, 0.052, 0.0), Vec3::zeros(), None);
        });
    }
    // Less than a step, and many of them with nothing on the way.
    for (bench, up) in [(free, 8e-3), (Bench::free_bar(), 8e-3), (point, 8e-3), (Bench::point_bar(), 8e-3)] {
        let from = if bench.is_ball() { ring(bench) } else { clasp(bench) };
        add(
            bench,
            from.clone(),
            Vec3::new(5e-5, 0.0, 1e-4),
            Vec3::new(0.0, 2e-3, 0.0),
            Some("shorter than a step"),
        );
        add(bench, from, Vec3::new(0.0, 0.0, up), Vec3::zeros(), Some("long, straight"));
    }
    // Three fingers hold, and the first rests before them: a little of a way is free, then one of those that
    // hold meets it, or the ball does.
    for leading in [[1.0, 0.0, 0.1], [0.3, 0.9, 0.2]] {
        let holding = on_ball(free, [[0.0, 0.3, 1.0], leading, [-0.5, 0.87, -0.1], [-0.5, -0.87, 0.0]]);
        let from = at_rest(free, &holding, 0);
        add(free, from.clone(), Vec3::new(-1e-3, 0.0, 2e-3), Vec3::zeros(), Some("with a finger at rest"));
        add(free, from, Vec3::new(0.045, 0.0, 0.0), Vec3::zeros(), None);
    }
    for (key, bench, kind) in uneven() {
        for turn in [random.direction() * 0.03, random.direction() * 0.25] {
            let clear = (turn.norm() < 0.1).then_some(kind);
            add(bench, outside(bench, 60 + key), random.direction() * 1e-3, turn, clear);
        }
    }
    cases
}

/// Objects that are no balls: long boxes, and a ring that dents in and has a hole.
fn uneven() -> [(u64, &'static Bench, &'static str); 4] {
    let (bar, ring) = (Bench::free_bar(), Bench::free_ring());
    [(0, bar, "on a long box"), (1, bar, "on a long box"), (2, ring, "on a ring"), (3, ring, "on a ring")]
}

/// A configuration near another: the pose moved, every contact slid.
fn slid(bench: &Bench, from: &Configuration, shift: f64, slide: f64, random: &mut Random) -> Configuration {
    let X_HO = turned(&from.X_HO, random.direction() * shift, random.direction() * (10.0 * shift));
    let mut contacts = from.contacts;
    for finger in from.holding().iter() {
        let moved = from.contacts[finger].map(|c| bench.surface.walk(&c, &random.direction(), slide));
        contacts[finger] = moved;
    }
    closed(bench, X_HO, &contacts).unwrap_or_else(|| from.clone())
}

fn grasps() -> Vec<Case> {
    let mut random = random(82);
    let mut cases = Vec::new();
    for (key, bench) in benches().into_iter().enumerate() {
        let from = somewhere(bench, 20 + key as u64);
        let to = slid(bench, &from, 1e-3, 2e-3, &mut random);
        cases.push(Case { bench, from, goal: Goal::Grasp(to.into()), clear: Some("short") });
    }
    // Far apart: limits, other fingers or loss of the grasp may be in the way.
    for key in 0..4 {
        let bench = [Bench::free_sphere(), Bench::hand_sphere()][key % 2];
        let (from, to) = (somewhere(bench, 30 + key as u64), somewhere(bench, 40 + key as u64));
        cases.push(Case { bench, from, goal: Goal::Grasp(to.into()), clear: None });
    }
    let free = Bench::free_sphere();
    // Around the back of the finger's box, into another finger, and from a grasp that holds nothing.
    let [near, far] = around(-1.0);
    let (from, to) = (on_ball(free, near), on_ball(free, far));
    cases.push(Case { bench: free, from, goal: Goal::Grasp(to.into()), clear: None });
    let [beside, through] = [[[1.0, 0.1, -0.2], [0.75, 0.65, 0.1]], [[0.6, 0.8, -0.1], [1.0, -0.1, 0.1]]];
    let [from, to] =
        [beside, through].map(|[a, b]| on_ball(free, [a, b, [-1.0, 0.1, 0.1], [0.1, -1.0, 0.0]]));
    cases.push(Case { bench: free, from, goal: Goal::Grasp(to.into()), clear: None });
    let (from, shift) = (slack(free), Vec3::new(0.0, 4e-3, 4e-3));
    let to = closed(free, turned(&from.X_HO, shift, Vec3::zeros()), &from.contacts).expect("it is near");
    cases.push(Case { bench: free, from, goal: Goal::Grasp(to.into()), clear: None });
    let soft = Bench::soft_sphere();
    let (from, far) = (somewhere(soft, 24), somewhere(soft, 44));
    let to = slid(soft, &from, 1e-3, 2e-3, &mut random);
    for (to, clear) in [(to, Some("with soft contacts")), (far, None)] {
        cases.push(Case { bench: soft, from: from.clone(), goal: Goal::Grasp(to.into()), clear });
    }
    for (key, bench, kind) in uneven() {
        let from = outside(bench, 70 + key);
        let to = slid(bench, &from, 1e-3, 2e-3, &mut random);
        cases.push(Case { bench, from, goal: Goal::Grasp(to.into()), clear: Some(kind) });
    }
    cases.extend(long_slides());
    cases
}

/// The object moves far and straight; one fingertip slides far over an object that rests.
fn long_slides() -> [Case; 2] {
    let free = Bench::free_sphere();
    let [from, to] = [0.25, -0.85]
        .map(|z| on_ball(free, [[1.0, 0.1, -0.2], [0.3, 0.9, z], [-1.0, 0.1, 0.1], [0.1, -1.0, 0.0]]));
    let start = ring(free);
    let up = closed(free, turned(&start.X_HO, Vec3::new(0.0, 0.0, 0.03), Vec3::zeros()), &start.contacts);
    let case = |from, to: Configuration, kind| Case {
        bench: free,
        from,
        goal: Goal::Grasp(to.into()),
        clear: Some(kind),
    };
    let up = up.expect("30 mm are within the fingers' boxes");
    [case(from, to, "one fingertip, long"), case(start, up, "long, straight")]
}

/// The regrasp of `finger` that leads to the configuration `to`.
fn regrasp(
    bench: &'static Bench,
    from: Configuration,
    to: &Configuration,
    finger: u8,
    clear: Option<&'static str>,
) -> Case {
    let finger = FingerIndex(finger);
    let goal = Goal::Regrasp { finger, contact: to.contacts[finger], joints: to.joints[finger] };
    Case { bench, from, goal, clear }
}

fn regrasps() -> Vec<Case> {
    let mut random = random(83);
    let mut cases = Vec::new();
    for (key, bench) in benches().into_iter().enumerate() {
        cases.extend((0..20).find_map(|i| short_regrasp(bench, 50 + 20 * key as u64 + i, &mut random)));
    }
    let (free, walled) = (Bench::free_sphere(), Bench::walled_sphere());
    let [from, to] = around(-1.0).map(|directions| on_ball(free, directions));
    cases.push(regrasp(free, from.clone(), &to, 0, None));
    let (held, resting) = (ring(free), at_rest(free, &ring(free), 0));
    cases.push(regrasp(free, held.clone(), &resting, 0, Some("letting go")));
    cases.push(regrasp(free, resting, &held, 0, Some("setting down")));
    let resting = at_rest(free, &from, 0);
    cases.push(regrasp(free, from.clone(), &resting, 0, None));
    cases.push(regrasp(free, resting, &to, 0, None));
    // Between ball and wall, and with a finger that the grasp needs.
    let [from, to] = around(1.0).map(|directions| on_ball(walled, directions));
    cases.push(regrasp(walled, from, &to, 0, None));
    let from = slack(free);
    let to = slid(free, &from, 0.0, 6e-3, &mut random);
    cases.push(regrasp(free, from, &to, 1, None));
    // Two soft contacts hold while the third moves.
    let soft = (0..20).find_map(|i| short_regrasp(Bench::soft_sphere(), 130 + i, &mut random));
    cases.push(soft.expect("among the grasps of the ball is one that two soft contacts hold"));
    for (key, bench, kind) in uneven() {
        let short = (0..20).find_map(|i| short_regrasp(bench, 150 + 20 * key + i, &mut random));
        cases.extend(short.map(|case| Case { clear: Some(kind), ..case }));
    }
    // Past the tip of another finger, and over the edge between two faces.
    let past = [[0.6, 0.8, -0.1], [0.84, -0.5, 0.2]]
        .map(|second| on_ball(free, [[1.0, 0.1, -0.2], second, [-1.0, 0.1, 0.1], [0.1, -1.0, 0.0]]));
    cases.push(regrasp(free, past[0].clone(), &past[1], 1, None));
    for side in [1.0, -1.0] {
        let [from, to] = [-0.5 * side, 1.1 * side]
            .map(|z| on_ball(free, [[1.0, 0.1, -0.2], [0.2, 0.9, z], [-1.0, 0.1, 0.1], [0.1, -1.0, 0.0]]));
        cases.push(regrasp(free, from, &to, 1, Some("far")));
    }
    cases.extend(over_an_edge());
    cases.extend(
        through_something().into_iter().map(|(bench, [from, to])| regrasp(bench, from, &to, 0, None)),
    );
    cases
}

/// One finger of a clasp from a wide face of the bar to a narrow one, and the other way round.
fn over_an_edge() -> Vec<Case> {
    let bar = Bench::free_bar();
    let from = clasp(bar);
    let finger = FingerIndex(1);
    let mut to = from.clone();
    let contact = bar.surface.project(&Vec3::new(-0.05, 8e-3, -5e-3), None).contact;
    let p_HF = to_hand(&from.X_HO, &contact.tip_center(bar.radius()));
    let Some(joints) = bar.world.hand.inverse(finger, &p_HF, &from.joints[finger]) else { return Vec::new() };
    (to.contacts[finger], to.joints[finger]) = (Some(contact), joints);
    vec![regrasp(bar, from.clone(), &to, 1, None), regrasp(bar, to, &from, 1, None)]
}

/// One finger to a contact 6 mm from its own, the others holding, the end free of collision; `None` if this
/// key gives none.
fn short_regrasp(bench: &'static Bench, key: u64, random: &mut Random) -> Option<Case> {
    let from = outside(bench, key);
    let task = bench.task();
    let leaves = |finger: &FingerIndex| {
        closure(&task.grasp(&from, from.holding().without(*finger))) == Closure::Closed
    };
    let finger = bench.fingers().iter().find(leaves)?;
    let contact = bench.surface.walk(from.contacts[finger].as_ref()?, &random.direction(), 6e-3);
    let p_HF = to_hand(&from.X_HO, &contact.tip_center(bench.radius()));
    let joints = task.hand.inverse(finger, &p_HF, &from.joints[finger])?;
    let mut to = from.clone();
    (to.contacts[finger], to.joints[finger]) = (Some(contact), joints);
    let fits = task.clearance.finger_free(finger, &joints, &from.X_HO, TipRule::Touches).is_ok()
        && task.clearance.configuration_free(&to, FingerSet::only(finger), false).is_ok();
    fits.then(|| regrasp(bench, from, &to, finger.0, Some("short")))
}
