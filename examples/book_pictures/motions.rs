//! Pictures of hand and object.

use crate::problem::{Example, in_hand};
use regrasp::api::{
    Configuration, Context, EdgeKind, FingerIndex, FingerSet, Hand, Hint, Path, Pose, Target, Vec3,
    any_orthogonal,
};
use regrasp::plan::{MarginFrame, SegmentKind};
use regrasp::planner::Fate;
use regrasp::view::picture::{Picture, sheet};
use std::error::Error;
use std::f64::consts::TAU;

type Drawn = Result<String, Box<dyn Error>>;

/// A plan at `count` even moments.
pub fn strip(example: &Example<'_>, count: usize, columns: usize) -> String {
    let states = example.states();
    let at = |k: usize| states[k * (states.len() - 1) / (count - 1)];
    let frames: Vec<_> =
        (0..count).map(at).map(|(q, time)| (example.picture(q), format!("{time:.1} s"))).collect();
    sheet(&frames, columns)
}

/// The grasps in which plans begin.
pub fn first_grasps(examples: &[Example<'_>]) -> String {
    let first =
        |example: &Example| (example.picture(example.states()[0].0), example.setup.scenario().name.clone());
    sheet(&examples.iter().map(first).collect::<Vec<_>>(), 4)
}

/// Adds what every contact did over `states`, painted on the object as it is at the last of them.
fn add_traces(picture: &mut Picture, states: &[Configuration]) {
    let Some(last) = states.last() else { return };
    for finger in last.contacts.fingers() {
        let points: Vec<_> = states
            .iter()
            .filter_map(|q| q.contacts[finger].map(|contact| in_hand(&last.X_HO, &contact)))
            .collect();
        picture.trace("rg-trace", &points);
        if let [(from, _), .., (to, _)] = points[..] {
            picture.mark("rg-from", &from);
            picture.mark("rg-to", &to);
        }
    }
}

/// The longest transfer at three moments, with what its contacts rolled over.
pub fn transfer(example: &Example<'_>) -> Drawn {
    let transfers = example.segments().iter().filter(|segment| segment.kind == SegmentKind::Transfer);
    let segment = transfers.max_by_key(|segment| segment.states.len()).ok_or("no transfer")?;
    let last = segment.states.len() - 1;
    let frames = [0, last / 2, last].map(|k| {
        let mut picture = example.picture(&segment.states[k]);
        add_traces(&mut picture, &segment.states[..=k]);
        (picture, format!("{:.2} s", segment.times[k]))
    });
    Ok(sheet(&frames, 3))
}

/// The regrasp with the longest way, at four moments, with the way of the fingertip's centre.
pub fn regrasp(example: &Example<'_>) -> Drawn {
    let hand = example.hand();
    let way = |finger: FingerIndex, states: &[Configuration]| -> Vec<Vec3> {
        states.iter().map(|q| hand.tip_center(finger, &q.joints[finger])).collect()
    };
    let length = |way: &[Vec3]| way.windows(2).map(|pair| (pair[1] - pair[0]).norm()).sum::<f64>();
    let regrasps = example.segments().iter().filter_map(|segment| match segment.kind {
        SegmentKind::Regrasp(finger) => Some((segment, way(finger, &segment.states))),
        SegmentKind::Transfer => None,
    });
    let longest = regrasps.max_by(|a, b| length(&a.1).total_cmp(&length(&b.1)));
    let (segment, way) = longest.ok_or("no regrasp")?;
    let last = way.len() - 1;
    let frames = [0, last / 3, 2 * last / 3, last].map(|k| {
        let mut picture = example.picture(&segment.states[k]);
        // In front of everything: the way in the air, which no surface hides.
        let towards = Vec3::new(0.0, -1.0, 0.0);
        picture.trace("rg-way", &way.iter().map(|p| (*p, towards)).collect::<Vec<_>>());
        picture.mark("rg-to", &way[k]);
        (picture, format!("{:.2} s", segment.times[k]))
    });
    Ok(sheet(&frames, 4))
}

/// The rim of a friction cone and its apex, reaching into the object.
fn cone((p, n): (Vec3, Vec3), mu: f64) -> Vec<Vec3> {
    let (height, u) = (0.014, any_orthogonal(&n));
    let v = n.cross(&u);
    let rim = (0..24).map(|k| TAU * f64::from(k) / 24.0);
    let rim = rim.map(|angle| p - n * height + (u * angle.cos() + v * angle.sin()) * (mu * height));
    rim.chain([p]).collect()
}

/// A node of the graph of which one finger may not be lifted: the whole grasp, and without each finger.
pub fn liftable(example: &Example<'_>) -> Drawn {
    let (task, mut context) = (example.setup.task(), Context::seeded(0));
    let all = FingerSet::first(task.hand.finger_count());
    let mut found = None;
    for q in example.graph().nodes() {
        let liftable = task.stability.liftable(&task.grasp(q, all), 0, &mut context)?;
        if q.holding() == all && liftable.len() + 1 == all.len() {
            found = Some(q);
            break;
        }
    }
    let q = found.ok_or("every finger of every node may be lifted")?;
    // One centre and one length for all, so that margins compare.
    let length = MarginFrame::of_object(task.object).length;
    let mut frames = Vec::new();
    for lifted in std::iter::once(None).chain(all.iter().map(Some)) {
        let holding = lifted.map_or(all, |finger| all.without(finger));
        let grasp = task.grasp(q, holding);
        let assessed = task.stability.assess(&grasp, Some(length), Some(task.object.p_OCm), &mut context)?;
        let mut shown = q.clone();
        lifted.iter().for_each(|&finger| shown.contacts[finger] = None);
        let mut picture = example.picture(&shown);
        for contact in holding.iter().filter_map(|finger| q.contacts[finger]) {
            picture.outline("rg-cone", &cone(in_hand(&q.X_HO, &contact), task.planning_friction()));
        }
        let who =
            lifted.map_or("all four".into(), |finger| format!("without {}", task.hand.finger(finger).name));
        let (low, high) = (assessed.margin_lower, assessed.margin_upper);
        let verdict = if low > 0.0 { format!("{low:.3} to {high:.3}") } else { "not stable".into() };
        frames.push((picture, format!("{who}: {verdict}")));
    }
    Ok(sheet(&frames, 3))
}

/// Two nodes that a path in GS_n joins: the contacts slide along it (above); rolled over the same way, they
/// go elsewhere (below).
pub fn slide_and_roll(example: &Example<'_>) -> Drawn {
    let (task, mut context) = (example.setup.task(), Context::seeded(0));
    let graph = example.graph();
    let inside = |fate| graph.edges().into_iter().find(|e| e.kind == EdgeKind::Grasp && e.fate == fate);
    let edge = inside(Fate::Used).or_else(|| inside(Fate::Executable)).or_else(|| inside(Fate::Valid));
    let edge = edge.ok_or("no path in GS_n")?;
    let [from, to] = [edge.from, edge.to].map(|node| &graph.nodes()[node.0 as usize]);
    let mut slid = Path::default();
    example.setup.plugins().grasp.connect(&task, from, &Target::Grasp(to), Some(&mut slid), &mut context)?;
    let mut rolled = Path::default();
    let transfer = &example.setup.plugins().transfer;
    transfer.connect(&task, from, &Target::Transfer(&to.X_HO), Some(&mut rolled), &mut context)?;
    let mut frames = Vec::new();
    for (name, path) in [("slides", &slid), ("rolls", &rolled)] {
        let last = path.states.len() - 1;
        for k in [0, last / 2, last] {
            let mut picture = example.picture(&path.states[k]);
            add_traces(&mut picture, &path.states[..=k]);
            let grasp = task.grasp(&path.states[k], path.states[k].holding());
            let stable = task.stability.test(&grasp, &mut Hint::default(), &mut context)?.is_stable();
            let turned = turn_deg(&from.X_HO, &path.states[k].X_HO);
            frames.push((picture, format!("{name}, {turned:.0}°{}", if stable { "" } else { ", unstable" })));
        }
    }
    Ok(sheet(&frames, 3))
}

/// The angle between two orientations (degrees).
pub fn turn_deg(a: &Pose, b: &Pose) -> f64 {
    regrasp::api::angle_between(&a.rotation, &b.rotation).to_degrees()
}
