//! Whether samples lie on all sides, sooner or later.

use super::build;
use crate::fixtures::Bench;
use crate::law::{Subject, context};
use crate::report::{Finding, ensure};
use regrasp_api::{Configuration, Pose, PoseRequest, Vec3, angle_between};

/// The most samples that are drawn to see every side.
const DRAWS: u64 = 150;
/// Turned by this much (rad) from start and goal, an object is no longer as it is there.
const TURNED: f64 = 1.0;

/// What samples of a ball that is held freely have shown.
#[derive(Default)]
struct Sides {
    /// Positions in the upper and lower half of the workspace along each axis.
    halves: [[u64; 2]; 3],
    /// Contacts in each octant of the ball.
    octants: [u64; 8],
    /// The object's axes x, y, z up and down the vertical.
    upright: [[u64; 2]; 3],
    turned: u64,
}

impl Sides {
    fn add(&mut self, bench: &Bench, q: &Configuration) {
        let (lower, upper) = bench.world.workspace;
        for (axis, halves) in self.halves.iter_mut().enumerate() {
            let p = q.X_HO.translation.vector[axis] - 0.5 * (lower[axis] + upper[axis]);
            halves[usize::from(p < 0.0)] += u64::from(p.abs() > 1e-9);
        }
        for contact in q.contacts.iter().filter_map(|(_, contact)| contact.as_ref()) {
            self.octants[(0..3).map(|i| usize::from(contact.p_OC[i] > 0.0) << i).sum::<usize>()] += 1;
        }
        for (axis, sides) in self.upright.iter_mut().enumerate() {
            let up = (q.X_HO.rotation * Vec3::ith(axis, 1.0)).z;
            // Level to rounding is neither.
            sides[usize::from(up < 0.0)] += u64::from(up.abs() > 1e-3);
        }
        let turn = |X_HO: &Pose| angle_between(&X_HO.rotation, &q.X_HO.rotation);
        self.turned += u64::from(bench.task().landmarks.iter().all(|landmark| turn(landmark) > TURNED));
    }

    /// What was never seen.
    fn lacks(&self) -> Option<String> {
        if self.turned == 0 {
            return Some(format!("none turns the object by {TURNED} rad from start and goal"));
        }
        if let Some(i) = (0..6).find(|i| self.upright[i / 2][i % 2] == 0) {
            let (axis, side) = (["x", "y", "z"][i / 2], ["up", "down"][i % 2]);
            return Some(format!("none turns the object's {axis} axis {side}"));
        }
        let half = (0..6).find(|i| self.halves[i / 2][i % 2] == 0);
        let half = half.map(|i| (["x", "y", "z"][i / 2], ["upper", "lower"][i % 2]));
        let half =
            half.map(|(axis, side)| format!("none has it in the {side} half of the workspace along {axis}"));
        half.or_else(|| {
            self.octants
                .contains(&0)
                .then(|| format!("none touches one octant of the ball: {:?}", self.octants))
        })
    }
}

/// Poses all over the workspace and turned far, contacts on every side of the object, if only now and then.
pub(super) fn spreads(subject: &Subject<'_>) -> Finding {
    let bench = Bench::free_sphere();
    let (sampler, mut sides) = (build(subject, bench)?, Sides::default());
    let mut before: Option<Configuration> = None;
    for key in 0..DRAWS {
        let found =
            sampler.sample(&bench.task(), PoseRequest::Anywhere, bench.fingers(), &mut context(key))?;
        // A sampler that finds next to nothing, or always the same, is another law's matter.
        if found.is_some() && found == before || key == 10 && before.is_none() {
            return Ok(());
        }
        found.iter().for_each(|q| sides.add(bench, q));
        before = found.or(before);
        if sides.lacks().is_none() {
            return Ok(());
        }
    }
    ensure(false, || format!("of {DRAWS} samples of a ball {}", sides.lacks().unwrap_or_default()))
}
