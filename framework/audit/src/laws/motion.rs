//! Laws of what a local planner answers.

use super::chain::{Chain, chain_kept};
use super::slip::Touch;
use super::{Kept, broken, ensure, length};
use regrasp_api::{
    CallError, Configuration, Context, FingerIndex, FingerSet, Fingertip, Path, Pose, Reached, Reason, Slot,
    Tally, Target, Task, Vec3, angle_between, interpolate,
};

/// A motion under judgement.
#[derive(Clone, Copy)]
pub struct Motion<'a> {
    /// What its states are held against.
    pub chain: Chain<'a>,
    /// Where it begins.
    pub from: &'a Configuration,
    /// Where it was to go.
    pub to: &'a Target<'a>,
    /// What the planner answered.
    pub reached: &'a Reached,
    /// The states.
    pub path: &'a Path,
}

/// Law `reached`: a fraction in [0, 1], and a reason exactly where it is below 1.
pub fn reached_kept(reached: &Reached) -> Kept {
    let Reached { fraction, stop, .. } = reached;
    let fits = (0.0..=1.0).contains(fraction) && (*fraction == 1.0) == stop.is_none();
    ensure("reached", fits, || match stop {
        None => format!("`stop: None` says that the target was reached, `fraction` is {fraction:.6}"),
        Some(reason) => format!("stopped by `{}` at the fraction {fraction:.6}", reason.name()),
    })
}

/// Law `fraction`: 0 exactly where no way was made; of a transfer, the share of the object's way, to a tenth
/// and a step.
pub fn fraction_kept(task: &Task<'_>, from: &Configuration, to: &Target<'_>, reached: &Reached) -> Kept {
    let (end, fraction) = (&reached.end, reached.fraction);
    let still = end == from;
    let fits = reached.is_complete() || still == (fraction == 0.0);
    ensure("fraction", fits, || match still {
        true => format!("it ends where it began, at the fraction {fraction:.6}"),
        false => "it made some way, at the fraction 0".into(),
    })?;
    let Target::Transfer(X_HO) = to else { return Ok(()) };
    let far = |a: &Pose, b: &Pose| (b.translation.vector - a.translation.vector).norm();
    let turned = |a: &Pose, b: &Pose| angle_between(&a.rotation, &b.rotation);
    let resolution = task.resolution;
    // Of the two ways the one that has more steps.
    let (step, turn) = (resolution.transfer_step, resolution.transfer_turn);
    let ways = [(far(&from.X_HO, X_HO) / step, far(&from.X_HO, &end.X_HO) / step)]
        .into_iter()
        .chain([(turned(&from.X_HO, X_HO) / turn, turned(&from.X_HO, &end.X_HO) / turn)]);
    let Some((whole, made)) = ways.max_by(|a, b| a.0.total_cmp(&b.0)) else { return Ok(()) };
    let off = (made - fraction * whole).abs();
    ensure("fraction", off <= 1.0 + 0.1 * whole, || {
        format!("{:.3} of the object's way is made, the fraction is {fraction:.3}", made / whole)
    })
}

/// Law `reasons`: one refusal is counted in the planner's slot where it stopped short, for the reason that it
/// gives; none where it did not.
pub fn refusal_counted(slot: Slot, reached: &Reached, tally: &Tally) -> Kept {
    let counted: u64 = Reason::ALL.iter().map(|&reason| tally.rejections(slot, reason)).sum();
    match reached.stop {
        Some(reason) => ensure("reasons", counted == 1 && tally.rejections(slot, reason) == 1, || {
            format!("stopped by `{}`, {counted} refusals are counted (`context.reject`)", reason.name())
        }),
        None => ensure("reasons", counted == 0, || format!("it arrived, but counts {counted} refusals")),
    }
}

/// Law `ends`: the first state is where it began, the last the end that it returns.
pub fn ends_kept(motion: &Motion<'_>) -> Kept {
    let states = &motion.path.states;
    ensure("ends", states.first() == Some(motion.from), || "the first state is not where it began".into())?;
    ensure("ends", states.last() == Some(&motion.reached.end), || {
        "the last state is not the returned end".into()
    })
}

