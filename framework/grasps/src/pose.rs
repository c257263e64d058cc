//! Where the object is: poses spread evenly over the places at which enough fingers may reach it.

use regrasp_api::{FingerIndex, FingerSet, Pose, Problem, Random, Task, Vec3};

/// Draws poses: the position uniform in a box, the orientation uniform over all.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PoseLaw {
    lower: Vec3,
    upper: Vec3,
    /// Largest distance of the object's surface from its origin (m).
    radius: f64,
}

impl PoseLaw {
    /// The box is the problem's workspace, or else what at least `fewest` fingers can reach together.
    pub fn new(task: &Task<'_>, problem: &Problem, fewest: usize) -> Self {
        let radius = task.object.mesh.radius();
        let (lower, upper) = match problem.workspace {
            Some(given) => (given.lower.into(), given.upper.into()),
            None => common_box(task, radius, fewest),
        };
        Self { lower, upper, radius }
    }

    /// Largest distance of the object's surface from its origin (m).
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// A pose, which fingers may not reach at all.
    pub fn draw(&self, random: &mut Random) -> Pose {
        let p = Vec3::from_fn(|i, _| random.range(self.lower[i], self.upper[i]));
        Pose::from_parts(p.into(), random.rotation())
    }

    /// The fingers that may reach the object there, by their balls of reach.
    pub fn may_reach(&self, task: &Task<'_>, X_HO: &Pose) -> FingerSet {
        let near = |finger: &FingerIndex| {
            let model = task.hand.finger(*finger);
            let most = model.reach + self.radius + task.hand.fingertip_radius();
            (X_HO.translation.vector - model.p_HReach).norm_squared() <= most * most
        };
        FingerSet::first(task.hand.finger_count()).iter().filter(near).collect()
    }
}

/// A box that holds all origins of the object at which `fewest` fingers can touch it: along each axis, what
/// so many of the fingers' own boxes share.
fn common_box(task: &Task<'_>, radius: f64, fewest: usize) -> (Vec3, Vec3) {
    let fingers = FingerSet::first(task.hand.finger_count());
    let bound = |axis: usize, side: f64| {
        let mut ends: Vec<f64> = fingers
            .iter()
            .map(|finger| {
                let model = task.hand.finger(finger);
                let reach = model.reach + radius + task.hand.fingertip_radius();
                side * (model.p_HReach[axis] + side * reach)
            })
            .collect();
        // The farthest end that `fewest` fingers reach.
        ends.sort_by(|a, b| b.total_cmp(a));
        side * ends[fewest.clamp(1, ends.len()) - 1]
    };
    let corner = |side: f64| Vec3::from_fn(|axis, _| bound(axis, side));
    (corner(-1.0), corner(1.0))
}
