//! The reference for `local-planner.grasp`: straight on, contacts sliding along geodesics.

use super::steps::{close, fault, refuse, wrong_target};
use regrasp_api::{
    CallError, Configuration, Context, FingerIndex, LocalPlanner, Path, Reached, Reason, Slot, SurfacePath,
    Target, Task, angle_between, interpolate,
};

/// The largest change of a joint from one state to the next (rad or m).
const JUMP: f64 = 0.4;

/// Moves the pose straight and the contacts along geodesics, in steps of a third of the task's resolution;
/// all or nothing.
#[derive(Clone, Copy, Debug, Default)]
pub struct GraspLine;

/// The ways of the fingertips that hold, and the number of steps.
struct Slides {
    each: Vec<(FingerIndex, SurfacePath)>,
    count: usize,
}

/// Lays the geodesics; `None` where a fingertip cannot follow.
fn slides(
    task: &Task<'_>,
    from: &Configuration,
    to: &Configuration,
    context: &mut Context<'_>,
) -> Result<Option<Slides>, CallError> {
    let distance = (to.X_HO.translation.vector - from.X_HO.translation.vector).norm();
    let angle = angle_between(&from.X_HO.rotation, &to.X_HO.rotation);
    let mut steps = (distance / task.resolution.grasp_step).max(angle / task.resolution.grasp_turn);
    let mut each = Vec::new();
    for finger in from.holding().iter() {
        let (Some(a), Some(b)) = (&from.contacts[finger], &to.contacts[finger]) else { continue };
        let mut slide = SurfacePath::default();
        if !task.surface.geodesic(a, b, &mut slide, context)? {
            return Ok(None);
        }
        steps = steps.max(slide.lift_length() / task.resolution.grasp_step);
        each.push((finger, slide));
    }
    Ok(Some(Slides { each, count: (3.0 * steps).ceil().max(1.0) as usize }))
}

/// The state at step `step`, the joints near those of the state `before`.
fn state(
    task: &Task<'_>,
    (from, to): (&Configuration, &Configuration),
    before: &Configuration,
    slides: &Slides,
    step: usize,
) -> Result<Configuration, Reason> {
    let s = step as f64 / slides.count as f64;
    let mut q = before.clone();
    q.X_HO = interpolate(&from.X_HO, &to.X_HO, s);
    for finger in q.joints.fingers() {
        q.joints[finger] = match slides.each.iter().find(|(f, _)| *f == finger) {
            None => from.joints[finger].interpolate(&to.joints[finger], s),
            Some((_, slide)) => {
                q.contacts[finger] = Some(slide.at(s));
                close(task, &q, finger)?
            }
        };
    }
    Ok(q)
}

/// The states after `from`, or what is in the way.
fn states(
    task: &Task<'_>,
    from: &Configuration,
    to: &Configuration,
    context: &mut Context<'_>,
) -> Result<Result<Vec<Configuration>, Reason>, CallError> {
    if from.holding() != to.holding() {
        return Ok(Err(Reason::Closure));
    }
    let Some(slides) = slides(task, from, to, context)? else { return Ok(Err(Reason::Surface)) };
    let mut states: Vec<Configuration> = Vec::new();
    for step in 1..slides.count {
        context.proceed()?;
        let q = match state(task, (from, to), states.last().unwrap_or(from), &slides, step) {
            Ok(q) => q,
            Err(reason) => return Ok(Err(reason)),
        };
        if let Some(reason) = fault(task, &q, context)? {
            return Ok(Err(reason));
        }
        states.push(q);
    }
    states.push(to.clone());
    let jumps = |a: &Configuration, b: &Configuration| {
        a.joints.iter().any(|(finger, joints)| joints.max_difference(&b.joints[finger]) > JUMP)
    };
    let jump = jumps(from, &states[0]) || states.windows(2).any(|pair| jumps(&pair[0], &pair[1]));
    Ok(if jump { Err(Reason::Closure) } else { Ok(states) })
}

impl LocalPlanner for GraspLine {
    fn connect(
        &self,
        task: &Task<'_>,
        from: &Configuration,
        to: &Target<'_>,
        mut path: Option<&mut Path>,
        context: &mut Context<'_>,
    ) -> Result<Reached, CallError> {
        context.count_call(Slot::GraspPlanner);
        let Target::Grasp(to) = to else { return Err(wrong_target(Slot::GraspPlanner)) };
        if let Some(path) = path.as_deref_mut() {
            path.restart(from);
        }
        match states(task, from, to, context)? {
            Err(reason) => refuse(Slot::GraspPlanner, reason, from, context),
            Ok(states) => {
                if let Some(path) = path {
                    path.states.extend(states);
                }
                Ok(Reached { end: (*to).clone(), fraction: 1.0, stop: None })
            }
        }
    }
}