/// Law `target`: who says that he arrived is there.
pub fn target_kept(motion: &Motion<'_>) -> Kept {
    let (end, reached) = (&motion.reached.end, motion.reached);
    if !reached.is_complete() {
        return Ok(());
    }
    let there = match motion.to {
        Target::Grasp(q) => end == *q,
        Target::Transfer(X_HO) => end.X_HO == **X_HO,
        Target::Regrasp { finger, contact, joints } => {
            end.joints[*finger] == **joints && end.contacts[*finger] == contact.copied()
        }
    };
    ensure("target", there, || "it says that it arrived, and ends elsewhere".into())
}

/// Laws of the states and of the motion between them: closed, within limits, free, stable, in small steps,
/// without slip.
pub fn states_kept(motion: &Motion<'_>, context: &mut Context<'_>) -> Kept {
    let states = &motion.path.states;
    let moving = match motion.to {
        Target::Regrasp { finger, .. } => Some(*finger),
        _ => None,
    };
    let inner = states.len().saturating_sub(1);
    for (i, q) in states.iter().enumerate() {
        let at = |fault: super::Broken| super::Broken {
            what: format!("state {} of {}: {}", i + 1, inner + 1, fault.what),
            ..fault
        };
        match moving {
            // The moving finger touches at the ends alone.
            Some(finger) => rests(motion, q, finger, i == 0 || i == inner).map_err(at)?,
            None => chain_kept(&motion.chain, q, motion.from.holding()).map_err(at)?,
        }
        if i > 0 && i < inner {
            holds(motion, q, moving, context).map_err(at)?;
        }
    }
    states.windows(2).enumerate().try_for_each(|(i, pair)| {
        let at = |fault: super::Broken| super::Broken {
            what: format!("after state {} of {}: {}", i + 1, inner + 1, fault.what),
            ..fault
        };
        step_kept(motion.chain.task, motion.to, &pair[0], &pair[1])
            .and_then(|()| between(motion, &pair[0], &pair[1], moving))
            .map_err(at)
    })?;
    if matches!(motion.to, Target::Transfer(_)) { no_slip(motion) } else { Ok(()) }
}

/// In a regrasp nothing but the finger moves, and it touches at the ends alone.
fn rests(motion: &Motion<'_>, q: &Configuration, finger: FingerIndex, end: bool) -> Kept {
    let from = motion.from;
    let still = q.X_HO == from.X_HO
        && q.joints.iter().all(|(other, joints)| other == finger || *joints == from.joints[other])
        && q.contacts.iter().all(|(other, contact)| other == finger || *contact == from.contacts[other]);
    ensure("regrasp-others-rest", still, || format!("something else moves than `finger[{}]`", finger.0))?;
    ensure("regrasp-touches-at-ends", end || q.contacts[finger].is_none(), || {
        format!("`finger[{}]` keeps a contact while it moves", finger.0)
    })?;
    chain_kept(&motion.chain, q, q.holding())
}

/// The bodies are apart, and the grasp holds.
fn holds(
    motion: &Motion<'_>,
    q: &Configuration,
    moving: Option<FingerIndex>,
    context: &mut Context<'_>,
) -> Kept {
    let task = motion.chain.task;
    let mut among = FingerSet::first(q.joints.len());
    if let Some(finger) = moving {
        among = FingerSet::EMPTY.with(finger);
        // Close to the surface its own rules hold for the tip that moves.
        if let Err(pair) = lone_free(motion, q, finger) {
            return broken("collision-free", format!("{pair:?} are in collision"));
        }
    } else if let Err(pair) = task.clearance.configuration_free(q, among, true) {
        return broken("collision-free", format!("{pair:?} are closer than the clearance"));
    }
    let holding = moving.map_or(q.holding(), |finger| q.holding().without(finger));
    let grasp = if moving.is_some() { task.grasp(q, holding) } else { task.transfer_grasp(q, holding) };
    let verdict = task.stability.test(&grasp, &mut Default::default(), context);
    match verdict {
        Ok(stability) => ensure("stable", stability.is_stable(), || {
            let held: Vec<u8> = holding.iter().map(|finger| finger.0).collect();
            format!("the fingers {held:?} do not hold the object ({stability:?})")
        }),
        Err(CallError::Interrupted) => Ok(()),
        Err(error) => broken("stable", format!("{error} ({among:?})")),
    }
}

