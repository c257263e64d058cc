//! What a path means, checked between its states at ten times their number.

use super::{Bench, geometry};
use regrasp_api::*;

/// How finely the motion between two states is looked at.
pub const FINE: usize = 10;

/// The worst values of a transfer.
#[derive(Clone, Copy, Debug, Default)]
pub struct Transfer {
    /// Distance (m) between fingertip and surface.
    pub closure: f64,
    /// Net slip (m) from the start to any instant.
    pub slip: f64,
    /// Net slip (m) from the start to any state.
    pub slip_at_states: f64,
    /// Angle (rad) between a state's normal and the true one.
    pub normal: f64,
    /// Largest motion (m) of a fingertip's centre over the object between two states.
    pub step: f64,
    /// By how much farther (m) a contact point moved than its fingertip's centre, over the object, between
    /// two instants.
    pub jump: f64,
    /// Length (m) that each contact point travelled on the object.
    pub rolled: [f64; MAX_FINGERS],
}

fn between(a: &Configuration, b: &Configuration, s: f64) -> Configuration {
    let mut q = a.clone();
    q.X_HO = interpolate(&a.X_HO, &b.X_HO, s);
    for (finger, joints) in b.joints.iter() {
        q.joints[finger] = a.joints[finger].interpolate(joints, s);
    }
    q
}

/// Touching bodies at one instant: the tip's pose, the object's pose, the contact point and normal in O.
struct Touch {
    X_HF: Pose,
    X_HO: Pose,
    p_OC: Vec3,
    n_O: Vec3,
    gap: f64,
}

impl Touch {
    /// The fingertip's centre in O.
    fn center(&self) -> Vec3 {
        geometry::to_object(&self.X_HO, &self.X_HF.translation.vector)
    }
}

fn touch(bench: &Bench, q: &Configuration, finger: FingerIndex) -> Touch {
    let tip = bench.hand.tip_kinematics(finger, &q.joints[finger]);
    let p_OF = geometry::to_object(&q.X_HO, &tip.p_HF);
    let p_OC = geometry::closest(&bench.object.mesh, &p_OF);
    let out = p_OF - p_OC;
    Touch {
        X_HF: Pose::from_parts(tip.p_HF.into(), tip.R_HF),
        X_HO: q.X_HO,
        p_OC,
        n_O: out.normalize(),
        gap: out.norm() - bench.radius(),
    }
}

/// The displacement, in O, of the fingertip's material point at `a`'s contact less that of the object's.
fn separation(a: &Touch, b: &Touch) -> Vec3 {
    let C_H = geometry::to_hand(&a.X_HO, &a.p_OC);
    let of_tip = geometry::to_hand(&b.X_HF, &geometry::to_object(&a.X_HF, &C_H));
    let slip_O = b.X_HO.rotation.inverse() * (of_tip - geometry::to_hand(&b.X_HO, &a.p_OC));
    slip_O - a.n_O * a.n_O.dot(&slip_O)
}

pub fn transfer(bench: &Bench, path: &Path) -> Transfer {
    let mut worst = Transfer::default();
    for finger in path.states[0].holding().iter() {
        let (mut before, mut net) = (touch(bench, &path.states[0], finger), Vec3::zeros());
        for pair in path.states.windows(2) {
            let from = geometry::to_object(&before.X_HO, &before.X_HF.translation.vector);
            for i in 1..=FINE {
                let now = touch(bench, &between(&pair[0], &pair[1], i as f64 / FINE as f64), finger);
                net += 0.5 * (separation(&before, &now) - separation(&now, &before));
                worst.closure = worst.closure.max(now.gap.abs());
                worst.jump =
                    worst.jump.max((now.p_OC - before.p_OC).norm() - (now.center() - before.center()).norm());
                worst.slip = worst.slip.max(net.norm());
                worst.rolled[finger.index()] += (now.p_OC - before.p_OC).norm();
                before = now;
            }
            worst.slip_at_states = worst.slip_at_states.max(net.norm());
            let contact = pair[1].contacts[finger].unwrap();
            let sin = contact.n_O.cross(&before.n_O).norm();
            worst.normal = worst.normal.max(sin);
            assert!((contact.p_OC - before.p_OC).norm() < 1e-6, "the stored contact is not where it touches");
            let to = geometry::to_object(&before.X_HO, &before.X_HF.translation.vector);
            worst.step = worst.step.max((to - from).norm());
        }
    }
    worst
}

/// Distances (m) of the moving fingertip from the object all along a regrasp, ten for each pair of states.
pub fn gaps(bench: &Bench, path: &Path, finger: FingerIndex) -> Vec<f64> {
    let mut gaps = vec![touch(bench, &path.states[0], finger).gap];
    for pair in path.states.windows(2) {
        let fine = (1..=FINE).map(|i| between(&pair[0], &pair[1], i as f64 / FINE as f64));
        gaps.extend(fine.map(|q| touch(bench, &q, finger).gap));
    }
    gaps
}
