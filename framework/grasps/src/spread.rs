//! Which grasps are too like each other.

use crate::grasp::BulkGrasp;
use regrasp_api::{Configuration, FingerSet, Pose, Vec3};
use std::collections::HashMap;

/// The grasps so far, by where the object is.
///
/// How far two grasps are apart is the largest of these: the distance of the object's two positions; the
/// angle between its two orientations times its radius; for each finger the distance of its two contact
/// points, on the object. Grasps by different fingers are never near. Of twins, grasps nearer than the
/// spread, the earlier one is kept.
pub struct Twins {
    spread: f64,
    /// The object's radius (m).
    radius: f64,
    /// For each cube of the space as wide as the spread the poses in it, by their places in `poses`.
    cells: HashMap<[i64; 3], Vec<u32>>,
    poses: Vec<At>,
    grasps: Vec<Touching>,
}

/// The grasps at one pose.
struct At {
    number: u64,
    X_HO: Pose,
    grasps: Vec<u32>,
}

/// The contacts of one grasp.
struct Touching {
    holding: FingerSet,
    points_O: Vec<Vec3>,
}

impl Touching {
    fn of(q: &Configuration) -> Self {
        let points_O =
            q.contacts.iter().filter_map(|(_, contact)| contact.map(|contact| contact.p_OC)).collect();
        Self { holding: q.holding(), points_O }
    }

    fn is_near(&self, other: &Self, spread: f64) -> bool {
        let near = |(p, q): (&Vec3, &Vec3)| (p - q).norm_squared() < spread * spread;
        self.holding == other.holding && self.points_O.iter().zip(&other.points_O).all(near)
    }
}

impl Twins {
    /// None yet; `spread` (m) above 0, `radius` (m) the object's largest distance from its origin.
    pub fn new(spread: f64, radius: f64) -> Self {
        Self { spread, radius, cells: HashMap::new(), poses: Vec::new(), grasps: Vec::new() }
    }

    /// Whether an earlier grasp is nearer than the spread.
    pub fn has_twin(&self, q: &Configuration) -> bool {
        let (X_HO, touching) = (&q.X_HO, Touching::of(q));
        self.near_poses(X_HO).any(|at| {
            at.grasps.iter().any(|&number| self.grasps[number as usize].is_near(&touching, self.spread))
        })
    }

    /// Takes in a grasp that is kept.
    pub fn add(&mut self, grasp: &BulkGrasp) {
        let number = self.grasps.len() as u32;
        self.grasps.push(Touching::of(&grasp.q));
        match self.poses.last_mut().filter(|at| at.number == grasp.pose) {
            Some(at) => at.grasps.push(number),
            None => {
                let X_HO = grasp.q.X_HO;
                let place = self.poses.len() as u32;
                self.cells.entry(self.cell(&X_HO)).or_default().push(place);
                self.poses.push(At { number: grasp.pose, X_HO, grasps: vec![number] });
            }
        }
    }

    fn cell(&self, X_HO: &Pose) -> [i64; 3] {
        std::array::from_fn(|axis| (X_HO.translation.vector[axis] / self.spread).floor() as i64)
    }

    /// The poses nearer than the spread.
    fn near_poses<'t>(&'t self, X_HO: &'t Pose) -> impl Iterator<Item = &'t At> {
        let center = self.cell(X_HO);
        let cells = (0..27).map(move |k: i64| [k / 9 - 1, k / 3 % 3 - 1, k % 3 - 1]);
        let cells = cells.map(move |step| std::array::from_fn(|axis| center[axis] + step[axis]));
        let places = cells.filter_map(|cell: [i64; 3]| self.cells.get(&cell)).flatten();
        places.map(|&place| &self.poses[place as usize]).filter(move |at| self.is_near(&at.X_HO, X_HO))
    }

    fn is_near(&self, a: &Pose, b: &Pose) -> bool {
        let apart = (a.translation.vector - b.translation.vector).norm_squared();
        apart < self.spread * self.spread
            && regrasp_api::angle_between(&a.rotation, &b.rotation) * self.radius < self.spread
    }
}
