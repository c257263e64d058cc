//! How a fingertip leaves its contact and comes to another: the law that the verifier has, too.

use super::motion::Motion;
use super::{Kept, ensure, length};
use regrasp_api::{Configuration, FingerIndex, Target, Vec3, interpolate};

/// How often the motion between two states is looked at.
const LOOKS: usize = 4;
/// A fall by less (m) is how exactly joints interpolate a straight retreat.
const FALL: f64 = 1e-6;

/// The moving fingertip at one instant: its centre in O, and its height above the object (m).
struct Instant {
    p_OF: Vec3,
    height: f64,
}

/// Law `regrasp-lifts`: a fingertip that goes from contact to contact rises to the lowest of the task's
/// heights for lifting and retreating; until it is so high, or as high as it comes, it never falls, and while
/// it touches it does not slide. The same backwards in time from the contact at the end.
pub fn lift_kept(motion: &Motion<'_>) -> Kept {
    let (Target::Regrasp { finger, .. }, true) = (motion.to, motion.reached.is_complete()) else {
        return Ok(());
    };
    let states = &motion.path.states;
    let [first, last] = [states.first(), states.last()].map(|q| q.is_some_and(|q| holds(q, *finger)));
    let row = instants(motion, *finger);
    let resolution = motion.chain.task.resolution;
    let lowest = resolution.retreat.into_iter().fold(resolution.lift, f64::min);
    let highest = row.iter().map(|instant| instant.height).fold(f64::NEG_INFINITY, f64::max);
    let moves = states.len() > 1;
    ensure("regrasp-lifts", highest >= lowest - FALL || !(first && last && moves), || {
        format!("`finger[{}]` rises by {}, at least {} is a lift", finger.0, length(highest), length(lowest))
    })?;
    let enough = lowest.min(highest);
    let slide = motion.chain.task.tolerances;
    if first {
        rises(*finger, &mut row.iter(), enough, (slide.closure, slide.slip))?;
    }
    if last {
        rises(*finger, &mut row.iter().rev(), enough, (slide.closure, slide.slip))?;
    }
    Ok(())
}

fn holds(q: &Configuration, finger: FingerIndex) -> bool {
    q.contacts[finger].is_some()
}

/// The fingertip at every state and between them.
fn instants(motion: &Motion<'_>, finger: FingerIndex) -> Vec<Instant> {
    let (task, states) = (motion.chain.task, &motion.path.states);
    let at = |q: &Configuration, next: &Configuration, s: f64| {
        let joints = q.joints[finger].interpolate(&next.joints[finger], s);
        let X_HO = interpolate(&q.X_HO, &next.X_HO, s);
        let p_OF = X_HO.inverse_transform_point(&task.hand.tip_center(finger, &joints).into()).coords;
        Instant { height: task.surface.project(&p_OF, None).distance - motion.chain.ground.radius, p_OF }
    };
    let between = states.windows(2).flat_map(|pair| {
        (0..LOOKS).map(move |k| (&pair[0], &pair[1], k as f64 / LOOKS as f64)).map(|(a, b, s)| at(a, b, s))
    });
    between.chain(states.last().map(|q| at(q, q, 0.0))).collect()
}

/// From a contact until it is high enough.
fn rises(
    finger: FingerIndex,
    row: &mut dyn Iterator<Item = &'_ Instant>,
    enough: f64,
    (closure, slip): (f64, f64),
) -> Kept {
    let Some(contact) = row.next() else { return Ok(()) };
    let (mut highest, mut touches) = (contact.height, true);
    for instant in row {
        ensure("regrasp-lifts", highest - instant.height <= FALL, || {
            let fall = length(highest - instant.height);
            format!("`finger[{}]` falls by {fall} before it is lifted", finger.0)
        })?;
        touches &= instant.height <= closure;
        let slid = (instant.p_OF - contact.p_OF).norm();
        ensure("regrasp-lifts", !touches || slid <= slip, || {
            format!("`finger[{}]` slides by {} while it touches", finger.0, length(slid))
        })?;
        highest = highest.max(instant.height);
        if instant.height >= enough {
            break;
        }
    }
    Ok(())
}
