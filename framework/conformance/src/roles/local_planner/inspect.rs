//! What a path means, looked at between its states by arithmetic of the kit's own.

use crate::fixtures::{Bench, to_hand, to_object};
use crate::reference::closest_on_mesh;
use regrasp_api::{Configuration, FingerIndex, Hand, Path, Pose, Vec3, interpolate};

/// How often the motion between two states is looked at.
const LOOKS: usize = 4;

/// The configuration a fraction `s` of the way between two states, with the contacts of the first.
fn between(a: &Configuration, b: &Configuration, s: f64) -> Configuration {
    let mut q = a.clone();
    q.X_HO = interpolate(&a.X_HO, &b.X_HO, s);
    for (finger, joints) in b.joints.iter() {
        q.joints[finger] = a.joints[finger].interpolate(joints, s);
    }
    q
}

/// Every state, and the motion between states at [`LOOKS`] instants each; with where on the path each lies.
pub(super) fn instants(path: &Path) -> impl Iterator<Item = (f64, Configuration)> + '_ {
    let inner = path.states.windows(2).enumerate().flat_map(|(i, pair)| {
        (0..LOOKS).map(move |k| {
            let s = k as f64 / LOOKS as f64;
            let q = if k == 0 { pair[0].clone() } else { between(&pair[0], &pair[1], s) };
            (i as f64 + s, q)
        })
    });
    let last = path.states.last().map(|q| ((path.states.len() - 1) as f64, q.clone()));
    inner.chain(last)
}

/// A fingertip and the object's point closest to it.
pub(super) struct Touch {
    X_HF: Pose,
    X_HO: Pose,
    pub p_OC: Vec3,
    pub n_O: Vec3,
    /// Distance (m) between fingertip and object; negative where they overlap.
    pub gap: f64,
}

impl Touch {
    pub fn new(bench: &Bench, q: &Configuration, finger: FingerIndex) -> Self {
        let tip = bench.world.hand.tip_kinematics(finger, &q.joints[finger]);
        let p_OF = to_object(&q.X_HO, &tip.p_HF);
        let closest = closest_on_mesh(&bench.world.object.mesh, &p_OF);
        let out = p_OF - closest.point;
        Self {
            X_HF: Pose::from_parts(tip.p_HF.into(), tip.R_HF),
            X_HO: q.X_HO,
            p_OC: closest.point,
            n_O: if closest.distance < 0.0 { -out } else { out }.try_normalize(0.0).unwrap_or(Vec3::z()),
            gap: closest.distance - bench.radius(),
        }
    }

    /// How far, in O and along the surface, the tip's material point at this contact moves against the
    /// object's until `later`.
    pub fn slip(&self, later: &Self) -> Vec3 {
        let contact_H = to_hand(&self.X_HO, &self.p_OC);
        let of_tip = to_hand(&later.X_HF, &to_object(&self.X_HF, &contact_H));
        let of_object = to_hand(&later.X_HO, &self.p_OC);
        let apart = later.X_HO.rotation.inverse() * (of_tip - of_object);
        apart - self.n_O * self.n_O.dot(&apart)
    }
}