fn lone_free(
    motion: &Motion<'_>,
    q: &Configuration,
    finger: FingerIndex,
) -> Result<(), regrasp_api::BodyPair> {
    let among = FingerSet::first(q.joints.len());
    let tip = regrasp_api::TipRule::Clear(0.0);
    motion.chain.task.clearance.lone_finger(finger, motion.from, among).free(&q.joints[finger], tip)
}

/// Law `steps`: no step is longer than the task's resolution, but for rounding and the bend of the path.
pub fn step_kept(task: &Task<'_>, to: &Target<'_>, a: &Configuration, b: &Configuration) -> Kept {
    /// By how much a step may be longer, and rounding.
    const SLACK: f64 = 2.0 + 1e-6;
    let resolution = task.resolution;
    let (step, turn) = match to {
        Target::Grasp(_) => (resolution.grasp_step, resolution.grasp_turn),
        Target::Transfer(_) => (resolution.transfer_step, resolution.transfer_turn),
        Target::Regrasp { .. } => (resolution.regrasp_step, f64::INFINITY),
    };
    let moved = (b.X_HO.translation.vector - a.X_HO.translation.vector).norm();
    let turned = angle_between(&a.X_HO.rotation, &b.X_HO.rotation);
    let tip = |q: &Configuration, finger| task.hand.tip_center(finger, &q.joints[finger]);
    let tips = match to {
        Target::Regrasp { finger, .. } => (tip(b, *finger) - tip(a, *finger)).norm(),
        _ => 0.0,
    };
    let longest = moved.max(tips);
    ensure("steps", longest <= SLACK * step && turned <= SLACK * turn, || {
        format!(
            "a step of {} and {turned:.4} rad; the resolution is {} and {turn:.4} rad",
            length(longest),
            length(step)
        )
    })
}

/// Half way between two states the holding fingertips still touch, to half of the tolerance; in GS_n to five
/// of them.
fn between(motion: &Motion<'_>, a: &Configuration, b: &Configuration, moving: Option<FingerIndex>) -> Kept {
    if moving.is_some() {
        return Ok(());
    }
    let part = if matches!(motion.to, Target::Grasp(_)) { 5.0 } else { 0.5 * 1.05 };
    let allowed = part * motion.chain.task.tolerances.closure;
    let (ground, hand) = (&motion.chain.ground, motion.chain.task.hand);
    let X_HO = interpolate(&a.X_HO, &b.X_HO, 0.5);
    for finger in a.holding().intersection(b.holding()).iter() {
        let joints = a.joints[finger].interpolate(&b.joints[finger], 0.5);
        let p_OF = X_HO.inverse_transform_point(&hand.tip_center(finger, &joints).into()).coords;
        let gap = motion.chain.task.surface.project(&p_OF, None).distance - ground.radius;
        ensure("closed-between", gap.abs() <= allowed, || {
            format!("half a step on the tip of `finger[{}]` is {} off the object", finger.0, length(gap))
        })?;
    }
    Ok(())
}

/// Slip adds up, as vectors in the object's frame, from the start to any state; point fingertips keep their
/// contacts.
fn no_slip(motion: &Motion<'_>) -> Kept {
    let task = motion.chain.task;
    let allowed = 0.5 * task.tolerances.slip * 1.1;
    for finger in motion.from.holding().iter() {
        let mut net = Vec3::zeros();
        for pair in motion.path.states.windows(2) {
            if task.hand.fingertip() == Fingertip::Point {
                ensure("no-slip", pair[1].contacts == motion.from.contacts, || {
                    "a point fingertip's contact moves".into()
                })?;
                continue;
            }
            let [before, now] = [&pair[0], &pair[1]].map(|q| Touch::new(task.hand, q, finger));
            if let (Some(before), Some(now)) = (before, now) {
                net += before.slip(&now);
            }
            let slip = net.norm();
            ensure("no-slip", slip <= allowed, || {
                format!("`finger[{}]` slips by {}, {} is allowed", finger.0, length(slip), length(allowed))
            })?;
        }
    }
    Ok(())
}
