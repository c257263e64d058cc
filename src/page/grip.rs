//! The forces by which a plan's fingers hold the object, for its page.

use crate::api::{FingerIndex, Hand, ObjectModel, Vec3};
use crate::physics::{Friction, Held, SimulationSettings, Stage, grasp_forces};
use crate::plan::{Criterion, Motion, Plan, Segment, SegmentKind};
use crate::view::GripCurves;
use crate::world::ChainHand;

/// The plan's own forces; where it brings none, those that hold the object against gravity with the least
/// share of the friction within the joints' efforts. `None` where the plan does not fit its own hand.
pub(super) fn grip(plan: &Plan) -> Option<GripCurves> {
    let problem = &plan.scenario.problem;
    let hand = ChainHand::new(problem.hand.clone()).ok()?;
    let object = crate::world::load_object(&problem.object).ok()?;
    let motion = crate::plan::motion(plan).ok()?;
    let held = held(plan, &motion, &hand, &object)?;
    let limits: Vec<f64> = joints(&hand).map(|(finger, j)| hand.finger(finger).joints[j].effort).collect();
    let mut curves = GripCurves { origin: origin(&motion, &held), ..GripCurves::default() };
    for (segment, held) in motion.segments.iter().zip(&held) {
        for (q, held) in segment.states.iter().zip(held) {
            let to_O = q.X_HO.rotation.inverse();
            let force = |finger| held.as_ref().and_then(|held| held.forces[finger]);
            let in_O = |finger| force(finger).map(|force| (to_O * force.force).into());
            curves.forces.push(fingers(&hand).map(in_O).collect());
            let effort = |(finger, j): (FingerIndex, usize)| {
                held.as_ref().map_or(0.0, |held| held.efforts[finger].get(j).copied().unwrap_or(0.0))
            };
            let shares = joints(&hand).zip(&limits).map(|(joint, limit)| effort(joint) / limit);
            curves.efforts.push(shares.collect());
        }
    }
    Some(curves)
}

/// The forces of every state, stage by stage.
fn held(
    plan: &Plan,
    motion: &Motion,
    hand: &ChainHand,
    object: &ObjectModel,
) -> Option<Vec<Vec<Option<Held>>>> {
    let cone = plan.claims.contact.cone;
    // Without an elliptic cone the plan's own forces can be shown, and no others be chosen.
    let friction = match cone {
        Some(cone) => Friction::of(&cone.cone())?,
        None if motion.segments.iter().any(|segment| !segment.forces.is_empty()) => {
            Friction::point(object.friction)
        }
        None => return None,
    };
    let mut settings = SimulationSettings::default();
    if let Criterion::Holding(load) = &plan.claims.criterion {
        settings.relied = load.friction_factor;
        settings.grip = load.max_normal_force;
    }
    let stages: Vec<Stage<'_>> = motion.segments.iter().map(stage).collect();
    let gravity = Vec3::from(plan.scenario.problem.gravity);
    grasp_forces((hand, object, gravity), friction, &stages, &settings).ok()
}

fn stage(segment: &Segment) -> Stage<'_> {
    let moving = match segment.kind {
        SegmentKind::Transfer => None,
        SegmentKind::Regrasp(finger) => Some(finger),
    };
    Stage { states: &segment.states, times: &segment.times, moving, forces: &segment.forces }
}

/// Where the forces come from, and whether there are some everywhere.
fn origin(motion: &Motion, held: &[Vec<Option<Held>>]) -> String {
    let own = motion.segments.iter().any(|segment| segment.forces.iter().any(Option::is_some));
    let origin = match own {
        true => "the plan's own",
        false => "chosen for this page: against gravity, with the least friction within the efforts",
    };
    let all = held.iter().flatten();
    let missing = all.clone().filter(|held| held.as_ref().is_none_or(|held| held.share > 1.0)).count();
    match missing {
        0 => origin.to_owned(),
        _ => format!("{origin}; in {missing} of {} states none within cones and efforts hold", all.count()),
    }
}

fn fingers(hand: &ChainHand) -> impl Iterator<Item = FingerIndex> + use<> {
    (0..hand.finger_count() as u8).map(FingerIndex)
}

/// Every joint of the hand, finger after finger.
fn joints(hand: &ChainHand) -> impl Iterator<Item = (FingerIndex, usize)> {
    fingers(hand).flat_map(|finger| (0..hand.finger(finger).joints.len()).map(move |j| (finger, j)))
}
